//! Inference of facade grammars against the exact search for the smallest grammar, on random small layouts:
//! `cargo run --release --example exact_search -- [COUNT] [SEED] [TILES]`.

use std::collections::BTreeMap;
use std::process::ExitCode;

use edifice_smallest_grammar::Limits;
use edifice_smallest_grammar::compare::{Case, Comparison};

const LIMITS: Limits = Limits {
    types: 1_000,
    steps: 200_000,
    bounds: 2_000,
};
const ITERATIONS: u64 = 2_000;

/// Counts of one kind of case.
#[derive(Default)]
struct Tally {
    cases: usize,
    exact: usize,
    proven: usize,
    optimal: usize,
    false_proofs: usize,
}

impl Tally {
    fn add(&mut self, found: &Comparison) {
        self.cases += 1;
        self.exact += usize::from(found.exact.is_some());
        self.proven += usize::from(found.proven());
        self.optimal += usize::from(found.optimal());
        self.false_proofs += usize::from(found.fault().is_some());
    }
}

fn main() -> ExitCode {
    let numbers: Result<Vec<u64>, _> = std::env::args().skip(1).map(|s| s.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("usage: exact_search [COUNT] [SEED] [TILES]");
        return ExitCode::from(2);
    };
    let number = |i: usize, default: u64| numbers.get(i).copied().unwrap_or(default);
    let (count, seed, tiles) = (number(0, 1_000), number(1, 0), number(2, 16));
    let mut tallies: BTreeMap<(String, String), Tally> = BTreeMap::new();
    let mut seconds = [0.0; 3];
    for index in 0..count {
        let case = Case::random(seed, index, tiles as usize);
        let found = case.compare(ITERATIONS, &LIMITS);
        if let Some(fault) = found.fault() {
            println!("{index}: {fault}: {case}");
        }
        for (sum, s) in seconds.iter_mut().zip(found.seconds) {
            *sum += s;
        }
        for (kind, value) in [
            ("operations", case.operations.to_string()),
            ("costs", case.prices.to_owned()),
            ("facades", case.facades.len().to_string()),
            ("all", String::new()),
        ] {
            let tally = tallies.entry((kind.to_owned(), value)).or_default();
            tally.add(&found);
        }
    }
    println!(
        "{:<56} {:>7} {:>7} {:>7} {:>7} {:>7}",
        "", "cases", "exact", "proven", "optimal", "false"
    );
    for ((kind, value), tally) in &tallies {
        println!(
            "{:<56} {:>7} {:>7} {:>7} {:>7} {:>7}",
            format!("{kind} {value}"),
            tally.cases,
            tally.exact,
            tally.proven,
            tally.optimal,
            tally.false_proofs
        );
    }
    let [inferred, bounded, searched] = seconds;
    println!("seconds: infer {inferred:.1}, lower_bound {bounded:.1}, exact search {searched:.1}");
    match tallies.values().any(|tally| tally.false_proofs > 0) {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    }
}
