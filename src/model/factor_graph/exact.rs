//! Fits without chains: gradients by elimination, steps by BFGS.
//!
//! `∂L/∂w = mean_n (E_w[f | v_n] - E_w[f | inputs_n]) - λ w`, both exactly; `L` is the mean log-likelihood of the observed part of
//! the examples given their inputs, less the penalty. Without hidden variables L is concave and the fit is the maximum; with them it is
//! a local one.
//!
//! Source: Nocedal and Wright 2006, Sec. 6.1 (BFGS); Koller and Friedman 2009, Sec. 20.3.

use std::collections::BTreeMap;

use super::super::error::ModelError;
use super::{Chain, Gibbs, Question, dot};

/// Steps at most.
const STEPS: usize = 500;
/// Length of the gradient at which the fit is done.
const DONE: f64 = 1e-9;

/// Result of [`fit_exact`].
#[derive(Clone, Debug, PartialEq)]
pub struct ExactFit {
    /// One weight per feature.
    pub weights: Vec<f64>,
    /// Mean log-likelihood of an example at the weights, without the penalty, nats.
    pub log_likelihood: f64,
    /// Length of the gradient that is left.
    pub gradient: f64,
}

/// Mean log-likelihood of the examples' observed part given their inputs, nats, and its gradient by the weights, both by elimination.
///
/// One elimination for each different example, and one for each different set of inputs.
///
/// # Errors
/// [`ModelError::Empty`] without examples; [`ModelError::Parameter`] for an example of another length or with values that are not there; as
/// [`Question::marginals`].
pub fn exact_gradient(
    graph: &Gibbs,
    data: &[Vec<usize>],
    weights: &[f64],
) -> Result<(f64, Vec<f64>), ModelError> {
    if data.is_empty() {
        return Err(ModelError::Empty { what: "examples" });
    }
    for (row, state) in data.iter().enumerate() {
        let fits = state.len() == graph.sizes.len();
        if !fits || state.iter().zip(&graph.sizes).any(|(x, k)| x >= k) {
            let problem = "has values that the variables do not have";
            return Err(ModelError::parameter(format!("example {row}"), problem));
        }
    }
    let question = graph.ask(weights)?;
    let mut known: BTreeMap<Vec<Option<usize>>, f64> = BTreeMap::new();
    for state in data {
        *known.entry(graph.observed(state)).or_default() += 1.0;
        *known.entry(graph.given(state)).or_default() -= 1.0;
    }
    let (mut log, mut slope) = (0.0, vec![0.0; weights.len()]);
    for (known, count) in known {
        if let Some(state) = known.iter().copied().collect::<Option<Vec<usize>>>() {
            // Nothing is hidden: no sum is needed.
            let share = count / data.len() as f64;
            let features = graph.features(&state);
            log += share * dot(weights, &features);
            slope
                .iter_mut()
                .zip(features)
                .for_each(|(s, f)| *s += share * f);
            continue;
        }
        let question = Question {
            known,
            ..question.clone()
        };
        let share = count / data.len() as f64;
        log += share * question.log_partition()?;
        for (s, f) in slope.iter_mut().zip(question.expectations()?) {
            *s += share * f;
        }
    }
    Ok((log, slope))
}

/// The weights of largest penalised likelihood, `L(w) - penalty / 2 |w|²`, where elimination fits.
///
/// # Errors
/// As [`exact_gradient`].
///
/// # Examples
/// Two bits that are equal in 3 of 4 examples:
/// ```
/// use edifice_model::factor_graph::{Factor, Gibbs, fit_exact};
/// let equal = Factor { variables: vec![0, 1], weight: 0, feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))) };
/// let gibbs = Gibbs::new(vec![2, 2], vec![equal])?;
/// let fitted = fit_exact(&gibbs, &[vec![0, 0], vec![1, 1], vec![0, 0], vec![0, 1]], 0.0)?;
/// assert!((fitted.weights[0] - 3.0_f64.ln()).abs() < 1e-8);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit_exact(graph: &Gibbs, data: &[Vec<usize>], penalty: f64) -> Result<ExactFit, ModelError> {
    let k = graph.weights;
    // The negative of what is maximised.
    let cost = |w: &[f64]| -> Result<(f64, Vec<f64>), ModelError> {
        let (log, slope) = exact_gradient(graph, data, w)?;
        let pairs = slope.iter().zip(w);
        let slope = pairs.map(|(s, w)| penalty * w - s).collect();
        Ok((0.5 * penalty * dot(w, w) - log, slope))
    };
    // Hidden units that all have weight 0 are alike, and stay so: a small asymmetry parts them.
    let mut w: Vec<f64> = (0..k)
        .map(|i| 0.01 * (((i + 1) as f64 * 0.618_034).fract() - 0.5))
        .collect();
    let (mut now, mut slope) = cost(&w)?;
    let mut inverse: Vec<f64> = identity(k);
    for _ in 0..STEPS {
        let length = dot(&slope, &slope).sqrt();
        if length <= DONE {
            break;
        }
        let mut step: Vec<f64> = (0..k)
            .map(|i| -dot(&inverse[i * k..(i + 1) * k], &slope))
            .collect();
        let mut along = dot(&step, &slope);
        if along >= 0.0 {
            inverse = identity(k);
            step = slope.iter().map(|s| -s).collect();
            along = -length * length;
        }
        // Armijo's rule by halves.
        let mut scale = 1.0;
        let next = loop {
            let at: Vec<f64> = w.iter().zip(&step).map(|(w, s)| w + scale * s).collect();
            let (value, new_slope) = cost(&at)?;
            if value <= now + 1e-4 * scale * along {
                break Some((at, value, new_slope));
            }
            scale *= 0.5;
            if scale < 1e-12 {
                break None;
            }
        };
        let Some((at, value, new_slope)) = next else {
            break;
        };
        let s: Vec<f64> = at.iter().zip(&w).map(|(a, b)| a - b).collect();
        let y: Vec<f64> = new_slope.iter().zip(&slope).map(|(a, b)| a - b).collect();
        update(&mut inverse, &s, &y);
        (w, now, slope) = (at, value, new_slope);
    }
    let (log_likelihood, _) = exact_gradient(graph, data, &w)?;
    Ok(ExactFit {
        weights: w,
        log_likelihood,
        gradient: dot(&slope, &slope).sqrt(),
    })
}

fn identity(k: usize) -> Vec<f64> {
    (0..k * k)
        .map(|i| f64::from(u8::from(i / k == i % k)))
        .collect()
}

/// `H ← (1 - ρ s yᵀ) H (1 - ρ y sᵀ) + ρ s sᵀ`, `ρ = 1 / yᵀs`; nothing where the curvature is not positive.
fn update(inverse: &mut [f64], s: &[f64], y: &[f64]) {
    let k = s.len();
    let curvature = dot(s, y);
    if curvature <= 1e-300 {
        return;
    }
    let hy: Vec<f64> = (0..k)
        .map(|i| dot(&inverse[i * k..(i + 1) * k], y))
        .collect();
    let factor = (1.0 + dot(y, &hy) / curvature) / curvature;
    for i in 0..k {
        for j in 0..k {
            inverse[i * k + j] += factor * s[i] * s[j] - (hy[i] * s[j] + s[i] * hy[j]) / curvature;
        }
    }
}
