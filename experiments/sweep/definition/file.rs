//! Reading a sweep file. Every mistake is named with its line and column, and the nearest right word.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::task::TaskOptions;
use crate::command::Written;
use crate::study::{Better, Study};
use edifice_base::{Error, Result};
use edifice_frame::place::{place, suggestion};

/// Settings by name, each with its place in the file.
pub(super) type Settings = BTreeMap<Spanned<String>, Spanned<toml::Value>>;
/// Lists of settings by name.
pub(super) type Lists = BTreeMap<Spanned<String>, Spanned<Vec<toml::Value>>>;

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    study: Spanned<String>,
    data: Spanned<Vec<String>>,
    learn: Option<Spanned<Vec<String>>>,
    seeds: Option<Spanned<Seeds>>,
    pair: Option<Spanned<Vec<String>>>,
    #[serde(default)]
    pub base: Settings,
    #[serde(default)]
    pub arm: Vec<ArmEntry>,
    #[serde(default)]
    pub grid: Vec<Spanned<GridEntry>>,
    #[serde(default)]
    pub exclude: Vec<Spanned<Settings>>,
    report: Option<Spanned<ReportOptions>>,
    task: Option<Spanned<TaskOptions>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArmEntry {
    pub name: Spanned<String>,
    #[serde(default)]
    pub set: Settings,
    /// A foreign program that answers instead of a built-in method.
    pub command: Option<Spanned<Written>>,
    /// Files that it needs, relative to the sweep file.
    pub files: Option<Spanned<Vec<String>>>,
    /// Seconds after which it has failed.
    pub timeout: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GridEntry {
    /// Every combination of these.
    #[serde(default)]
    pub set: Lists,
    /// The first of each, the second of each, ...
    #[serde(default)]
    pub zip: Lists,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Seeds {
    Count(u32),
    List(Vec<u64>),
}

/// The options of the report.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReportOptions {
    /// Metric; the study's first unless given.
    pub metric: Option<String>,
    /// The values that are better.
    pub better: Option<Better>,
    /// Name of the arm that the others are compared with; the first unless given.
    pub reference: Option<String>,
    /// Abscissa of anytime curves: `evaluations`.
    pub anytime: Option<String>,
    /// Targets of runtime distributions, as multiples of the best value known of an instance.
    #[serde(default)]
    pub targets: Vec<f64>,
}

/// A checked sweep file, its arms still as written.
pub struct Definition {
    /// Index among the studies.
    pub study: usize,
    /// Patterns of instances.
    pub data: Vec<String>,
    /// Patterns of files to learn from.
    pub learn: Vec<String>,
    /// Seeds.
    pub seeds: Vec<u64>,
    /// True if all arms meet the same chance on an instance and seed.
    pub paired_seeds: bool,
    /// The options of the report.
    pub report: ReportOptions,
    /// The needs of a task.
    pub task: TaskOptions,
    pub(super) file: File,
    pub(super) text: String,
}

/// A fault of a sweep file, as a sentence.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Wrong(String);

impl Definition {
    /// An error at a place of the file.
    pub(super) fn wrong(&self, path: &Path, at: &std::ops::Range<usize>, message: String) -> Error {
        wrong(path, &self.text, at, message)
    }
}

fn wrong(path: &Path, text: &str, at: &std::ops::Range<usize>, message: String) -> Error {
    Error::input(path, place(text, at), Wrong(message))
}

/// Reads and checks a sweep file.
///
/// # Errors
/// [`Error::Io`]; [`Error::Input`] with line, column and the nearest right word.
pub fn read(path: &Path, studies: &[Study]) -> Result<Definition> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::io(path, "read", e))?;
    let file: File = toml::from_str(&text).map_err(|e| {
        let at = e.span().unwrap_or(0..0);
        wrong(path, &text, &at, explained(e.message()))
    })?;
    let named = file.study.get_ref();
    let Some(study) = studies.iter().position(|study| study.name == named) else {
        let names = studies.iter().map(|study| study.name);
        let message = format!("there is no study `{named}`{}", suggestion(named, names));
        return Err(wrong(path, &text, &file.study.span(), message));
    };
    if file.data.get_ref().is_empty() {
        return Err(wrong(
            path,
            &text,
            &file.data.span(),
            "no instances are named".into(),
        ));
    }
    if let Some(learn) = &file.learn
        && !studies[study].learns
    {
        let message = format!("`{named}` learns from no files");
        return Err(wrong(path, &text, &learn.span(), message));
    }
    let seeds = match file.seeds.as_ref().map(Spanned::get_ref) {
        None => vec![0],
        Some(Seeds::Count(count)) => (0..u64::from(*count)).collect(),
        Some(Seeds::List(list)) => list.clone(),
    };
    let mut distinct = seeds.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if seeds.is_empty() || distinct.len() < seeds.len() {
        let span = file.seeds.as_ref().map_or(0..0, Spanned::span);
        let message = "seeds are a number of at least 1, or a list without repetition".to_owned();
        return Err(wrong(path, &text, &span, message));
    }
    if let Some(pair) = &file.pair {
        for word in pair.get_ref() {
            if !["instance", "facade", "house", "city", "seed"].contains(&word.as_str()) {
                let message = format!("arms are paired by `instance` and `seed`, not by `{word}`");
                return Err(wrong(path, &text, &pair.span(), message));
            }
        }
    }
    let paired_seeds = match &file.pair {
        None => true,
        Some(pair) => pair.get_ref().iter().any(|word| word == "seed"),
    };
    let (report, task) = (options(&file.report), options(&file.task));
    if let Err(message) = check_report(&report.1, studies[study].metrics) {
        return Err(wrong(path, &text, &report.0, message));
    }
    if let Err(message) = task.1.check() {
        return Err(wrong(path, &text, &task.0, message));
    }
    Ok(Definition {
        study,
        data: file.data.get_ref().clone(),
        learn: file
            .learn
            .clone()
            .map_or_else(Vec::new, Spanned::into_inner),
        seeds,
        paired_seeds,
        report: report.1,
        task: task.1,
        file,
        text,
    })
}

/// A table of the file and where it is.
fn options<T: Clone + Default>(table: &Option<Spanned<T>>) -> (std::ops::Range<usize>, T) {
    let table = table.as_ref();
    table.map_or_else(Default::default, |t| (t.span(), t.get_ref().clone()))
}

/// Why a report cannot be asked for so.
fn check_report(
    report: &ReportOptions,
    metrics: &[(&'static str, Better)],
) -> std::result::Result<(), String> {
    if let Some(metric) = &report.metric
        && metrics.iter().all(|(name, _)| name != metric)
    {
        let near = suggestion(metric, metrics.iter().map(|(name, _)| *name));
        return Err(format!("metric: the study has no metric `{metric}`{near}"));
    }
    if let Some(word) = report.anytime.as_ref().filter(|w| *w != "evaluations") {
        return Err(format!(
            "anytime: curves are over `evaluations`, not `{word}`"
        ));
    }
    match report
        .targets
        .iter()
        .find(|t| !(t.is_finite() && **t >= 1.0))
    {
        Some(bad) => Err(format!(
            "targets: {bad} is no multiple of the best value, at least 1"
        )),
        None => Ok(()),
    }
}

/// serde's message about an unknown key, with the nearest right one.
fn explained(message: &str) -> String {
    let words: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match words.split_first() {
        Some((word, expected)) if message.starts_with("unknown field") => {
            format!("{message}{}", suggestion(word, expected.iter().copied()))
        }
        _ => message.trim_end().to_owned(),
    }
}
