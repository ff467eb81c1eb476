//! The exact chain over grid lines against enumeration of all sets of lines.

use edifice::methods::structure_completion::best::chain::{Chain, LineProblem, log_weight};
use edifice::methods::structure_completion::best::density::Spacing;
use edifice::rng::{Stream, stream};
use rand::RngExt;

/// A spacing learnt from random facades.
fn spacing(rng: &mut Stream) -> Spacing {
    let example = |rng: &mut Stream| {
        let gap = 2.0 + 3.0 * rng.random::<f64>();
        let mut lines = vec![0.5 + 2.0 * rng.random::<f64>()];
        for _ in 0..rng.random_range(1..6) {
            let step = gap * (0.8 + 0.4 * rng.random::<f64>());
            lines.push(lines[lines.len() - 1] + step);
        }
        let length = lines[lines.len() - 1] + gap * rng.random::<f64>();
        (lines, 1.0 + rng.random::<f64>(), length)
    };
    let examples: Vec<_> = (0..8).map(|_| example(rng)).collect();
    Spacing::learn(&examples)
}

fn problem(rng: &mut Stream) -> LineProblem {
    let bins = rng.random_range(3..13);
    let least = rng.random_range(1..4);
    let mut observed: Vec<usize> = (0..bins).filter(|_| rng.random::<f64>() < 0.15).collect();
    observed.dedup();
    LineProblem {
        bins,
        size: 0.5 + 2.0 * rng.random::<f64>(),
        observed,
        evidence: (0..bins)
            .map(|_| {
                if rng.random::<bool>() {
                    1.0
                } else {
                    rng.random::<f64>()
                }
            })
            .collect(),
        least,
        most: rng.random_range(least..=bins),
    }
}

/// All sets of lines with their log weights, where finite.
fn all(problem: &LineProblem, spacing: &Spacing) -> Vec<(Vec<usize>, f64)> {
    let sets = (0u32..1 << problem.bins)
        .map(|set| -> Vec<usize> { (0..problem.bins).filter(|b| set >> b & 1 == 1).collect() });
    let weighed = sets.map(|lines| {
        let weight = log_weight(problem, spacing, &lines);
        (lines, weight)
    });
    weighed.filter(|(_, w)| w.is_finite()).collect()
}

#[test]
fn sums_and_maxima_equal_enumeration() {
    let mut rng = stream(1, "chain", 0);
    let mut finite = 0;
    for case in 0..2000 {
        let (spacing, problem) = (spacing(&mut rng), problem(&mut rng));
        let sets = all(&problem, &spacing);
        let sum = sets.iter().map(|s| s.1.exp()).sum::<f64>().ln();
        let best = sets.iter().map(|s| s.1).fold(f64::NEG_INFINITY, f64::max);
        let by_sum = Chain::new(&problem, &spacing, false).log_value();
        let chain = Chain::new(&problem, &spacing, true);
        let by_max = chain.log_value();
        if sets.is_empty() {
            assert!(
                by_sum == f64::NEG_INFINITY && by_max == f64::NEG_INFINITY,
                "{case}: {problem:?}"
            );
            assert!(chain.draw(2, &mut rng).is_empty());
            continue;
        }
        finite += 1;
        assert!(
            (by_sum - sum).abs() < 1e-9,
            "{case}: {by_sum} {sum} {problem:?}"
        );
        assert!(
            (by_max - best).abs() < 1e-9,
            "{case}: {by_max} {best} {problem:?}"
        );
        let lines = &chain.draw(1, &mut rng)[0];
        let weight = log_weight(&problem, &spacing, lines);
        assert!(
            (weight - best).abs() < 1e-9,
            "{case}: {lines:?} {problem:?}"
        );
    }
    assert!(finite > 1000, "{finite}");
}

#[test]
fn without_conditions_it_is_a_distribution() {
    let mut rng = stream(2, "chain", 0);
    for _ in 0..50 {
        let spacing = spacing(&mut rng);
        let mut problem = problem(&mut rng);
        problem.observed.clear();
        problem.evidence.fill(1.0);
        let total = Chain::new(&problem, &spacing, false).log_value();
        // Where no two lines fit there is nothing to distribute.
        assert!(
            total.abs() < 1e-9 || total == f64::NEG_INFINITY,
            "{total} {problem:?}"
        );
    }
}

#[test]
fn draws_have_the_enumerated_probabilities() {
    let mut rng = stream(3, "chain", 0);
    let mut checked = 0;
    while checked < 5 {
        let (spacing, problem) = (spacing(&mut rng), problem(&mut rng));
        let sets = all(&problem, &spacing);
        if sets.len() < 4 {
            continue;
        }
        checked += 1;
        let total: f64 = sets.iter().map(|s| s.1.exp()).sum();
        let count = 20_000;
        let draws = Chain::new(&problem, &spacing, false).draw(count, &mut rng);
        for (lines, weight) in &sets {
            let p = weight.exp() / total;
            let seen = draws.iter().filter(|d| *d == lines).count() as f64 / count as f64;
            let error = (p * (1.0 - p) / count as f64).sqrt();
            assert!(
                (seen - p).abs() < 5.0 * error + 1e-3,
                "{lines:?}: {seen} {p}"
            );
        }
    }
}

#[test]
fn long_axes_do_not_underflow() {
    let spacing = spacing(&mut stream(4, "chain", 0));
    let bins = 4000;
    let problem = LineProblem {
        bins,
        size: 3.0,
        observed: (5..bins).step_by(10).collect(),
        evidence: vec![1e-12; bins],
        least: 4,
        most: 20,
    };
    let chain = Chain::new(&problem, &spacing, false);
    assert!(chain.log_value().is_finite());
    let lines = &chain.draw(1, &mut stream(4, "chain", 1))[0];
    assert!(problem.observed.iter().all(|o| lines.contains(o)));
}
