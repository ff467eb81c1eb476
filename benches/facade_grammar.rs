//! Inference of facade grammars: the number of terminals stands in the id.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use edifice::grammar::derive;
use edifice::methods::facade_grammar::{Method, Settings, infer};
use edifice::unwatched;
use edifice_generators_facade_grammar as made;

fn settings(method: Method, iterations: u64) -> Settings {
    Settings {
        method,
        iterations,
        ..Settings::default()
    }
}

/// 10,000 iterations on about 600 terminals: at most 2 s on one core.
fn ten_thousand_iterations(c: &mut Criterion) {
    let Ok(layout) = made::sized(0, 600) else {
        return;
    };
    let facade = layout.facade;
    let mut group = c.benchmark_group("infer_10000_iterations");
    group.sample_size(10);
    for method in [Method::Lagrangian, Method::AdpPaper, Method::Importance] {
        let id = BenchmarkId::new(method.to_string(), facade.regions.len());
        group.bench_function(id, |b| {
            b.iter(|| {
                infer(
                    std::slice::from_ref(&facade),
                    &settings(method, 10_000),
                    &unwatched,
                )
            })
        });
    }
    group.finish();
}

/// Symmetry detection and one walk, and derivation, against terminals.
fn scaling(c: &mut Criterion) {
    let mut group = c.benchmark_group("scaling");
    group.sample_size(10);
    for terminals in [50, 200, 1_000, 5_000, 20_000] {
        let Ok(layout) = made::sized(0, terminals) else {
            continue;
        };
        let facade = layout.facade;
        let count = facade.regions.len();
        let greedy = || {
            infer(
                std::slice::from_ref(&facade),
                &settings(Method::Greedy, 1),
                &unwatched,
            )
        };
        group.bench_function(BenchmarkId::new("symmetry_and_greedy", count), |b| {
            b.iter(greedy)
        });
        if let Ok(outcome) = greedy() {
            group.bench_function(BenchmarkId::new("derive", count), |b| {
                b.iter(|| derive(&outcome.grammar, 0))
            });
        }
    }
    group.finish();
}

criterion_group!(benches, ten_thousand_iterations, scaling);
criterion_main!(benches);
