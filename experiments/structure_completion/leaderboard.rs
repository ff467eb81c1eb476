//! Rows of the leaderboard of completion beside the bundle that they name.
//!
//! A row says of a method and a task the mean of each metric over the facades. It stands if the bundle whose digest it names is a sweep of
//! the facades of the leaderboard, learns from the same layouts, hides by frozen masks, has an arm whose name has the method
//! and the task among its words, and the means of that arm, rounded to four decimals, are those of the row.

use std::collections::BTreeMap;
use std::path::Path;

use edifice_base::{Error, Result};

use edifice_frame::provenance;
use edifice_sweep::Study;
use edifice_sweep::collect::RESULTS;
use edifice_sweep::examples::examples;
use edifice_sweep::instances::Instance;
use edifice_sweep::plan::{Head, Plan};

/// The sweep of the leaderboard among those that ship.
const BOARD: &str = "structure_completion_leaderboard";
/// Columns that are no metrics.
const ABOUT: [&str; 5] = ["method", "by", "task", "facades", "bundle"];

/// The reasons why a row does not stand.
#[derive(Debug, thiserror::Error)]
enum RowError {
    #[error("no row names the bundle {0}")]
    NoRow(String),
    #[error("the column `{0}` is missing")]
    NoColumn(&'static str),
    #[error("row {row}: the sweep of the bundle {wrong}")]
    Sweep { row: usize, wrong: &'static str },
    #[error(
        "row {row}: {found} arms of the bundle have `{method}` and `{task}` in their names, one is wanted"
    )]
    Arms {
        row: usize,
        found: usize,
        method: String,
        task: String,
    },
    #[error("row {row}: the arm `{arm}` {wrong}")]
    Arm {
        row: usize,
        arm: String,
        wrong: &'static str,
    },
    #[error(
        "row {row}: {metric} is {told} over {of} facades, the bundle has {found} over {facades}"
    )]
    Value {
        row: usize,
        metric: String,
        told: String,
        of: String,
        found: String,
        facades: usize,
    },
}

/// Checks the rows of a leaderboard that name a bundle, which is unpacked in a folder, and returns how many they are.
///
/// # Errors
/// [`Error::Content`] for the first row that does not stand, and where no row names the bundle; those of reading.
pub fn check(board: &Path, bundle: &Path, unpacked: &Path, studies: &[Study]) -> Result<usize> {
    let digest = provenance::digest(bundle)?;
    let plan = Plan::read(unpacked, studies)?;
    let agrees = agreed(&plan.head, unpacked, studies)?;
    let results = results(unpacked)?;
    let wrong = |e: RowError| Error::content(board, e);
    let unread = |e: csv::Error| Error::content(board, e);
    let mut reader = csv::Reader::from_path(board).map_err(unread)?;
    let header = reader.headers().map_err(unread)?.clone();
    let place = |name: &'static str| {
        let found = header.iter().position(|column| column == name);
        found.ok_or_else(|| wrong(RowError::NoColumn(name)))
    };
    let [method, _, task, facades, named] = {
        let mut places = [0; 5];
        for (to, name) in places.iter_mut().zip(ABOUT) {
            *to = place(name)?;
        }
        places
    };
    let mut checked = 0;
    for (index, record) in reader.records().enumerate() {
        // Counted as in the file, whose first line is the header.
        let (record, row) = (record.map_err(unread)?, index + 2);
        if record[named] != digest {
            continue;
        }
        checked += 1;
        agrees.map_err(|wrong_of| {
            wrong(RowError::Sweep {
                row,
                wrong: wrong_of,
            })
        })?;
        let (method, task) = (&record[method], &record[task]);
        let is_meant = |name: &str| {
            let words: Vec<&str> = name.split([',', '=', ' ']).collect();
            words.contains(&method) && words.contains(&task)
        };
        let arms: Vec<_> = plan
            .head
            .arms
            .iter()
            .filter(|arm| is_meant(&arm.name))
            .collect();
        let [arm] = arms[..] else {
            return Err(wrong(RowError::Arms {
                row,
                found: arms.len(),
                method: method.to_owned(),
                task: task.to_owned(),
            }));
        };
        let no = |wrong_of: &'static str| {
            let arm = arm.name.clone();
            Err(wrong(RowError::Arm {
                row,
                arm,
                wrong: wrong_of,
            }))
        };
        if arm.settings.get("frozen") != Some(&true.into()) {
            return no("does not hide by frozen masks");
        }
        if arm.settings.get("task").and_then(|t| t.as_str()) != Some(task) {
            return no("has another task");
        }
        let Some(metrics) = results.get(&arm.name) else {
            return no("has no results");
        };
        let columns = header.iter().enumerate();
        for (k, metric) in columns.filter(|(_, name)| !ABOUT.contains(name)) {
            let values = metrics.get(metric).map(Vec::as_slice).unwrap_or_default();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let found = format!("{mean:.4}");
            if found != record[k] || record[facades] != values.len().to_string() {
                return Err(wrong(RowError::Value {
                    row,
                    metric: metric.to_owned(),
                    told: record[k].to_owned(),
                    of: record[facades].to_owned(),
                    found,
                    facades: values.len(),
                }));
            }
        }
    }
    match checked {
        0 => Err(wrong(RowError::NoRow(digest))),
        checked => Ok(checked),
    }
}

/// Compares the question of a sweep with that of the leaderboard.
fn agreed(
    head: &Head,
    unpacked: &Path,
    studies: &[Study],
) -> Result<std::result::Result<(), &'static str>> {
    let board = examples().into_iter().find(|example| example.name == BOARD);
    let text = board.map(|example| example.text).unwrap_or_default();
    let folder = unpacked.join("board");
    std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
    let file = folder.join("board.toml");
    edifice_base::file::write_atomic(&file, text.as_bytes())?;
    let own = Plan::make(&file, &folder, studies)?.head;
    let digests = |files: &[Instance]| {
        let mut all: Vec<String> = files.iter().map(|file| file.digest.clone()).collect();
        all.sort();
        all
    };
    Ok(match () {
        () if head.study != own.study => Err("is of another study"),
        () if digests(&head.instances) != digests(&own.instances) => {
            Err("has other facades than the leaderboard")
        }
        () if digests(&head.learn) != digests(&own.learn) => {
            Err("learns from other layouts than the leaderboard")
        }
        () => Ok(()),
    })
}

/// The values of a sweep by arm and metric.
fn results(unpacked: &Path) -> Result<BTreeMap<String, BTreeMap<String, Vec<f64>>>> {
    let path = unpacked.join(RESULTS);
    let unread = |e: csv::Error| Error::content(&path, e);
    let mut found: BTreeMap<String, BTreeMap<String, Vec<f64>>> = BTreeMap::new();
    for record in csv::Reader::from_path(&path).map_err(unread)?.records() {
        let record = record.map_err(unread)?;
        // A failure is text, and no facade.
        if let Ok(value) = record[5].parse() {
            let own = found.entry(record[1].to_owned()).or_default();
            own.entry(record[4].to_owned()).or_default().push(value);
        }
    }
    Ok(found)
}
