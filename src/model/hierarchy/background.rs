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
/// A state this much below the background (nats) explains nothing: less than the rounding of a sum.
const NEGLIGIBLE: f64 = 40.0;

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
    pub(crate) fn new(share: f64, p: &[usize], d: &[usize]) -> Option<Self> {
        let of = |(&p, &d): (&usize, &usize)| {
            let mut covariance = vec![0.0; d * d];
            (0..d).for_each(|i| covariance[i * d + i] = WIDTH * WIDTH);
            Linear::new(p, d, vec![0.0; p * d], covariance)
        };
        let linear: Option<Vec<Linear>> = p.iter().zip(d).map(of).collect();
        (share > 0.0).then(|| linear.map(|linear| Self { share, linear }))?
    }

    /// Mixes the background into the states of group `g` at `u`: log densities become densities over a common factor,
    /// whose log is returned, and `own` says which share of each the state's own Gaussian has.
    pub(crate) fn mix(
        &self,
        g: usize,
        u: &[f64],
        residual: &mut [f64],
        densities: &mut [f64],
        own: &mut [f64],
    ) -> f64 {
        let wide = self.share.ln() + self.linear[g].log_density(u, residual);
        let rest = (-self.share).ln_1p();
        let narrow = densities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let most = wide.max(rest + narrow);
        let floor = (wide - most).exp();
        for (density, own) in densities.iter_mut().zip(own) {
            let narrow = rest + *density;
            // Most states are far from a row: no exponential for those.
            (*density, *own) = if narrow < wide - NEGLIGIBLE {
                (floor, 0.0)
            } else {
                let narrow = (narrow - most).exp();
                (narrow + floor, narrow / (narrow + floor))
            };
        }
        most
    }
}
