//! Every experiment, end to end, at the smoke budget: by the library, and by the program alone.

use std::path::Path;

use assert_cmd::Command;

use edifice_experiments::{ALL, Budget, Experiment, Options, run};

fn options(out: &Path, threads: usize) -> Options {
    Options {
        only: Vec::new(),
        data: None,
        own: Vec::new(),
        seed: 1,
        budget: Budget::Smoke,
        out: out.to_path_buf(),
        threads,
        verify: false,
    }
}

/// The rows of a CSV but for measured times and memory.
fn without_times(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a CSV file");
    let measured = ["seconds", "peak_memory"];
    let same = |line: &&str| !measured.iter().any(|m| line.contains(m)) && !line.ends_with(",s");
    text.lines().filter(same).collect::<Vec<_>>().join("\n")
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
            let csv = without_times(&folder.join(format!("{}.csv", artefact.name)));
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

#[test]
fn every_experiment_runs_anywhere_and_threads_do_not_matter() {
    let one = tempfile::tempdir().expect("a folder");
    let two = tempfile::tempdir().expect("a folder");
    // As installed: a copy of the program in an empty folder, with no data but what it carries.
    let installed = tempfile::tempdir().expect("a folder");
    let program = installed.path().join("edifice");
    std::fs::copy(env!("CARGO_BIN_EXE_edifice"), &program).expect("copied");
    // Both at once: each leaves a core idle.
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let report = run(ALL, &options(one.path(), 1)).expect("experiments run");
            assert!(report.failed.is_empty(), "{:?}", report.failed);
        });
        Command::new(&program)
            .current_dir(installed.path())
            .env_remove("EDIFICE_DATA")
            .args(["reproduce", "--budget", "smoke", "--threads", "2", "--out"])
            .arg(two.path())
            .assert()
            .success();
    });
    assert_eq!(
        std::fs::read_dir(installed.path())
            .expect("a folder")
            .count(),
        1
    );

    for experiment in ALL {
        check(experiment, one.path());
        check(experiment, two.path());
    }
    for experiment in ALL {
        for artefact in experiment.artefacts {
            let name = format!("{}/{}.csv", experiment.slug, artefact.name);
            if one.path().join(&name).exists() {
                let [a, b] = [one.path(), two.path()].map(|out| without_times(&out.join(&name)));
                assert!(a == b, "{name} depends on the number of threads");
            }
        }
    }
}

#[test]
fn an_unknown_artefact_is_named() {
    let out = tempfile::tempdir().expect("a folder");
    let mut options = options(out.path(), 1);
    options.only = vec!["table_99".into()];
    let message = run(ALL, &options).expect_err("no such table").to_string();
    assert!(
        message.contains("table_99") && message.contains("table_1"),
        "{message}"
    );
}
