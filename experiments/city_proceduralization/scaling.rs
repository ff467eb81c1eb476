//! Seconds by number of buildings, on made cities.

use super::{data, synthetic};
use crate::Result;
use crate::experiments::Context;
use crate::methods::city_proceduralization::Mode;
use crate::report::{Chart, Figure, Scale, Series};

/// Runs cities of growing size.
pub fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let sizes: &[usize] =
        ctx.budget()
            .choose(&[16, 32], &[170, 500, 1700, 5000], &[170, 1700, 17_000]);
    let results: Vec<f64> = ctx.units(sizes, usize::to_string, |&motifs| {
        let (city, _) = synthetic::city(motifs, 0.03, seed);
        Ok(data::measure(&city, &data::settings(Mode::Best, 4, seed))?.seconds)
    })?;
    let mut line = Vec::new();
    for (&motifs, &seconds) in sizes.iter().zip(&results) {
        let buildings = (6 * motifs) as f64;
        ctx.observe(data::row(
            "synthetic",
            "best",
            &buildings.to_string(),
            "seconds",
            seconds,
            "s",
        ));
        line.push((buildings, seconds));
    }
    let chart = Chart::new(
        "",
        Scale::new("buildings").log(),
        Scale::new("seconds").log(),
    )
    .series(Series::marked("best, wall clock", line));
    ctx.figure("scaling", &Figure::single("seconds by buildings", chart))
}
