//! Every number in the prose of the report stands on the page of the artefact beside it.
//!
//! A row of `reports/README.md` links artefacts; each number of its last cell must be on one of their pages (`.md`) or in what `run.json`
//! says of them, rounded to as many decimals as the prose has; a share may stand there as per cent, and the other way round. A number
//! of another row of the same page passes: this finds prose of another run, not a number in the wrong place.

use std::path::Path;

use serde_json::Value;

/// Words before a number that is a name: of a figure, of a level.
const NAMES: [&str; 13] = [
    "Fig.", "Figs.", "Table", "Tables", "Eq.", "Sec.", "Secs.", "Model", "level", "levels", "rank",
    "ranks", "Level",
];

/// A number of prose: its value, its decimals, and if it is in per cent.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Quoted {
    value: f64,
    decimals: i32,
    per_cent: bool,
}

/// Text without code, targets and names of links.
fn plain(text: &str) -> String {
    let code = text.split('`').enumerate().filter(|(k, _)| k % 2 == 0);
    let text: Vec<&str> = code.map(|(_, piece)| piece).collect();
    let text = text.join("…");
    let mut kept = String::new();
    let mut rest = text.as_str();
    while let Some((before, target)) = rest.split_once("](") {
        kept.push_str(before.rsplit_once('[').map_or(before, |(before, _)| before));
        rest = target.split_once(')').map_or("", |(_, behind)| behind);
    }
    kept.push_str(rest);
    kept
}

/// The number that a word is, without signs around it.
fn number(word: &str) -> Option<(f64, i32)> {
    let word = word.trim_matches(|c: char| !c.is_ascii_digit());
    let digits = word.replace(',', "");
    if !word.starts_with(|c: char| c.is_ascii_digit())
        || digits.contains(|c: char| c.is_alphabetic() && c != 'e')
    {
        return None;
    }
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    Some((digits.parse().ok()?, i32::try_from(decimals).ok()?))
}

/// The numbers of prose, without those that are names.
fn quoted(text: &str) -> Vec<Quoted> {
    let text = plain(text);
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || "/()[]–;:".contains(c))
        .filter(|w| !w.is_empty())
        .collect();
    let mut found = Vec::new();
    let mut named = false;
    for (k, word) in words.iter().enumerate() {
        let word = word.trim_start_matches(['+', '-', '*']);
        let is_number = word.starts_with(|c: char| c.is_ascii_digit());
        match number(word).filter(|_| is_number) {
            Some((value, decimals)) if !named => {
                // "1 to 3 %", "1, 2 and 3 %": each is in per cent.
                let mut behind = words[k + 1..].iter();
                let unit = behind.find(|w| number(w).is_none() && !["to", "and", "or"].contains(w));
                found.push(Quoted {
                    value,
                    decimals,
                    per_cent: unit.is_some_and(|u| u.starts_with('%')),
                });
            }
            Some(_) => {}
            None => {
                named = NAMES.contains(&word)
                    || (named && ["to", "and", "left", "right"].contains(&word))
            }
        }
    }
    found
}

/// All numbers of a text, whatever stands around them.
fn numbers(text: &str) -> Vec<f64> {
    let part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    let words = text.split(|c| !part(c));
    let clean = |w: &str| w.trim_matches(['.', ',']).replace(',', "");
    words.filter_map(|w| clean(w).parse().ok()).collect()
}

/// True if a number stands in a list of them.
fn stands(quoted: Quoted, there: &[f64]) -> bool {
    let half = 0.5 * 10_f64.powi(-quoted.decimals) * (1.0 + 1e-6) + 1e-9;
    there.iter().any(|&v| {
        let shares = [100.0 * v, 100.0 - 100.0 * v, 100.0 - v].into_iter();
        let shares = shares.filter(|_| quoted.per_cent);
        let mut all = shares.chain([v]);
        all.any(|w| (w.abs() - quoted.value).abs() <= half)
    })
}

/// The artefacts that a line links, as slug and name.
fn linked(line: &str) -> Vec<(&str, &str)> {
    let targets = line.split("](").skip(1).filter_map(|t| t.split_once(')'));
    let pages = targets.filter_map(|(target, _)| target.strip_suffix(".md"));
    pages.filter_map(|page| page.rsplit_once('/')).collect()
}

/// All that the runs tell of some artefacts, of those that runs made.
fn told(reports: &Path, artefacts: &[(&str, &str)]) -> Vec<f64> {
    let mut all = Vec::new();
    for (slug, name) in artefacts {
        let slug = slug.trim_start_matches("reports/");
        let folder = reports.join(slug);
        let Ok(run) = std::fs::read_to_string(folder.join("run.json")) else {
            continue;
        };
        let run: Value = serde_json::from_str(&run).expect("run.json is JSON");
        let made = &run["artefacts"][name];
        let page = std::fs::read_to_string(folder.join(format!("{name}.md"))).unwrap_or_default();
        let times = folder.join(format!("{name}.times.md"));
        for text in [
            page,
            std::fs::read_to_string(times).unwrap_or_default(),
            made["comparisons"].to_string(),
            made["settings"].to_string(),
        ] {
            all.extend(numbers(&text));
        }
    }
    all
}

#[test]
fn numbers_in_prose_are_those_of_the_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut wrong = Vec::new();
    let mut checked = 0;
    for (file, is_table) in [("reports/README.md", true), ("README.md", false)] {
        let text = std::fs::read_to_string(root.join(file)).expect("text");
        for (k, line) in text.lines().enumerate() {
            let artefacts = linked(line);
            if artefacts.is_empty() || (is_table && !line.starts_with('|')) {
                continue;
            }
            let there = told(&root.join("reports"), &artefacts);
            let prose = match is_table {
                true => line
                    .trim_end_matches([' ', '|'])
                    .rsplit('|')
                    .next()
                    .unwrap_or(line),
                false => line,
            };
            if there.is_empty() {
                continue;
            }
            for quoted in quoted(prose) {
                checked += 1;
                if !stands(quoted, &there) {
                    wrong.push(format!(
                        "{file}:{}: {} is not on {artefacts:?}",
                        k + 1,
                        quoted.value
                    ));
                }
            }
        }
    }
    assert!(checked > 150, "only {checked} numbers");
    assert!(
        wrong.is_empty(),
        "{} numbers:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn a_number_of_another_run_is_found() {
    let page = numbers("| cost | 1.20 | 1,121 | 0.907 |");
    let wrong = |prose: &str| quoted(prose).iter().filter(|q| !stands(**q, &page)).count();
    assert_eq!(
        wrong(
            "IS/ADP 1.20, of 1,121 terminals, see [a page 7](x/a_9.md) of Fig. 9 left and Table 1"
        ),
        0
    );
    assert_eq!(wrong("90.7 % and 9.3 %, `--seed 4`, ECP2011, F1"), 0);
    assert_eq!(wrong("IS/ADP 1.19, and 90.7 of them, +1.3 ± 0.5"), 4);
    assert_eq!(
        quoted("10 to 90 %").iter().filter(|q| q.per_cent).count(),
        2
    );
    assert_eq!(linked("see [a](x/a.md) and [b](y/b.csv)"), [("x", "a")]);
}
