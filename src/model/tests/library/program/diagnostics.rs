//! Diagnostics of chains against numbers that ArviZ 0.23.4 printed for the same chains.

use edifice_model::program::diagnostics::{
    ess_bulk, ess_mean, ess_tail, mcse_mean, mcse_sd, r_hat,
};
use edifice_model::program::dist::normal;
use edifice_model::program::{Chains, Handler, Program, Real, metropolis, pareto_k};

/// Autoregressive chains from a linear congruential generator, the same numbers in any language.
fn chains(count: usize, draws: usize, rho: f64, drift: f64) -> Vec<Vec<f64>> {
    let mut state: u64 = 12345;
    let mut all = Vec::new();
    for c in 0..count {
        let mut y = 0.0;
        let mut row = Vec::new();
        for _ in 0..draws {
            state = (state * 1_103_515_245 + 12345) % 2_147_483_648;
            let u = state as f64 / 2_147_483_648.0;
            y = rho * y + (u - 0.5);
            row.push(y + drift * c as f64);
        }
        all.push(row);
    }
    all
}

fn check(name: &str, chains: &[Vec<f64>], expected: [f64; 6]) {
    let found = [
        r_hat(chains),
        ess_bulk(chains),
        ess_tail(chains),
        ess_mean(chains),
        mcse_mean(chains),
        mcse_sd(chains),
    ];
    for (i, (f, e)) in found.iter().zip(expected).enumerate() {
        let same = f.is_nan() && e.is_nan() || (f - e).abs() <= 1e-6 * e.abs().max(1.0);
        assert!(same, "{name}, number {i}: {f} is not {e}");
    }
}

#[test]
fn equal_those_of_arviz() {
    check(
        "positively correlated",
        &chains(4, 500, 0.7, 0.0),
        [
            1.0073380872544824,
            407.12614867194486,
            777.0405948835746,
            409.25128700733205,
            0.01885051749210925,
            0.008771540903934364,
        ],
    );
    check(
        "negatively correlated, odd, drifting apart",
        &chains(4, 501, -0.5, 0.05),
        [
            1.016767153612364,
            205.91700037009878,
            1281.1538396244257,
            275.2379375769523,
            0.02075834701222781,
            0.005308216419878328,
        ],
    );
    check(
        "nearly a random walk",
        &chains(2, 1000, 0.99, 0.0),
        [
            1.0555223906589468,
            19.524779622228003,
            60.73012424430608,
            19.345053666639355,
            0.34009880131320924,
            0.13864729103919265,
        ],
    );
    check(
        "apart",
        &chains(3, 100, 0.0, 0.3),
        [
            1.3512575182262712,
            7.924968260040429,
            31.80028780786345,
            7.7204519682921635,
            0.13742129063293308,
            0.016666217871634886,
        ],
    );
    check(
        "one chain",
        &chains(1, 400, 0.3, 0.0),
        [
            f64::NAN,
            182.5143289394168,
            255.73831688386733,
            192.57505051285312,
            0.021669086690462865,
            0.008023228635776852,
        ],
    );
    let mut tied = chains(4, 300, 0.5, 0.0);
    for x in tied.iter_mut().flatten() {
        *x = (*x * 4.0).round_ties_even() / 4.0;
    }
    check(
        "ties",
        &tied,
        [
            1.000038446637306,
            417.7366913763148,
            617.3939971364265,
            422.4163147986144,
            0.016222121511078037,
            0.0068514179258244885,
        ],
    );
}

#[test]
fn paretos_k_equals_that_of_arviz() {
    let base = chains(1, 2000, 0.0, 0.0).remove(0);
    for (scale, expected) in [
        (0.5, 0.45477782971378283),
        (1.5, 1.3132363102623599),
        (3.0, 2.6364147311265067),
    ] {
        let logs: Vec<f64> = base
            .iter()
            .map(|x| -scale * (x + 0.5 + 1e-6_f64).ln())
            .collect();
        let k = pareto_k(&logs);
        assert!(
            (k - expected).abs() < 1e-6,
            "{scale}: {k} is not {expected}"
        );
    }
}

/// A number near to an observation.
struct Near;

impl Program for Near {
    type Out = f64;

    fn run<H: Handler>(&self, h: &mut H) -> f64 {
        let x = h.sample("x", normal(0.0, 1.0));
        h.observe(normal(x, 0.3), &0.5.into());
        x.value()
    }
}

#[test]
fn errors_of_chains_are_those_of_the_chains_apart() {
    let settings = Chains {
        chains: 3,
        draws: 200,
        warmup: 0,
        seed: 4,
    };
    let posterior = metropolis(&Near, &settings).unwrap();
    let all: Vec<f64> = posterior.draws.iter().map(|d| d.out).collect();
    let chains: Vec<Vec<f64>> = all.chunks(200).map(<[f64]>::to_vec).collect();
    assert_eq!(chains.len(), 3);
    let error = posterior.estimate(|d| d.out).error;
    assert_eq!(error, mcse_mean(&chains));
    // As one chain they would seem to say something else.
    assert!((error / mcse_mean(&[all]) - 1.0).abs() > 1e-3);
    let summary = &posterior.summary()[0];
    assert_eq!((summary.mcse, summary.r_hat), (error, r_hat(&chains)));
}
