//! Sweeps that are refused: what is wrong is named, with its place, the exit code is 1 (2 for wrong usage), and nothing is lost.

use std::path::Path;

use assert_cmd::Command;

const SWEEP: &str = r#"study = "optim/annealing"
data = ["*.knapsack.json"]
seeds = 2
[base]
rounds = 5
[[grid]]
set.start = [0.1, 1.0]
[report]
metric = "left_out"
"#;

fn edifice(folder: &Path, words: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command
        .current_dir(folder)
        .arg("sweep")
        .args(words)
        .assert()
}

fn prepared(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    folder
}

fn good(folder: &Path, verb: &str) {
    edifice(folder, &[verb, "s.toml", "--out", "out"]).success();
}

/// The message of a command that fails with exit code 1.
fn refused(folder: &Path, verb: &str) -> String {
    let failed = edifice(folder, &[verb, "s.toml", "--out", "out"])
        .failure()
        .code(1);
    String::from_utf8_lossy(&failed.get_output().stderr).into_owned()
}

#[test]
fn every_mistake_of_a_file_is_named_with_its_place() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("set.start = [0.1, 1.0]", "", &["line 6", "varies nothing"]),
        (
            "set.start = [0.1, 1.0]",
            "set.start = [0.1, 1.0]\nzip.start = [0.1]",
            &["line 6", "`start` is varied twice"],
        ),
        (
            "[report]",
            "[[exclude]]\nstart = 3.0\n[report]",
            &["line 8", "nothing is left out"],
        ),
        (
            "[report]",
            "[[exclude]]\n[report]",
            &["line 8", "names no setting"],
        ),
        (
            "[report]",
            "[[exclude]]\nrounds = 5\n[report]",
            &["the sweep has no arm"],
        ),
        (
            "set.start = [0.1, 1.0]",
            "set.start = [0.1, 0.1]",
            &["two arms are called `start=0.1`"],
        ),
        (
            "[report]",
            "[task]\npack = \"soon\"\n[report]",
            &["line 8", "pack: `soon`"],
        ),
        (
            "[report]",
            "[task]\nmem = \"1GB\"\n[report]",
            &["line 8", "mem: `1GB`"],
        ),
        (
            "[report]",
            "[task]\ncpus = 0\n[report]",
            &["line 8", "cpus"],
        ),
        (
            "[report]",
            "[report]\ntargets = [0.5]",
            &["line 8", "targets: 0.5"],
        ),
        (
            "[report]",
            "[report]\nanytime = \"hours\"",
            &["line 8", "`hours`"],
        ),
        (
            "metric = \"left_out\"",
            "metric = \"left\"",
            &["line 8", "no metric `left`"],
        ),
        (
            "seeds = 2",
            "seeds = 0",
            &["line 3, column 9", "at least 1"],
        ),
        ("seeds = 2", "seeds = -1", &["line 3"]),
        (
            "seeds = 2",
            "learn = [\"*.json\"]",
            &["line 3, column 9", "learns from no files"],
        ),
        (
            "optim/annealing",
            "optim/anealing",
            &["line 1, column 9", "did you mean `optim/annealing`?"],
        ),
        (
            "[\"*.knapsack.json\"]",
            "[]",
            &["line 2, column 8", "no instances are named"],
        ),
        (
            "[\"*.knapsack.json\"]",
            "[\"[\"]",
            &["the pattern is not one"],
        ),
        (
            "rounds = 5",
            "rounds = -5",
            &["line 5, column 10", "rounds"],
        ),
        (
            "rounds = 5",
            "round = 5",
            &["line 5, column 1", "did you mean `rounds`?"],
        ),
    ];
    for (before, after, wanted) in cases {
        let folder = prepared(&SWEEP.replace(before, after));
        let text = refused(folder.path(), "plan");
        assert!(
            wanted.iter().all(|part| text.contains(part)),
            "{after}: {text}"
        );
        assert!(!folder.path().join("out/plan.jsonl").exists());
    }
    // A study that learns from other facades, and has none.
    let text = "study = \"procedural_logic/retrieval\"\ndata = [\"wu2014_fig9.facade.json\"]\n[[arm]]\nname = \"a\"\n";
    let folder = prepared(text);
    let text = refused(folder.path(), "plan");
    assert!(
        text.contains("name several instances, or files by `learn`"),
        "{text}"
    );
}

