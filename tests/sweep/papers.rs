//! The papers' ablations as sweeps give the numbers of the artefacts, at the smoke budget.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use edifice_experiments::sweep::examples::examples;
use edifice_experiments::{ALL, Budget, Options, run};

use crate::cases::cases;

/// Runs artefacts and returns their rows: `[dataset, method, instance, seed, metric]` to value.
fn artefact(paper: &str, name: &str) -> BTreeMap<[String; 5], f64> {
    let out = tempfile::tempdir().unwrap();
    let options = Options {
        only: vec![name.into()],
        data: None,
        own: Vec::new(),
        seed: 1,
        budget: Budget::Smoke,
        out: out.path().to_path_buf(),
        threads: 2,
        verify: false,
    };
    let own = ALL.iter().find(|e| e.slug == paper).unwrap();
    let report = run(&[own], &options).unwrap();
    assert!(report.failed.is_empty(), "{:?}", report.failed);
    let path = out.path().join(paper).join(format!("{name}.csv"));
    let mut rows = BTreeMap::new();
    for record in csv::Reader::from_path(path).unwrap().records() {
        let record = record.unwrap();
        let key = [1, 2, 3, 4, 5].map(|k| record[k].to_owned());
        rows.insert(key, record[6].parse().unwrap());
    }
    assert!(!rows.is_empty());
    rows
}

/// The text of a sweep that ships, with some parts replaced, each of which it has.
fn example(name: &str, replaced: &[(&str, String)]) -> String {
    let all = examples();
    let found = all.iter().find(|e| e.name == name).unwrap();
    let mut text = found.text.to_owned();
    for (before, after) in replaced {
        assert!(text.contains(before), "{name} has no {before}");
        text = text.replace(before, after);
    }
    text
}

/// The line of a sweep that ships that begins so.
fn line(name: &str, begin: &str) -> String {
    let all = examples();
    let found = all.iter().find(|e| e.name == name).unwrap();
    let mut lines = found.text.lines();
    lines
        .find(|line| line.starts_with(begin))
        .unwrap()
        .to_owned()
}

/// Runs a sweep and returns its results: `[arm, instance, seed, metric]` to value.
fn sweep(text: &str) -> BTreeMap<[String; 4], f64> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    for verb in ["run", "collect"] {
        let output = Command::new(env!("CARGO_BIN_EXE_edifice"))
            .current_dir(folder.path())
            .args(["sweep", verb, "s.toml", "--out", "out"])
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{message}");
    }
    read(&folder.path().join("out/results.csv"))
}

fn read(path: &Path) -> BTreeMap<[String; 4], f64> {
    let mut rows = BTreeMap::new();
    for record in csv::Reader::from_path(path).unwrap().records() {
        let record = record.unwrap();
        assert!(&record[4] != "failure", "{record:?}");
        let key = [1, 2, 3, 4].map(|k| record[k].to_owned());
        rows.insert(key, record[5].parse().unwrap());
    }
    rows
}

fn same(ours: Option<&f64>, theirs: f64, what: &[String]) {
    let ours = ours.unwrap_or_else(|| panic!("no result for {what:?}"));
    assert!(
        (ours - theirs).abs() < 1e-9,
        "{what:?}: {ours} and {theirs}"
    );
}

fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    quoted.join(", ")
}

/// Names of the layouts that ship, in order.
fn layouts() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".facade.json"))
        .collect();
    names.sort();
    names
}

