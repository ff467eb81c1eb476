//! A genetic algorithm on genomes of any kind.
//!
//! Minimizes a cost over genomes. Each generation ranks the population by cost, keeps its `elite`
//! best genomes, and fills the rest with children:
//!
//! ```text
//! parents   a, b: each the best of `tournament` genomes drawn at random
//! child     with probability `crossover` a cross of a and b, else a copy of a
//! mutation  with probability `mutation` one random change of the child
//! ```
//!
//! On a ranked population a tournament of size t picks rank r (0 the best of n) with probability
//! `((n - r)^t - (n - r - 1)^t) / n^t`; t = 2 is linear ranking. Only ranks matter: a cost that is
//! rescaled by any increasing function gives the same run. Nothing of a genome is required but that
//! it can be cloned, crossed, mutated and judged ([`Breed`]); a cost of NaN ranks last.
//!
//! Complexity: `population + generations (population - elite)` costs, each at most one crossover and
//! one mutation, and a sort of the population in each generation. With `elite` at least 1 the best cost never
//! rises.
//!
//! Sources: Holland 1975; Goldberg 1989 (crossover, mutation); Baker 1985 (ranks); De Jong 1975 (elitism).

use std::time::Duration;

use argmin::core::{Error as ArgminError, KV, Problem, Solver, State};
use rand::{Rng, RngExt};

use super::limits::Answer;
use super::run::{Run, Search, Step, execute};
use edifice_base::rng::{Stream, stream};

/// The population's problem: the first genomes, their crossing and change, and their cost.
///
/// Costs have any unit, as only their order counts; the [module](self) says how often each function is called. Most of
/// the time is usually spent in [`Breed::costs`], the only function that may compute in parallel: the others draw
/// from the one generator of the run, in order. [`Genetic`] has an example.
pub trait Breed {
    /// A candidate solution, in the form in which it is crossed and changed.
    type Genome: Clone;

    /// The cost of a genome, to be minimized.
    fn cost(&mut self, genome: &Self::Genome) -> f64;
    /// A genome to begin with; used where the population is larger than the given start.
    fn random<R: Rng>(&mut self, rng: &mut R) -> Self::Genome;
    /// A child of two parents.
    fn cross<R: Rng>(&mut self, a: &Self::Genome, b: &Self::Genome, rng: &mut R) -> Self::Genome;
    /// Changes a genome a little.
    fn mutate<R: Rng>(&mut self, genome: &mut Self::Genome, rng: &mut R);
    /// The costs of a whole generation, in order; override it to compute them in parallel.
    fn costs(&mut self, genomes: &[Self::Genome]) -> Vec<f64> {
        genomes.iter().map(|genome| self.cost(genome)).collect()
    }
}

/// Settings of a run, for [`Genetic::new`], whose example uses them. Ranges are checked there.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Genomes in the population, at least 2.
    pub population: usize,
    /// Generations after the first.
    pub generations: u64,
    /// Genomes that pass unchanged to the next generation, less than `population`.
    pub elite: usize,
    /// Genomes drawn for each parent, at least 1.
    pub tournament: usize,
    /// Probability that a child has two parents.
    pub crossover: f64,
    /// Probability that a child is mutated.
    pub mutation: f64,
    /// Ends the run once the best cost is at most this.
    pub goal: f64,
    /// Ends the run after so long.
    pub time_limit: Option<Duration>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: 100,
            generations: 100,
            elite: 1,
            tournament: 2,
            crossover: 0.9,
            mutation: 0.5,
            goal: f64::NEG_INFINITY,
            time_limit: None,
        }
    }
}

/// Genomes with their costs, from the best to the worst.
pub type Population<G> = Vec<(G, f64)>;

/// The errors of a run: settings in [`Genetic::new`], anything else in [`Genetic::run`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GeneticError {
    /// A setting is out of its range.
    #[error("genetic algorithm: {setting} is {value}, expected {expected}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// Its range.
        expected: &'static str,
    },
    /// argmin failed.
    #[error("genetic algorithm stopped: {0}")]
    Stopped(String),
}