/// The first digest of sources in a plan or journal, with its key.
fn made_by(text: &str) -> String {
    let digest = text.split("\"program\":\"").nth(1).unwrap();
    let digest = digest.split('"').next().unwrap();
    assert_eq!(digest.len(), 32, "{digest}");
    format!("\"program\":\"{digest}\"")
}

#[test]
fn plans_that_do_not_fit_are_refused_and_results_stay() {
    let folder = prepared(SWEEP);
    let folder = folder.path();
    for verb in ["status", "collect", "report"] {
        let text = refused(folder, verb);
        assert!(text.contains("there is no plan here"), "{text}");
    }
    good(folder, "run");
    good(folder, "collect");
    let plan = folder.join("out/plan.jsonl");
    let results = || std::fs::read(folder.join("out/results.csv")).unwrap();
    let (whole, table) = (std::fs::read_to_string(&plan).unwrap(), results());
    let version = made_by(&whole);
    let spoilt: &[(String, &str)] = &[
        (
            whole.replace(&version, "\"program\":\"0.0.0\""),
            "made with other sources of its study (0.0.0",
        ),
        (whole.replace("\"key\"", "\"kee\""), "line 2"),
        (
            whole.replace("\"instance\":9", "\"instance\":900"),
            "names no arm or instance",
        ),
        (
            whole.lines().take(5).map(|l| format!("{l}\n")).collect(),
            "it ends after 4 of 40 tasks",
        ),
        ("{}\n".into(), "this is no plan of a sweep"),
        (String::new(), "this is no plan of a sweep"),
    ];
    for (text, wanted) in spoilt {
        std::fs::write(&plan, text).unwrap();
        for verb in ["run", "retry", "status", "collect", "report"] {
            let message = refused(folder, verb);
            assert!(message.contains(wanted), "{verb}: {message}");
        }
    }
    assert_eq!(results(), table);
    // Planned anew, nothing has to be run again.
    good(folder, "plan");
    let ran = edifice(folder, &["run", "s.toml", "--out", "out", "--json"]).success();
    let text = String::from_utf8_lossy(&ran.get_output().stdout).into_owned();
    assert!(text.contains("\"failed\":0,\"finished\":0"), "{text}");
    good(folder, "collect");
    assert_eq!(results(), table);
    // A report that asks for something else now is that of another plan, too.
    std::fs::write(folder.join("s.toml"), SWEEP.replace("left_out", "optimal")).unwrap();
    let text = refused(folder, "report");
    assert!(text.contains("has changed since the plan"), "{text}");
    good(folder, "plan");
    good(folder, "report");
}

#[test]
fn results_of_other_sources_do_not_count() {
    let folder = prepared(SWEEP);
    let folder = folder.path();
    good(folder, "run");
    let journal = folder.join("out/journal/0-of-1.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    let version = made_by(&text);
    std::fs::write(&journal, text.replace(&version, "\"program\":\"0.0.0\"")).unwrap();
    let status = edifice(folder, &["status", "s.toml", "--out", "out"]).success();
    let text = String::from_utf8_lossy(&status.get_output().stderr).into_owned();
    assert!(text.contains("40 results of other sources"), "{text}");
    let text = refused(folder, "report");
    assert!(text.contains("40 of 40 tasks have no result"), "{text}");
}

#[test]
fn wrong_usage_is_exit_code_2_and_a_wrong_shard_1() {
    let folder = prepared(SWEEP);
    let folder = folder.path();
    edifice(folder, &["run", "s.toml"]).failure().code(2);
    edifice(folder, &["runn", "s.toml", "--out", "out"])
        .failure()
        .code(2);
    edifice(
        folder,
        &["submit", "s.toml", "--out", "out", "--engine", "cron"],
    )
    .failure()
    .code(2);
    for bad in ["2/2", "0/0", "1", "", "a/b", "1/2/3"] {
        let shard = format!("--shard={bad}");
        edifice(folder, &["run", "s.toml", "--out", "out", &shard])
            .failure()
            .code(1);
    }
    edifice(folder, &["examples", "ablatoin"]).failure().code(1);
    edifice(folder, &["run", "none.toml", "--out", "out"])
        .failure()
        .code(1);
}

#[test]
fn every_example_is_a_plan_and_every_study_has_one() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let list = edifice(folder, &["examples", "--json"]).success();
    let text = String::from_utf8_lossy(&list.get_output().stdout).into_owned();
    let list: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut used = Vec::new();
    for example in list["examples"].as_array().unwrap() {
        let name = example["name"].as_str().unwrap();
        let printed = edifice(folder, &["examples", name]).success();
        std::fs::write(folder.join("s.toml"), &printed.get_output().stdout).unwrap();
        edifice(folder, &["plan", "s.toml", "--out", name]).success();
        let plan = std::fs::read_to_string(folder.join(name).join("plan.jsonl")).unwrap();
        let head: serde_json::Value = serde_json::from_str(plan.lines().next().unwrap()).unwrap();
        used.push(head["study"].as_str().unwrap().to_owned());
        assert!(!example["about"].as_str().unwrap().is_empty());
    }
    let list = edifice(folder, &["studies", "--json"]).success();
    let text = String::from_utf8_lossy(&list.get_output().stdout).into_owned();
    let list: serde_json::Value = serde_json::from_str(&text).unwrap();
    let studies = list["studies"].as_array().unwrap();
    assert!(studies.len() >= 10);
    for study in studies {
        let name = study["name"].as_str().unwrap();
        // Generation has no ablation of its paper; its test is below.
        if name != "building_exteriors/generate" {
            assert!(used.iter().any(|u| u == name), "{name} has no example");
        }
        for setting in study["settings"].as_array().unwrap() {
            assert!(
                !setting["meaning"].as_str().unwrap().is_empty(),
                "{name}: {setting}"
            );
            assert!(
                !setting["kind"].as_str().unwrap().is_empty(),
                "{name}: {setting}"
            );
        }
    }
}

