//! A floor or column that is put in and taken out again leaves the facade as it was: all shipped grammars, all their rules.

use std::path::{Path, PathBuf};

use edifice::grammar::{Grammar, Operation, Rule, Size, Start, Successor, check};
use edifice::io::{facade_json, read_grammar};
use edifice::methods::facade_grammar::{Method, Settings, infer};
use edifice::rng::stream;
use edifice::shape::Axis;
use edifice::unwatched;
use edifice_editing::split_grammar::{Derived, GrammarEdit, Resizing, Wish, derived, edit};
use rand::{Rng, RngExt};

use crate::cases::cases;

fn files(ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let mut files = Vec::new();
    for folder in [folder.clone(), folder.join("layouts")] {
        let entries = std::fs::read_dir(folder).expect("listed");
        files.extend(entries.map(|entry| entry.expect("listed").path()));
    }
    files.retain(|file| file.to_string_lossy().ends_with(ending));
    files.sort();
    files
}

/// The shipped grammars, and one inferred from each shipped facade.
fn grammars() -> Vec<(String, Grammar)> {
    let settings = Settings {
        method: Method::Greedy,
        ..Settings::default()
    };
    let shipped = files(".cga").into_iter().chain(files(".grammar.json"));
    let read = |file: PathBuf| {
        (
            file.display().to_string(),
            read_grammar(&file).expect("ships"),
        )
    };
    let inferred = files(".facade.json").into_iter().map(|file| {
        let facade = facade_json::read(&file).expect("ships");
        let found = infer(&[facade], &settings, &unwatched).expect("a grammar");
        (format!("inferred from {}", file.display()), found.grammar)
    });
    shipped.map(read).chain(inferred).collect()
}

/// The places of a rule that a floor or column can stand at.
fn places(operation: &Operation) -> Vec<String> {
    let count = |n: usize, sign: &str| (0..n).map(|k| format!("{sign}{k}")).collect::<Vec<_>>();
    match operation {
        Operation::GridSplit { columns, rows, .. } => {
            let mut all = count(columns.len(), "c");
            all.extend(count(rows.len(), "r"));
            all
        }
        other => count(other.successor_count(), ""),
    }
}

fn shown(grammar: &Grammar) -> Derived {
    let wish = Wish {
        start: 0,
        size: None,
        seed: 0,
        resizing: Resizing::Rules,
    };
    derived(grammar, &wish).expect("derives")
}

fn edited(grammar: &Grammar, text: &str) -> Result<Grammar, String> {
    let read: GrammarEdit = text.parse().expect("an edit");
    edit(grammar, &[read]).map_err(|e| e.to_string())
}

#[test]
fn every_floor_and_column_comes_and_goes() {
    let mut rng = stream(3, "studio/all floors", 0);
    let (mut tried, mut fixed, mut refused, mut worst) = (0, 0, 0, 0.0_f64);
    let (mut inner, mut failures) = (0, Vec::new());
    let all = grammars();
    let every = all.len() / cases(all.len());
    for (name, grammar) in all.into_iter().step_by(every) {
        let start = &grammar.starts[0];
        let own = format!("outline {},{}", start.width, start.height);
        let before = edited(&grammar, &own).expect("stays");
        let facade = shown(&before).facade;
        for (rule, written) in before.rules.iter().enumerate() {
            let all = places(&written.operation);
            let drawn = rng.random_range(0..all.len());
            for place in [&all[0], &all[drawn]] {
                let grown = match edited(&before, &format!("grow {rule}.{place}")) {
                    Err(e) if e.contains("fixed length") => {
                        fixed += 1;
                        continue;
                    }
                    // A part of absolute size fits into some regions of the rule, and not into others.
                    Err(e) if e.contains("absolute sizes need") => {
                        println!("{name} {rule}.{place}: {e}");
                        refused += 1;
                        continue;
                    }
                    grown => grown.expect("grows"),
                };
                let [a, b] = [&before, &grown].map(|g| (g.starts[0].width, g.starts[0].height));
                let along = [b.0 > a.0 * (1.0 + 1e-9), b.1 > a.1 * (1.0 + 1e-9)];
                assert!(along[0] != along[1], "{name} {rule}.{place}: {a:?} {b:?}");
                let back = edited(&grown, &format!("shrink {rule}.{place}")).expect("shrinks");
                let c = (back.starts[0].width, back.starts[0].height);
                let off = ((c.0 - a.0) / a.0).abs().max(((c.1 - a.1) / a.1).abs());
                worst = worst.max(off);
                if off > 1e-9 {
                    let operation = written.operation.name();
                    failures.push(format!(
                        "{name} {rule}.{place} ({operation}): {a:?} {b:?} {c:?}"
                    ));
                }
                // And all regions inside it are as they were.
                let again = shown(&back).facade;
                let near = |(x, y): (&edifice::shape::Region, &edifice::shape::Region)| {
                    let d = [
                        x.rect.x - y.rect.x,
                        x.rect.y - y.rect.y,
                        x.rect.width - y.rect.width,
                        x.rect.height - y.rect.height,
                    ];
                    x.label == y.label
                        && d.iter()
                            .all(|d| d.abs() < 1e-6 * facade.width.max(facade.height))
                };
                let same = again.regions.len() == facade.regions.len()
                    && again.regions.iter().zip(&facade.regions).all(near);
                inner += usize::from(!same);
                tried += 1;
            }
        }
    }
    println!(
        "{tried} floors and columns, {fixed} of fixed length, {refused} refused; outline off by {worst:e} at most; {inner} facades differ inside"
    );
    assert!(
        failures.is_empty(),
        "{} of {tried}:\n{}",
        failures.len(),
        failures[..failures.len().min(20)].join("\n")
    );
    assert!(tried > 1000 / every, "{tried}");
}