#[test]
fn wu_table_5() {
    let name = "facade_grammar_table_5";
    let rows = artefact("facade_grammar", "table_5");
    let rows: Vec<_> = rows
        .into_iter()
        .filter(|(key, _)| ["shipped", "printed"].contains(&key[0].as_str()))
        .filter(|(key, _)| key[1].starts_with("adp_best_20 "))
        .collect();
    let mut files: Vec<String> = rows
        .iter()
        .map(|(key, _)| match key[0].as_str() {
            "printed" => "wu2014_fig9.facade.json".to_owned(),
            _ => format!("layouts/{}.facade.json", key[2]),
        })
        .collect();
    files.sort();
    files.dedup();
    let data = format!("data = [{}]", list(&files));
    let found = sweep(&example(
        name,
        &[
            (&line(name, "data"), data),
            ("iterations = 2000", "iterations = 20".into()),
        ],
    ));
    // 6 models, 3 facades, 3 measures.
    assert_eq!(rows.len(), 6 * files.len() * 3);
    assert!(files.len() >= 3);
    for ([kind, method, facade, _, metric], value) in rows {
        let arm = method.trim_start_matches("adp_best_20 ").to_owned();
        let instance = if kind == "printed" {
            "wu2014_fig9".into()
        } else {
            facade
        };
        let key = [arm, instance, "1".into(), metric];
        same(found.get(&key), value, &key);
    }
}

#[test]
fn wu_readings() {
    let name = "facade_grammar_readings";
    let rows = artefact("facade_grammar", "readings");
    let found = sweep(&example(
        name,
        &[
            (&line(name, "seeds"), "seeds = [1, 2]".into()),
            ("iterations = 10000", "iterations = 100".into()),
        ],
    ));
    let mut compared = 0;
    for ([_, method, instance, seed, metric], value) in rows {
        let Some(arm) = method.strip_prefix("adp_paper_100/") else {
            continue;
        };
        if instance == "wu2014_fig9" && metric == "cost" {
            let key = [arm.to_owned(), instance, seed, metric];
            same(found.get(&key), value, &key);
            compared += 1;
        }
    }
    assert_eq!(compared, 10 * 2);
}

#[test]
fn fan_figures_17_and_18() {
    let every_sixth: Vec<String> = layouts()
        .into_iter()
        .step_by(6)
        .map(|name| format!("layouts/{name}"))
        .collect();
    let both = [
        ("figure_17", "structure_completion_figure_17", 2),
        ("figure_18", "structure_completion_figure_18", 11),
    ];
    for (artefact_name, name, arms) in both.into_iter().take(cases(both.len())) {
        let rows = artefact("structure_completion", artefact_name);
        assert_eq!(rows.len(), arms);
        let completed = |instance: &str| instance.rsplit('/').next().unwrap().to_owned();
        let facade = completed(&rows.keys().next().unwrap()[2]);
        let found = sweep(&example(
            name,
            &[
                (
                    &line(name, "data"),
                    format!("data = [\"layouts/{facade}.facade.json\"]"),
                ),
                (
                    &line(name, "learn"),
                    format!("learn = [{}]", list(&every_sixth)),
                ),
                (&line(name, "seeds"), "seeds = [1]".into()),
                (
                    "task = \"side50\"",
                    "task = \"side50\"\npopulation = 10\ngenerations = 6\ndraws = 3".into(),
                ),
            ],
        ));
        for ([_, _, instance, _, metric], value) in rows {
            let arm = instance.split('/').next().unwrap().to_owned();
            let key = [arm, facade.clone(), "1".into(), metric];
            same(found.get(&key), value, &key);
        }
    }
}

#[test]
fn fan_and_wonka_models_1_to_3() {
    let name = "building_exteriors_figure_12";
    let rows = artefact("building_exteriors", "figure_12_left");
    let found = sweep(&example(
        name,
        &[(
            &line(name, "seeds"),
            "seeds = 1\n[base]\nmost_styles = 3\nmost_states = 4\nrestarts = 1".into(),
        )],
    ));
    // The study learns the models as published; the artefact has them without and with a background.
    let published = rows
        .into_iter()
        .filter(|(key, _)| key[0] == "shipped" && key[4] == "nll_without_background");
    let rows: Vec<_> = published.collect();
    assert_eq!(rows.len(), 5);
    for ([_, model, split, ..], value) in rows {
        let seed = split.parse::<u64>().unwrap() - 1;
        let key = [
            format!("model={model}"),
            "houses".into(),
            seed.to_string(),
            "nll".into(),
        ];
        same(found.get(&key), value, &key);
    }
}