#[test]
fn every_generic_study_and_that_of_generation_runs_and_reports() {
    let cases = [
        (
            "optim/genetic",
            "*.knapsack.json",
            "generations = 5",
            "[[grid]]\nset.crossover = [0.9, 0.0]",
            10,
        ),
        (
            "model/gmm",
            "mixture_*.csv",
            "most = 4",
            "[[grid]]\nset.covariance = [\"full\", \"tied\"]",
            3,
        ),
        (
            "model/network",
            "asia.bif",
            "rows = 100",
            "[[grid]]\nset.missing = [0.0, 0.5]",
            1,
        ),
        (
            "building_exteriors/generate",
            "houses.buildings.jsonl",
            "seed = 1",
            "[[grid]]\nset.method = [\"best\", \"nearest\"]",
            1,
        ),
    ];
    for (study, data, base, arms, instances) in cases {
        let text = format!(
            "study = \"{study}\"\ndata = [\"{data}\"]\nseeds = 3\n[base]\n{base}\n{arms}\n"
        );
        let folder = prepared(&text);
        let folder = folder.path();
        good(folder, "run");
        good(folder, "report");
        let table = std::fs::read_to_string(folder.join("out/results.csv")).unwrap();
        assert!(!table.contains("failure"), "{study}: {table}");
        let report = std::fs::read_to_string(folder.join("out/report/report.csv")).unwrap();
        assert_eq!(report.lines().count(), 3, "{study}: {report}");
        let tasks: std::collections::BTreeSet<String> = table
            .lines()
            .skip(1)
            .map(|line| line.rsplitn(3, ',').nth(2).unwrap().to_owned())
            .collect();
        assert_eq!(tasks.len(), 2 * 3 * instances, "{study}");
    }
}

#[test]
fn a_report_stands_beside_the_others() {
    let folder = prepared(SWEEP);
    let folder = folder.path();
    good(folder, "run");
    edifice(
        folder,
        &["report", "s.toml", "--out", "out", "--into", "reports"],
    )
    .success();
    let index = std::fs::read_to_string(folder.join("reports/index.html")).unwrap();
    assert!(index.contains("Sweep of optim/annealing: s"), "{index}");
    assert!(
        index.contains("href=\"#sweeps/s-report\"") && index.contains("id=\"sweeps/s-report\"")
    );
    for name in [
        "report.md",
        "report.tex",
        "results.csv",
        "sweep.toml",
        "anytime.png",
        "targets.svg",
        "run.json",
    ] {
        assert!(
            folder.join("reports/sweeps/s").join(name).is_file(),
            "{name}"
        );
        if name.ends_with("png") || name.ends_with("csv") {
            assert!(index.contains(&format!("sweeps/s/{name}")), "{name}");
        }
    }
}
