//! Processor seconds of mass models, roofs, facades and whole houses (Sec. 7: 12 minutes and 1 minute).

use std::time::Instant;

use rayon::prelude::*;

use super::data;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::facade::{FacadeTarget, furnish};
use edifice_building_exteriors::house::scene::{Placed, scene};
use edifice_building_exteriors::house::solids::prisms;
use edifice_building_exteriors::house::{Database, Joining, Options, generate};
use edifice_building_exteriors::mass::{MASS, MassTarget, SearchLimits, search};
use edifice_frame::Context;
use edifice_io::gltf;
use edifice_report::{Align, Row, Table};
use edifice_shape::solid::faces;

/// Times the parts of every shipped house, the house itself left out of the donors, and many whole houses.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let database = Database::new(shipped.buildings).map_err(Error::method)?;
    let many = ctx.budget().choose(5, 30, 200);
    let whole = ctx.budget().choose(10, 30, 1000);
    ctx.setting("houses", many);
    ctx.setting("whole_houses", whole);
    let row = |i: usize| -> [f64; 49] {
        std::array::from_fn(|c| database.rows[i % database.rows.len()][c].unwrap_or(0.0))
    };
    let mut times: [Vec<f64>; 3] = Default::default();
    // One after the other: times of one house must not contain those of another.
    for i in 0..many {
        let wanted = row(i);
        let options = SearchLimits {
            leave_out: Some(i),
            ..SearchLimits::default()
        };
        let target = MassTarget::new(std::array::from_fn(|c| wanted[c]));
        let mut rng = stream(ctx.seed(), "building_exteriors/generation_speed", i as u64);
        let clock = Instant::now();
        let mass = search(&target, &[], &database, &options, &mut rng).map_err(Error::method)?;
        times[0].push(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        let shell = faces(&prisms(&mass.building, Joining::Boxes));
        times[1].push(clock.elapsed().as_secs_f64());
        let target = FacadeTarget {
            wanted: std::array::from_fn(|k| wanted[MASS + k]),
            windows: std::array::from_fn(|k| wanted[42 + k] > 0.5),
            cuts: true,
            fixed: Vec::new(),
        };
        let clock = Instant::now();
        furnish(
            &mass.building,
            &shell,
            &target,
            &database.deviations[MASS..39],
        );
        times[2].push(clock.elapsed().as_secs_f64());
    }
    let seed = ctx.seed();
    let clock = Instant::now();
    let bytes = (0..whole).into_par_iter().map(|k| -> Result<usize> {
        let mut rng = stream(seed, "building_exteriors/generation_speed/whole", k as u64);
        let options = Options::default();
        let made = generate(
            "house",
            &row(k),
            &[false; 49],
            &database,
            &options,
            &mut rng,
        );
        let made = made.map_err(Error::method)?;
        let scene = scene(&[Placed {
            name: "house",
            surface: &made.model.surface,
            at: [0.0; 2],
            colours: k,
        }]);
        Ok(gltf::to_bytes(&scene).map_err(Error::method)?.len())
    });
    let bytes: usize = bytes.collect::<Result<Vec<_>>>()?.into_iter().sum();
    let seconds = clock.elapsed().as_secs_f64();

    let mut table = Table::new("Milliseconds of one house on one core")
        .column("part", Align::Left)
        .numbers(["median", "99 %", "longest", "paper"]);
    let names = ["mass model", "roofs and walls", "facades"];
    let printed = ["12 minutes for a set", "–", "1 minute"];
    for ((name, own), printed) in names.into_iter().zip(&mut times).zip(printed) {
        own.sort_by(f64::total_cmp);
        let at = |share: f64| 1e3 * own[((own.len() - 1) as f64 * share).round() as usize];
        table.row([
            name.to_owned(),
            format!("{:.2}", at(0.5)),
            format!("{:.2}", at(0.99)),
            format!("{:.2}", at(1.0)),
            printed.to_owned(),
        ]);
        for (metric, value) in [("seconds", at(0.5) / 1e3), ("seconds_p99", at(0.99) / 1e3)] {
            ctx.observe(time(name, metric, value, seed));
        }
    }
    ctx.table_of_times(&table);
    ctx.observe(time("glTF of whole houses", "seconds", seconds, seed));
    ctx.compare_times(
        format!("{whole} houses from attributes to binary glTF in memory"),
        "not printed",
        format!("{seconds:.1} s, {:.0} MB", bytes as f64 / 1e6),
    );
    Ok(())
}

fn time(name: &str, metric: &str, value: f64, seed: u64) -> Row {
    Row {
        dataset: "shipped".into(),
        method: "best".into(),
        instance: name.into(),
        seed: Some(seed),
        metric: metric.into(),
        value,
        unit: "s".into(),
        ..Row::default()
    }
}
