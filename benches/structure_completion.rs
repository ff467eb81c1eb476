//! Structure completion: five completions of half a facade, and the exact chain over its columns.

use criterion::{Criterion, criterion_group, criterion_main};
use edifice::methods::structure_completion::best::chain::Chain;
use edifice::methods::structure_completion::best::pool::line_problem;
use edifice::methods::structure_completion::best::scene::Scene;
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::shipped_model;
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::Axis;

fn completion(c: &mut Criterion) {
    let model = shipped_model().expect("the shipped model");
    let layout = &model.examples[model.examples.len() / 2].layout;
    let (partial, _) = Task::Side50.hide(layout, &mut stream(1, "bench", 0));
    let elements = layout.elements.len();
    c.bench_function(
        &format!("structure_completion/complete_5/{elements}"),
        |b| {
            b.iter(|| {
                complete(
                    Method::Best,
                    &partial,
                    &model,
                    5,
                    &mut stream(1, "bench", 1),
                )
            });
        },
    );
    let size = model.window_size(partial.width, partial.height);
    let scene = Scene::new(&partial, partial.observed.clone(), size);
    let (problem, _) = line_problem(&scene, Axis::X);
    let bins = problem.bins;
    c.bench_function(
        &format!("structure_completion/chain_100_draws/{bins}"),
        |b| {
            b.iter(|| {
                let chain = Chain::new(&problem, &model.columns, false);
                chain.draw(100, &mut stream(1, "bench", 2))
            });
        },
    );
}

criterion_group!(benches, completion);
criterion_main!(benches);
