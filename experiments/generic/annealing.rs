//! Simulated annealing, on knapsack problems.

use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::knapsack::{Knapsack, Solved};
use edifice_base::{Error, Result};
use edifice_optim::annealing::{Annealing, Cooling, Landscape};
use edifice_sweep::{Better, Given, Outcome, Study};

/// Settings of annealing.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Settings {
    /// Rounds of moves, each at one temperature.
    rounds: u64,
    /// Moves of a round.
    moves: u32,
    /// First temperature, in mean values of an item.
    start: f64,
    /// Last temperature, in mean values of an item.
    end: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            rounds: 100,
            moves: 50,
            start: 1.0,
            end: 0.01,
        }
    }
}

/// Simulated annealing.
pub fn study() -> Study {
    const METRICS: &[(&str, Better)] = &[("left_out", Better::Lower), ("optimal", Better::Higher)];
    let about = "simulated annealing on knapsacks of known optimum: value left out of the knapsack";
    Study::new("optim/annealing", about, "optim", METRICS, run)
        .made_of(&["edifice-optim"], "generic")
}

fn run(settings: &Settings, given: &Given) -> Result<Outcome> {
    let solved = Solved::read(given.path)?;
    let problem = &solved.problem;
    let unit = problem.total() as f64 / problem.items.len() as f64;
    let cooling = Cooling {
        start: settings.start * unit,
        end: settings.end * unit,
    };
    let annealing = Annealing::new(cooling, settings.rounds, settings.moves, given.seed);
    let mut landscape = Packing::empty(problem);
    let run = annealing
        .map_err(Error::method)?
        .run(&mut landscape, |_| {})
        .map_err(Error::method)?;
    let mut found = solved.judge(&run.best)?;
    for step in &run.trace {
        if found.trace.last().is_none_or(|last| step.best < last[1]) {
            let moves = (step.iteration + 1) * u64::from(settings.moves);
            found.trace.push([moves as f64, step.best]);
        }
    }
    Ok(found)
}

/// The items that are packed; a move packs an item or takes one out, and makes room by taking out others by chance.
struct Packing<'a> {
    problem: &'a Knapsack,
    packed: Vec<bool>,
    before: Vec<bool>,
    weight: u64,
    value: u64,
    changed: (u64, u64),
}

impl<'a> Packing<'a> {
    fn empty(problem: &'a Knapsack) -> Self {
        let packed = vec![false; problem.items.len()];
        Self {
            problem,
            before: packed.clone(),
            packed,
            weight: 0,
            value: 0,
            changed: (0, 0),
        }
    }

    fn put(&mut self, item: usize, inside: bool) {
        let (value, weight) = self.problem.items[item];
        self.packed[item] = inside;
        match inside {
            true => (self.weight, self.value) = (self.weight + weight, self.value + value),
            false => (self.weight, self.value) = (self.weight - weight, self.value - value),
        }
    }
}

impl Landscape for Packing<'_> {
    type Solution = Vec<bool>;

    fn cost(&self) -> f64 {
        (self.problem.total() - self.value) as f64
    }

    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        let count = self.packed.len();
        let item = rng.random_range(0..count);
        if self.problem.items[item].1 > self.problem.capacity {
            return None;
        }
        self.before.clone_from(&self.packed);
        self.changed = (self.weight, self.value);
        self.put(item, !self.packed[item]);
        while self.weight > self.problem.capacity {
            let other = rng.random_range(0..count);
            if other != item && self.packed[other] {
                self.put(other, false);
            }
        }
        Some(self.cost())
    }

    fn accept(&mut self) {}

    fn reject(&mut self) {
        std::mem::swap(&mut self.packed, &mut self.before);
        (self.weight, self.value) = self.changed;
    }

    fn solution(&self) -> Vec<bool> {
        self.packed.clone()
    }
}
