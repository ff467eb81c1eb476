//! Lines for programs: the last line of a command with `--json` has the keys that FORMATS.md lists.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use assert_cmd::Command;

pub(crate) const PAGE: &str = include_str!("../../FORMATS.md");

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The blocks of code of the page: the second word after the fence, and the text.
pub(crate) fn examples() -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let mut open: Option<(&str, String)> = None;
    for line in PAGE.lines() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(_), Some(done)) => found.push(done),
            (Some(info), None) => {
                let kind = info.split(' ').nth(1).expect("a kind after the language");
                open = Some((kind, String::new()));
            }
            (None, Some((kind, text))) => open = Some((kind, text + line + "\n")),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block of code does not end");
    found
}

pub(crate) fn word(path: &Path) -> &str {
    path.to_str().expect("a path of text")
}

/// The last line of standard output of a command, as JSON.
pub(crate) fn line(words: &[&str]) -> serde_json::Value {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    let output = command.current_dir(root()).args(words).assert().success();
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    let last = text.lines().last().unwrap_or_default().to_owned();
    serde_json::from_str(&last).unwrap_or_else(|e| panic!("{words:?}: {e}: {text}"))
}

pub(crate) fn keys(words: &[&str]) -> BTreeSet<String> {
    let line = line(words);
    let object = line.as_object().expect("an object");
    object.keys().cloned().collect()
}

/// The keys that the page lists for a command, those in brackets left out.
pub(crate) fn listed(command: &str) -> BTreeSet<String> {
    let all = table();
    let cell = all
        .get(command)
        .unwrap_or_else(|| panic!("no row of {command}"));
    let mut keys = BTreeSet::new();
    // Keys of inner objects stand in parentheses.
    let (mut depth, mut rest) = (0, cell.as_str());
    while let Some(at) = rest.find(['(', ')', '[', ']', '`']) {
        let sign = rest.as_bytes()[at];
        rest = &rest[at + 1..];
        match sign {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            _ => {
                let end = rest.find('`').expect("code ends");
                if depth == 0 {
                    keys.insert(rest[..end].to_owned());
                }
                rest = &rest[end + 1..];
            }
        }
    }
    keys
}

/// The rows of the table of lines: command, and the cell of its keys.
pub(crate) fn table() -> BTreeMap<String, String> {
    let rows = PAGE.split("| command | keys |").nth(1).expect("the table");
    let rows = rows.lines().skip(2).take_while(|l| l.starts_with('|'));
    let mut table = BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [commands, keys] = cells[..] else {
            panic!("{row}");
        };
        let (commands, about) = match commands.rsplit_once("`") {
            Some((commands, about)) => (commands, about.trim_matches([',', ';', ' '])),
            None => panic!("{row}"),
        };
        let about = match about.starts_with("of ") {
            true => format!(" {about}"),
            false => String::new(),
        };
        let mut room = "";
        for name in commands.split('`').filter(|n| !matches!(*n, "" | ", ")) {
            let name = match name.split_once(' ') {
                Some((first, second)) => {
                    room = first;
                    second
                }
                None => name,
            };
            table.insert(format!("{room} {name}{about}"), keys.to_owned());
        }
    }
    table
}

#[test]
fn lines_for_programs_have_the_keys_of_the_page() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| word(&folder.path().join(name)).to_owned();
    let cottage = "datasets/facade_grammar/layouts/cottage_1.facade.json";
    let terraces =
        ["a", "b"].map(|k| format!("datasets/facade_grammar/layouts/terrace_{k}.facade.json"));
    let houses = "datasets/building_exteriors/real.houses.json";
    let town = "datasets/city_proceduralization/town.city-grammar.json";
    let asia = "datasets/model/asia.bif";
    let (grammar, half, logic) = (
        at("c.grammar.json"),
        at("half.facade.json"),
        at("l.logic.json"),
    );
    let (out, whole, quarter) = (
        at("houses"),
        at("whole.facade.json"),
        at("q.city-grammar.json"),
    );
    let again = at("again.city-grammar.json");
    let city = at("town.obj");
    let table = at("table.csv");
    let bif = at("t.bif");
    let fitted = at("fitted.bif");
    let rows = "b,c\nx,yes\ny,no\nx,yes\ny,no\nx,no\nx,yes\ny,yes\nx,no\n";
    std::fs::write(&table, rows).expect("a written file");
    let view = at("view.json");
    let (_, text) = examples()
        .into_iter()
        .find(|(kind, _)| *kind == "city-view")
        .expect("a view");
    std::fs::write(&view, text).expect("a written file");
    let house = at("houses/house_0001.building.json");
    let cases: &[(&str, &[&str])] = &[
        (
            "grammar infer",
            &[
                "grammar", "infer", cottage, "--method", "greedy", "-o", &grammar,
            ],
        ),
        ("grammar show", &["grammar", "show", &grammar]),
        (
            "facade hide",
            &["facade", "hide", cottage, "--task", "side50", "-o", &half],
        ),
        (
            "facade complete",
            &["facade", "complete", &half, "-o", &whole],
        ),
        ("facade score", &["facade", "score", cottage]),
        (
            "logic fit",
            &["logic", "fit", &terraces[0], &terraces[1], "-o", &logic],
        ),
        (
            "logic compare",
            &[
                "logic",
                "compare",
                "--model",
                &logic,
                "--query",
                "terrace_a",
            ],
        ),
        ("model show of a logic model", &["model", "show", &logic]),
        ("model show of a network", &["model", "show", asia]),
        (
            "model structure",
            &["model", "structure", &table, "-o", &bif, "--restarts", "1"],
        ),
        ("model fit", &["model", "fit", &bif, &table, "-o", &fitted]),
        ("building show", &["building", "show", houses]),
        (
            "building generate",
            &["building", "generate", houses, "-n", "1", "-o", &out],
        ),
        (
            "building from-facades",
            &[
                "building",
                "from-facades",
                "--front",
                "datasets/examples/front.facade.json",
                "--footprint",
                "datasets/examples/lot.geojson",
                "--height",
                "6",
                "-o",
                &out,
            ],
        ),
        ("building check", &["building", "check", &house]),
        ("city show", &["city", "show", town]),
        (
            "city morphology",
            &["city", "morphology", town, "--side", "100"],
        ),
        (
            "city synthesize",
            &[
                "city",
                "synthesize",
                town,
                "--polygon",
                "0,0,60,0,60,60,0,60",
                "-o",
                &quarter,
            ],
        ),
        ("city derive", &["city", "derive", town, "-o", &city]),
        (
            "city compare",
            &["city", "compare", &city, &city, "--resolution", "2"],
        ),
        (
            "city proceduralize",
            &["city", "proceduralize", &city, "-o", &again],
        ),
        (
            "city locate",
            &["city", "locate", town, "--view", &view, "--top", "1"],
        ),
        ("sweep studies", &["sweep", "studies"]),
    ];
    for (command, words) in cases {
        if *command == "city derive" {
            let mut derive = Command::cargo_bin("edifice").expect("the program");
            derive.current_dir(root()).args(*words).assert().success();
            continue;
        }
        let found = keys(&[words, &["--json"][..]].concat());
        assert_eq!(found, listed(command), "{command}");
    }
    // A line a variable.
    let answers = line(&["model", "query", asia, "--of", "lung", "--json"]);
    assert!(answers["lung"]["probabilities"].is_array());
}
