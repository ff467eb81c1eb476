//! A background component for every real group: rows that no state explains.
//!
//! With the share ε ([`super::Settings::background`]) the Gaussian of every state is contaminated:
//!
//! ```text
//! p(C_g | π(C_g), h) = (1 - ε) N(C_g; B_ghᵀ (1, π(C_g)), Σ_gh) + ε N(C_g; 0, 9 I)      (standardised columns)
//! ```
//!
//! The background is three deviations of the whole table wide and depends on nothing. It has no parameters to learn: a row
//! that a state explains to the share ρ enters the statistics of its regression with the weight ρ. Exactness is kept, as
//! the model stays a mixture of Gaussians. One row of an unforeseen kind then costs `log 1/ε` and a few nats instead of
//! hundreds, since regressions learned from few rows are far too sure where they extrapolate.
//!
//! Source: Tukey's contaminated normal; Banfield and Raftery 1993 (a noise component in mixtures).

use super::super::conjugate::Linear;

/// Deviation of the background, in deviations of the table's columns.
const WIDTH: f64 = 3.0;

/// The background of every group.
#[derive(Clone, Debug)]
pub(crate) struct Background {
    /// ε.
    pub share: f64,
    /// Per group, N(0, 9 I) with inputs that do not count.
    pub linear: Vec<Linear>,
}

impl Background {
    /// For groups with `p` inputs (the leading 1 among them) and `d` columns; `None` for no share.
    pub fn new(share: f64, p: &[usize], d: &[usize]) -> Option<Self> {
        let of = |(&p, &d): (&usize, &usize)| {
            let mut covariance = vec![0.0; d * d];
            (0..d).for_each(|i| covariance[i * d + i] = WIDTH * WIDTH);
            Linear::new(p, d, vec![0.0; p * d], covariance)
        };
        let linear: Option<Vec<Linear>> = p.iter().zip(d).map(of).collect();
        (share > 0.0).then(|| linear.map(|linear| Self { share, linear }))?
    }

    /// Mixes the background into log densities of group `g` at `u`, and says for each which share of it the state's own
    /// Gaussian has.
    pub fn mix(
        &self,
        g: usize,
        u: &[f64],
        residual: &mut [f64],
        logs: &mut [f64],
        own: &mut [f64],
    ) {
        let wide = self.share.ln() + self.linear[g].log_density(u, residual);
        let rest = (-self.share).ln_1p();
        for (l, own) in logs.iter_mut().zip(own) {
            let narrow = rest + *l;
            let most = narrow.max(wide);
            *l = most + ((narrow - most).exp() + (wide - most).exp()).ln();
            *own = (narrow - *l).exp();
        }
    }
}
