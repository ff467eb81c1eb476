//! Several costs at once: NSGA-II, and the hypervolume by which fronts are compared.
//!
//! A genome dominates another one when none of its costs is higher and one is lower. Wanted is the front: genomes that none dominates. Each
//! generation makes as many children as there are genomes, by tournaments of two, and keeps the better half of all: first the
//! front, then what is the front without it, and so on; of the last that fits in part those with the largest crowding distance, the
//! sum over costs of the gap between a genome's neighbours.
//!
//! Constraints: a genome with less violation dominates one with more, whatever their costs. Bounds: [`Reals`] has them, by
//! reflection; a genome of one's own repairs itself where it is made ([`Breed::repair`]).
//!
//! Cost of a generation of n genomes with m costs: n evaluations, and O(m n²) comparisons.
//!
//! Sources: Deb, Pratap, Agarwal and Meyarivan 2002; Deb and Agrawal 1995 (crossover and mutation of real genomes).

mod hypervolume;
mod reals;

use rand::{Rng, RngExt};

use super::limits::{Answer, Limits, Watch};
use super::run::{Outcome, Step};
use edifice_base::rng::{Stream, stream};
pub use hypervolume::hypervolume;
pub use reals::Reals;

/// A problem of several costs: its genomes and their costs.
pub trait Breed {
    /// A candidate solution.
    type Genome: Clone;

    /// Number of costs, the same for every genome.
    fn objectives(&self) -> usize;
    /// The costs, each to be minimised; one that is not a number is the worst.
    fn costs(&mut self, genome: &Self::Genome) -> Vec<f64>;
    /// Sum of the violations of all constraints, in any unit; 0 if all hold.
    fn violation(&mut self, _: &Self::Genome) -> f64 {
        0.0
    }
    /// A genome to begin with.
    fn random<R: Rng>(&mut self, rng: &mut R) -> Self::Genome;
    /// A child of two parents.
    fn cross<R: Rng>(&mut self, a: &Self::Genome, b: &Self::Genome, rng: &mut R) -> Self::Genome;
    /// Changes a genome a little.
    fn mutate<R: Rng>(&mut self, genome: &mut Self::Genome, rng: &mut R);
    /// Makes a new genome satisfy what it can; nothing unless overridden.
    fn repair(&mut self, _: &mut Self::Genome) {}
}

/// Settings of [`evolve`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Genomes, at least 4.
    pub population: usize,
    /// Generations after the first.
    pub generations: u64,
    /// Probability that a child has two parents.
    pub crossover: f64,
    /// Limits of the run; a target has no meaning here.
    pub limits: Limits,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: 100,
            generations: 250,
            crossover: 0.9,
            limits: Limits::default(),
        }
    }
}

/// Failures of [`evolve`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NsgaError {
    /// A setting is out of its range.
    #[error("`{setting}` must be {must}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its range.
        must: &'static str,
    },
    /// A genome has not as many costs as [`Breed::objectives`] says.
    #[error("a genome has {found} costs, expected {expected}")]
    Costs {
        /// Their number.
        found: usize,
        /// The number that [`Breed::objectives`] gives.
        expected: usize,
    },
}

/// A genome and what it costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Member<G> {
    /// The genome.
    pub genome: G,
    /// Its costs.
    pub costs: Vec<f64>,
    /// Its violation of constraints, at least 0.
    pub violation: f64,
    rank: usize,
    crowding: f64,
}

/// The result of [`evolve`].
#[derive(Debug, Clone, PartialEq)]
pub struct Front<G> {
    /// The genomes that no other one dominates, by their first cost.
    pub members: Vec<Member<G>>,
    /// The reason for which the run ended.
    pub outcome: Outcome,
    /// Generations done.
    pub generations: u64,
    /// Evaluations done.
    pub evaluations: u64,
}

impl<G> Front<G> {
    /// The volume that the front dominates below a reference point ([`hypervolume`]); members that violate constraints do not count.
    pub fn hypervolume(&self, reference: &[f64]) -> f64 {
        let fine = self.members.iter().filter(|m| m.violation <= 0.0);
        let costs: Vec<Vec<f64>> = fine.map(|m| m.costs.clone()).collect();
        hypervolume(&costs, reference)
    }
}

