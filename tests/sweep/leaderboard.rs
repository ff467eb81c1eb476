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
