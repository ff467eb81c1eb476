//! Fig. 7: quality against compression, for both representatives and for `best`.

use super::data::{self, Measures};
use edifice_base::Result;
use edifice_base::unwatched;
use edifice_city_proceduralization::{Mode, Representative};
use edifice_frame::Context;
use edifice_report::{Chart, Corner, Figure, Scale, Series};

/// Runs all levels of each curve.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let levels: u32 = ctx.budget().choose(3, 4, 10);
    ctx.setting("levels", levels);
    let cities = data::cities(ctx)?;
    let curves = [
        ("paper", Mode::Paper, Representative::Nearest),
        ("paper_poly", Mode::Paper, Representative::FewestPolygons),
        ("best", Mode::Best, Representative::Nearest),
    ];
    let mut units = Vec::new();
    for c in 0..cities.len() {
        for k in 0..curves.len() {
            units.extend((1..=levels).map(|l| (c, k, l)));
        }
    }
    let key = |u: &(usize, usize, u32)| format!("{}/{}/{}", cities[u.0].0, curves[u.1].0, u.2);
    let run = |&(c, k, level): &(usize, usize, u32)| {
        let mut settings = data::settings(curves[k].1, level, seed);
        settings.representative = curves[k].2;
        data::measure(&cities[c].1, &settings, &unwatched)
    };
    let results: Vec<Measures> = ctx.units(&units, key, run)?;
    for (c, (name, _)) in cities.iter().enumerate() {
        let mut chart = Chart::new(
            name.as_str(),
            Scale::new("triangles of templates").log(),
            Scale::new("volumetric IoU"),
        )
        .legend(Corner::Above);
        for (k, (method, ..)) in curves.iter().enumerate() {
            let own = units
                .iter()
                .zip(&results)
                .filter(|(u, _)| (u.0, u.1) == (c, k));
            let mut line = Vec::new();
            for (u, m) in own {
                let instance = format!("level_{}", u.2);
                ctx.observe(data::row(name, method, &instance, "iou", m.iou, ""));
                ctx.observe(data::row(
                    name, method, &instance, "polygons", m.polygons, "",
                ));
                line.push((m.polygons, m.iou));
            }
            chart = chart.series(Series::marked(*method, line));
        }
        let suffix = if c == 0 {
            String::new()
        } else {
            format!("_{name}")
        };
        let figure = Figure::single(format!("quality against compression, {name}"), chart);
        ctx.figure(&format!("figure_7{suffix}"), &figure)?;
    }
    Ok(())
}
