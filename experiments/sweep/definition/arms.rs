//! The arms of a sweep: named ones, and those of grids.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use toml::Spanned;

use super::file::{ArmEntry, Definition, Lists, Settings};
use crate::command::Command;
use crate::study::Study;
use edifice_base::{Error, Result};
use edifice_frame::place::suggestion;

/// A configuration that is compared with others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Arm {
    /// Its name.
    pub name: String,
    /// All settings.
    pub settings: Map<String, Value>,
    /// The program that answers instead of a built-in method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<Command>,
}

/// The faults of the arms.
#[derive(Debug, thiserror::Error)]
enum ArmError {
    #[error("the sweep has no arm: write [[arm]] or [[grid]], and leave some of them in")]
    None,
    #[error("two arms are called `{0}`")]
    SameName(String),
    #[error("the arms `{0}` and `{1}` differ in nothing")]
    SameSettings(String, String),
    #[error("[report] compares with the arm `{0}`, which there is not{1}")]
    Reference(String, String),
}

/// All arms, in the order of the file: named ones first, then those of each grid.
///
/// # Errors
/// [`Error::Input`] with line and column where a setting is wrong, [`Error::Content`] where arms are.
pub fn arms(path: &Path, definition: &Definition, study: &Study) -> Result<Vec<Arm>> {
    let check = |settings: &Settings| typed(path, definition, study, settings);
    let base = check(&definition.file.base)?;
    let with = |more: Map<String, Value>| {
        let mut given = base.clone();
        given.extend(more);
        study.complete(&given)
    };
    let mut arms = Vec::new();
    for entry in &definition.file.arm {
        arms.push(Arm {
            name: entry.name.get_ref().clone(),
            settings: with(check(&entry.set)?),
            command: command(path, definition, study, entry)?,
        });
    }
    for grid in &definition.file.grid {
        let entry = grid.get_ref();
        let wrong = |message: String| Err(definition.wrong(path, &grid.span(), message));
        if entry.set.is_empty() && entry.zip.is_empty() {
            return wrong("this grid varies nothing: write set.NAME = [...]".into());
        }
        if let Some(name) = entry.set.keys().find(|name| entry.zip.contains_key(*name)) {
            let name = name.get_ref();
            return wrong(format!("`{name}` is varied twice, by set and by zip"));
        }
        let sets = lists(path, definition, study, &entry.set)?;
        let zips = lists(path, definition, study, &entry.zip)?;
        for varied in combinations(&sets, &zipped(path, definition, &entry.zip, &zips)?) {
            let words: Vec<String> = varied
                .iter()
                .map(|(name, value)| word(name, value))
                .collect();
            arms.push(Arm {
                name: words.join(", "),
                settings: with(varied.into_iter().collect()),
                command: None,
            });
        }
    }
    for settings in &definition.file.exclude {
        let without = check(settings.get_ref())?;
        let before = arms.len();
        arms.retain(|arm| {
            without
                .iter()
                .any(|(name, value)| arm.settings.get(name) != Some(value))
        });
        // Most often a value that is written otherwise in the grid.
        if without.is_empty() || arms.len() == before {
            let message = match without.is_empty() {
                true => "this [[exclude]] names no setting",
                false => "no arm has these settings: nothing is left out",
            };
            return Err(definition.wrong(path, &settings.span(), message.into()));
        }
    }
    let fail = |error: ArmError| Error::content(path, error);
    if arms.is_empty() {
        return Err(fail(ArmError::None));
    }
    let mut names = BTreeSet::new();
    for (index, arm) in arms.iter().enumerate() {
        if !names.insert(&arm.name) {
            return Err(fail(ArmError::SameName(arm.name.clone())));
        }
        if let Some(twin) = arms[..index]
            .iter()
            .find(|other| other.settings == arm.settings && other.command == arm.command)
        {
            return Err(fail(ArmError::SameSettings(
                twin.name.clone(),
                arm.name.clone(),
            )));
        }
    }
    if let Some(reference) = &definition.report.reference
        && !names.contains(reference)
    {
        let hint = suggestion(reference, names.iter().map(|name| name.as_str()));
        return Err(fail(ArmError::Reference(reference.clone(), hint)));
    }
    Ok(arms)
}

