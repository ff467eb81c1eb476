//! The first test of a method: perfect grids of which a part is seen.

use super::row;
use crate::Context;
use edifice_structure_completion::layout::Element;
use edifice_structure_completion::made::grids::{self, Sight};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::model::shipped_model;
use edifice_structure_completion::score::Scored;
use edifice_report::{Align, Table};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};

/// Intersection over union at which a completion is perfect.
const PERFECT: f64 = 0.9;

/// Completes 24 grids by all methods with the default model, and compares the score of the truth with that of the truth
/// without one element.
pub fn run(ctx: &mut Context) -> Result<()> {
    let model = shipped_model().map_err(Error::method)?;
    let all = grids::all(ctx.seed());
    let grids: Vec<_> = all
        .iter()
        .take(ctx.budget().choose(3, all.len(), all.len()))
        .collect();
    let title = format!(
        "Of {} grids, completed perfectly (every window, and nothing else, at {PERFECT})",
        grids.len()
    );
    let mut table = Table::new(title)
        .column("method", Align::Left)
        .numbers(Sight::ALL.map(Sight::name));
    for method in Method::ALL {
        let mut cells = vec![method.name().to_string()];
        for sight in Sight::ALL {
            let mut perfect = 0;
            for (k, (layout, size)) in grids.iter().enumerate() {
                let mut rng = stream(ctx.seed(), sight.name(), k as u64);
                let (partial, hidden) = sight.of(layout, *size, &mut rng);
                let done = complete(method, &partial, &model, 1, &mut rng);
                let added: Vec<Element> = done
                    .iter()
                    .flat_map(|c| c.added.iter().map(|a| a.element))
                    .collect();
                let f1 = agreement(&added, &hidden, PERFECT).f1;
                perfect += usize::from(f1 == 1.0);
                let instance = format!("{}/{}", sight.name(), layout.name);
                ctx.observe(row("made", method.name(), instance, None, "f1_90", f1));
            }
            cells.push(perfect.to_string());
        }
        table.row(cells);
    }
    ctx.table(&table);
    if let Some(paper) = &model.paper {
        let mut best = 0;
        for (layout, _) in &grids {
            let facade = [layout.width, layout.height];
            let mut scored = Scored::new(&paper.score, facade, layout.elements.clone());
            let truth = scored.score();
            let mut without = |k: usize| {
                let score = scored.apply(
                    edifice_structure_completion::score::Change::Remove(k),
                );
                scored.undo();
                score
            };
            let higher = (0..layout.elements.len()).all(|k| without(k) < truth);
            best += usize::from(higher);
            let instance = format!("truth/{}", layout.name);
            let value = f64::from(u8::from(higher));
            ctx.observe(row("made", "paper", instance, None, "truth_is_best", value));
        }
        ctx.note(&format!(
            "The paper's score of the grid is above that of the grid without any one of its windows for {best} of {} grids.",
            grids.len()
        ));
    }
    Ok(())
}
