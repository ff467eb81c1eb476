//! Speed of the procedural logic: parse, n-ary, rules and statistics, from the label image in memory.
//!
//! On the shipped layouts, and on ECP2011 when `EDIFICE_DATA` names the data folder. The target is
//! 1 ms per facade on one core; the paper's own time is 32 ms.

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edifice::methods::procedural_logic::{
    Alphabet, Canvas, Coefficients, Inference, Parameters, Profile, learn_affinity, parse,
};
use edifice::shape::{LabelGrid, Lattice};
use edifice_experiments::layouts;
use edifice_experiments::procedural_logic::data::{label_images, shipped_source};

const PARAMETERS: Parameters = Parameters::COMPRESSION;

fn sets() -> Vec<(&'static str, Vec<LabelGrid>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let shipped = layouts::read_all(&folder).and_then(|layouts| shipped_source(&layouts));
    let shipped = shipped.expect("the shipped layouts are read");
    let mut sets = vec![
        ("shipped_houses", shipped.grids),
        ("shipped_blocks", shipped.other),
    ];
    if let Some(data) = std::env::var_os("EDIFICE_DATA") {
        let folder = Path::new(&data).join("facades/ecp2011/labels");
        if let Ok(grids) = label_images(&folder) {
            sets.push(("ecp2011", grids));
        }
    }
    sets
}

fn infer(grids: &[LabelGrid], alphabet: &mut Alphabet, coefficients: &Coefficients) -> Inference {
    let mut inference = Inference::default();
    for grid in grids {
        let labels = alphabet.intern_all(&grid.labels);
        if let Ok(tree) = parse(&Canvas::from_grid(grid, labels), coefficients, &PARAMETERS) {
            black_box(inference.add(&tree));
        }
    }
    inference
}

fn procedural_logic(criterion: &mut Criterion) {
    for (name, grids) in sets() {
        let mut alphabet = Alphabet::default();
        let coefficients = learn_affinity(&grids, &mut alphabet, &PARAMETERS).normalized();
        let mut group = criterion.benchmark_group("procedural_logic");
        group.sample_size(20);
        group.throughput(Throughput::Elements(grids.len() as u64));
        group.bench_function(
            BenchmarkId::new(format!("inference/{name}"), grids.len()),
            |bencher| bencher.iter(|| infer(&grids, &mut alphabet, &coefficients)),
        );
        group.bench_function(
            BenchmarkId::new(format!("affinity/{name}"), grids.len()),
            |bencher| {
                bencher.iter(|| learn_affinity(&grids, &mut Alphabet::default(), &PARAMETERS))
            },
        );
        let rules = infer(&grids, &mut alphabet, &coefficients).rules;
        let labels = alphabet.intern_all(&grids[0].labels);
        let canvas = Canvas::from_grid(&grids[0], labels);
        if let Ok(tree) = parse(&canvas, &coefficients, &PARAMETERS) {
            let start = Inference::default().add(&tree).start;
            group.throughput(Throughput::Elements(1));
            group.bench_function(BenchmarkId::new(format!("profile/{name}"), 1), |bencher| {
                bencher.iter(|| Profile::new(&tree, &rules, start, Lattice::read(&grids[0])));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, procedural_logic);
criterion_main!(benches);
