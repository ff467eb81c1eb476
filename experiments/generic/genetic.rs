//! The genetic algorithm, on knapsack problems.

use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::knapsack::{Knapsack, Solved};
use edifice_base::{Error, Result};
use edifice_optim::genetic::{self, Breed, Genetic};
use edifice_sweep::{Better, Given, Outcome, Study};

/// Settings of the genetic algorithm.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Settings {
    /// Genomes in the population, at least 2.
    population: usize,
    /// Generations after the first.
    generations: u64,
    /// Genomes that pass unchanged to the next generation.
    elite: usize,
    /// Genomes drawn for each parent.
    tournament: usize,
    /// Probability that a child has two parents.
    crossover: f64,
    /// Probability that a child is mutated.
    mutation: f64,
}

impl Default for Settings {
    fn default() -> Self {
        let settings = genetic::Settings::default();
        Self {
            population: 50,
            generations: settings.generations,
            elite: settings.elite,
            tournament: settings.tournament,
            crossover: settings.crossover,
            mutation: settings.mutation,
        }
    }
}

/// The genetic algorithm.
pub fn study() -> Study {
    const METRICS: &[(&str, Better)] = &[("left_out", Better::Lower), ("optimal", Better::Higher)];
    let about =
        "the genetic algorithm on knapsacks of known optimum: value left out of the knapsack";
    Study::new("optim/genetic", about, "optim", METRICS, run).made_of(&["edifice-optim"], "generic")
}

fn run(settings: &Settings, given: &Given) -> Result<Outcome> {
    let solved = Solved::read(given.path)?;
    let asked = genetic::Settings {
        population: settings.population,
        generations: settings.generations,
        elite: settings.elite,
        tournament: settings.tournament,
        crossover: settings.crossover,
        mutation: settings.mutation,
        ..genetic::Settings::default()
    };
    let genetic = Genetic::new(asked, Vec::new(), given.seed).map_err(Error::method)?;
    let mut packers = Packers(&solved.problem);
    let (run, _) = genetic.run(&mut packers, |_| {}).map_err(Error::method)?;
    let mut found = solved.judge(&run.best)?;
    let each = (settings.population - settings.elite) as u64;
    for step in &run.trace {
        if found.trace.last().is_none_or(|last| step.best < last[1]) {
            let evaluations = settings.population as u64 + each * step.iteration;
            found.trace.push([evaluations as f64, step.best]);
        }
    }
    Ok(found)
}

/// Genomes are what is packed; they always fit.
struct Packers<'a>(&'a Knapsack);

impl Breed for Packers<'_> {
    type Genome = Vec<bool>;

    fn cost(&mut self, packed: &Vec<bool>) -> f64 {
        let left = self.0.items.iter().zip(packed).filter(|(_, p)| !**p);
        left.map(|((value, _), _)| *value).sum::<u64>() as f64
    }

    fn random<R: Rng>(&mut self, rng: &mut R) -> Vec<bool> {
        let mut packed: Vec<bool> = self.0.items.iter().map(|_| rng.random()).collect();
        self.0.repair(&mut packed);
        packed
    }

    fn cross<R: Rng>(&mut self, a: &Vec<bool>, b: &Vec<bool>, rng: &mut R) -> Vec<bool> {
        let pick = |(a, b): (&bool, &bool)| if rng.random() { *a } else { *b };
        let mut packed: Vec<bool> = a.iter().zip(b).map(pick).collect();
        self.0.repair(&mut packed);
        packed
    }

    fn mutate<R: Rng>(&mut self, packed: &mut Vec<bool>, rng: &mut R) {
        let item = rng.random_range(0..packed.len());
        packed[item] = !packed[item];
        self.0.repair(packed);
    }
}
