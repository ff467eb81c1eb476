//! Fits of hierarchical models: priors, starts, and when EM ends, against counts by hand.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use edifice_base::rng::stream;
use edifice_model::em::{Outcome, Stopping};
use edifice_model::hierarchy::{
    Group, Priors, SearchStep, Settings, Variant, fit, learn, learn_observed,
};
use edifice_model::{Cell, Table};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Widths of two kinds that overlap, so that EM takes many rounds.
fn overlapping(rows: usize) -> Table {
    let mut rng = stream(1, "widths", 0);
    let widths = (0..rows).map(|i| {
        let z: f64 = rng.sample(StandardNormal);
        Some([5.0, 7.5][i % 2] + z)
    });
    Table::new().real("width", widths).unwrap()
}

fn width(houses: &Table, row: usize) -> f64 {
    match houses.column("width").unwrap().cell(row) {
        Cell::Real(width) => width,
        other => panic!("{other:?}"),
    }
}

fn size() -> [Group; 1] {
    [Group::new("size", &["width"])]
}

#[test]
fn a_fit_has_the_priors_given() {
    // Twenty narrow houses, forty wide ones.
    let width = (0..60).map(|i| Some(if i < 20 { 5.0 } else { 12.0 } + f64::from(i % 5) * 0.1));
    let houses = Table::new().real("width", width).unwrap();
    for dirichlet in [1.2, 11.0, 101.0] {
        let priors = Priors {
            dirichlet,
            ..Priors::default()
        };
        let fitted = fit(&houses, &size(), 1, &[2], &priors, &Stopping::default(), 1).unwrap();
        let kinds = &fitted.model.state_probabilities("size").unwrap()[0];
        // The mode under Dirichlet(a, a) with these counts.
        let mode = (20.0 + dirichlet - 1.0) / (60.0 + 2.0 * (dirichlet - 1.0));
        assert!(
            (kinds[0].min(kinds[1]) - mode).abs() < 1e-3,
            "{dirichlet}: {kinds:?}"
        );
    }
}

#[test]
fn a_fit_ends_when_it_is_told_to() {
    let houses = overlapping(200);
    let ended = |movement: f64, gain: f64, max_rounds: usize| {
        let stopping = Stopping {
            movement,
            gain,
            max_rounds,
        };
        let fitted = fit(&houses, &size(), 1, &[2], &Priors::default(), &stopping, 1).unwrap();
        let likelihood = fitted.model.log_likelihood(&houses).unwrap();
        (fitted.outcome, likelihood.iter().sum::<f64>())
    };
    let (outcome, first) = ended(1e-6, 0.0, 1);
    assert_eq!(outcome, Outcome::MaxRounds);
    let (outcome, fifth) = ended(1e-6, 0.0, 5);
    assert_eq!(outcome, Outcome::MaxRounds);
    assert!(fifth > first);
    // Parameters move by far less than a thousand in one round.
    assert_eq!(ended(1e3, 0.0, 5), (Outcome::Converged, first));
    assert_eq!(ended(1e-6, 1e3, 5), (Outcome::SmallGain, first));
    assert_eq!(ended(1e-3, 0.0, 10_000).0, Outcome::Converged);
}

/// Without a round of EM, a fit is the mode of the counts in the clusters that it starts from.
#[test]
fn a_fit_starts_from_the_counts_of_its_clusters() {
    // Two kinds of houses, told apart by three bits; a roof of three shapes is as it happens to be.
    let narrow = |i: usize| i < 20;
    let roof = |i: usize| ["flat", "hip", "gable"][if narrow(i) { i % 2 } else { i % 3 }];
    let mut houses = Table::new();
    for bit in ["garage", "porch", "garden"] {
        let bits = (0..50).map(|i| Some(!narrow(i)));
        houses = houses.binary(bit, bits).unwrap();
    }
    let roofs = (0..50).map(|i| Some(roof(i)));
    houses = houses
        .categorical("roof", &["flat", "hip", "gable"], roofs)
        .unwrap();
    let groups = [Group::new("parts", &["garage", "porch", "garden", "roof"])];
    let stopping = Stopping {
        max_rounds: 0,
        ..Stopping::default()
    };
    let priors = Priors::default();
    let fitted = fit(&houses, &groups, 2, &[], &priors, &stopping, 1).unwrap();
    assert_eq!(fitted.outcome, Outcome::MaxRounds);
    let mode = |count: usize, of: usize, values: usize| {
        let more = priors.dirichlet - 1.0;
        (count as f64 + more) / (of as f64 + more * values as f64)
    };
    let found = fitted.model.log_likelihood(&houses).unwrap();
    for (i, found) in found.into_iter().enumerate() {
        let style = |of_narrow: bool| {
            let rows: Vec<usize> = (0..50).filter(|&j| narrow(j) == of_narrow).collect();
            let bit = if narrow(i) == of_narrow {
                rows.len()
            } else {
                0
            };
            let roofs = rows.iter().filter(|&&j| roof(j) == roof(i)).count();
            mode(rows.len(), 50, 2) * mode(bit, rows.len(), 2).powi(3) * mode(roofs, rows.len(), 3)
        };
        let probability: f64 = style(true) + style(false);
        assert!((found - probability.ln()).abs() < 1e-9, "row {i}: {found}");
    }
}

