//! Every command serves programs: `--json`, with the keys that FORMATS.md lists, and `--quiet`.

use std::collections::BTreeSet;

use super::lines::{keys, line, listed, table, word};

/// The commands that have no commands below them, as `--help` tells: their words.
fn commands() -> Vec<Vec<String>> {
    let (mut open, mut found) = (vec![Vec::new()], Vec::new());
    while let Some(words) = open.pop() {
        let text = help(&words);
        let below = text.split("Commands:\n").nth(1).unwrap_or_default();
        let below = below.lines().take_while(|l| l.starts_with("  "));
        // Continued descriptions are indented further.
        let names = below.filter(|l| !l.starts_with("    "));
        let names = names.filter_map(|l| l.split_whitespace().next());
        let names: Vec<&str> = names.filter(|name| *name != "help").collect();
        if names.is_empty() {
            found.push(words);
            continue;
        }
        open.extend(names.iter().map(|name| {
            let mut inner = words.clone();
            inner.push((*name).to_owned());
            inner
        }));
    }
    found.sort();
    found
}

fn help(words: &[String]) -> String {
    let mut command = assert_cmd::Command::cargo_bin("edifice").expect("the program");
    let output = command.args(words).arg("--help").assert().success();
    String::from_utf8_lossy(&output.get_output().stdout).into_owned()
}

#[test]
fn every_command_has_a_line_for_programs_and_can_be_quiet() {
    let all = commands();
    assert!(all.len() >= 79, "{} commands", all.len());
    let table = table();
    let rows: BTreeSet<&str> = table.keys().map(|row| row.trim()).collect();
    for words in &all {
        let (name, help) = (words.join(" "), help(words));
        for option in ["--json", "--quiet"] {
            assert!(help.contains(option), "`{name}` has no {option}");
        }
        // Some have several rows, such as `grammar show`, of a library.
        let row = rows.iter().any(|row| {
            let rest = row.strip_prefix(name.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(" of "))
        });
        assert!(row, "FORMATS.md lists no keys of `{name} --json`");
    }
    // No row is of a command that is not there.
    for row in rows {
        let of = row.split(" of ").next().unwrap_or_default();
        let of = of.split(" --").next().unwrap_or_default();
        assert!(all.iter().any(|words| words.join(" ") == of), "{row}");
    }
}

