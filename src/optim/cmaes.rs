//! Covariance matrix adaptation: real functions without derivatives, whatever their scale and rotation.
//!
//! From a mean m, a step s and a covariance C, each generation draws `x_i = m + s y_i`, `y_i ~ N(0, C)`, ranks them by cost, and
//! learns from the best half with falling weights w: the mean moves to their weighted mean, C takes in the directions that led there
//! (of this generation, and of the path over generations), and s grows while the path is longer than that of a random walk, and
//! shrinks while it is shorter. Only ranks matter: the run is the same for every rising function of the cost.
//!
//! Restarts are BIPOP's: after each run that has converged, either the population is doubled, or a small one with a small step is tried,
//! whichever kind has used fewer evaluations.
//!
//! Cost of a generation of λ points in n variables: λ costs, O(λ n²) for the draws, and O(n³) for the eigenvectors of C, every
//! `λ / (10 n)` generations or so.
//!
//! # Deviations and readings
//! - Within bounds a point is judged where it is clipped to, and pays the squared distance in units of the step, times the spread
//!   of costs in the generation: simple, and enough as long as optima at bounds are not sharp.
//!
//! Sources: Hansen 2016, *The CMA evolution strategy: a tutorial*; Hansen 2009 (BIPOP).

use argmin::core::{Error as ArgminError, KV, Problem, Solver, State, TerminationReason, TerminationStatus};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::limits::{Answer, Limits, Watch};
use super::run::{Run, Search, Step, execute};
use edifice_base::rng::{Stream, stream};

/// Settings of [`minimize`]. The example of [`Limits`] uses some.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// First step, in the unit of the variables: a third of where the optimum is looked for. One number for all, so
    /// variables should be scaled to be alike.
    pub step: f64,
    /// Lower bounds, one for each variable; none where empty.
    pub lower: Vec<f64>,
    /// Upper bounds.
    pub upper: Vec<f64>,
    /// Points of the first generation; `4 + 3 ln n` unless given, at least 4.
    pub population: Option<usize>,
    /// Restarts after the first run has converged.
    pub restarts: usize,
    /// The steps and the spreads of costs at which a run has converged, relative to the first step and the widest spread.
    pub tolerance: f64,
    /// Limits of the run.
    pub limits: Limits,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            step: 1.0,
            lower: Vec::new(),
            upper: Vec::new(),
            population: None,
            restarts: 0,
            tolerance: 1e-12,
            limits: Limits::default(),
        }
    }
}

/// Failures of [`minimize`].
#[derive(Debug, thiserror::Error)]
pub enum CmaError {
    /// A setting is out of its range.
    #[error("`{setting}` must be {must}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its range.
        must: &'static str,
    },
    /// argmin failed.
    #[error("CMA-ES stopped: {0}")]
    Stopped(String),
}

/// Minimises a function from `start`, telling `observer` of every generation. A cost that is not a number ranks last.
///
/// Converged where a generation's points and costs do not differ by more than the tolerance, and no restart is left.
///
/// # Errors
/// [`CmaError::Setting`].
///
/// # Examples
/// Rosenbrock's valley in ten variables, a curved one:
/// ```
/// use edifice_optim::{Limits, Outcome, cmaes::{Settings, minimize}};
/// let valley = |x: &[f64]| -> f64 {
///     x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
/// };
/// let limits = Limits { evaluations: Some(10_000), target: Some(1e-10), ..Limits::default() };
/// let settings = Settings { step: 0.5, limits, ..Settings::default() };
/// let run = minimize(valley, &[0.0; 10], &settings, 1, |_| {})?;
/// assert_eq!(run.outcome, Outcome::TargetReached);
/// # Ok::<(), edifice_optim::cmaes::CmaError>(())
/// ```
pub fn minimize<F: FnMut(&[f64]) -> f64, A: Answer>(
    cost: F,
    start: &[f64],
    settings: &Settings,
    seed: u64,
    observer: impl FnMut(Step) -> A + 'static,
) -> Result<Run<Vec<f64>>, CmaError> {
    check(start, settings)?;
    let solver = Cma {
        path: Path::new(start, settings.step, population(start.len(), settings)),
        settings: settings.clone(),
        start: start.to_vec(),
        watch: Watch::new(settings.limits),
        restarts: Restarts::default(),
        done: false,
        rng: stream(seed, "cmaes", 0),
    };
    let mut cost = cost;
    let begin = |state: Search<Vec<f64>>| state.param(start.to_vec()).max_iters(u64::MAX);
    let (run, _) = execute(&mut cost, solver, |e| e.configure(begin), observer)
        .map_err(|error| CmaError::Stopped(error.to_string()))?;
    Ok(run)
}

