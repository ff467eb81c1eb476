//! Fig. 8: a city beside what its grammar derives to.

use super::data;
use crate::Context;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Mode, judge, proceduralize};
use edifice_io::city::picture::{Drawing, Drawn, draw};
use edifice_shape::triangles::City;

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
        let drawing = Drawing {
            width,
            height: width * 5 / 8,
            plan: false,
            around: (name == data::MADE).then(|| middle(&city)),
        };
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

/// The middle of a city in its reference system, and the radius around it that is drawn.
fn middle(city: &City) -> ([f64; 2], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (l, h) in city.buildings.iter().filter_map(|b| b.mesh.bounds()) {
        for k in 0..2 {
            low[k] = low[k].min(l[k]);
            high[k] = high[k].max(h[k]);
        }
    }
    let at = [0, 1].map(|k| (low[k] + high[k]) / 2.0 + city.origin[k]);
    (at, NEAR * (high[0] - low[0]).max(high[1] - low[1]))
}
