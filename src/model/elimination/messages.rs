//! Loopy belief propagation: sum-product messages between factors and variables.
//!
//! The message of a factor f to its variable v is `m(x_v) = Σ f(x) Π_u Π_g m_(g→u)(x_u)` over the other variables u of f and the
//! other factors g of u. Exact where the factors form a tree. Source: Koller and Friedman 2009, Sec. 11.3.

use super::super::linalg::log_sum_exp;
use super::{Factor, advance};

/// Messages from factors to variables, logarithms that sum to probability 1.
pub(crate) struct Messages<'a> {
    factors: &'a [Factor],
    sizes: &'a [usize],
    /// Per factor and place in its scope.
    to: Vec<Vec<Vec<f64>>>,
    /// Per variable, the factors and places that speak to it.
    around: Vec<Vec<(usize, usize)>>,
}

impl<'a> Messages<'a> {
    pub(crate) fn new(factors: &'a [Factor], sizes: &'a [usize]) -> Self {
        let mut around = vec![Vec::new(); sizes.len()];
        let mut to = Vec::with_capacity(factors.len());
        for (f, factor) in factors.iter().enumerate() {
            for (place, &v) in factor.vars.iter().enumerate() {
                around[v].push((f, place));
            }
            let vars = factor.vars.iter();
            to.push(
                vars.map(|&v| vec![-(sizes[v] as f64).ln(); sizes[v]])
                    .collect(),
            );
        }
        Self {
            factors,
            sizes,
            to,
            around,
        }
    }

    /// True if no factor speaks to a variable.
    pub(crate) fn is_free(&self, v: usize) -> bool {
        self.around[v].is_empty()
    }

    /// The product of the messages of all factors but one to a variable, as logarithms.
    fn without(&self, v: usize, factor: usize) -> Vec<f64> {
        let mut sum = vec![0.0; self.sizes[v]];
        for &(f, place) in self.around[v].iter().filter(|(f, _)| *f != factor) {
            sum.iter_mut()
                .zip(&self.to[f][place])
                .for_each(|(s, m)| *s += m);
        }
        sum
    }

    /// Sends every message anew; the largest change of a probability.
    pub(crate) fn round(&mut self) -> f64 {
        let mut moved: f64 = 0.0;
        for (f, factor) in self.factors.iter().enumerate() {
            let vars = &factor.vars;
            let heard: Vec<Vec<f64>> = vars.iter().map(|&v| self.without(v, f)).collect();
            let mut said: Vec<Vec<Vec<f64>>> = vars
                .iter()
                .map(|&v| vec![Vec::new(); self.sizes[v]])
                .collect();
            let mut assignment = vec![0; self.sizes.len()];
            for value in &factor.values {
                let all: Vec<f64> = (vars.iter().zip(&heard))
                    .map(|(&v, h)| h[assignment[v]])
                    .collect();
                for (place, &v) in vars.iter().enumerate() {
                    let others = all.iter().enumerate().filter(|(p, _)| *p != place);
                    let sum = value + others.map(|(_, h)| h).sum::<f64>();
                    said[place][assignment[v]].push(sum);
                }
                advance(vars, self.sizes, &mut assignment);
            }
            for (place, terms) in said.into_iter().enumerate() {
                let logs: Vec<f64> = terms.iter().map(|t| log_sum_exp(t)).collect();
                let old = &mut self.to[f][place];
                let damped: Vec<f64> = old.iter().zip(&logs).map(|(o, n)| 0.5 * (o + n)).collect();
                let total = log_sum_exp(&damped);
                for (o, d) in old.iter_mut().zip(damped) {
                    let new = if total == f64::NEG_INFINITY {
                        total
                    } else {
                        d - total
                    };
                    moved = moved.max((new.exp() - o.exp()).abs());
                    *o = new;
                }
            }
        }
        moved
    }

    /// The belief of a variable; `None` when nothing is possible.
    pub(crate) fn belief(&self, v: usize) -> Option<Vec<f64>> {
        let sum = self.without(v, usize::MAX);
        let total = log_sum_exp(&sum);
        (total > f64::NEG_INFINITY).then(|| sum.iter().map(|s| (s - total).exp()).collect())
    }

