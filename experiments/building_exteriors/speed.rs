//! One run of EM at fixed cardinalities on ever more houses: time and memory are linear in houses.

use rand::RngExt;

use super::data;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_frame::memory::{peak_megabytes, reset_peak};
use edifice_model::em::Stopping;
use edifice_model::hierarchy::{Priors, fit};
use edifice_report::{Chart, Corner, Figure, Row, Scale, Series, Table};

/// Cardinalities of the hidden variables: those of the generator.
const KINDS: [usize; 10] = [5, 3, 2, 4, 4, 3, 4, 3, 3, 3];
/// Rounds of EM: the same for all sizes, so that only houses differ.
const ROUNDS: usize = 20;

/// Fits houses drawn with replacement from the shipped ones, up to as many as the budget allows.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let sizes: Vec<usize> = ctx.budget().choose(
        vec![1_000],
        vec![10_000, 100_000],
        vec![10_000, 100_000, 1_000_000],
    );
    ctx.setting("sizes", sizes.clone());
    ctx.setting("rounds", ROUNDS);
    let stopping = Stopping {
        movement: 0.0,
        gain: 0.0,
        max_rounds: ROUNDS,
    };
    let mut table = Table::new("One run of EM, 7 styles, 20 rounds")
        .numbers(["houses"])
        .times(["seconds", "microseconds per house", "peak MB"]);
    let mut line = Vec::new();
    for &houses in &sizes {
        let mut rng = stream(ctx.seed(), "building_exteriors/speed", houses as u64);
        let count = shipped.data.table.rows();
        let drawn: Vec<usize> = (0..houses).map(|_| rng.random_range(0..count)).collect();
        reset_peak();
        let data = shipped.data.select(&drawn);
        let start = std::time::Instant::now();
        fit(
            &data.table,
            &data.groups,
            7,
            &KINDS,
            &Priors::default(),
            &stopping,
            ctx.seed(),
        )
        .map_err(Error::method)?;
        let seconds = start.elapsed().as_secs_f64();
        let peak = peak_megabytes();
        line.push((houses as f64, seconds));
        table.row([
            houses.to_string(),
            format!("{seconds:.2}"),
            format!("{:.1}", 1e6 * seconds / houses as f64),
            peak.map_or("not known".to_owned(), |mb| format!("{mb:.0}")),
        ]);
        let mut observe = |metric: &str, value: f64, unit: &str| {
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: "ours".into(),
                instance: houses.to_string(),
                seed: Some(ctx.seed()),
                metric: metric.into(),
                value,
                unit: unit.into(),
                ..Row::default()
            });
        };
        observe("seconds", seconds, "s");
        if let Some(mb) = peak {
            observe("peak_memory", mb, "MB");
        }
    }
    ctx.table_of_times(&table);
    ctx.note(
        "Peak memory is that of the whole process while it drew and fitted these houses (VmHWM of Linux, set back \
         before each size), data included: a table and one standardised copy.",
    );
    let chart = Chart::new("", Scale::new("houses").log(), Scale::new("seconds").log())
        .legend(Corner::Above)
        .series(Series::marked("20 rounds of EM, wall clock", line));
    ctx.figure_of_times(
        "speed",
        &Figure::single("seconds of one run of EM by houses", chart),
    )
}
