//! Fig. 10: how often a view is found in the city, by noise and by the number of buildings seen.

use super::photographs::Streets;
use super::{data, judge};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::localization::{Landmark, landmarks};
use edifice_city_proceduralization::{Mode, proceduralize};
use edifice_frame::Context;
use edifice_io_city as city;
use edifice_report::{Chart, Corner, Figure, Scale, Series};
use edifice_shape::triangles::City;

/// Noise in standard deviations of the features.
const NOISE: [f64; 5] = [0.0, 0.05, 0.1, 0.2, 0.4];
/// Buildings in a view.
const SEEN: [usize; 3] = [3, 6, 9];

/// Photographs in a view.
const PHOTOGRAPHS: [usize; 3] = [1, 3, 6];
/// Noise of photographs in greys, of 255.
const GREYS: [f64; 5] = [0.0, 5.0, 10.0, 20.0, 40.0];

/// Looks rectified photographs of facades up in Chiba, whose buildings have textures: in the city, and in its grammar of level 1.
fn photographs(ctx: &mut Context, views: usize) -> Result<()> {
    let seed = ctx.seed();
    let Some(city) = data::chiba(ctx)? else {
        return Ok(());
    };
    let mut chart = Chart::new(
        "photographs in Chiba",
        Scale::new("noise, greys of 255"),
        Scale::new("views found first"),
    )
    .legend(Corner::Above);
    let streets = Streets::new(&city);
    let grammar = derived(&city, seed)?;
    let known = [
        ("city", streets.facades.clone()),
        ("grammar", streets.of(&grammar)),
    ];
    let units: Vec<(usize, usize)> = (0..2).flat_map(|k| PHOTOGRAPHS.map(|n| (k, n))).collect();
    let lines: Vec<Vec<f64>> = ctx.units(
        &units,
        |(k, n)| format!("chiba {} {n}", known[*k].0),
        |&(k, n)| {
            Ok(GREYS
                .map(|g| streets.rank_one(&known[k].1, n, g, views, seed))
                .to_vec())
        },
    )?;
    for (&(k, count), line) in units.iter().zip(&lines) {
        for (noise, &value) in GREYS.iter().zip(line) {
            let instance = format!("photographs_{count}/greys_{noise}");
            ctx.observe(data::row(
                "chiba", known[k].0, &instance, "rank_1", value, "",
            ));
        }
        let points = GREYS.iter().copied().zip(line.iter().copied());
        chart = chart.series(Series::marked(
            format!("{count} in the {}", known[k].0),
            points.collect(),
        ));
    }
    let figure = Figure::single("localization by photographs", chart);
    ctx.figure("figure_10_photographs", &figure)
}

fn derived(city: &City, seed: u64) -> Result<City> {
    let settings = data::settings(Mode::Best, 1, seed);
    let mut made = proceduralize(city, &settings, &unwatched).map_err(Error::method)?;
    let textures = made.box_textures(city, 256);
    city::add_textures(&mut made.grammar, &textures).map_err(Error::method)?;
    let derivation = made.grammar.derive().map_err(Error::method)?;
    let mut derived = derivation.city(&made.grammar);
    city::paint_parts(&mut derived).map_err(Error::method)?;
    Ok(derived)
}

/// Looks views of each city up in its grammar of level 4.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let views = ctx.budget().choose(10, 20, 200);
    ctx.setting("views", views);
    let cities = data::cities(ctx)?;
    let units: Vec<usize> = (0..cities.len()).collect();
    let results: Vec<Vec<Vec<f64>>> = ctx.units(
        &units,
        |c| cities[*c].0.clone(),
        |&c| {
            let city = &cities[c].1;
            let made = proceduralize(city, &data::settings(Mode::Best, 4, seed), &unwatched)
                .map_err(Error::method)?;
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
    photographs(ctx, views)?;
    ctx.note("A view is a building and those nearest to it, in any order, each with width, depth, height and solid share; it is found when the first place sees exactly these. In the made city many places look alike, because its motifs repeat. Photographs are of facades of neighbours, found when the first place is one of them; they are the city's own textures with noise, without what a camera adds: light, trees, perspective that is left.");
    Ok(())
}
