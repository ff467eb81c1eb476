//! Seconds of the whole structure search (Sec. 7: 40 minutes for 200 buildings).

use super::{data, settings};
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_model::hierarchy::{Settings, learn};
use edifice_report::{Chart, Corner, Figure, Row, Scale, Series};

/// Learns from the first 50, 100, 150 and 200 shipped houses, S from 2 to 25 as in the paper.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = Settings {
        styles: ctx.budget().choose(2..=3, 2..=25, 2..=25),
        ..settings(ctx)
    };
    let sizes: Vec<usize> =
        ctx.budget()
            .choose(vec![30], vec![50, 100, 200], vec![50, 100, 150, 200]);
    let mut line = Vec::new();
    for &houses in &sizes {
        let data = shipped.data.select(&(0..houses).collect::<Vec<_>>());
        // One after the other, since the search itself takes all threads.
        let start = std::time::Instant::now();
        learn(&data.table, &data.groups, &settings, ctx.seed()).map_err(Error::method)?;
        let seconds = start.elapsed().as_secs_f64();
        line.push((houses as f64, seconds));
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "ours".into(),
            instance: houses.to_string(),
            seed: Some(ctx.seed()),
            metric: "seconds".into(),
            value: seconds,
            unit: "s".into(),
            ..Row::default()
        });
    }
    if let Some((houses, seconds)) = line.last() {
        ctx.compare_times(
            format!("learning from {houses} houses"),
            "about 40 minutes for 200",
            format!("{seconds:.1} s"),
        );
    }
    let chart = Chart::new(
        "",
        Scale::new("houses").from_zero(),
        Scale::new("seconds").from_zero(),
    )
    .legend(Corner::Above)
    .series(Series::marked("whole search, wall clock", line));
    ctx.figure_of_times(
        "learning",
        &Figure::single("seconds of the whole structure search", chart),
    )
}
