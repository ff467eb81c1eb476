//! Candidates of policies, rollouts and annealing: they respect what is known, and the same seed repeats.

use edifice::methods::structure_completion::annealing::{self, anneal};
use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::partial::PartialLayout;
use edifice::methods::structure_completion::policy::{
    Budget, CompletionProblem, PaperModel, Policy, grow, optimize, rollouts,
};
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::Rect;
use edifice::unwatched;

/// Windows in a regular lattice over a door.
fn layout(columns: u32, rows: u32) -> Layout {
    let mut elements = Vec::new();
    for column in 0..columns {
        let x = 10.0 + 22.0 * f64::from(column);
        for row in 0..rows {
            let rect = Rect::new(x, 40.0 + 30.0 * f64::from(row), 10.0, 16.0);
            elements.push(Element::new(Class::Window, rect));
        }
        if column == columns / 2 {
            elements.push(Element::new(Class::Door, Rect::new(x, 0.0, 11.0, 24.0)));
        }
    }
    Layout {
        name: format!("{columns} x {rows}"),
        width: 8.0 + 22.0 * f64::from(columns),
        height: 46.0 + 30.0 * f64::from(rows),
        elements,
    }
}

fn database() -> Vec<Layout> {
    (0..20).map(|i| layout(3 + i % 5, 2 + i % 4)).collect()
}

const FEW: Budget = Budget {
    population: 6,
    generations: 10,
    draws: 3,
};

fn check(partial: &PartialLayout, added: &[Element]) {
    for (i, element) in added.iter().enumerate() {
        assert!(partial.allows(element), "{element:?}");
        assert!(
            !added[..i].iter().any(|e| e.excludes(element)),
            "{element:?}"
        );
    }
}

#[test]
fn candidates_keep_to_what_is_known() {
    let model = PaperModel::of_densities(&database(), 1).unwrap();
    for (i, task) in Task::ALL.into_iter().enumerate() {
        let mut rng = stream(4, "candidates", i as u64);
        let (mut partial, _) = task.hide(&layout(6, 4), &mut rng);
        partial.forbidden = vec![Rect::new(50.0, 60.0, 30.0, 30.0)];
        let problem = CompletionProblem::new(&model, &partial);
        for _ in 0..20 {
            let policy = Policy::random(&mut rng);
            let elements = grow(&problem, &policy, &mut rng);
            let (observed, added) = elements.split_at(partial.observed.len());
            assert!(partial.observed.iter().all(|o| observed.contains(o)));
            check(&partial, added);
        }
        let settings = annealing::Settings {
            evaluations: 2000,
            ..annealing::Settings::default()
        };
        let (added, score) = anneal(&problem, &partial, &settings, 1).unwrap();
        check(&partial, &added);
        let whole: Vec<Element> = partial.observed.iter().chain(&added).copied().collect();
        let anew = model
            .score
            .evaluate([partial.width, partial.height], &whole);
        assert!((model.score.score(&anew.features) - score).abs() < 1e-9);
    }
}

#[test]
fn evolved_policies_beat_a_random_one_and_repeat() {
    let model = PaperModel::of_densities(&database(), 1).unwrap();
    let mut rng = stream(5, "side", 0);
    let (partial, _) = Task::Side50.hide(&layout(6, 4), &mut rng);
    let problem = CompletionProblem::new(&model, &partial);
    let found = optimize(&problem, &FEW, 5, 3, &unwatched).unwrap();
    assert_eq!(found.made, FEW.candidates());
    assert_eq!(Budget::PAPER.candidates(), 10_000);
    assert!(found.candidates.windows(2).all(|w| w[0].score > w[1].score));
    assert_eq!(found, optimize(&problem, &FEW, 5, 3, &unwatched).unwrap());
    let score = |elements: &[Element]| {
        let evaluation = model.score.evaluate(problem.facade, elements);
        model.score.score(&evaluation.features)
    };
    let random = (0..10).map(|_| {
        let policy = Policy::random(&mut rng);
        score(&grow(&problem, &policy, &mut rng))
    });
    assert!(found.candidates[0].score > random.sum::<f64>() / 10.0);
    let (added, value) = rollouts(&problem, found.policy, 2, 1).unwrap();
    check(&partial, &added);
    assert!(value.is_finite());
}

#[test]
fn nothing_observed_adds_nothing() {
    let model = PaperModel::of_densities(&database(), 1).unwrap();
    let partial = PartialLayout {
        width: 100.0,
        height: 100.0,
        observed: Vec::new(),
        unknown: None,
        forbidden: Vec::new(),
    };
    let problem = CompletionProblem::new(&model, &partial);
    let found = optimize(&problem, &FEW, 3, 1, &unwatched).unwrap();
    assert!(found.candidates.iter().all(|c| c.added.is_empty()));
    // A model survives its file.
    let text = serde_json::to_string(&model).unwrap();
    assert_eq!(serde_json::from_str::<PaperModel>(&text).unwrap(), model);
    assert!(model.check().is_ok());
}
