//! Expectation-maximization towards the maximum a posteriori, once for every model.
//!
//! With observations O, hidden values Z and parameters Θ, each round replaces Θ by
//! `argmax E[log P(O, Z | Θ') | O, Θ] + log P(Θ')`, which never lowers
//! `log P(O | Θ) + log P(Θ)`. The E step yields expected sufficient statistics, the M step turns
//! them into parameters; both are a model's own, the loop is here.
//!
//! Source: Fan and Wonka 2016, Sec. 5.3, *Parameter learning*: iterate until no parameter changes
//! by more than 1e-6.

use super::error::ModelError;

/// A model that can be learned by EM from data it holds.
///
/// `expect` is called once a round on the whole data, `maximize` on its result, whose size should not depend on the
/// number of rows. The steps are given in the [module](self); `log_prior` may leave out a constant.
/// Sources: Dempster, Laird and Rubin 1977; Fan and Wonka 2016, Sec. 5.3.
///
/// # Examples
/// The share w of the first of two known densities, from their values at each row; the likelihood
/// `(1 + 2w) (2 - w)` has its maximum at 3/4:
/// ```
/// use edifice_model::ModelError;
/// use edifice_model::em::{Em, Outcome, Stopping, run};
/// struct Share(Vec<[f64; 2]>);
/// impl Em for Share {
///     type Model = f64;
///     type Stats = f64;
///     fn expect(&self, share: &f64) -> Result<(f64, f64), ModelError> {
///         let (mut rows, mut log_likelihood) = (0.0, 0.0);
///         for [p, q] in &self.0 {
///             let density = share * p + (1.0 - share) * q;
///             rows += share * p / density;
///             log_likelihood += density.ln();
///         }
///         Ok((rows, log_likelihood))
///     }
///     fn maximize(&self, rows: &f64) -> Result<f64, ModelError> { Ok(rows / self.0.len() as f64) }
///     fn log_prior(&self, _: &f64) -> f64 { 0.0 }
///     fn movement(&self, before: &f64, after: &f64) -> f64 { (after - before).abs() }
/// }
/// let fit = run(&Share(vec![[3.0, 1.0], [1.0, 2.0]]), 0.5, &Stopping::default())?;
/// assert!((fit.model - 0.75).abs() < 1e-4);
/// assert!((fit.log_likelihood - 3.125_f64.ln()).abs() < 1e-6);
/// assert_eq!(fit.outcome, Outcome::Converged);
/// assert!(fit.trace.is_sorted());
/// # Ok::<(), ModelError>(())
/// ```
pub trait Em {
    /// Parameters Θ.
    type Model: Clone;
    /// Expected sufficient statistics of the complete data.
    type Stats;

    /// E step: expected sufficient statistics under `model`, and `log P(O | Θ)`.
    ///
    /// # Errors
    /// Parameters that the data contradict; [`ModelError::Interrupted`] where the model was told to end within the step: a run then ends
    /// with what it has.
    fn expect(&self, model: &Self::Model) -> Result<(Self::Stats, f64), ModelError>;

    /// M step: the parameters of highest expected complete-data log posterior.
    ///
    /// # Errors
    /// Statistics that determine no parameters, such as a singular covariance without a prior.
    fn maximize(&self, stats: &Self::Stats) -> Result<Self::Model, ModelError>;

    /// `log P(Θ)`; 0 for maximum likelihood.
    fn log_prior(&self, model: &Self::Model) -> f64;

    /// The largest absolute change of any parameter between two models.
    fn movement(&self, before: &Self::Model, after: &Self::Model) -> f64;
}

/// When to stop a [`run`]: the first of three conditions that holds. Movements have the unit of the parameters, gains are
/// nats of the whole data. The example of [`Em`] uses the default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopping {
    /// Stop when no parameter moves by more than this (paper: 1e-6).
    pub movement: f64,
    /// Stop as well when a round gains less log posterior than this (0: never for this reason).
    pub gain: f64,
    /// Most rounds.
    pub max_rounds: usize,
}