impl Settings {
    fn check(&self) -> Result<(), GeneticError> {
        let probability = 0.0..=1.0;
        let (population, elite) = (self.population as f64, self.elite as f64);
        let rules = [
            ("population", population, "at least 2", population >= 2.0),
            (
                "elite",
                elite,
                "less than the population",
                elite < population,
            ),
            (
                "tournament",
                self.tournament as f64,
                "at least 1",
                self.tournament > 0,
            ),
            (
                "crossover",
                self.crossover,
                "0 to 1",
                probability.contains(&self.crossover),
            ),
            (
                "mutation",
                self.mutation,
                "0 to 1",
                probability.contains(&self.mutation),
            ),
        ];
        match rules.into_iter().find(|(.., holds)| !holds) {
            None => Ok(()),
            Some((setting, value, expected, _)) => Err(GeneticError::Setting {
                setting,
                value,
                expected,
            }),
        }
    }
}

/// The solver of the [module](self): [`Settings`] and first genomes. One iteration of argmin is one generation; the trace
/// has the best cost of each, and never rises where `elite` is at least 1.
///
/// Complexity of a generation of n genomes: n - `elite` costs, O(n `tournament`) draws and a sort, O(n log n). Memory: two
/// generations. Sources: Goldberg 1989; Baker 1985.
///
/// # Examples
/// All bits of a word of 16 to 1, by one-point crossover and flips of single bits:
/// ```
/// use edifice_optim::Outcome;
/// use edifice_optim::genetic::{Breed, Genetic, Settings};
/// use rand::{Rng, RngExt};
/// struct Ones;
/// impl Breed for Ones {
///     type Genome = u16;
///     fn cost(&mut self, word: &u16) -> f64 { f64::from(word.count_zeros()) }
///     fn random<R: Rng>(&mut self, rng: &mut R) -> u16 { rng.random() }
///     fn cross<R: Rng>(&mut self, a: &u16, b: &u16, rng: &mut R) -> u16 {
///         let low = (1 << rng.random_range(0..16)) - 1;
///         a & low | b & !low
///     }
///     fn mutate<R: Rng>(&mut self, word: &mut u16, rng: &mut R) { *word ^= 1 << rng.random_range(0..16) }
/// }
/// let settings = Settings { population: 40, goal: 0.0, ..Settings::default() };
/// let (run, population) = Genetic::new(settings, vec![0], 1)?.run(&mut Ones, |_| {})?;
/// assert_eq!((run.best, run.outcome), (u16::MAX, Outcome::TargetReached));
/// assert!(run.trace.windows(2).all(|w| w[1].cost <= w[0].cost));
/// assert!(population.len() == 40 && population.is_sorted_by(|a, b| a.1 <= b.1));
/// # Ok::<(), edifice_optim::genetic::GeneticError>(())
/// ```
#[derive(Debug)]
pub struct Genetic<G> {
    settings: Settings,
    /// Genomes and their costs, from the best to the worst.
    population: Population<G>,
    start: Vec<G>,
    rng: Stream,
}

impl<G: Clone> Genetic<G> {
    /// A solver that begins with the genomes of `start` (the first `population` of them) and as many
    /// random ones as are missing, with the randomness of `seed`.
    ///
    /// # Errors
    /// [`GeneticError::Setting`].
    pub fn new(settings: Settings, start: Vec<G>, seed: u64) -> Result<Self, GeneticError> {
        settings.check()?;
        Ok(Self {
            settings,
            population: Vec::new(),
            start,
            rng: stream(seed, "genetic", 0),
        })
    }