/// Finds the front, telling `observer` of every generation: the step's cost is the number of genomes on the front.
///
/// # Errors
/// [`NsgaError`].
///
/// # Examples
/// Schaffer's problem, `x²` against `(x - 2)²`; the front is `sqrt(f_1) + sqrt(f_2) = 2`:
/// ```
/// use edifice_optim::nsga::{Reals, Settings, evolve};
/// let costs = |x: &[f64]| vec![x[0] * x[0], (x[0] - 2.0).powi(2)];
/// let mut problem = Reals::new(vec![(-10.0, 10.0)], 2, costs);
/// let front = evolve(&mut problem, &Settings { population: 40, generations: 50, ..Settings::default() }, 1, |_| {})?;
/// assert!(front.members.iter().all(|m| (m.costs[0].sqrt() + m.costs[1].sqrt() - 2.0).abs() < 0.05));
/// assert!(front.hypervolume(&[4.0, 4.0]) > 13.0); // of 13.33
/// # Ok::<(), edifice_optim::nsga::NsgaError>(())
/// ```
pub fn evolve<B: Breed, A: Answer>(
    breed: &mut B,
    settings: &Settings,
    seed: u64,
    mut observer: impl FnMut(Step) -> A,
) -> Result<Front<B::Genome>, NsgaError> {
    let wrong = |setting, must| Err(NsgaError::Setting { setting, must });
    if settings.population < 4 {
        return wrong("population", "at least 4");
    }
    if !(0.0..=1.0).contains(&settings.crossover) {
        return wrong("crossover", "0 to 1");
    }
    let limits = Limits {
        target: None,
        ..settings.limits
    };
    let (mut watch, mut rng) = (Watch::new(limits), stream(seed, "nsga", 0));
    let mut all = Vec::with_capacity(2 * settings.population);
    for _ in 0..settings.population {
        let genome = breed.random(&mut rng);
        all.push(judge(breed, genome)?);
    }
    watch.evaluations += all.len() as u64;
    select(&mut all, settings.population);
    let mut generation = 0;
    let outcome = loop {
        if generation == settings.generations {
            break Outcome::MaxIterations;
        }
        if let Some(outcome) = Outcome::reached(&watch.status(f64::INFINITY)) {
            break outcome;
        }
        for _ in 0..settings.population {
            let child = child(breed, &all[..settings.population], settings, &mut rng);
            all.push(judge(breed, child)?);
        }
        watch.evaluations += settings.population as u64;
        select(&mut all, settings.population);
        let on_front = all.iter().filter(|m| m.rank == 0).count() as f64;
        let step = Step {
            iteration: generation,
            cost: on_front,
            best: on_front,
        };
        generation += 1;
        if observer(step).stops() {
            break Outcome::Stopped;
        }
    };
    all.retain(|m| m.rank == 0);
    all.sort_by(|a, b| a.costs[0].total_cmp(&b.costs[0]));
    Ok(Front {
        members: all,
        outcome,
        generations: generation,
        evaluations: watch.evaluations,
    })
}

fn judge<B: Breed>(breed: &mut B, mut genome: B::Genome) -> Result<Member<B::Genome>, NsgaError> {
    breed.repair(&mut genome);
    let mut costs = breed.costs(&genome);
    let expected = breed.objectives().max(1);
    if costs.len() != expected {
        let found = costs.len();
        return Err(NsgaError::Costs { found, expected });
    }
    for cost in costs.iter_mut().filter(|c| c.is_nan()) {
        *cost = f64::INFINITY;
    }
    let violation = breed.violation(&genome);
    Ok(Member {
        violation: if violation.is_nan() {
            f64::INFINITY
        } else {
            violation.max(0.0)
        },
        genome,
        costs,
        rank: 0,
        crowding: 0.0,
    })
}

