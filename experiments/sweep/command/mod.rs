//! Arms that are commands: how one is written in a sweep file, and how it is run with limits on time, memory and the size of its answer.

mod limits;
mod process;

pub use process::{Circumstances, ask, timed};

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::definition::suggestion;
use edifice_base::{Error, Result};
use edifice_frame::provenance;

/// Seconds of a command unless the arm says otherwise.
const TIMEOUT: f64 = 600.0;

/// Words in braces that a command may use.
const PLACES: [&str; 6] = ["input", "output", "learn", "seed", "settings", "claims"];

/// A file that a command needs, beside the sweep file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Needed {
    /// Its name in the folder that the command runs in.
    pub name: String,
    /// Its path.
    pub path: PathBuf,
    /// SHA-256 of its bytes.
    pub digest: String,
}

/// A command that answers instead of a built-in method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Program and arguments, with places in braces: `{input}`, `{output}`, `{learn}`, `{seed}`, `{settings}`, `{claims}`.
    pub words: Vec<String>,
    /// Files that are copied into the folder that it runs in.
    pub files: Vec<Needed>,
    /// Seconds after which it has failed.
    pub timeout: f64,
}

/// A command as it is written: a line, or its words.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub enum Written {
    /// A line, split at spaces; words with spaces stand between quotes. No shell reads it.
    Line(String),
    /// Its words.
    Words(Vec<String>),
}

impl Command {
    /// Checks a command and finds its files, which are relative to `folder`; the error says why it is none.
    pub fn new(
        written: &Written,
        files: &[String],
        timeout: Option<f64>,
        folder: &Path,
    ) -> std::result::Result<Self, String> {
        let words = match written {
            Written::Line(line) => split(line)?,
            Written::Words(words) => words.clone(),
        };
        if words.first().is_none_or(String::is_empty) {
            return Err("command: it names no program".into());
        }
        let mut places = Vec::new();
        for word in &words {
            places.extend(named(word)?);
        }
        for wanted in ["input", "output"] {
            if !places.iter().any(|place| place == wanted) {
                return Err(format!("command: it has no {{{wanted}}}"));
            }
        }
        let timeout = timeout.unwrap_or(TIMEOUT);
        if !(timeout.is_finite() && timeout > 0.0) {
            return Err(format!("timeout: {timeout} is no number of seconds"));
        }
        let mut needed: Vec<Needed> = Vec::new();
        for file in files {
            let path = folder.join(file);
            let path = std::path::absolute(&path).unwrap_or(path);
            let name = path.file_name().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            if !path.is_file() {
                return Err(format!("files: there is no file `{file}`"));
            }
            if needed.iter().any(|other| other.name == name) {
                return Err(format!("files: two are called `{name}`"));
            }
            let digest = provenance::digest(&path).map_err(|e| e.to_string())?;
            needed.push(Needed { name, path, digest });
        }
        let mut words = words;
        // A program with a folder in its name is meant from the sweep file; others are looked for in PATH.
        let program = Path::new(&words[0]);
        if program.components().count() > 1 && !program.is_absolute() {
            let program = folder.join(program);
            let program = std::path::absolute(&program).unwrap_or(program);
            words[0] = program.to_string_lossy().into_owned();
        }
        Ok(Self {
            words,
            files: needed,
            timeout,
        })
    }

    /// The part of a key that a command decides: its words, the names and bytes of its files.
    pub fn identity(&self) -> String {
        let files = self
            .files
            .iter()
            .map(|f| format!("{} {}", f.name, f.digest));
        let parts: Vec<String> = self.words.iter().cloned().chain(files).collect();
        parts.join("\0")
    }

