//! The leaderboard of completion says what its sweep finds, and each row is in its form.

use std::collections::BTreeMap;
use std::path::Path;

use assert_cmd::Command;
use edifice_experiments::sweep::examples::examples;

const BOARD: &str = include_str!("../../datasets/structure_completion/leaderboard.csv");
const TASKS: [&str; 5] = ["r20", "r50", "side50", "corner36", "bottom40"];
/// Layouts that are hidden and completed.
const LAYOUTS: usize = 8;

fn rows() -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_reader(BOARD.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let names = [
        "method",
        "by",
        "task",
        "facades",
        "f1",
        "iou",
        "count_error",
        "bundle",
    ];
    assert_eq!(header.iter().collect::<Vec<_>>(), names);
    let rows = reader.records().map(|row| row.expect("a row"));
    rows.map(|row| row.iter().map(str::to_owned).collect())
        .collect()
}

#[test]
fn every_method_has_a_row_for_each_task() {
    let mut tasks: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for row in rows() {
        let number = |k: usize| row[k].parse::<f64>().expect("a number");
        assert_eq!(row[3], LAYOUTS.to_string(), "{row:?}");
        assert!(
            [4, 5].iter().all(|k| (0.0..=1.0).contains(&number(*k))),
            "{row:?}"
        );
        assert!(number(6) >= 0.0, "{row:?}");
        let digest = row[7].len() == 64 && row[7].bytes().all(|b| b.is_ascii_hexdigit());
        // What the project itself found needs no bundle: the test below runs it.
        assert!(
            digest || (row[1] == "edifice" && row[7].is_empty()),
            "{row:?}"
        );
        tasks
            .entry(row[0].clone())
            .or_default()
            .push(row[2].clone());
    }
    assert!(tasks.len() >= 5, "{tasks:?}");
    for (method, own) in tasks {
        assert_eq!(own, TASKS, "{method}");
    }
}

#[test]
fn the_rows_of_two_baselines_are_found_again() {
    let board = examples()
        .into_iter()
        .find(|e| e.name == "structure_completion_leaderboard");
    let text = board.expect("the sweep").text;
    let all = "[\"mirror\", \"lattice\", \"nearest\", \"low-rank\", \"best\"]";
    let fast = text.replace(all, "[\"mirror\", \"lattice\"]");
    assert_ne!(fast, text);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    std::fs::write(path.join("s.toml"), fast).expect("a sweep");
    sweep(path, &["run", "s.toml", "--out", "out"]);
    sweep(path, &["collect", "s.toml", "--out", "out"]);
    let mut found: BTreeMap<(String, String), Vec<f64>> = BTreeMap::new();
    let mut reader = csv::Reader::from_path(path.join("out/results.csv")).expect("results");
    for row in reader.records() {
        let row = row.expect("a row");
        // Of settings `method=mirror,task=r20` the arm is named.
        let key = (row[1].to_owned(), row[4].to_owned());
        found
            .entry(key)
            .or_default()
            .push(row[5].parse().expect("a number"));
    }
    let mut compared = 0;
    for row in rows()
        .iter()
        .filter(|row| ["mirror", "lattice"].contains(&row[0].as_str()))
    {
        for (metric, printed) in [("f1", &row[4]), ("iou", &row[5]), ("count_error", &row[6])] {
            let own = found.iter().filter(|((arm, of), _)| {
                let words: Vec<&str> = arm.split([',', '=', ' ']).collect();
                of == metric && words.contains(&row[0].as_str()) && words.contains(&row[2].as_str())
            });
            let own: Vec<&Vec<f64>> = own.map(|(_, values)| values).collect();
            assert_eq!(own.len(), 1, "{row:?} among {:?}", found.keys());
            assert_eq!(own[0].len(), LAYOUTS, "{row:?}");
            let mean = own[0].iter().sum::<f64>() / LAYOUTS as f64;
            assert_eq!(&format!("{mean:.4}"), printed, "{row:?}, {metric}");
            compared += 1;
        }
    }
    assert_eq!(compared, 30);
    rows_stand_by_their_bundle(path);
}

