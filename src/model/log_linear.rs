//! Log-linear models `p(x; w) ∝ exp(wᵀ f(x))` whose negative sampler the user supplies.
//!
//! [`LogLinear`] makes a [`Chain`] of two closures: the features f, and a sampler that changes a state. It is
//! fitted by [`fit`], the code that also learns factor graphs of
//! discrete variables. The sampler decides what is learned:
//!
//! - one that leaves `p(x; w)` invariant, for instance by resampling a part of the state given the rest, makes
//!   the update unbiased as its moves grow or, persistent, as the step shrinks;
//! - another one (for instance the best of some candidates) makes it a heuristic.
//!
//! [`Settings::newton`] makes the update one that is as good for correlated features.
//!
//! [`LogLinear::fit`] divides each feature by its standard deviation over the data before the ascent, so that one
//! rate serves for all and the weights do not depend on the features' units.

use super::ModelError;
use super::factor_graph::{Chain, Fitted, Settings, fit};
use edifice_base::Watch;
use edifice_base::rng::Stream;

/// A model by its features and its negative sampler.
///
/// `p(x; w) ∝ exp(wᵀ f(x))`: f gives as many values as there are weights, the sampler changes a state under given weights, in the
/// features' own units. [`LogLinear::fit`] costs what [`fit`] does, and one more evaluation of the features per example.
///
/// # Examples
/// A bit that is 1 in 3 of 4 examples, its feature in some unit: the weight is the log odds over the unit.
/// ```
/// use edifice_model::factor_graph::Settings;
/// use edifice_model::log_linear::LogLinear;
/// use edifice_base::rng::Stream;
/// use edifice_base::unwatched;
/// use rand::RngExt;
/// let model = LogLinear::new(
///     1,
///     |x: &bool| vec![if *x { 100.0 } else { 0.0 }],
///     |x: &mut bool, weights: &[f64], rng: &mut Stream| *x = rng.random::<f64>() < 1.0 / (1.0 + (-100.0 * weights[0]).exp()),
/// );
/// let data = [true, true, true, false].repeat(250);
/// let fitted = model.fit(&data, &Settings::default(), 1, &unwatched)?;
/// assert!((100.0 * fitted.weights[0] - 3.0_f64.ln()).abs() < 0.1);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub struct LogLinear<X, F, S> {
    weights: usize,
    scales: Vec<f64>,
    least: f64,
    features: F,
    sampler: S,
    state: std::marker::PhantomData<fn() -> X>,
}

impl<X, F, S> LogLinear<X, F, S>
where
    X: Clone + Send + Sync,
    F: Fn(&X) -> Vec<f64> + Sync,
    S: Fn(&mut X, &[f64], &mut Stream) + Sync,
{
    /// A model from its number of weights, its features and its sampler, which gets a state and the weights.
    pub fn new(weights: usize, features: F, sampler: S) -> Self {
        Self {
            weights,
            scales: vec![1.0; weights],
            least: f64::NEG_INFINITY,
            features,
            sampler,
            state: std::marker::PhantomData,
        }
    }

    /// The same with no weight below `least`, which is at most 0, in the features' own units.
    #[must_use]
    pub fn at_least(mut self, least: f64) -> Self {
        self.least = least;
        self
    }

    /// Learns the weights from examples; see the module's page.
    ///
    /// # Errors
    /// As [`fit`].
    pub fn fit(
        mut self,
        data: &[X],
        settings: &Settings,
        seed: u64,
        watch: &Watch,
    ) -> Result<Fitted, ModelError> {
        let all: Vec<Vec<f64>> = data.iter().map(&self.features).collect();
        for (i, scale) in self.scales.iter_mut().enumerate() {
            let (_, deviation) = super::density::moments(all.iter().map(|f| f[i]));
            // A feature that never varies says nothing of its weight; its scale is arbitrary.
            *scale = if deviation > 0.0 { deviation } else { 1.0 };
        }
        let scaled = fit(&self, data, settings, seed, watch)?;
        let gap = scaled.gap.iter().zip(&self.scales).map(|(g, s)| g * s);
        Ok(Fitted {
            gap: gap.collect(),
            weights: self.unscaled(&scaled.weights),
            standard_errors: self.unscaled(&scaled.standard_errors),
            ..scaled
        })
    }

    fn unscaled(&self, weights: &[f64]) -> Vec<f64> {
        let pairs = weights.iter().zip(&self.scales);
        pairs.map(|(w, s)| w / s).collect()
    }
}

impl<X, F, S> Chain for LogLinear<X, F, S>
where
    X: Clone + Send + Sync,
    F: Fn(&X) -> Vec<f64> + Sync,
    S: Fn(&mut X, &[f64], &mut Stream) + Sync,
{
    type State = X;

    fn weights(&self) -> usize {
        self.weights
    }
    fn features(&self, state: &X) -> Vec<f64> {
        let features = (self.features)(state);
        features
            .iter()
            .zip(&self.scales)
            .map(|(f, s)| f / s)
            .collect()
    }
    fn step(&self, state: &mut X, weights: &[f64], rng: &mut Stream) {
        (self.sampler)(state, &self.unscaled(weights), rng);
    }
    fn least(&self, k: usize) -> f64 {
        self.least * self.scales[k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::unwatched;
    use rand::RngExt;

    /// Two bits that exclude each other: with no weight below 0 that of the pair is 0, and the others are those of bits alone.
    #[test]
    fn weights_stay_above_their_least_value() {
        let features = |x: &[bool; 2]| {
            let own = |x: bool| f64::from(u8::from(x));
            vec![own(x[0]), own(x[1]), 100.0 * own(x[0] && x[1])]
        };
        let sampler = move |x: &mut [bool; 2], weights: &[f64], rng: &mut Stream| {
            for i in 0..2 {
                let [off, on] = [false, true].map(|value| {
                    x[i] = value;
                    features(x)
                        .iter()
                        .zip(weights)
                        .map(|(f, w)| f * w)
                        .sum::<f64>()
                });
                x[i] = rng.random::<f64>() < 1.0 / (1.0 + (off - on).exp());
            }
        };
        let states = [
            (80, [true, false]),
            (80, [false, true]),
            (40, [true, true]),
            (10, [false, false]),
        ];
        let data: Vec<[bool; 2]> = states.iter().flat_map(|(n, x)| vec![*x; 20 * n]).collect();
        let fitted = |newton, least: f64| {
            let settings = Settings {
                newton,
                moves: 3,
                ..Settings::default()
            };
            let model = LogLinear::new(3, features, sampler).at_least(least);
            model.fit(&data, &settings, 1, &unwatched).unwrap().weights
        };
        for newton in [true, false] {
            let weights = fitted(newton, 0.0);
            assert!((0.0..1e-6).contains(&weights[2]), "{newton} {weights:?}");
        }
        // Of 210, 120 have each bit alone; with the pair the log odds are those where the other is off.
        let (alone, beside) = ((120.0_f64 / 90.0).ln(), (80.0_f64 / 10.0).ln());
        let (weights, free) = (fitted(true, 0.0), fitted(true, -100.0));
        for k in 0..2 {
            assert!((weights[k] - alone).abs() < 0.1, "{weights:?}");
            assert!((free[k] - beside).abs() < 0.2, "{free:?}");
        }
        // The unit of its feature is a hundredth.
        let pair = (40.0_f64 * 10.0 / (80.0 * 80.0)).ln();
        assert!((100.0 * free[2] - pair).abs() < 0.2, "{free:?}");
    }
}
