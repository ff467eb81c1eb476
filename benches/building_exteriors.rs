//! Times of houses: fixed seeds, sizes in the names.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use edifice::io::gltf;
use edifice::methods::building_exteriors::attributes::attributes;
use edifice::methods::building_exteriors::data::dataset;
use edifice::methods::building_exteriors::facade::{FacadeTarget, furnish};
use edifice::methods::building_exteriors::house::scene::{Placed, scene};
use edifice::methods::building_exteriors::house::solids::prisms;
use edifice::methods::building_exteriors::house::{Database, Joining, Options, generate};
use edifice::methods::building_exteriors::mass::{MassTarget, SearchLimits, search};
use edifice::model::hierarchy::{Constant, Settings, learn};
use edifice::rng::stream;
use edifice::shape::solid::faces;
use edifice_generators_building_exteriors::houses;
use rayon::prelude::*;

fn of_houses(c: &mut Criterion) {
    c.bench_function("generate/houses_200", |b| {
        b.iter(|| houses(black_box(1), 200))
    });
    let made = houses(1, 200);
    c.bench_function("attributes/houses_200", |b| {
        b.iter(|| {
            made.iter()
                .map(|h| attributes(&h.building))
                .collect::<Vec<_>>()
        })
    });
    let rows = made.iter().map(|h| attributes(&h.building));
    let rows: Vec<_> = rows
        .collect::<Result<_, _>>()
        .expect("at most three floors");
    let data = dataset(&rows).expect("finite");
    let settings = Settings {
        styles: 7..=7,
        constant: Constant::Keep,
        ..Settings::default()
    };
    let mut group = c.benchmark_group("learn");
    group.sample_size(10);
    group.bench_function("houses_200_styles_7", |b| {
        b.iter(|| learn(&data.table, &data.groups, &settings, 1))
    });
    group.finish();
}

/// The parts of a house's way from its attributes to files, the house itself left out of the donors.
fn of_generation(c: &mut Criterion) {
    let buildings = houses(1, 200).into_iter().map(|h| h.building);
    let database = Database::new(buildings.collect()).expect("at most three floors");
    let row = |i: usize| -> [f64; 49] {
        std::array::from_fn(|c| database.rows[i][c].expect("all sides have pieces"))
    };
    let without = |i: usize| SearchLimits {
        leave_out: Some(i),
        ..SearchLimits::default()
    };
    let some = || (0..200).step_by(10);
    c.bench_function("mass/houses_20", |b| {
        b.iter(|| {
            for i in some() {
                let target = MassTarget::new(std::array::from_fn(|c| row(i)[c]));
                let mut rng = stream(1, "benches/mass", i as u64);
                black_box(search(&target, &[], &database, &without(i), &mut rng).ok());
            }
        })
    });
    c.bench_function("roof/houses_20", |b| {
        b.iter(|| {
            for i in some() {
                let solids = prisms(&database.buildings[i], Joining::Boxes);
                black_box(faces(&solids));
            }
        })
    });
    let shells: Vec<_> = some()
        .map(|i| (i, faces(&prisms(&database.buildings[i], Joining::Boxes))))
        .collect();
    c.bench_function("facades/houses_20", |b| {
        b.iter(|| {
            for (i, shell) in &shells {
                let row = row(*i);
                let target = FacadeTarget {
                    wanted: std::array::from_fn(|k| row[27 + k]),
                    windows: std::array::from_fn(|k| row[42 + k] > 0.5),
                    cuts: true,
                    fixed: Vec::new(),
                };
                let deviations = &database.deviations[27..39];
                black_box(furnish(&database.buildings[*i], shell, &target, deviations));
            }
        })
    });
    let mut group = c.benchmark_group("whole");
    group.sample_size(10);
    group.bench_function("glb_of_houses_1000", |b| {
        b.iter(|| {
            let bytes = (0..1000_usize).into_par_iter().map(|k| {
                let mut rng = stream(1, "benches/whole", k as u64);
                let (wanted, given) = (row(k % 200), [false; 49]);
                let options = Options::default();
                let house = generate("h", &wanted, &given, &database, &options, &mut rng);
                let house = house.expect("a row of a house can be built");
                let scene = scene(&[Placed {
                    name: "h",
                    surface: &house.model.surface,
                    at: [0.0; 2],
                    colours: k,
                }]);
                gltf::to_bytes(&scene).map_or(0, |bytes| bytes.len())
            });
            black_box(bytes.sum::<usize>())
        })
    });
    group.finish();
}

criterion_group!(benches, of_houses, of_generation);
criterion_main!(benches);
