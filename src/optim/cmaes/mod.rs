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

mod path;

use argmin::core::{
    Error as ArgminError, KV, Problem, Solver, State, TerminationReason, TerminationStatus,
};
use nalgebra::DVector;
use rand::RngExt;
use rand_distr::StandardNormal;

use path::Path;

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
#[non_exhaustive]
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
    observer: impl FnMut(Step) -> A,
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
    let crossed = settings
        .lower
        .iter()
        .zip(&settings.upper)
        .any(|(l, u)| l >= u);
    match crossed {
        true => wrong("upper", "above the lower bounds"),
        false => Ok(()),
    }
}

fn population(n: usize, settings: &Settings) -> usize {
    let usual = 4 + (3.0 * (n as f64).ln()) as usize;
    settings.population.unwrap_or(usual)
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
            let low = self
                .settings
                .lower
                .get(i)
                .copied()
                .unwrap_or(f64::NEG_INFINITY);
            let high = self.settings.upper.get(i).copied().unwrap_or(f64::INFINITY);
            v.clamp(low, high)
        };
        let inside: Vec<f64> = x.iter().enumerate().map(|(i, v)| bound(i, *v)).collect();
        let off = x
            .iter()
            .zip(&inside)
            .map(|(a, b)| ((a - b) / self.path.step).powi(2));
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
            let low = self
                .settings
                .lower
                .get(i)
                .copied()
                .unwrap_or(f64::NEG_INFINITY);
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
