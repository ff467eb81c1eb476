//! Structure completion: five completions of half a facade, the exact chain over its columns, and the paper's method.

use criterion::{Criterion, criterion_group, criterion_main};
use edifice::methods::structure_completion::best::chain::Chain;
use edifice::methods::structure_completion::best::observation::Observation;
use edifice::methods::structure_completion::best::pool::line_problem;
use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::shipped_model;
use edifice::methods::structure_completion::policy::{
    Budget, CompletionProblem, PaperModel, Policy, WEIGHTS, grow, optimize, weight_states,
};
use edifice::methods::structure_completion::score::{Change, Scored};
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::{Axis, Rect};
use edifice::unwatched;

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
    let observation = Observation::new(&partial, partial.observed.clone(), size);
    let (problem, _) = line_problem(&observation, Axis::X);
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

/// The paper's method: candidates, the score after a change of one element, and the weights of 100 facades.
fn paper(c: &mut Criterion) {
    let model = shipped_model().expect("the shipped model");
    let paper = model.paper.as_ref().expect("learnt");
    let layouts = model.layouts();
    let layout = &layouts[layouts.len() / 2];
    let mut group = c.benchmark_group("structure_completion");
    group.sample_size(10);
    for task in Task::ALL {
        let (partial, _) = task.hide(layout, &mut stream(1, "bench", 0));
        let problem = CompletionProblem::new(paper, &partial);
        let candidates = Budget::PAPER.candidates();
        group.bench_function(
            format!(
                "candidates_{candidates}_{}/{}",
                task.name(),
                layout.elements.len()
            ),
            |b| b.iter(|| optimize(&problem, &Budget::PAPER, 5, 1, &unwatched)),
        );
    }
    // Linear in the number of elements.
    for side in [10u32, 22, 71] {
        let whole = lattice(side);
        let (partial, _) = Task::R50.hide(&whole, &mut stream(1, "bench", 3));
        let problem = CompletionProblem::new(paper, &partial);
        group.bench_function(format!("candidate/{}", whole.elements.len()), |b| {
            let mut rng = stream(1, "bench", 4);
            b.iter(|| grow(&problem, &Policy::FIXED, &mut rng));
        });
    }
    let facade = [layout.width, layout.height];
    group.bench_function(format!("score_update/{}", layout.elements.len()), |b| {
        let mut scored = Scored::new(&paper.score, facade, layout.elements.clone());
        let mut moved = layout.elements[0];
        moved.rect.x += 0.01 * moved.rect.width;
        b.iter(|| {
            scored.apply(Change::Set(0, moved));
            scored.undo();
        });
    });
    let hundred: Vec<_> = layouts.iter().cycle().take(100).collect();
    let states = weight_states(&hundred, 1);
    group.bench_function("weights/100", |b| {
        b.iter(|| PaperModel::unbiased_weights(&paper.score, &states, &WEIGHTS, 1, &unwatched));
    });
    group.finish();
}

/// A lattice of `side` columns and rows of windows.
fn lattice(side: u32) -> Layout {
    let windows = (0..side * side).map(|k| {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        let rect = Rect::new(0.5 + 2.0 * x, 0.5 + 3.0 * y, 1.0, 1.6);
        Element::new(Class::Window, rect)
    });
    Layout {
        name: format!("{side} x {side}"),
        width: 2.0 * f64::from(side),
        height: 3.0 * f64::from(side),
        elements: windows.collect(),
    }
}

criterion_group!(benches, completion, paper);
criterion_main!(benches);