impl Default for Stopping {
    fn default() -> Self {
        Self {
            movement: 1e-6,
            gain: 0.0,
            max_rounds: 2000,
        }
    }
}

/// Why a [`run`] ended, in [`Fit::outcome`]; none is an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// No parameter moved by more than the tolerance.
    Converged,
    /// A round gained less than [`Stopping::gain`].
    SmallGain,
    /// The log posterior could not rise any more in floating point.
    Stalled,
    /// [`Stopping::max_rounds`] were run.
    MaxRounds,
    /// The caller of [`run_while`] ended it; the parameters are those of the last round.
    Interrupted,
}

/// Result of EM, of [`run`], [`run_while`] and [`restarts`]; the example of [`Em`] reads one. A maximum found is a local one.
#[derive(Clone, Debug)]
pub struct Fit<M> {
    /// The parameters.
    pub model: M,
    /// `log P(O | Θ)`, nats.
    pub log_likelihood: f64,
    /// `log P(O | Θ) + log P(Θ)`, nats.
    pub log_posterior: f64,
    /// Log posterior before each round and after the last; never falls.
    pub trace: Vec<f64>,
    /// Why the run ended.
    pub outcome: Outcome,
}

/// Runs EM from `start`.
///
/// R rounds take R + 1 E steps and R M steps, and the memory of two models and their statistics. Convergence is linear, the
/// slower the more of the information is hidden (Dempster, Laird and Rubin 1977). [`Em`] has an example.
///
/// # Errors
/// Those of [`Em::expect`] and [`Em::maximize`].
pub fn run<E: Em>(
    em: &E,
    start: E::Model,
    stopping: &Stopping,
) -> Result<Fit<E::Model>, ModelError> {
    run_while(em, start, stopping, &|| true)
}

/// Runs EM from `start` as long as `goes_on`, which is asked before every step.
///
/// For limits of time, and for users who cancel: what has been reached is kept, with [`Outcome::Interrupted`].
///
/// # Errors
/// As [`run`].
pub fn run_while<E: Em>(
    em: &E,
    start: E::Model,
    stopping: &Stopping,
    goes_on: &dyn Fn() -> bool,
) -> Result<Fit<E::Model>, ModelError> {
    Ok(run_kept(em, start, stopping, goes_on)?.0)
}

/// As [`run_while`], and the statistics at the parameters found.
pub(crate) fn run_kept<E: Em>(
    em: &E,
    start: E::Model,
    stopping: &Stopping,
    goes_on: &dyn Fn() -> bool,
) -> Result<(Fit<E::Model>, E::Stats), ModelError> {
    let (mut stats, mut log_likelihood) = em.expect(&start)?;
    let mut model = start;
    let mut log_posterior = log_likelihood + em.log_prior(&model);
    let mut trace = vec![log_posterior];
    let mut outcome = Outcome::MaxRounds;
    for _ in 0..stopping.max_rounds {
        if !goes_on() {
            outcome = Outcome::Interrupted;
            break;
        }
        let next = em.maximize(&stats)?;
        if !goes_on() {
            outcome = Outcome::Interrupted;
            break;
        }
        let (next_stats, next_likelihood) = match em.expect(&next) {
            Err(ModelError::Interrupted) => {
                outcome = Outcome::Interrupted;
                break;
            }
            other => other?,
        };
        let next_posterior = next_likelihood + em.log_prior(&next);
        let gain = next_posterior - log_posterior;
        if gain.is_nan() || gain < 0.0 {
            outcome = Outcome::Stalled;
            break;
        }
        let movement = em.movement(&model, &next);
        (model, stats) = (next, next_stats);
        (log_likelihood, log_posterior) = (next_likelihood, next_posterior);
        trace.push(log_posterior);
        if movement <= stopping.movement {
            outcome = Outcome::Converged;
            break;
        }
        if gain < stopping.gain {
            outcome = Outcome::SmallGain;
            break;
        }
    }
    let fit = Fit {
        model,
        log_likelihood,
        log_posterior,
        trace,
        outcome,
    };
    Ok((fit, stats))
}

