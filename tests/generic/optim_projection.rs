//! The projection onto a simplex with bounds against Clarabel, and against the conditions of optimality.

use edifice::optim::Outcome;
use edifice::optim::projection::{BoundedSimplex, ProjectionError};
use edifice::optim::qp::{QpOptions, QuadraticProgram, Row, solve};
use edifice::rng::{Stream, stream};
use rand::RngExt;

/// One problem: target, weights and the set.
#[derive(Debug)]
struct Case {
    target: Vec<f64>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
    total: f64,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Case {
    /// A feasible problem; many are degenerate: equal numbers, fixed variables, no bounds, coefficients
    /// of 0, totals that the bounds reach only at their ends.
    fn random(rng: &mut Stream) -> Self {
        let n = rng.random_range(1..9);
        let round = rng.random::<bool>();
        let number = |rng: &mut Stream| {
            let value = rng.random_range(-3.0..3.0f64);
            if round { value.round() } else { value }
        };
        let list = |rng: &mut Stream| (0..n).map(|_| number(rng)).collect::<Vec<f64>>();
        let (target, ends) = (list(rng), [list(rng), list(rng)]);
        let plain = rng.random::<bool>();
        let coefficients: Vec<f64> = match plain {
            true => vec![1.0; n],
            false => list(rng),
        };
        let weights = match rng.random::<bool>() {
            true => vec![1.0; n],
            false => (0..n).map(|_| rng.random_range(0.05..20.0)).collect(),
        };
        let mut lower: Vec<f64> = (0..n).map(|i| ends[0][i].min(ends[1][i])).collect();
        let mut upper: Vec<f64> = (0..n).map(|i| ends[0][i].max(ends[1][i])).collect();
        // A feasible point, at a corner now and then.
        let share: f64 = [0.0, 1.0, rng.random(), rng.random()][rng.random_range(0..4)];
        let inside = |i: usize| match coefficients[i] > 0.0 {
            true => lower[i] + share * (upper[i] - lower[i]),
            false => upper[i] - share * (upper[i] - lower[i]),
        };
        let total = (0..n).map(|i| coefficients[i] * inside(i)).sum();
        for i in 0..n {
            if rng.random_range(0..4) == 0 {
                lower[i] = f64::NEG_INFINITY;
            }
            if rng.random_range(0..4) == 0 {
                upper[i] = f64::INFINITY;
            }
        }
        Self {
            target,
            weights,
            coefficients,
            total,
            lower,
            upper,
        }
    }

    fn project(&self) -> Result<Vec<f64>, ProjectionError> {
        BoundedSimplex::new(
            self.coefficients.clone(),
            self.total,
            self.lower.clone(),
            self.upper.clone(),
        )?
        .project(&self.target, &self.weights)
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let term = |i: usize| self.weights[i] / 2.0 * (x[i] - self.target[i]).powi(2);
        (0..x.len()).map(term).sum()
    }

    /// The largest violation of the equality or a bound by a point.
    fn violation(&self, x: &[f64]) -> f64 {
        let sum: f64 = self.coefficients.iter().zip(x).map(|(a, x)| a * x).sum();
        let bounds = (0..x.len()).map(|i| (self.lower[i] - x[i]).max(x[i] - self.upper[i]));
        bounds.fold((sum - self.total).abs(), f64::max)
    }

    /// The conditions of Karush, Kuhn and Tucker: some multiplier λ explains every variable. Each one
    /// strictly inside its bounds says what λ is, each one at a bound gives it a bound.
    fn explained(&self, x: &[f64]) -> bool {
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        for (i, &x) in x.iter().enumerate() {
            let a = self.coefficients[i];
            // Stationarity: w (x - t) - λ a is 0 inside, >= 0 at the lower and <= 0 at the upper bound.
            let pull = self.weights[i] * (x - self.target[i]);
            let (low, high) = (x <= self.lower[i], x >= self.upper[i]);
            let noise = 1e-9;
            if a == 0.0 {
                let good = (pull <= noise || low) && (pull >= -noise || high);
                if !good {
                    return false;
                }
                continue;
            }
            let at = pull / a;
            // λ a <= pull unless at the upper bound; λ a >= pull unless at the lower one.
            let (under, over) = if a > 0.0 {
                (!high, !low)
            } else {
                (!low, !high)
            };
            if under {
                most = most.min(at + noise / a.abs());
            }
            if over {
                least = least.max(at - noise / a.abs());
            }
        }
        least <= most
    }

    fn by_clarabel(&self) -> (Vec<f64>, Outcome) {
        let n = self.target.len();
        let mut program = QuadraticProgram::new(n);
        for i in 0..n {
            program.pull(i, self.target[i], self.weights[i]);
        }
        let terms = self.coefficients.iter().copied().enumerate();
        program.equalities.push(Row::new(terms, self.total));
        program.lower.clone_from(&self.lower);
        program.upper.clone_from(&self.upper);
        let run = solve(&program, QpOptions::default()).expect("a convex program");
        (run.best.unwrap_or_default(), run.outcome)
    }
}

#[test]
fn equals_clarabel_and_satisfies_the_conditions_of_optimality() {
    let (mut rng, mut solved) = (stream(4, "projection", 0), 0);
    for _ in 0..4000 {
        let case = Case::random(&mut rng);
        let x = case
            .project()
            .unwrap_or_else(|error| panic!("{error}: {case:?}"));
        assert!(case.violation(&x) < 1e-12, "{x:?}: {case:?}");
        assert!(case.explained(&x), "{x:?}: {case:?}");
        let (oracle, outcome) = case.by_clarabel();
        if outcome.is_solved() {
            solved += 1;
            let (ours, theirs) = (case.cost(&x), case.cost(&oracle));
            assert!((ours - theirs).abs() < 1e-6 * (1.0 + ours), "{case:?}");
            // The oracle's tolerance is one of costs, which are flat near the optimum.
            let distance = (x.iter().zip(oracle)).map(|(x, y)| (x - y).abs());
            assert!(distance.fold(0.0, f64::max) < 2e-3, "{case:?}");
        }
    }
    assert!(solved > 3900, "Clarabel solved {solved} of 4000");
}

#[test]
fn units_and_order_do_not_matter() {
    let mut rng = stream(5, "projection", 0);
    for _ in 0..2000 {
        let case = Case::random(&mut rng);
        let x = case.project().expect("feasible");
        let scaled = |list: &[f64]| list.iter().rev().map(|v| v * 1024.0).collect::<Vec<f64>>();
        let other = Case {
            target: scaled(&case.target),
            weights: case.weights.iter().rev().map(|w| w * 0.125).collect(),
            coefficients: case.coefficients.iter().rev().copied().collect(),
            total: case.total * 1024.0,
            lower: scaled(&case.lower),
            upper: scaled(&case.upper),
        };
        let y = other.project().expect("feasible");
        for (x, y) in x.iter().zip(y.iter().rev()) {
            assert!((x * 1024.0 - y).abs() < 1e-8, "{case:?}");
        }
    }
}

#[test]
fn a_point_of_the_set_stays() {
    let mut rng = stream(6, "projection", 0);
    for _ in 0..2000 {
        let mut case = Case::random(&mut rng);
        case.target = case.project().expect("feasible");
        let again = case.project().expect("feasible");
        for (x, y) in case.target.iter().zip(again) {
            assert!((x - y).abs() < 1e-11, "{case:?}");
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let simplex = |total, lower: f64, upper| {
        BoundedSimplex::new(vec![1.0, 2.0], total, vec![lower; 2], vec![upper; 2])
    };
    assert!(matches!(
        simplex(1.0, 2.0, 1.0),
        Err(ProjectionError::CrossedBounds { index: 0, .. })
    ));
    assert!(matches!(
        simplex(3.5, 0.0, 1.0),
        Err(ProjectionError::Infeasible {
            least: 0.0,
            most: 3.0,
            ..
        })
    ));
    assert!(matches!(
        simplex(f64::NAN, 0.0, 1.0),
        Err(ProjectionError::Number { what: "total", .. })
    ));
    let good = simplex(3.0, 0.0, 1.0).expect("feasible");
    assert_eq!(good.project(&[9.0, -9.0], &[1.0; 2]), Ok(vec![1.0, 1.0]));
    assert!(matches!(
        good.project(&[0.0; 2], &[1.0, 0.0]),
        Err(ProjectionError::Number {
            what: "weights",
            index: 1,
            ..
        })
    ));
    assert!(matches!(
        good.project(&[0.0; 3], &[1.0; 2]),
        Err(ProjectionError::Dimension {
            what: "target",
            found: 3,
            expected: 2
        })
    ));
    assert!(BoundedSimplex::probability(0).is_err());
}