/// The command of an arm, if it is one.
fn command(
    path: &Path,
    definition: &Definition,
    study: &Study,
    entry: &ArmEntry,
) -> Result<Option<Command>> {
    let Some(written) = &entry.command else {
        let alone = [
            entry.files.as_ref().map(|files| ("files", files.span())),
            entry.timeout.as_ref().map(|t| ("timeout", t.span())),
        ];
        return match alone.into_iter().flatten().next() {
            None => Ok(None),
            Some((name, span)) => {
                let message = format!("{name}: only an arm with a `command` has it");
                Err(definition.wrong(path, &span, message))
            }
        };
    };
    if !study.takes_commands() {
        let message = format!("command: `{}` takes none", study.name);
        return Err(definition.wrong(path, &written.span(), message));
    }
    let none = Vec::new();
    let files = entry.files.as_ref().map_or(&none, |files| files.get_ref());
    let timeout = entry.timeout.as_ref().map(|timeout| *timeout.get_ref());
    let folder = path.parent().unwrap_or(Path::new(""));
    let command = Command::new(written.get_ref(), files, timeout, folder);
    command.map(Some).map_err(|message| {
        let files = entry.files.as_ref().map(toml::Spanned::span);
        let timeout = entry.timeout.as_ref().map(toml::Spanned::span);
        let span = match message.split(':').next() {
            Some("files") => files,
            Some("timeout") => timeout,
            _ => None,
        };
        definition.wrong(path, &span.unwrap_or(written.span()), message)
    })
}

/// `name=value`.
fn word(name: &str, value: &Value) -> String {
    match value {
        Value::String(text) => format!("{name}={text}"),
        Value::Array(items) => {
            let words: Vec<String> = items.iter().map(bare).collect();
            format!("{name}={}", words.join("+"))
        }
        other => format!("{name}={other}"),
    }
}

fn bare(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

/// Settings whose names and types are the study's.
fn typed(
    path: &Path,
    definition: &Definition,
    study: &Study,
    settings: &Settings,
) -> Result<Map<String, Value>> {
    let mut checked = Map::new();
    for (name, value) in settings {
        let json = json(path, definition, study, name, value.get_ref(), value.span())?;
        checked.insert(name.get_ref().clone(), json);
    }
    Ok(checked)
}

/// One setting's value as JSON.
fn json(
    path: &Path,
    definition: &Definition,
    study: &Study,
    name: &Spanned<String>,
    value: &toml::Value,
    span: std::ops::Range<usize>,
) -> Result<Value> {
    let key = name.get_ref();
    let known = study.settings().iter().map(|setting| setting.name.as_str());
    if !known.clone().any(|known| known == key) {
        let message = format!(
            "`{}` has no setting `{key}`{}",
            study.name,
            suggestion(key, known)
        );
        return Err(definition.wrong(path, &name.span(), message));
    }
    let json = serde_json::to_value(value).map_err(Error::method)?;
    if let Err(reason) = study.check(key, &json) {
        return Err(definition.wrong(path, &span, format!("`{key}`: {}", meant(&reason))));
    }
    Ok(json)
}

/// serde's message about an unknown variant, with the nearest right one.
fn meant(message: &str) -> String {
    let words: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match words.split_first() {
        Some((word, expected)) => {
            format!("{message}{}", suggestion(word, expected.iter().copied()))
        }
        None => message.to_owned(),
    }
}

/// Values of each setting of a grid.
fn lists(
    path: &Path,
    definition: &Definition,
    study: &Study,
    lists: &Lists,
) -> Result<Vec<(String, Vec<Value>)>> {
    let mut all = Vec::new();
    for (name, list) in lists {
        if list.get_ref().is_empty() {
            let message = format!("`{}` has no value in this grid", name.get_ref());
            return Err(definition.wrong(path, &list.span(), message));
        }
        let values: Result<Vec<Value>> = list
            .get_ref()
            .iter()
            .map(|value| json(path, definition, study, name, value, list.span()))
            .collect();
        all.push((name.get_ref().clone(), values?));
    }
    Ok(all)
}

/// The rows of lists that are zipped; one empty row when there is none.
fn zipped(
    path: &Path,
    definition: &Definition,
    written: &Lists,
    lists: &[(String, Vec<Value>)],
) -> Result<Vec<Vec<(String, Value)>>> {
    let Some((_, first)) = lists.first() else {
        return Ok(vec![Vec::new()]);
    };
    for (name, list) in written {
        if list.get_ref().len() != first.len() {
            let message = format!(
                "zip.{}: lists that are zipped are equally long",
                name.get_ref()
            );
            return Err(definition.wrong(path, &list.span(), message));
        }
    }
    let row = |i: usize| {
        lists
            .iter()
            .map(|(name, list)| (name.clone(), list[i].clone()))
            .collect()
    };
    Ok((0..first.len()).map(row).collect())
}

/// Every combination of some lists with every row.
fn combinations(
    sets: &[(String, Vec<Value>)],
    rows: &[Vec<(String, Value)>],
) -> Vec<Vec<(String, Value)>> {
    let mut all: Vec<Vec<(String, Value)>> = vec![Vec::new()];
    for (name, values) in sets {
        let extended = all.iter().flat_map(|before| {
            values.iter().map(move |value| {
                let mut next = before.clone();
                next.push((name.clone(), value.clone()));
                next
            })
        });
        all = extended.collect();
    }
    let joined = all
        .iter()
        .flat_map(|set| rows.iter().map(move |row| [set.as_slice(), row].concat()));
    let mut joined: Vec<Vec<(String, Value)>> = joined.collect();
    joined.retain(|varied| !varied.is_empty());
    joined
}