#[test]
fn demir_figure_7() {
    let name = "city_proceduralization_figure_7";
    let rows = artefact("city_proceduralization", "figure_7");
    let found = sweep(&example(
        name,
        &[
            ("made_500_1", "made_16_1".into()),
            (&line(name, "set.level"), "set.level = [1, 2, 3]".into()),
        ],
    ));
    assert_eq!(rows.len(), 3 * 3 * 2);
    for ([_, method, instance, _, metric], value) in rows {
        let level = instance.trim_start_matches("level_");
        let rest = match method.as_str() {
            "paper" => "mode=paper, representative=nearest",
            "paper_poly" => "mode=paper, representative=fewest_polygons",
            _ => "mode=best, representative=nearest",
        };
        let arm = format!("level={level}, {rest}");
        let key = [arm, "made_16_1".into(), "1".into(), metric];
        same(found.get(&key), value, &key);
    }
}

#[test]
fn weissenberg_readings() {
    let name = "procedural_logic_readings";
    let rows = artefact("procedural_logic", "readings");
    let houses = [
        "wu2014_fig9",
        "layouts/cottage_1",
        "layouts/cottage_2",
        "layouts/shophouse_1",
    ];
    let files = houses.map(|house| format!("{house}.facade.json"));
    let data = format!("data = [{}]", list(&files));
    let found = sweep(&example(name, &[(&line(name, "data"), data)]));
    let mut compared = 0;
    for ([_, method, rank, _, metric], value) in rows {
        if metric != "cmc" {
            continue;
        }
        let (extent, facing) = method.split_once('/').unwrap();
        let arm = format!("extent={extent}, facing={facing}");
        let of = |metric: &str| -> Vec<f64> {
            let own = found
                .iter()
                .filter(|(key, _)| key[0] == arm && key[3] == metric);
            own.map(|(_, value)| *value).collect()
        };
        let (rates, queries) = (of(&rank), of("queries"));
        // Every house stands at five sizes, so that each has as many queries.
        assert_eq!(queries, [5.0; 4]);
        let mean = rates.iter().sum::<f64>() / rates.len() as f64;
        same(Some(&mean), value, &[arm, rank]);
        compared += 1;
    }
    assert_eq!(compared, 6 * 2);
}

#[test]
fn a_bundle_has_what_was_learnt_from() {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<String> = layouts()
        .into_iter()
        .take(12)
        .map(|f| format!("layouts/{f}"))
        .collect();
    let retrieval = format!(
        "study = \"procedural_logic/retrieval\"\ndata = [{}]\n[base]\nsizes = 2\n[[arm]]\nname = \"only\"\n",
        list(&files[..11])
    );
    let completion = format!(
        "study = \"structure_completion/complete\"\ndata = [{}]\nlearn = [{}]\n[base]\nmethod = \"nearest\"\n[[arm]]\nname = \"only\"\n",
        list(&files[..1]),
        list(&files)
    );
    for (name, text, tasks) in [("retrieval", retrieval, 11), ("completion", completion, 1)] {
        std::fs::write(folder.path().join(format!("{name}.toml")), text).unwrap();
        let edifice = |words: &[&str]| {
            let output = Command::new(env!("CARGO_BIN_EXE_edifice"))
                .current_dir(folder.path())
                .arg("sweep")
                .args(words)
                .output()
                .unwrap();
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{words:?}: {message}");
            message
        };
        let (file, zip) = (format!("{name}.toml"), format!("{name}.zip"));
        edifice(&["run", &file, "--out", name]);
        edifice(&["bundle", &file, "--out", name, "-o", &zip]);
        // Alone, with nothing but the zip.
        std::fs::remove_dir_all(folder.path().join(name)).unwrap();
        let said = edifice(&["verify", &zip, "--sample", "20"]);
        let wanted = format!("{tasks} tasks were run again, 0 rows differ");
        assert!(said.contains(&wanted), "{said}");
    }
}