/// A search with edges from categories is followed by the same search without them.
#[test]
fn the_search_without_edges_from_categories_is_made_as_well() {
    let mut rng = stream(2, "houses", 0);
    let hip: Vec<bool> = (0..80).map(|_| rng.random()).collect();
    let widths = hip.iter().map(|hip| {
        let z: f64 = rng.sample(StandardNormal);
        Some(if *hip { 9.0 } else { 5.0 } + z)
    });
    let houses = Table::new()
        .real("width", widths.collect::<Vec<_>>())
        .unwrap();
    let houses = houses.binary("hip", hip.iter().map(|h| Some(*h))).unwrap();
    let groups = [Group::new("size", &["width"]), Group::new("roof", &["hip"])];
    let searched = |category_edges: bool| {
        let settings = Settings {
            category_edges,
            styles: 1..=2,
            most_states: 3,
            ..Settings::default()
        };
        learn(&houses, &groups, &settings, 1).unwrap()
    };
    let (both, without) = (searched(true), searched(false));
    assert!(both.trace.iter().any(|step| step.lateral_edges > 0));
    assert!(without.trace.iter().all(|step| step.lateral_edges == 0));
    assert!(both.trace.ends_with(&without.trace));
    assert!(both.trace.len() > without.trace.len());
    assert!(both.score >= without.score);
}

/// The fit to all rows, of which a few were searched, ends when a round gains less than 1e-4 nats a row, however long EM
/// would go on: the observer is asked twice a round, and once for each 512 rows.
#[test]
fn the_fit_to_rows_that_were_not_searched_ends_at_small_gains() {
    const ROUNDS: usize = 50;
    let houses = overlapping(4096);
    let settings = Settings {
        variant: Variant::NoSecondLevel,
        styles: 2..=2,
        searched: 256,
        stopping: Stopping {
            movement: 0.0,
            gain: 0.0,
            max_rounds: ROUNDS,
        },
        ..Settings::default()
    };
    let asked = AtomicUsize::new(0);
    let observer = |step: Option<&SearchStep>| {
        match step {
            // The only configuration; what follows are the last fits to the rows searched and to all.
            Some(_) => asked.store(0, Ordering::Relaxed),
            None => {
                asked.fetch_add(1, Ordering::Relaxed);
            }
        }
        ControlFlow::Continue(())
    };
    let learned = learn_observed(&houses, &size(), &settings, 1, &observer).unwrap();
    assert_eq!((learned.rows, learned.trace.len()), (4096, 1));
    let asked = asked.load(Ordering::Relaxed);
    let (searched, round) = (2 * ROUNDS, 2 + 4096 / 512);
    let last = asked.saturating_sub(searched);
    assert!(last > round, "{asked}: all rows were not fitted");
    assert!(last < ROUNDS / 2 * round, "{asked}: the fit went on and on");
}

#[test]
fn a_search_may_try_two_states_and_no_fewer_and_tells_its_bic() {
    let houses = overlapping(60);
    let searched = |most_states: usize| {
        let settings = Settings {
            most_states,
            styles: 1..=1,
            ..Settings::default()
        };
        learn(&houses, &size(), &settings, 1)
    };
    let found = searched(2).unwrap();
    // BIC is of standardised widths: each row is likelier by their deviation.
    let own: Vec<f64> = (0..60).map(|i| width(&houses, i)).collect();
    let mean = own.iter().sum::<f64>() / 60.0;
    let variance = own.iter().map(|w| (w - mean).powi(2)).sum::<f64>() / 60.0;
    let likelihood: f64 = found.model.log_likelihood(&houses).unwrap().iter().sum();
    let penalty = 0.5 * found.model.free_parameters() as f64 * 60f64.ln();
    let bic = likelihood + 30.0 * variance.ln() - penalty;
    assert!((found.bic - bic).abs() < 1e-6, "{} for {bic}", found.bic);
    assert!(searched(1).is_err());
}
