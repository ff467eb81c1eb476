//! Inference against the exact search on one random case.

use std::fmt;
use std::time::Instant;

use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_facade_grammar::{BoundLimits, Operations, Settings, infer, lower_bound};
use edifice_grammar::{Costs, evaluate};
use edifice_shape::Facade;
use rand::RngExt;

use super::content::Content;
use super::layouts::random_layouts;
use super::search::{Limits, smallest};

/// Differences of costs that are noise.
const NOISE: f64 = 1e-6;

/// The layouts, operations and costs of a case.
pub struct Case {
    /// The layouts.
    pub facades: Vec<Content>,
    /// Allowed operations.
    pub operations: Operations,
    /// Name of the costs.
    pub prices: &'static str,
    /// The costs.
    pub costs: Costs,
}

/// The costs and bounds found.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// The least cost; `None` when the exact search was not finished.
    pub exact: Option<f64>,
    /// Cost of the grammar that inference found, by the evaluator.
    pub cost: f64,
    /// The bound of inference: it says that no grammar costs less.
    pub bound: Option<f64>,
    /// Lower and upper bound with more work, of a single facade.
    pub bounds: Option<(f64, f64)>,
    /// Seconds of inference, of the longer bound and of the exact search.
    pub seconds: [f64; 3],
}

impl Case {
    /// A random case of up to `most` tiles in each of one to three facades.
    pub fn random(seed: u64, index: u64, most: usize) -> Self {
        let rng = &mut stream(seed, "exact", index);
        let bits: u32 = rng.random_range(0..16);
        let prices = prices();
        let (prices, costs) = match rng.random_range(0..3) {
            0 => prices[0],
            _ => prices[rng.random_range(0..prices.len())],
        };
        let count = [1, 1, 2, 3][rng.random_range(0..4)];
        Self {
            facades: random_layouts(rng, count, 1, most),
            operations: Operations {
                repeat: bits & 1 != 0,
                repeat_aba: bits & 2 != 0,
                sym_split: bits & 4 != 0,
                grid_split: bits & 8 != 0,
            },
            prices,
            costs,
        }
    }

    /// The layouts as inference reads them.
    pub fn layouts(&self) -> Vec<Facade> {
        let named = self.facades.iter().enumerate();
        named
            .map(|(i, f)| f.facade(&format!("facade {i}")))
            .collect()
    }

    /// Runs inference and the exact search.
    ///
    /// # Panics
    /// When a grammar does not derive the layouts, or costs less than the exact search says.
    pub fn compare(&self, iterations: u64, limits: &Limits) -> Comparison {
        let settings = Settings {
            operations: self.operations,
            costs: self.costs,
            iterations,
            ..Settings::default()
        };
        let layouts = self.layouts();
        let start = Instant::now();
        let found = infer(&layouts, &settings, &unwatched).expect("random layouts are splittable");
        let inferred = start.elapsed().as_secs_f64();
        let cost = evaluate(&found.grammar, &layouts, &self.costs)
            .expect("an inferred grammar derives its layouts")
            .cost;
        let start = Instant::now();
        let bounds = (layouts.len() == 1).then(|| {
            let bound = lower_bound(&layouts[0], &settings, &BoundLimits::default(), &unwatched);
            let bound = bound.expect("random layouts are splittable");
            (bound.lower, bound.upper)
        });
        let bounded = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let exact = smallest(&self.facades, self.operations, &self.costs, limits);
        let searched = start.elapsed().as_secs_f64();
        let exact = exact.map(|exact| {
            let written = evaluate(&exact.grammar, &layouts, &self.costs)
                .expect("the smallest grammar derives its layouts")
                .cost;
            assert!((written - exact.cost).abs() < NOISE, "{self}");
            assert!(written < cost + NOISE, "{cost} < {written}: {self}");
            written
        });
        Comparison {
            exact,
            cost,
            bound: found.lower_bound,
            bounds,
            seconds: [inferred, bounded, searched],
        }
    }
}

impl Comparison {
    /// True if inference says that its grammar is optimal.
    pub fn proven(&self) -> bool {
        self.bound.is_some_and(|bound| self.cost <= bound + NOISE)
    }

    /// True if the grammar is known to be optimal.
    pub fn optimal(&self) -> bool {
        self.exact.is_some_and(|exact| self.cost <= exact + NOISE)
    }

    /// A bound that is above the least cost, in words; `None` if all are right.
    pub fn fault(&self) -> Option<String> {
        let exact = self.exact?;
        let above = |bound: f64| bound > exact + NOISE;
        if let Some(bound) = self.bound.filter(|b| above(*b)) {
            let cost = self.cost;
            return Some(format!("infer: cost {cost}, bound {bound}, exact {exact}"));
        }
        let (lower, upper) = self.bounds.filter(|(lower, _)| above(*lower))?;
        Some(format!("lower_bound: {lower} to {upper}, exact {exact}"))
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.operations, self.prices)?;
        for facade in &self.facades {
            write!(f, "; {facade}")?;
        }
        Ok(())
    }
}

/// Costs to try, by name.
pub fn prices() -> [(&'static str, Costs); 9] {
    let costs = |split, repeat, repeat_aba, sym_split, grid_split, successor| Costs {
        split,
        repeat,
        repeat_aba,
        sym_split,
        grid_split,
        successor,
    };
    let third = 1.0 / 3.0;
    [
        ("default", Costs::default()),
        ("split 0", costs(0.0, 0.5, 0.5, 0.1, 0.1, 1.0)),
        ("repeat 0", costs(0.1, 0.0, 0.0, 0.1, 0.1, 1.0)),
        ("only successors", costs(0.0, 0.0, 0.0, 0.0, 0.0, 1.0)),
        ("only operations", costs(0.1, 0.5, 0.5, 0.1, 0.1, 0.0)),
        ("thirds", costs(third, third, third, third, third, third)),
        ("dear split", costs(1.0, 0.5, 0.25, 0.75, 0.25, 1.0)),
        ("dear extensions", costs(0.1, 1.5, 2.0, 1.5, 1.5, 1.0)),
        ("uneven", costs(0.137, 0.519, 0.471, 0.283, 0.359, 1.013)),
    ]
}
