//! Every experiment, end to end, at the smoke budget: by the library, and by the program alone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

use edifice_experiments::{ALL, Budget, Experiment, Options, run};

use crate::cases::cases;

fn options(out: &Path, threads: usize, only: Vec<String>) -> Options {
    Options {
        only,
        data: None,
        own: Vec::new(),
        seed: 1,
        budget: Budget::Smoke,
        out: out.to_path_buf(),
        threads,
        verify: false,
    }
}

/// All files of a report that are the same wherever it is made again: not those of times, of provenance and of locks.
fn lasting(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![out.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            match path.is_dir() {
                true => folders.push(path),
                false
                    if name.contains(".times.") || name == "provenance.json" || name == ".lock" => {
                }
                false => {
                    let bytes = std::fs::read(&path).expect("a file");
                    let name = path.strip_prefix(out).expect("a file of the report");
                    files.insert(name.to_path_buf(), bytes);
                }
            }
        }
    }
    files
}

fn check(experiment: &'static Experiment, out: &Path) {
    let folder = out.join(experiment.slug);
    let text = std::fs::read_to_string(folder.join("run.json")).expect("run.json");
    let about: serde_json::Value = serde_json::from_str(&text).expect("run.json is JSON");
    for artefact in experiment.artefacts {
        let made = &about["artefacts"][artefact.name];
        assert_eq!(made["seed"], 1, "{}", artefact.name);
        for file in made["files"].as_array().expect("files") {
            let path = folder.join(file.as_str().expect("a name"));
            let length = std::fs::metadata(&path).map_or(0, |m| m.len());
            assert!(length > 0, "{} is missing or empty", path.display());
        }
        if made["skipped"].is_null() {
            let csv = folder.join(format!("{}.csv", artefact.name));
            let csv = std::fs::read_to_string(csv).expect("a CSV file");
            let header = "experiment,dataset,method,instance,seed,metric,value,unit";
            assert!(csv.starts_with(header), "{}", artefact.name);
            let own = |line: &str| line.starts_with(&format!("{},", experiment.slug));
            assert!(csv.lines().skip(1).all(own), "{}", artefact.name);
        }
    }
    let index = std::fs::read_to_string(out.join("index.html")).expect("index.html");
    assert!(index.contains(experiment.paper));
    assert!(!folder.join(".work").exists(), "journals of a finished run");
}

/// The artefacts that run with one thread, too: a sixteenth of them, or all.
fn with_one_thread() -> Vec<String> {
    let mut names: Vec<&str> = Vec::new();
    for artefact in ALL.iter().flat_map(|experiment| experiment.artefacts) {
        if !names.contains(&artefact.name) {
            names.push(artefact.name);
        }
    }
    let every = names.len() / cases(cases(names.len()));
    names
        .into_iter()
        .step_by(every.max(1))
        .map(str::to_owned)
        .collect()
}

/// True if a file of the run of some artefacts is that of the run of all. The index and the pages of a run tell of all of them: of
/// those the artefacts that both have must be told alike.
fn agrees(name: &Path, some: &[u8], all: &[u8]) -> bool {
    if name.file_name().is_none_or(|file| file != "run.json") {
        return some == all || name == Path::new("index.html");
    }
    let [some, all] = [some, all].map(|bytes| {
        let about: serde_json::Value = serde_json::from_slice(bytes).expect("run.json is JSON");
        about["artefacts"].as_object().expect("artefacts").clone()
    });
    !some.is_empty() && some.iter().all(|(name, made)| all.get(name) == Some(made))
}

#[test]
fn every_experiment_runs_anywhere_and_threads_do_not_matter() {
    let one = tempfile::tempdir().expect("a folder");
    let two = tempfile::tempdir().expect("a folder");
    // As installed: a copy of the program in an empty folder, with no data but what it carries.
    let installed = tempfile::tempdir().expect("a folder");
    let program = installed.path().join("edifice");
    std::fs::copy(env!("CARGO_BIN_EXE_edifice"), &program).expect("copied");
    // All at once, since each leaves a core idle; two runs into one report add up. The threads are tried on a sixteenth of the artefacts, on
    // all where all cases are (`.ci/full`).
    let slugs: Vec<&str> = ALL.iter().map(|experiment| experiment.slug).collect();
    let installed_run = |papers: &[&str]| {
        Command::new(&program)
            .current_dir(installed.path())
            .env_remove("EDIFICE_DATA")
            .args(["reproduce", "--budget", "smoke", "--threads", "2", "--out"])
            .arg(two.path())
            .args(papers)
            .assert()
            .success();
    };
    let (some, others) = slugs.split_at(slugs.len() / 2);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let some = options(one.path(), 1, with_one_thread());
            let report = run(ALL, &some).expect("experiments run");
            assert!(report.failed.is_empty(), "{:?}", report.failed);
        });
        scope.spawn(|| installed_run(some));
        installed_run(others);
    });
    assert_eq!(
        std::fs::read_dir(installed.path())
            .expect("a folder")
            .count(),
        1
    );

    for experiment in ALL {
        check(experiment, two.path());
    }
    let [one, two] = [one.path(), two.path()].map(lasting);
    assert!(two.len() > 200, "{}", two.len());
    assert!(one.len() >= cases(cases(two.len())) / 3, "{}", one.len());
    let other = one.iter().filter(|(name, bytes)| {
        let all = two.get(*name);
        all.is_none_or(|all| !agrees(name, bytes, all))
    });
    let other: Vec<_> = other.map(|(name, _)| name).collect();
    assert!(
        other.is_empty(),
        "these depend on the run or on the number of threads: {other:?}"
    );
}

#[test]
fn an_unknown_artefact_is_named() {
    let out = tempfile::tempdir().expect("a folder");
    let options = options(out.path(), 1, vec!["table_99".into()]);
    let message = run(ALL, &options).expect_err("no such table").to_string();
    assert!(
        message.contains("table_99") && message.contains("table_1"),
        "{message}"
    );
}
