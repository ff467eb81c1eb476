//! Simulation-based calibration: where parameters are drawn from the prior and data from them, the rank of a parameter among draws
//! of its posterior is uniform. Source: Talts, Betancourt, Simpson, Vehtari and Gelman 2018.

use edifice_base::rng::stream;
use edifice_model::program::dist::*;
use edifice_model::program::{
    Address, Chains, Handler, Posterior, Program, ProgramError, Value, given, importance,
    metropolis, prior, smc,
};
use statrs::distribution::{ChiSquared, ContinuousCDF};

const DRAWS: usize = 31;
const BINS: usize = 8;

/// Data sets: half of those that are made where `EDIFICE_ALL_CASES` is set, as in `.ci/full`.
fn rounds() -> u64 {
    std::env::var_os("EDIFICE_ALL_CASES").map_or(200, |_| 400)
}

/// Ranks of the first choice over many rounds, and the probability of a larger chi-square.
fn calibrate<P: Program + Sync + Copy>(
    name: &'static str,
    program: P,
    engine: impl Fn(&edifice_model::program::Given<P>, u64) -> Result<Posterior<P::Out>, ProgramError>,
    data: fn(&Address) -> bool,
    target: &'static str,
) -> f64 {
    let mut counts = [0_u32; BINS];
    let rounds = rounds();
    for round in 0..rounds {
        let mut rng = stream(7, name, round);
        let (trace, _) = prior(&program, &mut rng).unwrap();
        let seen: Vec<(Address, Value)> = trace
            .choices()
            .iter()
            .filter(|c| data(&c.address))
            .map(|c| (c.address.clone(), c.value.clone()))
            .collect();
        let truth = trace.get(target).unwrap().numbers()[0];
        let posterior = engine(&given(program, seen), round).unwrap();
        let below = (0..DRAWS).filter(|_| {
            let x = posterior
                .pick(&mut rng)
                .trace
                .get(target)
                .unwrap()
                .numbers()[0];
            // Equal whole numbers are ranked by lot.
            x < truth || x == truth && rand::RngExt::random::<bool>(&mut rng)
        });
        let rank = below.count();
        counts[rank * BINS / (DRAWS + 1)] += 1;
    }
    let expected = rounds as f64 / BINS as f64;
    let square: f64 = counts
        .iter()
        .map(|&c| (f64::from(c) - expected).powi(2) / expected)
        .sum();
    let p = 1.0 - ChiSquared::new(BINS as f64 - 1.0).unwrap().cdf(square);
    println!("{name}: {counts:?}, p = {p:.3}");
    p
}

#[derive(Clone, Copy)]
struct Mean;
impl Program for Mean {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let mean = h.sample("mean", normal(0.0, 1.0));
        h.plate(5, |h, i| h.sample(("y", i), normal(mean, 1.0)));
    }
}

#[derive(Clone, Copy)]
struct Rate;
impl Program for Rate {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let rate = h.sample("rate", gamma(2.0, 1.0));
        h.plate(4, |h, i| h.sample(("y", i), poisson(rate)));
    }
}

#[derive(Clone, Copy)]
struct Walk;
impl Program for Walk {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let noise = h.sample("noise", half_normal(1.0));
        let mut at = H::Real::from(0.0);
        for i in 0..6 {
            at = h.sample(("at", i), normal(at, noise));
            h.sample(("y", i), normal(at, 0.5));
        }
    }
}

#[derive(Clone, Copy)]
struct Bias;
impl Program for Bias {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let bias = h.sample("bias", beta(2.0, 3.0));
        h.sample("y", binomial(10, bias));
    }
}

#[derive(Clone, Copy)]
struct Mixture;
impl Program for Mixture {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let share = h.sample("share", uniform(0.0, 1.0));
        for i in 0..4 {
            let second = h.sample(("second", i), bernoulli(share));
            h.sample(("y", i), normal(if second { 2.0 } else { 0.0 }, 1.0));
        }
    }
}

fn y(at: &Address) -> bool {
    at.name() == "y"
}

#[test]
fn five_programs_are_calibrated() {
    let chains = |seed| Chains {
        chains: 2,
        warmup: 300,
        draws: 300,
        seed,
    };
    let p = [
        calibrate(
            "mean by importance",
            Mean,
            |p, s| importance(p, 2000, s),
            y,
            "mean",
        ),
        calibrate(
            "rate by single changes",
            Rate,
            |p, s| metropolis(p, &chains(s)),
            y,
            "rate",
        ),
        calibrate(
            "walk by sequential Monte Carlo",
            Walk,
            |p, s| smc(p, 6400, s),
            y,
            "noise",
        ),
        calibrate(
            "bias by single changes",
            Bias,
            |p, s| metropolis(p, &chains(s)),
            y,
            "bias",
        ),
        calibrate(
            "mixture by single changes",
            Mixture,
            |p, s| metropolis(p, &chains(s)),
            y,
            "share",
        ),
    ];
    // Five tests at one in a hundred together.
    assert!(p.iter().all(|p| *p > 0.002), "{p:?}");
}