/// A grammar of eight rules of all operations, each of symbols further down, some of whose parts have absolute sizes.
fn drawn(rng: &mut impl Rng) -> Grammar {
    const RULES: usize = 8;
    let rules = (0..RULES).map(|k| {
        let mut symbol = || match rng.random_range(0..3) {
            0 => format!("t{}", rng.random_range(0..4)),
            _ if k + 1 < RULES => format!("S{}", rng.random_range(k + 1..RULES)),
            _ => "t".to_owned(),
        };
        let symbols: Vec<String> = (0..9).map(|_| symbol()).collect();
        let mut sizes = |n: usize| -> Vec<Size> {
            let relative = rng.random_range(0..n);
            let size = |k: usize| match k != relative && rng.random_range(0..4) == 0 {
                true => Size::Absolute(rng.random_range(0.01..0.2)),
                false => Size::Relative(rng.random_range(0.5..4.0)),
            };
            (0..n).map(size).collect()
        };
        let count = 2 + k % 2;
        let parts: Vec<Successor> = symbols
            .iter()
            .cloned()
            .zip(sizes(count))
            .map(|(symbol, size)| Successor { symbol, size })
            .collect();
        let (columns, rows) = (sizes(3), sizes(2));
        let axis = [Axis::X, Axis::Y][rng.random_range(0..2)];
        let operation = match rng.random_range(0..6) {
            0 => Operation::Repeat {
                axis,
                successors: parts,
            },
            1 => Operation::RepeatAba {
                axis,
                a: parts[0].clone(),
                b: parts[1].clone(),
            },
            2 => Operation::SymSplit {
                axis,
                successors: parts,
                center: rng.random(),
            },
            3 => Operation::GridSplit {
                columns,
                rows,
                cells: symbols[..6].chunks(3).map(<[String]>::to_vec).collect(),
            },
            _ => Operation::Split {
                axis,
                successors: parts,
            },
        };
        Rule {
            symbol: format!("S{k}"),
            weight: None,
            operation,
        }
    });
    let rules = rules.collect();
    Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: "f".into(),
            symbol: "S0".into(),
            width: 30.0,
            height: 20.0,
        }],
        rules,
    }
}

#[test]
fn floors_and_columns_of_any_rules_come_and_go() {
    let mut rng = stream(8, "studio/drawn floors", 0);
    let (mut tried, mut refused, mut inner, mut off) = (0, 0, 0, Vec::new());
    for _ in 0..400 {
        let grammar = drawn(&mut rng);
        if check(&grammar).is_err() {
            continue;
        }
        let facade = shown(&grammar).facade;
        for (rule, written) in grammar.rules.iter().enumerate() {
            let all = places(&written.operation);
            let place = &all[rng.random_range(0..all.len())];
            let Ok(grown) = edited(&grammar, &format!("grow {rule}.{place}")) else {
                refused += 1;
                continue;
            };
            let Ok(back) = edited(&grown, &format!("shrink {rule}.{place}")) else {
                refused += 1;
                continue;
            };
            let [a, b] = [&grammar, &back].map(|g| [g.starts[0].width, g.starts[0].height]);
            if a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-9 * a) {
                off.push(format!("{b:?} {rule}.{place}: {written:?}"));
            }
            // Where a repeat had to get other sizes, another region of its rule may take another number of periods.
            inner += usize::from(shown(&back).facade.regions.len() != facade.regions.len());
            tried += 1;
        }
    }
    println!("{tried} tried, {refused} refused, {inner} differ inside");
    assert!(
        off.is_empty() && tried > 500,
        "{tried}: {}\n{}",
        off.len(),
        off[..off.len().min(12)].join("\n")
    );
    assert!(200 * inner < tried, "{inner} of {tried}");
}
