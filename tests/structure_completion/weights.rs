//! The weights of the scoring functions: the sampler against enumeration, and weights that come back.

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::model::shipped_model;
use edifice::methods::structure_completion::policy::{PaperModel, WEIGHTS};
use edifice::methods::structure_completion::score::{ScoreModel, Sites, State, TERMS, Training};
use edifice::model::factor_graph::Settings;
use edifice::rng::stream;
use edifice::shape::Rect;
use edifice::unwatched;

use crate::cases::cases;

/// Windows in a lattice over doors.
fn layout(columns: u32, rows: u32) -> Layout {
    let mut elements = Vec::new();
    for column in 0..columns {
        let x = 8.0 + 20.0 * f64::from(column);
        for row in 0..rows {
            let rect = Rect::new(x, 40.0 + 28.0 * f64::from(row), 10.0, 16.0);
            elements.push(Element::new(Class::Window, rect));
        }
        if column % 3 == 1 {
            elements.push(Element::new(Class::Door, Rect::new(x, 0.0, 11.0, 24.0)));
        }
    }
    Layout {
        name: format!("{columns} x {rows}"),
        width: 6.0 + 20.0 * f64::from(columns),
        height: 44.0 + 28.0 * f64::from(rows),
        elements,
    }
}

fn model() -> ScoreModel {
    let layouts: Vec<Layout> = (0..20).map(|i| layout(3 + i % 4, 2 + i % 3)).collect();
    ScoreModel::train(&layouts, &Training::default()).unwrap()
}

fn mean_features(model: &ScoreModel, states: &[Sites]) -> [f64; TERMS] {
    let mut mean = [0.0; TERMS];
    for state in states {
        let features = model.evaluate(state.facade(), &state.elements()).features;
        for (m, f) in mean.iter_mut().zip(features) {
            *m += f / states.len() as f64;
        }
    }
    mean
}

/// A facade of one element and one spurious site has 301 x 301 states: the means of the features over draws are those of
/// their enumeration.
#[test]
fn draws_have_the_enumerated_means() {
    let model = model();
    let mut one = layout(1, 1);
    one.width = 60.0;
    let sites = Sites::of_layout(&one, &mut stream(1, "sites", 0));
    // Small, so that the least feature of -30 is no barrier that the chain crosses but rarely.
    let weights: [f64; TERMS] = std::array::from_fn(|k| 0.02 + 0.01 * k as f64);
    let (mut total, mut exact, mut square) = (0.0, [0.0; TERMS], [0.0; TERMS]);
    for (log_count, elements) in sites.states() {
        let features = model.evaluate(sites.facade(), &elements).features;
        let score: f64 = weights.iter().zip(features).map(|(w, f)| w * f).sum();
        let mass = (score + log_count).exp();
        total += mass;
        for (k, f) in features.into_iter().enumerate() {
            exact[k] += mass * f;
            square[k] += mass * f * f;
        }
    }
    let mut rng = stream(2, "draws", 0);
    let draws: Vec<Sites> = (0..3000)
        .map(|_| sites.draw(&model, &weights, 30, &mut rng))
        .collect();
    let found = mean_features(&model, &draws);
    // Blocks of a tenth, here one site, leave the distribution as it is.
    let moved: Vec<Sites> = draws
        .iter()
        .map(|draw| {
            let mut state = draw.clone();
            state.resample_block(&model, &weights, 2, &mut rng);
            state
        })
        .collect();
    let after = mean_features(&model, &moved);
    for k in 0..TERMS {
        let exact = exact[k] / total;
        let error = ((square[k] / total - exact * exact) / draws.len() as f64).sqrt();
        for mean in [found[k], after[k]] {
            let away = (mean - exact).abs();
            assert!(away < 4.5 * error + 1e-6, "term {k}: {mean} is not {exact}");
        }
    }
}

/// Weights of drawn layouts come back nearer than the prior is, and by Eq. 20 they do not.
#[test]
fn weights_come_back_by_the_unbiased_update_only() {
    let shipped = shipped_model().unwrap();
    let model = shipped.paper.as_ref().unwrap();
    let truth = model.score.weights;
    let whole: Vec<Layout> = shipped.layouts();
    let drawn: Vec<Sites> = (0..cases(80).max(40))
        .map(|i| {
            let mut rng = stream(5, "draw", i as u64);
            let sites = Sites::of_layout(&whole[i % whole.len()], &mut rng);
            sites.draw(&model.score, &truth, 30, &mut rng)
        })
        .collect();
    let settings = Settings {
        rounds: 80,
        rate: 0.5,
        newton: true,
        ..WEIGHTS
    };
    let rmse = |weights: [f64; TERMS]| {
        let square = weights.iter().zip(truth).map(|(a, b)| (a - b).powi(2));
        (square.sum::<f64>() / TERMS as f64).sqrt()
    };
    let weights =
        PaperModel::unbiased_weights(&model.score, &drawn, &settings, 1, &unwatched).unwrap();
    let few = Settings {
        rounds: 4,
        ..settings
    };
    let started =
        || PaperModel::unbiased_weights(&model.score, &drawn, &few, 1, &unwatched).unwrap();
    assert_eq!(started(), started());
    let prior = rmse([1.0; TERMS]);
    let unbiased = rmse(weights);
    assert!(unbiased < 0.6 * prior, "{unbiased} of {prior}: {weights:?}");
    let layouts: Vec<Layout> = drawn.iter().map(|s| s.layout("drawn".into())).collect();
    let layouts: Vec<Layout> = layouts
        .into_iter()
        .filter(|l| l.elements.len() > 1)
        .collect();
    let printed = model
        .printed_weights(&layouts, 3, &settings, 1, &unwatched)
        .unwrap();
    assert!(rmse(printed) > 1.5 * unbiased, "{printed:?}");
}