/// Runs EM from every start and keeps the first of highest log posterior.
///
/// Starts run one after the other, so that a lazy iterator has one start in memory at a time. The cost is the sum of
/// the runs'. [`gmm::fit`](super::gmm::fit) uses it, with k-means++ starts.
///
/// # Errors
/// [`ModelError::Empty`] without starts; the first error of a run.
pub fn restarts<E: Em>(
    em: &E,
    starts: impl IntoIterator<Item = E::Model>,
    stopping: &Stopping,
) -> Result<Fit<E::Model>, ModelError> {
    let mut best: Option<Fit<E::Model>> = None;
    for start in starts {
        let fit = run(em, start, stopping)?;
        if best
            .as_ref()
            .is_none_or(|b| fit.log_posterior > b.log_posterior)
        {
            best = Some(fit);
        }
    }
    best.ok_or(ModelError::Empty { what: "starts" })
}

#[cfg(test)]
mod tests {
    use super::{Em, Outcome, Stopping, run};
    use crate::ModelError;

    /// Log posteriors that a list gives, one round after the other: the model is the place in the list.
    struct Listed(&'static [f64]);

    impl Em for Listed {
        type Model = usize;
        type Stats = usize;

        fn expect(&self, model: &usize) -> Result<(usize, f64), ModelError> {
            Ok((*model, self.0[*model]))
        }

        fn maximize(&self, stats: &usize) -> Result<usize, ModelError> {
            Ok((stats + 1).min(self.0.len() - 1))
        }

        fn log_prior(&self, _: &usize) -> f64 {
            0.0
        }

        fn movement(&self, before: &usize, after: &usize) -> f64 {
            before.abs_diff(*after) as f64
        }
    }

    #[test]
    fn rounds_that_lose_are_undone_and_rounds_that_gain_nothing_are_not() {
        let stopping = Stopping {
            movement: 0.5,
            ..Stopping::default()
        };
        for (listed, outcome, reached) in [
            // The last model moves no more.
            (&[-3.0, -2.0, -1.0][..], Outcome::Converged, 2),
            (&[-3.0, -2.0, -2.0, -1.0], Outcome::Converged, 3),
            (&[-3.0, -3.0], Outcome::Converged, 1),
            // A round that loses, and one of which nothing is known.
            (&[-3.0, -2.0, -2.5, -1.0], Outcome::Stalled, 1),
            (&[-3.0, -2.0, f64::NAN, -1.0], Outcome::Stalled, 1),
        ] {
            let fit = run(&Listed(listed), 0, &stopping).unwrap();
            assert_eq!((fit.outcome, fit.model), (outcome, reached), "{listed:?}");
            assert_eq!(fit.log_posterior, listed[reached]);
        }
    }

    #[test]
    fn rounds_end_at_their_number_or_at_a_small_gain() {
        let listed = Listed(&[-9.0, -5.0, -4.0, -3.5, -3.4, -3.3]);
        let ended = |gain: f64, max_rounds: usize| {
            let stopping = Stopping {
                movement: 0.5,
                gain,
                max_rounds,
            };
            let fit = run(&listed, 0, &stopping).unwrap();
            (fit.outcome, fit.model)
        };
        assert_eq!(ended(0.0, 3), (Outcome::MaxRounds, 3));
        assert_eq!(ended(0.7, 100), (Outcome::SmallGain, 3));
        assert_eq!(ended(0.2, 100), (Outcome::SmallGain, 4));
        assert_eq!(ended(0.0, 100), (Outcome::Converged, 5));
    }
}
