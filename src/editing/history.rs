//! A document: its first state and the commands since. Undo and redo are places in that list.

use std::sync::Arc;

use serde_json::Value;

use super::script::{Shell, script};
use super::work::Work;
use super::{Applied, CommandError, State};
use edifice_base::Result;

/// Commands that were done at once, and are undone at once.
struct Entry {
    commands: Vec<Value>,
    steps: Vec<Applied>,
}

/// A document with its history.
pub struct Document {
    start: Arc<dyn State>,
    entries: Vec<Entry>,
    at: usize,
    revision: u64,
}

/// The steps that commands make, one after another, from a state.
///
/// # Errors
/// As [`State::apply`]; [`CommandError::Nothing`] without commands.
pub fn steps(state: &Arc<dyn State>, commands: &[Value], work: &Work) -> Result<Vec<Applied>> {
    if commands.is_empty() {
        return Err(CommandError::Nothing.into());
    }
    let mut steps: Vec<Applied> = Vec::with_capacity(commands.len());
    for command in commands {
        let step = steps
            .last()
            .map_or(state, |s| &s.state)
            .apply(command, work)?;
        steps.push(step);
    }
    Ok(steps)
}

/// An entry of the log.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Logged {
    /// The edit, in words.
    pub said: String,
    /// The commands, without the files that they hold.
    pub commands: Vec<Value>,
    /// True if it is done, false if it was undone.
    pub done: bool,
}

/// Longest text of a logged command, in characters.
const LONGEST: usize = 500;

/// A command with long texts cut short: a log is for people.
fn shortened(command: &Value) -> Value {
    match command {
        Value::String(text) if text.len() > LONGEST => {
            let start: String = text.chars().take(60).collect();
            format!("{start}… ({} bytes)", text.len()).into()
        }
        Value::Array(all) => all.iter().map(shortened).collect(),
        Value::Object(all) => {
            let each = all
                .iter()
                .map(|(key, value)| (key.clone(), shortened(value)));
            Value::Object(each.collect())
        }
        other => other.clone(),
    }
}

impl Document {
    /// A document without edits.
    pub fn new(start: Arc<dyn State>) -> Self {
        Self {
            start,
            entries: Vec::new(),
            at: 0,
            revision: 0,
        }
    }

    /// The state it is in.
    pub fn state(&self) -> &Arc<dyn State> {
        let last = self.entries[..self.at].last().and_then(|e| e.steps.last());
        last.map_or(&self.start, |s| &s.state)
    }

    /// Grows with every change, undo and redo.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Does commands in turn, all of them or none. What was undone is forgotten.
    ///
    /// # Errors
    /// As [`State::apply`]; [`CommandError::Nothing`] without commands.
    pub fn edit(&mut self, commands: &[Value]) -> Result<()> {
        let steps = steps(self.state(), commands, &Work::default())?;
        self.take(commands, steps);
        Ok(())
    }

    /// Takes the steps that commands came to, from the state that it is in.
    pub fn take(&mut self, commands: &[Value], steps: Vec<Applied>) {
        self.entries.truncate(self.at);
        self.entries.push(Entry {
            commands: commands.to_vec(),
            steps,
        });
        self.at += 1;
        self.revision += 1;
    }

    /// Takes back the last edit; whether there was one.
    pub fn undo(&mut self) -> bool {
        self.move_to(self.at.checked_sub(1))
    }

    /// Does again what was taken back; whether there was something.
    pub fn redo(&mut self) -> bool {
        self.move_to(Some(self.at + 1).filter(|at| *at <= self.entries.len()))
    }

    fn move_to(&mut self, at: Option<usize>) -> bool {
        let Some(at) = at else { return false };
        self.at = at;
        self.revision += 1;
        true
    }

    /// True if there is something to undo; true if there is something to redo.
    pub fn can(&self) -> (bool, bool) {
        (self.at > 0, self.at < self.entries.len())
    }

    /// All commands, those undone last.
    pub fn log(&self) -> Vec<Logged> {
        let logged = |(k, e): (usize, &Entry)| Logged {
            said: e
                .steps
                .iter()
                .map(|s| s.said.as_str())
                .collect::<Vec<_>>()
                .join("; "),
            commands: e.commands.iter().map(shortened).collect(),
            done: k < self.at,
        };
        self.entries.iter().enumerate().map(logged).collect()
    }

    /// The warnings of the last edit.
    pub fn warnings(&self) -> Vec<String> {
        let last = self.entries[..self.at].last();
        let steps = last.into_iter().flat_map(|e| &e.steps);
        steps.flat_map(|s| s.warnings.clone()).collect()
    }

    /// Name of the file that the script writes.
    pub fn target(&self) -> String {
        format!("{}{}", self.state().name(), self.state().ending())
    }

    /// The shell script that makes the present state from the first one.
    ///
    /// # Errors
    /// As [`State::bytes`].
    pub fn script(&self) -> Result<String> {
        let steps = self.entries[..self.at].iter().flat_map(|e| &e.steps);
        let shells: Vec<Shell> = steps.map(|s| s.shell.clone()).collect();
        let start = || self.start.bytes();
        script(&self.target(), self.start.ending(), start, &shells)
    }
}
