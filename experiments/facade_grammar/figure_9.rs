//! Fig. 9 and 11: the grammar of the example, without and with the extensions.

use super::data::{self, FIGURE_9};
use super::published::Published;
use super::runs::{Answer, Question, Solver, least, mean, solve};
use super::{BEST, PAPER, picture};
use edifice_base::Result;
use edifice_facade_grammar::Operations;
use edifice_frame::Context;
use edifice_grammar::{Costs, Grammar, derivation, evaluate};
use edifice_io::grammar_cga;
use edifice_report::{Align, Figure, Outline, Row, Table, category};
use edifice_shape::Facade;

/// Fig. 9: split and repeat.
pub(crate) fn figure_9(ctx: &mut Context) -> Result<()> {
    let facade = data::figure_9(ctx)?;
    let printed = grammar_cga::read(&data::folder(ctx)?.join(format!("{FIGURE_9}.cga")))?;
    let costs = Costs::default();
    let theirs = evaluate(&printed, std::slice::from_ref(&facade), &costs)
        .map_err(edifice_base::Error::method)?;
    let best = example(ctx, &facade, Operations::default())?;
    let numbers = Published::read(ctx)?;
    ctx.compare(
        "rules of the grammar",
        numbers.text(["figure_9", "printed_grammar", "i", "rules", "value"]),
        best.1.rules.to_string(),
    );
    ctx.compare(
        "cost of the grammar",
        format!("{:.1} (the printed grammar, our evaluator)", theirs.cost),
        format!("{:.1}", best.1.cost),
    );
    ctx.note("The grammar printed in Sec. 4.6, with sizes of our choice:");
    ctx.note(format!("```\n{}\n```", grammar_cga::to_string(&printed)));
    ctx.note("The cheapest grammar found:");
    ctx.note(format!("```\n{}\n```", grammar_cga::to_string(&best.0)));
    let figure = Figure::new(
        "non-terminals of the printed and of the inferred grammar",
        2,
    )
    .cell(430.0, 460.0)
    .panel(regions("Printed grammar", &facade, &printed)?)
    .panel(regions("Inferred grammar", &facade, &best.0)?);
    ctx.figure("figure_9", &figure)
}

/// Fig. 11: with the extensions of Sec. 4.7.
pub(crate) fn figure_11(ctx: &mut Context) -> Result<()> {
    let facade = data::figure_9(ctx)?;
    let plain = example(ctx, &facade, Operations::default())?;
    let mirrored = Operations {
        grid_split: false,
        ..Operations::all()
    };
    let extended = example(ctx, &facade, mirrored)?;
    ctx.compare(
        "cost without the extensions",
        "39.4 (sum over the printed rules)",
        format!("{:.1}", plain.1.cost),
    );
    ctx.compare(
        "cost with the extensions",
        "36.3 (sum over the printed rules)",
        format!("{:.1}", extended.1.cost),
    );
    ctx.compare(
        "rules with the extensions",
        "9",
        extended.1.rules.to_string(),
    );
    ctx.note(
        "The printed rules of Fig. 11 ask for equal walls above and below NT10, while our sizes of Fig. 9 differ there (8 and 12); \
         their cost is therefore the sum over the rules as printed, with repeatABA and symsplit costed as repeat and split. \
         Also allowed are repeat_aba and sym_split.",
    );
    ctx.note(format!("```\n{}\n```", grammar_cga::to_string(&extended.0)));
    let figure = Figure::new("non-terminals without and with the extensions", 2)
        .cell(430.0, 460.0)
        .panel(regions("Split and repeat", &facade, &plain.0)?)
        .panel(regions("With the extensions", &facade, &extended.0)?);
    ctx.figure("figure_11", &figure)
}

/// Both configurations on the example, several seeds; the cheapest grammar.
fn example(
    ctx: &mut Context,
    facade: &Facade,
    operations: Operations,
) -> Result<(Grammar, Answer)> {
    let (_, many) = super::iterations(ctx.budget());
    let seeds = ctx.budget().choose(1, 10, 10);
    let extended = operations != Operations::default();
    let label = if extended {
        "all_operations"
    } else {
        "split_repeat"
    };
    ctx.setting("iterations", many);
    ctx.setting("seeds", seeds);
    let units: Vec<_> = [BEST, PAPER]
        .into_iter()
        .flat_map(|m| (0..seeds).map(move |run| (Solver::Infer(m, many), run)))
        .map(|(solver, run)| (solver, ctx.seed() + run))
        .collect();
    let found = ctx.units(
        &units,
        |(solver, seed)| format!("{label}/{}/{seed}", solver.name()),
        |&(solver, seed)| {
            let question = Question {
                operations,
                ..Question::new(solver, seed)
            };
            let (grammar, answer) = solve(std::slice::from_ref(facade), &question)?;
            Ok((edifice_io::grammar_json::to_string(&grammar), answer))
        },
    )?;
    let mut table = Table::new(format!("Cost of facade (i), {label}, {seeds} seeds"))
        .column("method", Align::Left)
        .numbers(["least", "mean", "seeds at the least"]);
    for method in [BEST, PAPER] {
        let name = Solver::Infer(method, many).name();
        let mine = units
            .iter()
            .zip(&found)
            .filter(|((s, _), _)| s.name() == name);
        let costs: Vec<f64> = mine.map(|(_, (_, answer))| answer.cost).collect();
        let low = least(&costs);
        let at = costs.iter().filter(|c| **c <= low + 1e-9).count();
        table.row([
            name,
            format!("{low:.1}"),
            format!("{:.2}", mean(&costs)),
            at.to_string(),
        ]);
    }
    ctx.table(&table);
    for ((solver, seed), (_, answer)) in units.iter().zip(&found) {
        for (metric, value) in [("cost", answer.cost), ("rules", answer.rules as f64)] {
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: format!("{}_{label}", solver.name()),
                instance: facade.name.clone(),
                seed: Some(*seed),
                metric: metric.into(),
                value,
                ..Row::default()
            });
        }
    }
    let best = found.iter().min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    let Some((text, answer)) = best else {
        return Err(edifice_base::Error::method("no run was asked for"));
    };
    let grammar = edifice_io::grammar_json::parse(text.as_bytes(), "grammar".as_ref())?;
    Ok((grammar, *answer))
}

/// The facade with its non-terminal regions outlined, one colour for each symbol that occurs more
/// than once.
fn regions(title: &str, facade: &Facade, grammar: &Grammar) -> Result<edifice_report::Tiles> {
    let derived = derivation(grammar, 0).map_err(edifice_base::Error::method)?;
    let mut count = vec![0usize; grammar.rules.len()];
    for n in &derived.non_terminals {
        count[n.rule] += 1;
    }
    let shared: Vec<usize> = (0..count.len()).filter(|&r| count[r] > 1).collect();
    let outlines = derived.non_terminals.iter().filter_map(|n| {
        let colour = shared.iter().position(|&r| r == n.rule)?;
        // Drawn a little inside, so that nested outlines stay apart.
        let inset = 0.8 * n.depth as f64;
        Some(Outline {
            rect: [
                n.rect.x + inset,
                n.rect.y + inset,
                n.rect.width - 2.0 * inset,
                n.rect.height - 2.0 * inset,
            ],
            colour: category(colour),
            name: String::new(),
        })
    });
    let caption = format!(
        "{} rules; colours are the {} symbols used more than once",
        grammar.rules.len(),
        shared.len()
    );
    Ok(picture::tiles(title, facade)
        .outlines(outlines.collect())
        .caption(caption))
}