    /// Breeds all generations, telling `observer` of each; returns the last population besides.
    ///
    /// # Errors
    /// [`GeneticError::Stopped`] when argmin fails.
    pub fn run<B: Breed<Genome = G>, A: Answer>(
        self,
        breed: &mut B,
        observer: impl FnMut(Step) -> A,
    ) -> Result<(Run<G>, Population<G>), GeneticError> {
        let settings = self.settings;
        let limits = |state: Search<G>| {
            let state = state.max_iters(settings.generations);
            state.target_cost(settings.goal)
        };
        let (run, solver) = execute(
            breed,
            self,
            |executor| match settings.time_limit {
                Some(limit) => executor.configure(limits).timeout(limit),
                None => executor.configure(limits),
            },
            observer,
        )
        .map_err(|error| GeneticError::Stopped(error.to_string()))?;
        Ok((run, solver.population))
    }

    /// A parent: the best of a few genomes drawn at random; ranks are positions.
    fn parent(&mut self) -> usize {
        let n = self.population.len();
        let draws = (0..self.settings.tournament).map(|_| self.rng.random_range(0..n));
        draws.min().unwrap_or(0)
    }

    fn child<B: Breed<Genome = G>>(&mut self, breed: &mut B) -> G {
        let a = self.parent();
        let mut child = if self.rng.random::<f64>() < self.settings.crossover {
            let b = self.parent();
            breed.cross(&self.population[a].0, &self.population[b].0, &mut self.rng)
        } else {
            self.population[a].0.clone()
        };
        if self.rng.random::<f64>() < self.settings.mutation {
            breed.mutate(&mut child, &mut self.rng);
        }
        child
    }

    /// Adds genomes with their costs, and ranks all (equal costs keep their order: the elder first).
    fn admit<B: Breed<Genome = G>>(
        &mut self,
        breed: &mut B,
        genomes: Vec<G>,
    ) -> Result<(), ArgminError> {
        let costs = breed.costs(&genomes);
        if costs.len() != genomes.len() {
            return Err(ArgminError::msg("a generation has not one cost per genome"));
        }
        let costs = costs
            .into_iter()
            .map(|c| if c.is_nan() { f64::INFINITY } else { c });
        self.population.extend(genomes.into_iter().zip(costs));
        self.population.sort_by(|a, b| a.1.total_cmp(&b.1));
        Ok(())
    }

    /// The state with the best of this generation, told to argmin only when it is the best so far.
    fn tell(&self, state: Search<G>) -> Search<G> {
        let (best, cost) = &self.population[0];
        let better = state.get_best_param().is_none() || *cost < state.get_best_cost();
        let state = if better {
            state.param(best.clone())
        } else {
            state
        };
        state.cost(*cost)
    }
}

impl<B: Breed> Solver<&mut B, Search<B::Genome>> for Genetic<B::Genome> {
    fn name(&self) -> &str {
        "genetic algorithm"
    }

    fn init(
        &mut self,
        problem: &mut Problem<&mut B>,
        state: Search<B::Genome>,
    ) -> Result<(Search<B::Genome>, Option<KV>), ArgminError> {
        let breed = problem.problem.as_deref_mut();
        let breed = breed.ok_or_else(|| ArgminError::msg("no problem"))?;
        let mut first = std::mem::take(&mut self.start);
        first.truncate(self.settings.population);
        while first.len() < self.settings.population {
            first.push(breed.random(&mut self.rng));
        }
        self.admit(breed, first)?;
        let mut state = self.tell(state);
        state.update();
        Ok((state, None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&mut B>,
        state: Search<B::Genome>,
    ) -> Result<(Search<B::Genome>, Option<KV>), ArgminError> {
        let breed = problem.problem.as_deref_mut();
        let breed = breed.ok_or_else(|| ArgminError::msg("no problem"))?;
        let missing = self.settings.population - self.settings.elite;
        let children: Vec<B::Genome> = (0..missing).map(|_| self.child(breed)).collect();
        self.population.truncate(self.settings.elite);
        self.admit(breed, children)?;
        Ok((self.tell(state), None))
    }
}