    /// Bethe's approximation of `log Σ Π f`: `Σ_f log Z_f - Σ_v (d_v - 1) log Z_v` by the messages as they are, with `Z_f` the sum of f times what
    /// its variables hear from elsewhere and `Z_v` of what they hear from all, messages normalised; exact on trees.
    pub(crate) fn log_partition(&self) -> f64 {
        let mut total = 0.0;
        // Σ_v log Z_v + Σ_f log Z_f - Σ_(f, v) log Z_fv, Z_fv of the products of both messages.
        for v in (0..self.sizes.len()).filter(|&v| !self.is_free(v)) {
            total += log_sum_exp(&self.without(v, usize::MAX));
        }
        for (f, factor) in self.factors.iter().enumerate() {
            let vars = &factor.vars;
            let heard: Vec<Vec<f64>> = vars.iter().map(|&v| normal(self.without(v, f))).collect();
            let mut assignment = vec![0; self.sizes.len()];
            let mut terms = Vec::with_capacity(factor.values.len());
            for value in &factor.values {
                let all = vars.iter().zip(&heard).map(|(&v, h)| h[assignment[v]]);
                terms.push(value + all.sum::<f64>());
                advance(vars, self.sizes, &mut assignment);
            }
            total += log_sum_exp(&terms);
            for (place, h) in heard.iter().enumerate() {
                let both: Vec<f64> = h
                    .iter()
                    .zip(&self.to[f][place])
                    .map(|(a, b)| a + b)
                    .collect();
                total -= log_sum_exp(&both);
            }
        }
        total
    }
}

/// The same with a sum of 1.
fn normal(mut logs: Vec<f64>) -> Vec<f64> {
    let total = log_sum_exp(&logs);
    logs.iter_mut().for_each(|l| *l -= total);
    logs
}

#[cfg(test)]
mod tests {
    use super::{Factor, Messages};
    use edifice_base::rng::{Stream, stream};
    use rand::RngExt;

    /// Factors of a random tree over all variables: of each with an earlier one, and of some alone. None is normalised.
    fn tree(sizes: &[usize], rng: &mut Stream) -> Vec<Factor> {
        let mut factors = Vec::new();
        for v in 0..sizes.len() {
            let mut scopes = Vec::new();
            if v > 0 {
                let earlier = rng.random_range(0..v);
                scopes.push(match rng.random::<bool>() {
                    true => vec![v, earlier],
                    false => vec![earlier, v],
                });
            }
            if rng.random::<bool>() {
                scopes.push(vec![v]);
            }
            for vars in scopes {
                let cells: usize = vars.iter().map(|&v| sizes[v]).product();
                let values = (0..cells).map(|_| rng.random_range(-3.0..4.0));
                factors.push(Factor::new(vars, values.collect()));
            }
        }
        factors
    }

    /// The sum of the products of all factors, and its parts by the value of each variable.
    fn enumerated(factors: &[Factor], sizes: &[usize]) -> (f64, Vec<Vec<f64>>) {
        let mut total = 0.0;
        let mut parts: Vec<Vec<f64>> = sizes.iter().map(|&k| vec![0.0; k]).collect();
        for number in 0..sizes.iter().product() {
            let mut rest: usize = number;
            let digits = sizes.iter().map(|k| {
                let digit = rest % k;
                rest /= k;
                digit
            });
            let x: Vec<usize> = digits.collect();
            let value = |f: &Factor| match f.vars[..] {
                [v] => f.values[x[v]],
                [v, w] => f.values[x[v] * sizes[w] + x[w]],
                _ => panic!("{f:?} is of no variable or of many"),
            };
            let product = factors.iter().map(value).sum::<f64>().exp();
            total += product;
            for (part, &value) in parts.iter_mut().zip(&x) {
                part[value] += product;
            }
        }
        (total, parts)
    }

    #[test]
    fn on_trees_beliefs_and_the_partition_function_are_those_of_enumeration() {
        let mut rng = stream(1, "trees", 0);
        for case in 0..100 {
            let n = rng.random_range(2..=6);
            let sizes: Vec<usize> = (0..n).map(|_| rng.random_range(1..=3)).collect();
            let factors = tree(&sizes, &mut rng);
            let mut messages = Messages::new(&factors, &sizes);
            let moved = (0..200).map(|_| messages.round()).last().unwrap();
            assert!(moved < 1e-12, "{case}: {moved}");
            let (total, parts) = enumerated(&factors, &sizes);
            let found = messages.log_partition();
            assert!(
                (found - total.ln()).abs() < 1e-9,
                "{case}: {found} is not {}",
                total.ln()
            );
            for (v, parts) in parts.iter().enumerate() {
                assert!(!messages.is_free(v));
                let belief = messages.belief(v).unwrap();
                for (b, p) in belief.iter().zip(parts) {
                    assert!((b - p / total).abs() < 1e-9, "{case}: {b} of {v}");
                }
            }
        }
    }
}
