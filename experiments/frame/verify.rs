//! Which kept artefacts are older than the code or the data that they show: `edifice reproduce --verify`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::options::Options;
use super::progress::{line, result};
use super::provenance::{self, Made, Run};
use super::{Artefact, Experiment, Program};
use edifice_base::{Error, Result};
use edifice_datasets as datasets;

/// The state of a kept artefact.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum State {
    /// Made by this code from this data.
    Current,
    /// Not in the folder.
    Missing,
    /// It was made before the digest of the sources was recorded.
    Unknown,
    /// The parts that have changed since: `code`, or names of data.
    Older(Vec<String>),
}

/// The state of each artefact, in the order of the report, as `paper/artefact`.
///
/// # Errors
/// Those of reading the data.
pub(crate) fn verify(
    program: &Program,
    chosen: &[(&'static Experiment, Vec<&'static Artefact>)],
    options: &Options,
) -> Result<Vec<(String, State)>> {
    let unpacked = tempfile::tempdir().map_err(Error::method)?;
    let mut digests = Digests {
        unpacked: unpacked.path(),
        data: options.data.as_deref(),
        known: BTreeMap::new(),
    };
    let mut found = Vec::new();
    for (experiment, artefacts) in chosen {
        let run = Run::read(&options.out.join(experiment.slug));
        for artefact in artefacts {
            let state = match run.artefacts.get(artefact.name) {
                None => State::Missing,
                Some(made) => digests.state(made, &program.sources.of_paper(experiment.slug))?,
            };
            found.push((format!("{}/{}", experiment.slug, artefact.name), state));
        }
    }
    Ok(found)
}

/// Some artefacts are not of this code and this data.
#[derive(Debug, thiserror::Error)]
#[error("{older} of {all} artefacts are older than the code or the data that they show")]
struct Stale {
    older: usize,
    all: usize,
}

/// Says of each artefact if it is of this code and this data.
///
/// # Errors
/// When one is older, or data cannot be read.
pub(crate) fn say_which_are_older(
    program: &Program,
    chosen: &[(&'static Experiment, Vec<&'static Artefact>)],
    options: &Options,
    json: bool,
) -> Result<()> {
    let found = verify(program, chosen, options)?;
    let (mut older, mut states) = (0, Vec::new());
    for (name, state) in &found {
        let said = match state {
            State::Current => "is of this code and data".to_owned(),
            State::Missing => "is not in the report".to_owned(),
            State::Unknown => "was made before the digest of its code was recorded".to_owned(),
            State::Older(parts) => {
                older += 1;
                format!("is older than: {}", parts.join(", "))
            }
        };
        line(&format!("{name} {said}"));
        let (word, than): (&str, &[String]) = match state {
            State::Current => ("current", &[]),
            State::Missing => ("missing", &[]),
            State::Unknown => ("unknown", &[]),
            State::Older(parts) => ("older", parts),
        };
        states.push(serde_json::json!({ "artefact": name, "state": word, "older_than": than }));
    }
    if json {
        result(&serde_json::json!({ "states": states }))?;
    }
    match older {
        0 => Ok(()),
        older => Err(Error::method(Stale {
            older,
            all: found.len(),
        })),
    }
}

/// Digests of data, each made once.
struct Digests<'a> {
    unpacked: &'a Path,
    data: Option<&'a Path>,
    known: BTreeMap<String, Option<String>>,
}

impl Digests<'_> {
    fn state(&mut self, made: &Made, sources: &str) -> Result<State> {
        let mut older = Vec::new();
        for (name, digest) in &made.data {
            // Data that is not here, the real sets or one's own, says nothing.
            if self.of(name)?.is_some_and(|now| now != *digest) {
                older.push(name.clone());
            }
        }
        if !made.sources.is_empty() && made.sources != sources {
            older.insert(0, "code".to_owned());
        }
        Ok(match (older.is_empty(), made.sources.is_empty()) {
            (false, _) => State::Older(older),
            (true, true) => State::Unknown,
            (true, false) => State::Current,
        })
    }

    fn of(&mut self, name: &str) -> Result<Option<String>> {
        if let Some(known) = self.known.get(name) {
            return Ok(known.clone());
        }
        let place: Option<PathBuf> = if let Some(shipped) = name.strip_prefix("datasets/") {
            // A set that ships no more is one that has changed.
            let path = datasets::unpack(shipped, self.unpacked);
            Some(path.unwrap_or_default())
        } else {
            let real = name.strip_prefix("DATA/").zip(self.data);
            real.map(|(name, data)| data.join(name))
        };
        let digest = match place {
            None => None,
            Some(path) if path.exists() => Some(provenance::digest(&path)?),
            Some(_) => Some("none".to_owned()),
        };
        self.known.insert(name.to_owned(), digest.clone());
        Ok(digest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_artefact_of_other_code_or_data_is_older() {
        let folder = tempfile::tempdir().unwrap();
        let mut digests = Digests {
            unpacked: folder.path(),
            data: None,
            known: BTreeMap::from([("datasets/a".to_owned(), Some("1".to_owned()))]),
        };
        let made = |sources: &str, data: &str| Made {
            sources: sources.into(),
            data: BTreeMap::from([
                ("datasets/a".to_owned(), data.to_owned()),
                ("DATA/b".to_owned(), "unseen".to_owned()),
            ]),
            ..Made::default()
        };
        for (sources, data, expected) in [
            ("s", "1", State::Current),
            ("", "1", State::Unknown),
            ("t", "1", State::Older(vec!["code".into()])),
            (
                "t",
                "2",
                State::Older(vec!["code".into(), "datasets/a".into()]),
            ),
            ("", "2", State::Older(vec!["datasets/a".into()])),
        ] {
            assert_eq!(digests.state(&made(sources, data), "s").unwrap(), expected);
        }
    }
}
