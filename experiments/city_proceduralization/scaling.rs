//! Seconds and memory by number of buildings: made cities, and Manhattan laid out again and again with jitter.

use std::time::Instant;

use rand_distr::{Distribution, StandardNormal};

use super::data;
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{
    Decomposition, Mode, decompose, from_components, proceduralize,
};
use edifice_frame::Progress;
use edifice_frame::memory::{peak_megabytes, reset_peak};
use edifice_frame::{Budget, Context};
use edifice_generators_city_proceduralization as synthetic;
use edifice_io_city as city;
use edifice_report::{Align, Chart, Corner, Figure, Scale, Series, Table};
use edifice_shape::triangles::{City, CityBuilding};

/// Standard deviation of the factors of a copy's width, depth and height.
const JITTER: f64 = 0.03;
/// Ground between two copies of a city, in metres.
const GAP: f64 = 200.0;

/// Runs cities of growing size.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let settings = data::settings(Mode::Best, 4, seed);
    let mut table = Table::new("Time and memory of level 4, `best`")
        .column("city", Align::Left)
        .numbers(["buildings", "components", "templates"])
        .times(["seconds", "peak memory, MB"]);
    let mut lines = vec![("made cities".to_owned(), Vec::new())];
    let sizes: &[usize] =
        ctx.budget()
            .choose(&[16, 32], &[170, 500, 1700, 5000], &[170, 1700, 17_000]);
    let progress = Progress::new("scaling: made cities", sizes.len() as u64, 0);
    for &motifs in sizes {
        let (city, _) = synthetic::city(motifs, 0.03, seed);
        let found = timed(city.buildings.len(), || {
            let made = proceduralize(&city, &settings, &unwatched).map_err(Error::method)?;
            Ok((
                made.decomposition.components.len(),
                made.grammar.templates.len(),
            ))
        })?;
        found.note(ctx, "synthetic", &mut table);
        lines[0].1.push((found.buildings as f64, found.seconds));
        progress.step();
    }
    drop(progress);
    if ctx.budget() > Budget::Smoke
        && let Some(path) = ctx.real("city/nyc_manhattan_lod2.npz")?
    {
        let manhattan = city::read(&path)?;
        let sizes: &[usize] = ctx.budget().choose(
            &[],
            &[10_000, 47_815, 150_000],
            &[10_000, 47_815, 150_000, 400_000, 1_000_000],
        );
        let mut line = Vec::new();
        let progress = Progress::new("scaling: Manhattan, tiled", sizes.len() as u64, 0);
        for &buildings in sizes {
            let found = timed(buildings, || {
                let (city, cut) = tiled(&manhattan, buildings, seed);
                let components = cut.components.len();
                let made =
                    from_components(&city, cut, &settings, &unwatched).map_err(Error::method)?;
                Ok((components, made.grammar.templates.len()))
            })?;
            found.note(ctx, "manhattan, tiled", &mut table);
            line.push((buildings as f64, found.seconds));
            progress.step();
        }
        drop(progress);
        lines.push(("Manhattan, tiled with jitter".to_owned(), line));
        ctx.note("Manhattan, tiled: copies side by side, each building with its own factors of width, depth and height (3 %); a copy is made when it is its turn to be cut, so that the triangles of one copy only are in memory. Seconds include making the copies.");
    }
    ctx.table(&table);
    ctx.note("Peak memory is that of the whole process (VmHWM of Linux, set back before each size), the input included.");
    let mut chart = Chart::new(
        "",
        Scale::new("buildings").log(),
        Scale::new("seconds").log(),
    )
    .legend(Corner::Above);
    for (name, line) in lines {
        chart = chart.series(Series::marked(name, line));
    }
    ctx.figure_of_times("scaling", &Figure::single("seconds by buildings", chart))
}

/// The size of a city, and the time and memory that it took.
struct Found {
    buildings: usize,
    components: usize,
    templates: usize,
    seconds: f64,
    memory: Option<f64>,
}

fn timed(buildings: usize, work: impl FnOnce() -> Result<(usize, usize)>) -> Result<Found> {
    reset_peak();
    let start = Instant::now();
    let (components, templates) = work()?;
    Ok(Found {
        buildings,
        components,
        templates,
        seconds: start.elapsed().as_secs_f64(),
        memory: peak_megabytes(),
    })
}

impl Found {
    fn note(&self, ctx: &mut Context, city: &str, table: &mut Table) {
        let instance = self.buildings.to_string();
        let mut observe = |metric: &str, value: f64, unit: &str| {
            ctx.observe(data::row(city, "best", &instance, metric, value, unit));
        };
        observe("seconds", self.seconds, "s");
        if let Some(mb) = self.memory {
            observe("peak_memory", mb, "MB");
        }
        table.row([
            city.to_owned(),
            instance,
            self.components.to_string(),
            self.templates.to_string(),
            format!("{:.1}", self.seconds),
            self.memory
                .map_or("not known".to_owned(), |mb| format!("{mb:.0}")),
        ]);
    }
}

/// The components of `buildings` buildings, copies of a city side by side, and a city of their names without triangles.
fn tiled(city: &City, buildings: usize, seed: u64) -> (City, Decomposition) {
    let bounds = city.buildings.iter().filter_map(|b| b.mesh.bounds());
    let (low, high) = bounds.fold(
        ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]),
        |(l, h), (a, b)| {
            (
                [0, 1].map(|k| l[k].min(a[k])),
                [0, 1].map(|k| h[k].max(b[k])),
            )
        },
    );
    let span = [0, 1].map(|k| high[k] - low[k] + GAP);
    let copies = buildings.div_ceil(city.buildings.len().max(1));
    let side = (copies as f64).sqrt().ceil() as usize;
    let mut names = City::default();
    let mut cut = Decomposition::default();
    for copy in 0..copies {
        let first = names.buildings.len();
        let shift = [
            (copy % side) as f64 * span[0],
            (copy / side) as f64 * span[1],
        ];
        let tile = jittered(city, buildings - first, copy, shift, seed);
        let own = decompose(&tile, true, &unwatched);
        cut.components
            .extend(own.components.into_iter().map(|mut c| {
                c.building += first;
                c
            }));
        cut.faults.extend(own.faults);
        cut.empty.extend(own.empty.into_iter().map(|b| first + b));
        names
            .buildings
            .extend(tile.buildings.into_iter().map(|b| CityBuilding {
                id: b.id,
                ..CityBuilding::default()
            }));
    }
    (names, cut)
}

/// The first `most` buildings of a city, shifted, each scaled about the middle of its ground.
fn jittered(city: &City, most: usize, copy: usize, shift: [f64; 2], seed: u64) -> City {
    let mut rng = stream(seed, "city tiles", copy as u64);
    let one = |b: &CityBuilding| {
        let mut mesh = b.mesh.clone();
        let (low, high) = mesh.bounds().unwrap_or_default();
        let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, low[2]];
        let factors: [f64; 3] = std::array::from_fn(|_| {
            let z: f64 = StandardNormal.sample(&mut rng);
            (JITTER * z).exp()
        });
        let shift = [shift[0], shift[1], 0.0];
        for p in &mut mesh.positions {
            *p = [0, 1, 2].map(|k| middle[k] + factors[k] * (p[k] - middle[k]) + shift[k]);
        }
        CityBuilding {
            id: format!("{copy}-{}", b.id),
            attributes: serde_json::Map::new(),
            mesh,
            ..CityBuilding::default()
        }
    };
    City {
        buildings: city.buildings.iter().take(most).map(one).collect(),
        ..City::default()
    }
}
