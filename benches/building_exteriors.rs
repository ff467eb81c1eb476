//! Times of houses: fixed seeds, sizes in the names.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use edifice::experiments::building_exteriors::houses::houses;
use edifice::methods::building_exteriors::attributes::attributes;
use edifice::methods::building_exteriors::data::dataset;
use edifice::model::hierarchy::{Constant, Settings, learn};

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

criterion_group!(benches, of_houses);
criterion_main!(benches);