fn check(start: &[f64], settings: &Settings) -> Result<(), CmaError> {
    let wrong = |setting, must| Err(CmaError::Setting { setting, must });
    let n = start.len();
    if n == 0 || start.iter().any(|x| !x.is_finite()) {
        return wrong("start", "at least one finite number");
    }
    if !(settings.step > 0.0 && settings.step.is_finite()) {
        return wrong("step", "positive");
    }
    if settings.population.is_some_and(|p| p < 4) {
        return wrong("population", "at least 4");
    }
    for (setting, bounds) in [("lower", &settings.lower), ("upper", &settings.upper)] {
        if !bounds.is_empty() && bounds.len() != n || bounds.iter().any(|b| b.is_nan()) {
            return wrong(setting, "one number for each variable");
        }
    }
    let crossed = settings.lower.iter().zip(&settings.upper).any(|(l, u)| l >= u);
    match crossed {
        true => wrong("upper", "above the lower bounds"),
        false => Ok(()),
    }
}

fn population(n: usize, settings: &Settings) -> usize {
    let usual = 4 + (3.0 * (n as f64).ln()) as usize;
    settings.population.unwrap_or(usual)
}

/// The state of one run between restarts.
#[derive(Debug)]
struct Path {
    weights: Vec<f64>,
    /// Σ w, squared, over Σ w²: how many points the mean is of.
    effective: f64,
    count: usize,
    mean: DVector<f64>,
    first: f64,
    step: f64,
    covariance: DMatrix<f64>,
    /// Eigenvectors of the covariance, and the roots of its eigenvalues.
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
    path_step: DVector<f64>,
    path: DVector<f64>,
    generation: u64,
    decomposed: u64,
    /// Best costs of the last generations, newest last.
    recent: Vec<f64>,
    /// Largest spread of costs of a generation so far.
    widest: f64,
    evaluations: u64,
}

impl Path {
    fn new(start: &[f64], step: f64, count: usize) -> Self {
        let n = start.len();
        let half = count / 2;
        let raw = (1..=half).map(|i| ((count as f64 + 1.0) / 2.0).ln() - (i as f64).ln());
        let raw: Vec<f64> = raw.collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        Self {
            effective: 1.0 / weights.iter().map(|w| w * w).sum::<f64>(),
            weights,
            count,
            mean: DVector::from_column_slice(start),
            first: step,
            step,
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
            path_step: DVector::zeros(n),
            path: DVector::zeros(n),
            generation: 0,
            decomposed: 0,
            recent: Vec::new(),
            widest: 0.0,
            evaluations: 0,
        }
    }

    fn draw<R: Rng>(&self, rng: &mut R) -> DVector<f64> {
        let n = self.mean.len();
        let z = DVector::from_fn(n, |i, _| self.lengths[i] * rng.sample::<f64, _>(StandardNormal));
        &self.axes * z
    }