    /// The first of its files that is not what it was.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn changed(&self) -> Result<Option<&Path>> {
        for file in &self.files {
            if !file.path.is_file() || provenance::digest(&file.path)? != file.digest {
                return Ok(Some(&file.path));
            }
        }
        Ok(None)
    }

    /// Its words with every place filled in.
    fn filled(&self, value: impl Fn(&str) -> String) -> Result<Vec<String>> {
        let fill = |word: &String| {
            let mut filled = String::new();
            for part in parts(word).map_err(Error::method)? {
                match part {
                    Part::Text(text) => filled += text,
                    Part::Place(place) => filled += &value(place),
                }
            }
            Ok(filled)
        };
        self.words.iter().map(fill).collect()
    }
}

enum Part<'a> {
    Text(&'a str),
    Place(&'a str),
}

/// Text and places of a word; `{{` and `}}` are braces.
fn parts(word: &str) -> std::result::Result<Vec<Part<'_>>, String> {
    let mut parts = Vec::new();
    let mut rest = word;
    while let Some(at) = rest.find(['{', '}']) {
        let (text, brace) = rest.split_at(at);
        parts.push(Part::Text(text));
        if brace.starts_with("{{") || brace.starts_with("}}") {
            parts.push(Part::Text(&brace[..1]));
            rest = &brace[2..];
            continue;
        }
        let inside = brace.strip_prefix('{').and_then(|b| b.split_once('}'));
        let (place, after) = inside.ok_or("command: a brace stands alone; write `{{` or `}}`")?;
        parts.push(Part::Place(place));
        rest = after;
    }
    parts.push(Part::Text(rest));
    Ok(parts)
}

/// The places of a word; the error names one that there is not.
fn named(word: &str) -> std::result::Result<Vec<String>, String> {
    let mut found = Vec::new();
    for part in parts(word)? {
        if let Part::Place(place) = part {
            if !PLACES.contains(&place) {
                let near = suggestion(place, PLACES.into_iter());
                return Err(format!("command: there is no place {{{place}}}{near}"));
            }
            found.push(place.to_owned());
        }
    }
    Ok(found)
}

/// Splits a line at spaces; `"..."` and `'...'` keep them.
fn split(line: &str) -> std::result::Result<Vec<String>, String> {
    let (mut words, mut word, mut within) = (Vec::new(), None::<String>, None::<char>);
    for letter in line.chars() {
        match (within, letter) {
            (Some(quote), _) if letter == quote => within = None,
            (None, '"' | '\'') => {
                within = Some(letter);
                word.get_or_insert_default();
            }
            (None, _) if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    if within.is_some() {
        return Err("command: a quote is not closed".into());
    }
    words.extend(word);
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn new(line: &str) -> std::result::Result<Command, String> {
        Command::new(&Written::Line(line.into()), &[], None, Path::new("/tmp"))
    }

    #[test]
    fn lines_are_split_and_filled() {
        let command = new("run 'a b' {input} -o {output} x={seed}{{}}").unwrap();
        let filled = command.filled(|place| place.to_uppercase()).unwrap();
        assert_eq!(filled, ["run", "a b", "INPUT", "-o", "OUTPUT", "x=SEED{}"]);
        assert_eq!(new("./run {input} {output}").unwrap().words[0], "/tmp/run");
    }

    #[test]
    fn what_is_no_command_is_named() {
        for (line, expected) in [
            ("", "names no program"),
            ("a {input}", "no {output}"),
            ("a {output}", "no {input}"),
            ("a {input} {outptu}", "did you mean `output`?"),
            ("a {input} {output", "stands alone"),
            ("a {input} 'x {output}", "not closed"),
        ] {
            let message = new(line).unwrap_err();
            assert!(message.contains(expected), "{line}: {message}");
        }
        let written = Written::Line("a {input} {output}".into());
        let with = |files: &[String], t| Command::new(&written, files, t, Path::new("/nowhere"));
        assert!(
            with(&["mine.py".into()], None)
                .unwrap_err()
                .contains("mine.py")
        );
        assert!(with(&[], Some(-1.0)).unwrap_err().contains("timeout"));
    }
}
