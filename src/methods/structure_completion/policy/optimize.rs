//! Policy optimization (Sec. 5.2): a genetic algorithm over λ for one facade.
//!
//! Covariance matrix adaptation ([`edifice_optim::cmaes`], λ reflected into 0 to 1, from the mean of the initial policies) was tried in its place, with
//! the same 1,130 candidates, on 54 tasks of shipped layouts: its best candidate was better in 31, the genetic algorithm's in 23, and the mean score is
//! 0.46 higher by the genetic algorithm. Neither is the winner, and the paper's stays.

use rand::Rng;

use super::{CompletionProblem, Policy, grow};
use crate::layout::Element;
use edifice_base::Watch;
use edifice_base::rng::{Stream, stream};
use edifice_optim::genetic::{Breed, Genetic, GeneticError, Settings};
use edifice_optim::tell;

/// The number of candidates to make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget {
    /// Policies of a generation; 10 in Sec. 5.2.
    pub population: usize,
    /// Generations after the first.
    pub generations: u64,
    /// Candidates of each policy.
    pub draws: usize,
}

impl Budget {
    /// 10,000 candidates (Sec. 6): 10 policies, then 110 times 9 new ones, 10 candidates each.
    pub const PAPER: Self = Self {
        population: 10,
        generations: 110,
        draws: 10,
    };
    /// 192 candidates, to learn initial policies.
    pub const SMALL: Self = Self {
        population: 10,
        generations: 6,
        draws: 3,
    };

    /// Total number of candidates.
    pub fn candidates(&self) -> usize {
        let policies = self.population + (self.population - 1) * self.generations as usize;
        policies * self.draws
    }
}

/// One candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Score of the candidate, `w · f`.
    pub score: f64,
    /// Its added elements.
    pub added: Vec<Element>,
    /// Number of candidates that had this score.
    pub times: usize,
}

/// Result of [`optimize`].
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The best candidates of different score, from the best on.
    pub candidates: Vec<Candidate>,
    /// The policy of greatest mean score.
    pub policy: Policy,
    /// Number of candidates made.
    pub made: usize,
}

/// Policies for one facade.
struct PolicySearch<'a> {
    problem: &'a CompletionProblem<'a>,
    draws: usize,
    keep: usize,
    best: Vec<Candidate>,
    made: usize,
    rng: Stream,
}

impl PolicySearch<'_> {
    /// Keeps a candidate if it is among the best.
    fn note(&mut self, score: f64, elements: &[Element]) {
        let at = self.best.partition_point(|c| c.score > score);
        match self.best.get_mut(at) {
            Some(same) if same.score == score => same.times += 1,
            _ if at < self.keep => {
                let added = elements[self.problem.start.items.len()..].to_vec();
                let times = 1;
                self.best.insert(
                    at,
                    Candidate {
                        score,
                        added,
                        times,
                    },
                );
                self.best.truncate(self.keep);
            }
            _ => {}
        }
    }
}

impl Breed for PolicySearch<'_> {
    type Genome = Policy;

    /// Less the mean score of the policy's candidates: the expectation of Eq. 24.
    fn cost(&mut self, policy: &Policy) -> f64 {
        let mut sum = 0.0;
        for _ in 0..self.draws {
            let elements = grow(self.problem, policy, &mut self.rng);
            let score = self.problem.score(&elements);
            self.note(score, &elements);
            self.made += 1;
            sum += score;
        }
        -sum / self.draws as f64
    }

    fn random<R: Rng>(&mut self, rng: &mut R) -> Policy {
        Policy::random(rng)
    }

    fn cross<R: Rng>(&mut self, a: &Policy, b: &Policy, rng: &mut R) -> Policy {
        a.cross(b, rng)
    }

    fn mutate<R: Rng>(&mut self, policy: &mut Policy, rng: &mut R) {
        policy.mutate(rng);
    }
}

/// Evolves policies from the model's and keeps the `keep` best candidates of different score, until `watch` stops it.
///
/// # Errors
/// [`GeneticError`] for a budget out of range.
pub fn optimize(
    problem: &CompletionProblem,
    budget: &Budget,
    keep: usize,
    seed: u64,
    watch: &Watch,
) -> Result<Found, GeneticError> {
    let settings = Settings {
        population: budget.population,
        generations: budget.generations,
        elite: 1,
        crossover: 0.9,
        mutation: 0.8,
        ..Settings::default()
    };
    let mut search = PolicySearch {
        problem,
        draws: budget.draws,
        keep,
        best: Vec::new(),
        made: 0,
        rng: stream(seed, "candidates", 0),
    };
    let genetic = Genetic::new(settings, problem.model.policies.clone(), seed)?;
    let (run, _) = genetic.run(&mut search, tell(watch, None))?;
    Ok(Found {
        candidates: search.best,
        policy: run.best,
        made: search.made,
    })
}
