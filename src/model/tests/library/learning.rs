//! Learning hierarchical models that is watched, ended early, continued, limited to a sample of the rows.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use edifice_base::rng::stream;
use edifice_model::ModelError;
use edifice_model::Table;
use edifice_model::em::Outcome;
use edifice_model::hierarchy::{
    Group, SearchStep, Settings, Sweep, Variant, fit_observed, learn, learn_observed, refine,
};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Three styles, told by two lengths and a flag; some cells missing.
fn table(rows: usize, seed: u64) -> (Table, Vec<Group>) {
    let mut rng = stream(seed, "styles", 0);
    let style: Vec<usize> = (0..rows).map(|_| rng.random_range(0..3)).collect();
    let mut length = |centres: [f64; 3]| -> Vec<Option<f64>> {
        let value = |&s: &usize| {
            let noise: f64 = rng.sample(StandardNormal);
            (rng.random::<f64>() > 0.05).then_some(centres[s] + noise)
        };
        style.iter().map(value).collect()
    };
    let (width, depth) = (length([0.0, 8.0, 8.0]), length([0.0, 0.0, 9.0]));
    let flag: Vec<Option<bool>> = style.iter().map(|&s| Some(s == 2)).collect();
    let table = Table::new().real("width", width).unwrap();
    let table = table
        .real("depth", depth)
        .unwrap()
        .binary("flag", flag)
        .unwrap();
    let groups = ["width", "depth", "flag"].map(|n| Group::new(n, &[n]));
    (table, groups.to_vec())
}

fn settings() -> Settings {
    Settings {
        styles: 2..=5,
        ..Settings::default()
    }
}

#[test]
fn an_observer_changes_nothing_and_hears_every_step() {
    let (data, groups) = table(150, 1);
    let heard = AtomicUsize::new(0);
    let watched = learn_observed(&data, &groups, &settings(), 1, &|step: Option<
        &SearchStep,
    >| {
        heard.fetch_add(usize::from(step.is_some()), Ordering::Relaxed);
        ControlFlow::Continue(())
    })
    .unwrap();
    let plain = learn(&data, &groups, &settings(), 1).unwrap();
    assert_eq!(watched.score.to_bits(), plain.score.to_bits());
    assert_eq!(watched.trace, plain.trace);
    assert!(!watched.interrupted);
    assert!(heard.into_inner() >= plain.trace.len());
}

#[test]
fn a_search_ended_at_any_time_returns_a_model_and_goes_on_from_it() {
    let (data, groups) = table(150, 2);
    let whole = learn(&data, &groups, &settings(), 1).unwrap();
    for rounds in [0, 1, 5, 40, 300] {
        let left = AtomicUsize::new(rounds);
        let ended = learn_observed(&data, &groups, &settings(), 1, &|_| {
            let more =
                left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1));
            match more {
                Ok(_) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            }
        })
        .unwrap();
        assert!(ended.interrupted && ended.score.is_finite());
        let logs = ended.model.log_likelihood(&data).unwrap();
        assert!(logs.iter().all(|l| l.is_finite()));
        let go_on = |_: Option<&SearchStep>| ControlFlow::Continue(());
        let refined = refine(&ended.model, &data, &settings(), 1, &go_on).unwrap();
        assert!(!refined.interrupted);
        // EM raises the posterior, not the score: near the end both may differ by what is left of it.
        assert!(
            refined.score > ended.score - 0.5,
            "{} {}",
            refined.score,
            ended.score
        );
        assert!(
            refined.score > whole.score - 5.0,
            "{} {}",
            refined.score,
            whole.score
        );
    }
}

#[test]
fn many_rows_are_searched_on_a_sample_and_fitted_whole() {
    let (data, groups) = table(3000, 3);
    let sampled = Settings {
        searched: 300,
        ..settings()
    };
    let a = learn(&data, &groups, &sampled, 1).unwrap();
    let b = learn(&data, &groups, &settings(), 1).unwrap();
    let mean = |l: &[f64]| l.iter().sum::<f64>() / l.len() as f64;
    let (a, b) = (
        mean(&a.model.log_likelihood(&data).unwrap()),
        mean(&b.model.log_likelihood(&data).unwrap()),
    );
    assert!((a - b).abs() < 0.05, "{a} {b}");
    let none = Settings {
        searched: 0,
        ..settings()
    };
    let error = learn(&data, &groups, &none, 1).unwrap_err();
    assert!(matches!(error, ModelError::Parameter { .. }));
}

#[test]
fn a_sweep_of_few_styles_finds_what_one_of_all_does() {
    let (data, groups) = table(400, 4);
    let with = |sweep| {
        let settings = Settings {
            sweep,
            styles: 2..=9,
            ..Settings::default()
        };
        learn(&data, &groups, &settings, 1).unwrap()
    };
    let (few, all) = (with(Sweep::Few), with(Sweep::All));
    assert_eq!(few.model.styles(), all.model.styles());
    assert!(few.score > all.score - 2.0, "{} {}", few.score, all.score);
    assert!(few.trace.len() < all.trace.len());
}

#[test]
fn a_fit_can_be_ended_and_a_model_of_another_variant_is_refused() {
    let (data, groups) = table(200, 5);
    let end = |_: Option<&SearchStep>| ControlFlow::Break(());
    let fitted = fit_observed(&data, &groups, 3, &[2, 2], &settings(), 1, &end).unwrap();
    assert_eq!(fitted.outcome, Outcome::Interrupted);
    let error = refine(&fitted.model, &data, &settings(), 1, &end).unwrap_err();
    assert!(error.to_string().contains("NoLateral"), "{error}");
    let same = Settings {
        variant: Variant::NoLateral,
        ..settings()
    };
    assert!(refine(&fitted.model, &data, &same, 1, &end).is_ok());
}
