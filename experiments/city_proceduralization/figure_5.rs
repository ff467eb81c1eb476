//! Fig. 5: a rule, its mean transforms, and what it derives to.

use super::data;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Mode, proceduralize};
use edifice_frame::Context;
use edifice_io_city::picture::side_by_side;
use edifice_report::{Align, Table};

/// Draws the pattern that holds the most buildings, and lists its successors.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let width = ctx.budget().choose(120, 360, 480);
    for (name, city) in data::cities(ctx)? {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let mut grammar = made.grammar;
        // Patterns are what the axiom does not lead to.
        let patterns = grammar.rules.iter().filter(|r| r.symbol.starts_with('P'));
        let size = |r: &edifice_grammar::instance::InstanceRule| {
            r.weight * (r.successors.len() - 1) as f64
        };
        let largest = patterns.max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some(rule) = largest.cloned() else {
            ctx.note(format!("{name}: no pattern repeats."));
            continue;
        };
        let title = format!("{name}: {} stands {} times", rule.symbol, rule.weight);
        let mut table = Table::new(title.as_str())
            .column("successor", Align::Left)
            .numbers(["x", "y", "z", "turn"]);
        for s in &rule.successors {
            let mut row = vec![s.symbol.clone()];
            row.extend(s.at.iter().chain([&s.turn]).map(|v| format!("{v:.2}")));
            table.row(row);
        }
        ctx.table(&table);
        for (metric, value) in [
            ("times", rule.weight),
            ("successors", rule.successors.len() as f64),
        ] {
            ctx.observe(data::row(&name, "best", &rule.symbol, metric, value, ""));
        }
        grammar.axiom.clone_from(&rule.symbol);
        let derived = grammar.derive().map_err(Error::method)?.city(&grammar);
        let picture = side_by_side(&[&derived], width, width * 3 / 4).map_err(Error::method)?;
        let what = format!(
            "{name}: what {} derives to, by its mean transforms",
            rule.symbol
        );
        ctx.attach(&format!("figure_5_{name}.png"), &picture, &what)?;
    }
    Ok(())
}
