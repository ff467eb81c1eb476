//! Random programs of finite choices: every engine beside exact networks and enumeration.

use edifice_base::rng::{Stream, stream};
use edifice_model::network::{Evidence, Network, Variable};
use edifice_model::program::dist::categorical;
use edifice_model::program::{
    Chains, Handler, Program, compile, exact, importance, metropolis, smc,
};
use rand::RngExt;

/// A random Bayesian network as a program: some of its variables are seen, each as soon as its parents are chosen.
struct Random {
    sizes: Vec<usize>,
    parents: Vec<Vec<usize>>,
    tables: Vec<Vec<f64>>,
    seen: Vec<Option<usize>>,
}

impl Random {
    fn new(rng: &mut Stream) -> Self {
        let n = rng.random_range(3..9);
        let sizes: Vec<usize> = (0..n).map(|_| rng.random_range(2..4)).collect();
        let mut parents = Vec::new();
        let mut tables = Vec::new();
        for i in 0..n {
            let all: Vec<usize> = (0..i)
                .filter(|_| rng.random::<f64>() < 0.4)
                .take(3)
                .collect();
            let rows: usize = all.iter().map(|&p| sizes[p]).product();
            let mut table = Vec::new();
            for _ in 0..rows {
                let row: Vec<f64> = (0..sizes[i]).map(|_| 0.05 + rng.random::<f64>()).collect();
                let sum: f64 = row.iter().sum();
                table.extend(row.iter().map(|p| p / sum));
            }
            parents.push(all);
            tables.push(table);
        }
        let seen = sizes
            .iter()
            .map(|&k| (rng.random::<f64>() < 0.35).then(|| rng.random_range(0..k)));
        Self {
            seen: seen.collect(),
            sizes,
            parents,
            tables,
        }
    }

    fn names(&self) -> Vec<String> {
        (0..self.sizes.len()).map(|i| format!("x[{i}]")).collect()
    }

    fn network(&self) -> (Network, Evidence) {
        let names = self.names();
        let categories = ["0", "1", "2"];
        let variable = |i: usize| {
            let parents: Vec<&str> = self.parents[i].iter().map(|&p| names[p].as_str()).collect();
            Variable::table(
                &names[i],
                &categories[..self.sizes[i]],
                &parents,
                &self.tables[i],
            )
        };
        let network = Network::new((0..self.sizes.len()).map(variable).collect()).unwrap();
        let mut evidence = Evidence::new();
        for (i, seen) in self.seen.iter().enumerate() {
            if let Some(v) = seen {
                evidence = evidence.is(&names[i], categories[*v]);
            }
        }
        (network, evidence)
    }
}

impl Program for Random {
    type Out = ();

    fn run<H: Handler>(&self, h: &mut H) {
        let mut x: Vec<usize> = Vec::new();
        for (i, &k) in self.sizes.iter().enumerate() {
            let row = self.parents[i]
                .iter()
                .fold(0, |r, &p| r * self.sizes[p] + x[p]);
            let d = categorical::<H::Real, f64>(&self.tables[i][row * k..(row + 1) * k]);
            match self.seen[i] {
                Some(v) => {
                    h.observe(d, &v);
                    x.push(v);
                }
                None => x.push(h.sample(("x", i), d)),
            }
        }
    }
}

fn programs(count: u64) -> impl Iterator<Item = Random> {
    (0..count).map(|i| Random::new(&mut stream(38, "random programs", i)))
}

#[test]
fn enumeration_and_compilation_equal_the_network() {
    for (i, program) in programs(200).enumerate() {
        let (network, evidence) = program.network();
        let log = network.log_probability(&evidence).unwrap();
        let tried = exact(&program).unwrap();
        let compiled = compile(&program).unwrap();
        let z = tried.evidence.unwrap();
        assert!((z.log - log).abs() < 1e-10, "{i}: {z:?} is not {log}");
        assert!(
            (compiled.log_evidence().unwrap() - log).abs() < 1e-10,
            "{i}"
        );
        for (v, name) in program.names().iter().enumerate() {
            if program.seen[v].is_some() {
                continue;
            }
            let truth = network.marginal(&evidence, name).unwrap();
            let other = compiled.marginal(("x", v)).unwrap();
            for (k, p) in truth.iter().enumerate() {
                let found = tried.probability(("x", v), k as u64).mean;
                assert!(
                    (found - p).abs() < 1e-10,
                    "{i}, {name}={k}: {found} is not {p}"
                );
                assert!((other[k] - p).abs() < 1e-10, "{i}, {name}={k}");
            }
        }
    }
}

#[test]
fn evidence_is_within_three_errors_on_nearly_all() {
    let (mut near_importance, mut near_smc, mut off, mut count) = (0, 0, 0.0, 0.0);
    for (i, program) in programs(200).enumerate() {
        let (network, evidence) = program.network();
        let log = network.log_probability(&evidence).unwrap();
        let truth = exact(&program).unwrap();
        for (engine, posterior) in [
            importance(&program, 4000, i as u64).unwrap(),
            smc(&program, 4000, i as u64).unwrap(),
        ]
        .into_iter()
        .enumerate()
        {
            let z = posterior.evidence.unwrap();
            let near = (z.log - log).abs() <= 3.0 * z.error + 1e-9;
            match engine {
                0 => near_importance += usize::from(near),
                _ => near_smc += usize::from(near),
            }
            for b in posterior.beside(&truth) {
                count += 1.0;
                off += f64::from(u8::from(b.error().abs() > 3.0 * b.estimate.error + 1e-9));
            }
        }
    }
    println!(
        "importance {near_importance}, smc {near_smc} of 200; {off} of {count} probabilities off"
    );
    assert!(near_importance >= 197 && near_smc >= 197);
    // Three errors are left by 3 in 1000.
    assert!(off / count < 0.02, "{off} of {count}");
}

#[test]
fn single_changes_find_the_same_posterior() {
    let (mut off, mut count) = (0.0, 0.0);
    for (i, program) in programs(40).enumerate() {
        let truth = exact(&program).unwrap();
        let settings = Chains {
            warmup: 200,
            draws: 1000,
            seed: i as u64,
            ..Chains::default()
        };
        let posterior = metropolis(&program, &settings).unwrap();
        for b in posterior.beside(&truth) {
            count += 1.0;
            off += f64::from(u8::from(b.error().abs() > 4.0 * b.estimate.error + 1e-3));
        }
    }
    println!("{off} of {count} probabilities off by more than four errors");
    assert!(off / count < 0.01, "{off} of {count}");
}
