//! A probabilistic program: eight schools (Rubin 1981), by sequential Monte Carlo and by single changes, each beside the other.
//! `cargo run --release --example model_eight_schools --no-default-features`

use edifice::model::program::dist::{half_cauchy, normal};
use edifice::model::program::{Chains, Handler, Program, ProgramError, Real, metropolis, smc};

/// Effects of coaching, and their standard errors.
const EFFECTS: [(f64, f64); 8] = [
    (28.0, 15.0),
    (8.0, 10.0),
    (-3.0, 16.0),
    (7.0, 11.0),
    (-1.0, 9.0),
    (1.0, 11.0),
    (18.0, 10.0),
    (12.0, 18.0),
];

struct Schools;

impl Program for Schools {
    /// The effect in the first school.
    type Out = f64;

    fn run<H: Handler>(&self, h: &mut H) -> f64 {
        let mean = h.sample("mean", normal(0.0, 5.0));
        let spread = h.sample("spread", half_cauchy(5.0));
        let effects = h.plate(EFFECTS.len(), |h, i| {
            let effect = mean + spread * h.sample(("own", i), normal(0.0, 1.0));
            h.observe(normal(effect, EFFECTS[i].1), &EFFECTS[i].0.into());
            effect
        });
        effects[0].value()
    }
}

fn main() -> Result<(), ProgramError> {
    let weighted = smc(&Schools, 20_000, 1)?;
    if let Some(z) = weighted.evidence {
        println!("log evidence {:.2} +- {:.2}", z.log, z.error);
    }
    let settings = Chains {
        draws: 4000,
        ..Chains::default()
    };
    let chains = metropolis(&Schools, &settings)?;
    for s in chains.summary().iter().take(2) {
        println!(
            "{}: {:.2} +- {:.2}, deviation {:.2}, bulk {:.0} and tail {:.0} of 16000 draws, R-hat {:.3}",
            s.name, s.mean, s.mcse, s.sd, s.ess_bulk, s.ess_tail, s.r_hat
        );
    }
    let (a, b) = (weighted.estimate(|d| d.out), chains.estimate(|d| d.out));
    println!(
        "first school: {:.2} +- {:.2} and {:.2} +- {:.2}",
        a.mean, a.error, b.mean, b.error
    );
    assert!((a.mean - b.mean).abs() < 5.0 * a.error.hypot(b.error));
    Ok(())
}
