//! Data sets of one's own by name: `--dataset NAME=GLOB[:MAP.json]`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_io::{LabelMap, ReadOptions};

/// Facades of one's own, beside those that ship and those of the data folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Own {
    /// Name of the set in tables and rows.
    pub name: &'static str,
    /// Its files, in order of name.
    pub files: Vec<PathBuf>,
    /// Options of reading the files.
    pub options: ReadOptions,
}

/// Names of sets that experiments know.
const TAKEN: [&str; 14] = [
    "shipped",
    "shipped_houses",
    "shipped_blocks",
    "ecp2011",
    "graz50",
    "cmp",
    "paris_art_deco",
    "made",
    "h2k",
    "ames",
    "wild",
    "sampled",
    "most_probable",
    "sweep",
];

impl Own {
    /// Finds the files of `NAME=GLOB`, read by a label map where `:MAP.json` follows.
    ///
    /// # Errors
    /// [`Error::Option`] for a name that is none or taken and a pattern that matches nothing; those of reading the label map.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |message: String| Error::option("--dataset", message);
        let (name, rest) = text
            .split_once('=')
            .ok_or_else(|| wrong(format!("{text:?} is not NAME=GLOB or NAME=GLOB:MAP.json")))?;
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if name.is_empty() || !name.chars().all(plain) {
            return Err(wrong(format!(
                "{name:?} is no name: small letters, digits and _"
            )));
        }
        if TAKEN.contains(&name) {
            return Err(wrong(format!("{name:?} is the name of another set")));
        }
        let (pattern, map) = match rest.rsplit_once(':') {
            Some((pattern, map)) if map.ends_with(".json") => (pattern, Some(Path::new(map))),
            _ => (rest, None),
        };
        let found = glob::glob(pattern).map_err(|e| wrong(format!("{pattern:?}: {e}")))?;
        let mut files: Vec<PathBuf> = found.flatten().filter(|path| path.is_file()).collect();
        files.sort();
        if files.is_empty() {
            return Err(wrong(format!("no file is called {pattern:?}")));
        }
        let label_map = map.map(LabelMap::read).transpose()?;
        Ok(Self {
            // A name lives as long as the program, as those of the known sets do.
            name: name.to_owned().leak(),
            files,
            options: ReadOptions {
                label_map,
                ..ReadOptions::default()
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_named_and_found() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().display();
        for name in ["b.png", "a.png", "c.txt"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let found = Own::parse(&format!("mine={place}/*.png")).unwrap();
        assert_eq!((found.name, found.files.len()), ("mine", 2));
        assert!(found.files[0].ends_with("a.png"));
        for (text, expected) in [
            ("mine".to_owned(), "is not NAME=GLOB"),
            ("My Set=*".to_owned(), "is no name"),
            ("cmp=*".to_owned(), "another set"),
            (format!("mine={place}/*.xml"), "no file is called"),
        ] {
            let message = Own::parse(&text).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
