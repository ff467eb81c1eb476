//! Fig. 10: how often a view is found in the city, by noise and by the number of buildings seen.

use super::{data, judge};
use crate::experiments::Context;
use crate::methods::city_proceduralization::localization::{Landmark, landmarks};
use crate::methods::city_proceduralization::{Mode, proceduralize};
use crate::report::{Chart, Corner, Figure, Scale, Series};
use crate::{Error, Result};

/// Noise in standard deviations of the features.
const NOISE: [f64; 5] = [0.0, 0.05, 0.1, 0.2, 0.4];
/// Buildings in a view.
const SEEN: [usize; 3] = [3, 6, 9];

/// Looks views of each city up in its grammar of level 4.
pub fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let views = ctx.budget().choose(10, 200, 200);
    ctx.setting("views", views);
    let cities = data::cities(ctx)?;
    let units: Vec<usize> = (0..cities.len()).collect();
    let results: Vec<Vec<Vec<f64>>> = ctx.units(
        &units,
        |c| cities[*c].0.clone(),
        |&c| {
            let city = &cities[c].1;
            let made =
                proceduralize(city, &data::settings(Mode::Best, 4, seed)).map_err(Error::method)?;
            let derived = made.grammar.derive().map_err(Error::method)?;
            let known = landmarks(&derived.city(&made.grammar)).0;
            // Views are taken of the city as it was; what is solid of a dirty mesh is not known.
            let truth: Vec<Landmark> = landmarks(&data::repaired(city)).0;
            let rank = |seen, noise| judge::rank_one(&truth, &known, noise, seen, views, seed);
            Ok(SEEN.map(|s| NOISE.map(|n| rank(s, n)).to_vec()).to_vec())
        },
    )?;
    for (&c, found) in units.iter().zip(&results) {
        let name = &cities[c].0;
        let mut chart = Chart::new(
            name.as_str(),
            Scale::new("noise, standard deviations"),
            Scale::new("views found first"),
        )
        .legend(Corner::Above);
        for (seen, line) in SEEN.iter().zip(found) {
            for (noise, &value) in NOISE.iter().zip(line) {
                let instance = format!("seen_{seen}/noise_{noise}");
                ctx.observe(data::row(name, "best", &instance, "rank_1", value, ""));
            }
            let points = NOISE.iter().copied().zip(line.iter().copied());
            chart = chart.series(Series::marked(
                format!("{seen} buildings"),
                points.collect(),
            ));
        }
        let suffix = match c {
            0 => String::new(),
            _ => format!("_{name}"),
        };
        let figure = Figure::single(format!("localization in {name}"), chart);
        ctx.figure(&format!("figure_10{suffix}"), &figure)?;
    }
    ctx.note("A view is a building and those nearest to it, in any order, each with width, depth, height and solid share; it is found when the first place sees exactly these. In the made city many places look alike, because its motifs repeat.");
    Ok(())
}