/// Bundles the sweep, and checks a board whose rows name the bundle: as found, with another number, another task, or none.
fn rows_stand_by_their_bundle(path: &Path) {
    let digest = bundle(path);
    let row = |line: &str| line.starts_with("mirror,") && line.contains(",side50,");
    let own = BOARD.lines().find(|line| row(line)).expect("a row");
    let named = own.replacen("edifice", "somebody", 1) + &digest;
    let verify = |board: String| {
        std::fs::write(path.join("board.csv"), board).expect("a board");
        let mut command = Command::cargo_bin("edifice").expect("the program");
        let words = ["sweep", "verify", "b.zip", "--sample", "0"];
        command.current_dir(path).args(words);
        let done = command.args(["--board", "board.csv"]).assert();
        let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        (done.get_output().status.code(), said)
    };
    let (code, said) = verify(format!("{BOARD}{named}\n"));
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("1 rows of board.csv stand"), "{said}");
    for (board, expected) in [
        (BOARD.to_owned(), "no row names the bundle"),
        (
            format!("{BOARD}{}\n", named.replace(",3.0000,", ",2.0000,")),
            "row 27: count_error is 2.0000 over 8 facades, the bundle has 3.0000 over 8",
        ),
        (
            format!("{BOARD}{}\n", named.replace(",8,", ",9,")),
            "over 9 facades, the bundle has 0.5201 over 8",
        ),
        (
            format!("{BOARD}{}\n", named.replace("mirror", "mine")),
            "0 arms of the bundle have `mine` and `side50` in their names",
        ),
        (
            format!("{BOARD}{}\n", named.replace("side50", "r20")),
            "f1 is 0.5201",
        ),
    ] {
        let (code, said) = verify(board);
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains(expected), "{expected}: {said}");
    }
}

/// Packs the sweep as `b.zip` and returns its digest.
fn bundle(path: &Path) -> String {
    let words = "sweep bundle s.toml --out out -o b.zip --json".split(' ');
    let mut command = Command::cargo_bin("edifice").expect("the program");
    let done = command.current_dir(path).args(words).assert().success();
    let told: serde_json::Value =
        serde_json::from_slice(&done.get_output().stdout).expect("an object");
    told["sha256"].as_str().expect("a digest").to_owned()
}

/// Somebody's sweep of other facades, or by masks of a seed, proves no row.
#[test]
fn other_facades_and_masks_prove_no_row() {
    let board = examples()
        .into_iter()
        .find(|e| e.name == "structure_completion_leaderboard");
    let text = board.expect("the sweep").text;
    let line = text.lines().find(|line| line.starts_with("data"));
    let all = line.expect("its facades");
    let others = "data = [\"layouts/office_*.facade.json\"]";
    for (data, frozen, expected) in [
        (others, true, "has other facades than the leaderboard"),
        (all, false, "does not hide by frozen masks"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path();
        let text = format!(
            "study = \"structure_completion/complete\"\n{data}\nlearn = [\"layouts/*.facade.json\"]\nseeds = [1]\n\
             [base]\nmethod = \"mirror\"\ntask = \"side50\"\nfrozen = {frozen}\n[[arm]]\nname = \"mirror side50\"\n"
        );
        std::fs::write(path.join("s.toml"), text).expect("a sweep");
        sweep(path, &["run", "s.toml", "--out", "out"]);
        let digest = bundle(path);
        let board = format!("{BOARD}mirror,me,side50,8,1.0,1.0,0.0,{digest}\n");
        std::fs::write(path.join("board.csv"), board).expect("a board");
        let mut command = Command::cargo_bin("edifice").expect("the program");
        let words = [
            "sweep",
            "verify",
            "b.zip",
            "--sample",
            "0",
            "--board",
            "board.csv",
        ];
        let failed = command
            .current_dir(path)
            .args(words)
            .assert()
            .failure()
            .code(1);
        let said = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(said.contains(expected), "{said}");
    }
}

fn sweep(folder: &Path, words: &[&str]) {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    command
        .current_dir(folder)
        .arg("sweep")
        .args(words)
        .assert()
        .success();
}
