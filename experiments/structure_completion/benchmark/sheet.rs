//! Twelve random completions of each part, to be looked at.

use rand::seq::SliceRandom;

use super::super::picture::panel;
use super::measures::added;
use super::models::{MADE, Models};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::Figure;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::sights::Sight;

/// Pictures of each part.
const SHOWN: usize = 12;

/// Draws one row for each part: what is added is outlined. Real facades where there are some.
pub(crate) fn draw(ctx: &mut Context, models: &Models) -> Result<()> {
    let real = models.tested.iter().any(|t| t.set != MADE);
    let mut order: Vec<usize> = (0..models.tested.len())
        .filter(|&k| (models.tested[k].set != MADE) == real)
        .collect();
    let (wide, high) = (100.0, 104.0);
    let mut figure = Figure::new(
        "Random completions by the default model, a row for each part that is hidden; added elements are outlined",
        SHOWN,
    )
    .cell(wide, high);
    let shown = ctx.budget().choose(1, SHOWN, SHOWN);
    for (row, sight) in Sight::all().into_iter().enumerate() {
        let rng = &mut stream(ctx.seed(), "benchmark: sheet", row as u64);
        order.shuffle(rng);
        for place in 0..SHOWN {
            let tested = order.get(place).filter(|_| place < shown);
            let Some(&k) = tested else { continue };
            let layout = &models.tested[k].layout;
            let (partial, _) = sight.hide_frozen(layout);
            let done = complete(Method::Best, &partial, &models.all[0], 1, rng);
            // The name of the part stands once a row, with room at its sides.
            let name = if place == 1 {
                sight.name()
            } else {
                String::new()
            };
            figure = figure.panel(panel(
                name,
                layout.width,
                layout.height,
                &partial.observed,
                &added(done.first()),
            ));
        }
    }
    ctx.figure("benchmark", &figure)
}