fn child<B: Breed>(
    breed: &mut B,
    parents: &[Member<B::Genome>],
    settings: &Settings,
    rng: &mut Stream,
) -> B::Genome {
    let pick = |rng: &mut Stream| {
        let (a, b) = (
            rng.random_range(0..parents.len()),
            rng.random_range(0..parents.len()),
        );
        let (a, b) = (&parents[a], &parents[b]);
        let better = b.rank < a.rank || b.rank == a.rank && b.crowding > a.crowding;
        if better { b } else { a }
    };
    let a = pick(rng);
    let mut child = match rng.random::<f64>() < settings.crossover {
        true => breed.cross(&a.genome, &pick(rng).genome, rng),
        false => a.genome.clone(),
    };
    breed.mutate(&mut child, rng);
    child
}

/// Keeps the best `count`, ranks and crowding set.
fn select<G>(all: &mut Vec<Member<G>>, count: usize) {
    let n = all.len();
    let mut dominated_by = vec![0_usize; n];
    let mut dominates = vec![Vec::new(); n];
    for i in 0..n {
        for j in i + 1..n {
            match compare(&all[i], &all[j]) {
                std::cmp::Ordering::Less => {
                    dominates[i].push(j);
                    dominated_by[j] += 1;
                }
                std::cmp::Ordering::Greater => {
                    dominates[j].push(i);
                    dominated_by[i] += 1;
                }
                std::cmp::Ordering::Equal => {}
            }
        }
    }
    let mut front: Vec<usize> = (0..n).filter(|&i| dominated_by[i] == 0).collect();
    let mut kept = Vec::with_capacity(count);
    let mut rank = 0;
    while !front.is_empty() && kept.len() < count {
        crowd(all, &front);
        front.iter().for_each(|&i| all[i].rank = rank);
        if kept.len() + front.len() > count {
            front.sort_by(|&a, &b| all[b].crowding.total_cmp(&all[a].crowding));
            front.truncate(count - kept.len());
        }
        let mut next = Vec::new();
        for &i in &front {
            for &j in &dominates[i] {
                dominated_by[j] -= 1;
                if dominated_by[j] == 0 {
                    next.push(j);
                }
            }
        }
        next.sort_unstable();
        kept.append(&mut front);
        front = next;
        rank += 1;
    }
    let mut place = vec![usize::MAX; n];
    kept.iter().enumerate().for_each(|(p, &i)| place[i] = p);
    let mut pairs: Vec<(usize, Member<G>)> = place.into_iter().zip(all.drain(..)).collect();
    pairs.retain(|(p, _)| *p < usize::MAX);
    pairs.sort_by_key(|(p, _)| *p);
    all.extend(pairs.into_iter().map(|(_, m)| m));
}

/// Less where a dominates b, greater where b dominates a.
fn compare<G>(a: &Member<G>, b: &Member<G>) -> std::cmp::Ordering {
    if a.violation != b.violation {
        return a.violation.total_cmp(&b.violation);
    }
    let pairs = || a.costs.iter().zip(&b.costs);
    match (pairs().any(|(x, y)| x < y), pairs().any(|(x, y)| x > y)) {
        (true, false) => std::cmp::Ordering::Less,
        (false, true) => std::cmp::Ordering::Greater,
        _ => std::cmp::Ordering::Equal,
    }
}

/// Crowding distances within a front.
fn crowd<G>(all: &mut [Member<G>], front: &[usize]) {
    front.iter().for_each(|&i| all[i].crowding = 0.0);
    let objectives = front.first().map_or(0, |&i| all[i].costs.len());
    let mut order = front.to_vec();
    for o in 0..objectives {
        order.sort_by(|&a, &b| all[a].costs[o].total_cmp(&all[b].costs[o]));
        let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
            return;
        };
        let range = all[last].costs[o] - all[first].costs[o];
        all[first].crowding = f64::INFINITY;
        all[last].crowding = f64::INFINITY;
        for w in order.windows(3) {
            let gap = (all[w[2]].costs[o] - all[w[0]].costs[o]) / range;
            if gap.is_finite() {
                all[w[1]].crowding += gap;
            }
        }
    }
}
