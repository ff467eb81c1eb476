//! Fig. 8: a city beside what its grammar derives to.

use super::data;
use crate::Context;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Mode, judge, proceduralize};
use edifice_io::city::picture::side_by_side;

/// Draws each city beside its level 4.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let width = ctx.budget().choose(160, 900, 1200);
    for (name, city) in data::cities(ctx)? {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let derived = made
            .grammar
            .derive()
            .map_err(Error::method)?
            .city(&made.grammar);
        let picture =
            side_by_side(&[&city, &derived], width, width * 3 / 4).map_err(Error::method)?;
        let value = judge::iou(&city, &made.grammar).map_err(Error::method)?;
        ctx.observe(data::row(&name, "best", "level_4", "iou", value, ""));
        let what = format!(
            "{name}: the original and its {} templates",
            made.grammar.templates.len()
        );
        ctx.attach(&format!("figure_8_{name}.png"), &picture, &what)?;
    }
    Ok(())
}
