//! Fig. 8: a city beside what its grammar derives to.

use super::data;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Mode, judge, proceduralize};
use edifice_frame::Context;
use edifice_io_city::picture::{Drawing, Drawn, View, bounds, draw};

/// Part of the width of a made city that is drawn: its buildings are small and far apart.
const NEAR: f64 = 0.12;

/// Draws each city beside its level 4; of the made one a part.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let width = ctx.budget().choose(160, 720, 1200);
    for (name, city) in data::cities(ctx)? {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let derived = made
            .grammar
            .derive()
            .map_err(Error::method)?
            .city(&made.grammar);
        let whole = Drawing {
            width,
            height: width * 5 / 8,
            view: View::Oblique,
            around: None,
        };
        let near = bounds(&city, &whole).filter(|_| name == data::MADE);
        let around = near.map(|(low, high)| {
            let at = [0, 1].map(|k| (low[k] + high[k]) / 2.0 + city.origin[k]);
            (at, NEAR * (high[0] - low[0]).max(high[1] - low[1]))
        });
        let drawing = Drawing { around, ..whole };
        let drawn = [&city, &derived].map(|city| Drawn {
            city,
            colours: None,
        });
        let picture = draw(&drawn, &drawing, &Vec::new()).map_err(Error::method)?;
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