    /// Learns from steps y in rising order of cost.
    fn learn(&mut self, ranked: &[&DVector<f64>]) {
        let n = self.mean.len() as f64;
        let mu = self.effective;
        let c_step = (mu + 2.0) / (n + mu + 5.0);
        let damping = 1.0 + 2.0 * (((mu - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_step;
        let c_path = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
        let c_one = 2.0 / ((n + 1.3).powi(2) + mu);
        let c_mu = (2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0).powi(2) + mu)).min(1.0 - c_one);
        let normal_length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let mut moved = DVector::zeros(self.mean.len());
        for (w, y) in self.weights.iter().zip(ranked) {
            moved.axpy(*w, y, 1.0);
        }
        self.mean.axpy(self.step, &moved, 1.0);
        self.generation += 1;
        // C^(-1/2) of the move.
        let inside = (self.axes.transpose() * &moved).component_div(&self.lengths);
        let white = &self.axes * inside;
        self.path_step *= 1.0 - c_step;
        self.path_step.axpy((c_step * (2.0 - c_step) * mu).sqrt(), &white, 1.0);
        let length = self.path_step.norm();
        let begun = 1.0 - (1.0 - c_step).powf(2.0 * self.generation as f64);
        let slow = length / begun.sqrt() < (1.4 + 2.0 / (n + 1.0)) * normal_length;
        self.path *= 1.0 - c_path;
        if slow {
            self.path.axpy((c_path * (2.0 - c_path) * mu).sqrt(), &moved, 1.0);
        }
        let lost = if slow { 0.0 } else { c_one * c_path * (2.0 - c_path) };
        self.covariance *= 1.0 - c_one - c_mu + lost;
        self.covariance.ger(c_one, &self.path, &self.path, 1.0);
        for (w, y) in self.weights.iter().zip(ranked) {
            self.covariance.ger(c_mu * w, y, y, 1.0);
        }
        self.step *= ((c_step / damping) * (length / normal_length - 1.0)).min(1.0).exp();
        let pause = self.count as f64 / (c_one + c_mu) / n / 10.0;
        let since = (self.generation - self.decomposed) as f64 * self.count as f64;
        if since >= pause {
            self.decompose();
        }
    }

    fn decompose(&mut self) {
        self.decomposed = self.generation;
        self.covariance = (&self.covariance + self.covariance.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(self.covariance.clone());
        self.lengths = eigen.eigenvalues.map(|v| v.max(1e-300).sqrt());
        self.axes = eigen.eigenvectors;
    }

    /// True if nothing more is to be had from this run.
    fn converged(&self, tolerance: f64, spread: f64) -> bool {
        let n = self.mean.len();
        let window = 10 + 30 * n / self.count;
        let largest = self.lengths.max();
        let least = self.lengths.min();
        let last = &self.recent[self.recent.len().saturating_sub(window)..];
        let range = last.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - last.iter().copied().fold(f64::INFINITY, f64::min);
        let flat = last.len() >= window && range.max(spread) <= tolerance * self.widest;
        let small = self.step * largest <= tolerance * self.first;
        let singular = largest > 1e7 * least;
        let broken = !(self.step.is_finite() && largest.is_finite());
        // No progress for long: the median of the recent costs is not below that of before.
        let long = (120.0 + 30.0 * n as f64 / self.count as f64) as usize;
        let stagnant = self.recent.len() >= 2 * long && {
            let median = |x: &[f64]| {
                let mut x = x.to_vec();
                x.sort_by(f64::total_cmp);
                x[x.len() / 2]
            };
            let (old, new) = self.recent[self.recent.len() - 2 * long..].split_at(long);
            median(new) >= median(old)
        };
        flat || small || singular || broken || stagnant
    }
}

/// Evaluations that the two kinds of restarts have used.
#[derive(Debug, Default)]
struct Restarts {
    done: usize,
    large: u64,
    small: u64,
    doublings: u32,
    small_now: bool,
}

#[derive(Debug)]
struct Cma {
    settings: Settings,
    start: Vec<f64>,
    path: Path,
    watch: Watch,
    restarts: Restarts,
    done: bool,
    rng: Stream,
}

impl Cma {
    fn clip(&self, x: &DVector<f64>) -> (Vec<f64>, f64) {
        let bound = |i: usize, v: f64| {
            let low = self.settings.lower.get(i).copied().unwrap_or(f64::NEG_INFINITY);
            let high = self.settings.upper.get(i).copied().unwrap_or(f64::INFINITY);
            v.clamp(low, high)
        };
        let inside: Vec<f64> = x.iter().enumerate().map(|(i, v)| bound(i, *v)).collect();
        let off = x.iter().zip(&inside).map(|(a, b)| ((a - b) / self.path.step).powi(2));
        let off = off.sum();
        (inside, off)
    }

    /// The next run, by BIPOP's rule.
    fn restart(&mut self) {
        let used = self.path.evaluations;
        match self.restarts.small_now {
            true => self.restarts.small += used,
            // The very first run belongs to neither.
            false if self.restarts.done > 0 => self.restarts.large += used,
            false => {}
        }
        self.restarts.done += 1;
        let usual = population(self.start.len(), &self.settings);
        self.restarts.small_now =
            self.restarts.doublings > 0 && self.restarts.small < self.restarts.large;
        let (count, step) = if self.restarts.small_now {
            let u: f64 = self.rng.random();
            let large = 2_f64.powi(self.restarts.doublings as i32);
            let count = usual as f64 * (0.5 * large).powf(u * u);
            let step = self.settings.step * 100_f64.powf(-self.rng.random::<f64>());
            ((count as usize).max(4), step)
        } else {
            self.restarts.doublings += 1;
            (usual << self.restarts.doublings.min(16), self.settings.step)
        };
        let place = |(i, x): (usize, &f64)| {
            let low = self.settings.lower.get(i).copied().unwrap_or(f64::NEG_INFINITY);
            let high = self.settings.upper.get(i).copied().unwrap_or(f64::INFINITY);
            match (high - low).is_finite() {
                true => low + (high - low) * self.rng.random::<f64>(),
                false => {
                    let z: f64 = self.rng.sample(StandardNormal);
                    (x + self.settings.step * z).clamp(low, high)
                }
            }
        };
        let start: Vec<f64> = self.start.iter().enumerate().map(place).collect();
        self.path = Path::new(&start, step, count);
    }
}

impl<F: FnMut(&[f64]) -> f64> Solver<&mut F, Search<Vec<f64>>> for Cma {
    fn name(&self) -> &str {
        "CMA-ES"
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&mut F>,
        state: Search<Vec<f64>>,
    ) -> Result<(Search<Vec<f64>>, Option<KV>), ArgminError> {
        let cost = problem.problem.as_deref_mut();
        let cost = cost.ok_or_else(|| ArgminError::msg("no cost"))?;
        let count = self.path.count;
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let y = self.path.draw(&mut self.rng);
            let x = &self.path.mean + &y * self.path.step;
            let (inside, off) = self.clip(&x);
            let value = cost(&inside);
            let value = if value.is_nan() { f64::INFINITY } else { value };
            points.push((value, off, y, inside));
        }
        self.watch.evaluations += count as u64;
        self.path.evaluations += count as u64;
        let finite = || points.iter().map(|p| p.0).filter(|c| c.is_finite());
        let least = finite().fold(f64::INFINITY, f64::min);
        let spread = finite().fold(least, f64::max) - least;
        // Outside of the bounds a step's length costs as much as the costs differ.
        let fee = if spread > 0.0 { spread } else { 1.0 };
        points.sort_by(|a, b| (a.0 + fee * a.1).total_cmp(&(b.0 + fee * b.1)));
        let ranked: Vec<&DVector<f64>> = points.iter().map(|p| &p.2).collect();
        self.path.learn(&ranked);
        let best = points.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let (best_cost, best) = best.map_or((f64::INFINITY, Vec::new()), |p| (p.0, p.3.clone()));
        self.path.recent.push(best_cost);
        self.path.widest = self.path.widest.max(spread);
        let better = best_cost < state.get_best_cost() || state.get_best_param().is_none();
        if self.path.converged(self.settings.tolerance, spread) {
            if self.restarts.done >= self.settings.restarts {
                self.done = true;
            } else {
                self.restart();
            }
        }
        let state = if better { state.param(best) } else { state };
        Ok((state.cost(best_cost), None))
    }

    fn terminate(&mut self, state: &Search<Vec<f64>>) -> TerminationStatus {
        match self.done {
            true => TerminationStatus::Terminated(TerminationReason::SolverConverged),
            false => self.watch.status(state.get_best_cost()),
        }
    }
}