#[test]
fn files_and_tables_are_told_to_programs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| word(&folder.path().join(name)).to_owned();
    let layout = |name: &str| format!("datasets/facade_grammar/layouts/{name}.facade.json");
    let [cottage, a, b] = ["cottage_1", "terrace_a", "terrace_b"].map(layout);
    let houses = "datasets/building_exteriors/real.houses.json";
    let cabin = "datasets/examples/cottage.building.json";
    let town = "datasets/city_proceduralization/town.city-grammar.json";
    let asia = "datasets/model/asia.bif";
    let library = at("s.library.json");
    let [first, second, logic] = ["a.cga", "b.cga", "l.logic.json"].map(at);
    for words in [
        vec!["grammar", "infer", &a, "--method", "greedy", "-o", &first],
        vec!["grammar", "infer", &b, "--method", "greedy", "-o", &second],
        vec![
            "grammar", "infer", &a, &b, "--sizes", "free", "-o", &library,
        ],
        vec!["logic", "fit", &a, &b, "-o", &logic],
    ] {
        line(&[&words[..], &["--json"]].concat());
    }
    let csv = at("t.csv");
    std::fs::write(&csv, "smoke,lung\nyes,\nno,no\n").expect("a written file");
    let numbers = at("n.csv");
    let rows: String = (0..40)
        .map(|k| format!("{},{}\n", k % 7, (k * k) % 11))
        .collect();
    std::fs::write(&numbers, format!("x,y\n{rows}")).expect("a written file");
    let out = |name: &str| at(name);
    let [code, drawn, decoded] = ["x.encoded.json", "d.facade.json", "e.facade.json"].map(out);
    let [derived, edited, merged, both] = ["d.svg", "e.cga", "m.cga", "c.cga"].map(out);
    let [picture, changed, parsed, virtuals] = ["p.png", "f.facade.json", "g.cga", "v"].map(out);
    let [house, city, again, scaled] =
        ["h.svg", "c.obj", "c.city.json", "s.city-grammar.json"].map(out);
    let [tiles, view, network, pages] = ["tiles", "v.png", "n.json", "man"].map(out);
    let country = out("country");
    let town_view = out("town.png");
    let cases: &[(&str, &[&str])] = &[
        ("grammar derive", &[&first, "-o", &derived]),
        (
            "grammar edit",
            &[&first, "symbol 0.0=Ground", "-o", &edited],
        ),
        ("grammar merge", &[&first, &b, "-o", &merged]),
        ("grammar combine", &[&first, &second, "-o", &both]),
        ("grammar draw", &[&library, "-o", &drawn]),
        (
            "grammar town",
            &[&both, "--buildings", "3", "--size", "64", "-o", &town_view],
        ),
        ("grammar encode", &[&library, &a, "-o", &code]),
        ("grammar decode", &[&library, &code, "-o", &decoded]),
        ("facade convert", &[&cottage, "-o", &picture]),
        (
            "facade edit",
            &[&cottage, "add sign@1,1,1,1", "-o", &changed],
        ),
        ("logic parse", &[&a, "-o", &parsed]),
        ("logic cluster", &[&a, &b, "--clusters", "2"]),
        ("logic synthesize", &[&logic, "-n", "2", "-o", &virtuals]),
        ("building attributes", &[cabin]),
        ("building sample", &[houses, "-n", "2"]),
        ("building draw", &[cabin, "-o", &house]),
        ("city derive", &[town, "-o", &city]),
        ("city convert", &[&city, "-o", &again]),
        ("city edit", &[town, "scale house=1,1,2", "-o", &scaled]),
        ("city tiles", &[town, "-o", &tiles]),
        ("city plan", &[&city, "--tile", "200", "-o", &country]),
        ("city work", &[&country]),
        (
            "city submit",
            &[&country, "--engine", "snakemake", "--dry-run"],
        ),
        ("city draw", &[town, "--size", "64x48", "-o", &view]),
        ("model schema", &[&numbers]),
        ("model sample", &[asia, "-n", "3"]),
        ("model score", &[asia, &csv]),
        ("model complete", &[asia, &csv, "-n", "2"]),
        ("model convert", &[asia, "-o", &network]),
        (
            "model evaluate",
            &[&numbers, "--splits", "2", "--models", "gaussian,kde"],
        ),
        ("completions", &["fish"]),
        ("man", &["-o", &pages]),
    ];
    for (command, rest) in cases {
        let words: Vec<&str> = command.split(' ').chain(rest.iter().copied()).collect();
        let found = keys(&[&words[..], &["--json"]].concat());
        let row = match command.contains(' ') {
            true => (*command).to_owned(),
            false => format!(" {command}"),
        };
        assert_eq!(found, listed(&row), "{command}");
    }
    // The rows are those of the CSV.
    let told = line(&["model", "complete", asia, &csv, "-n", "2", "--json"]);
    assert_eq!(told["of"], serde_json::json!([0, 0, 1, 1]));
    let lung = told["columns"].as_array().expect("names");
    let lung = lung.iter().position(|name| name == "lung").expect("lung");
    assert_eq!(
        (&told["rows"][2][lung], &told["rows"][3][lung]),
        (&"no".into(), &"no".into())
    );
    let sampled = line(&[
        "building",
        "sample",
        houses,
        "-n",
        "2",
        "--given",
        "bbox.w=14.5",
        "--json",
    ]);
    let width = sampled["columns"].as_array().expect("names");
    let width = width
        .iter()
        .position(|name| name == "bbox.w")
        .expect("bbox.w");
    assert_eq!(sampled["rows"][1][width], 14.5);
}
