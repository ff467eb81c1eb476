//! The documents that the pictures of a report show: shipped files that an experiment names, and files that stand in the report.

use std::path::Path;

use serde::Deserialize;

use super::place::suggestion;
use super::provenance::Run;
use super::{Experiment, Program};
use edifice_base::{Error, Result};
use edifice_datasets::shipped_bytes;
use edifice_io::read_bytes;

/// Endings of the files of a report that can be edited.
const ENDINGS: [&str; 4] = [
    ".facade.json",
    ".grammar.json",
    ".building.json",
    ".city-grammar.json",
];

/// A shipped document, named by its path below `datasets/`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Pictured {
    /// A whole file.
    File(String),
    /// A line of a file of houses, from 0.
    Line(String, usize),
}

/// The place of a document.
#[derive(Debug, Clone)]
enum Place {
    Shipped(Pictured),
    /// A file of the report, by its name in the folder of the paper.
    Report(String),
}

/// A document that a picture of the report shows, with what is needed to choose it.
#[derive(Debug, Clone)]
pub struct Shown {
    /// Slug of the paper.
    pub paper: &'static str,
    /// Name of the artefact.
    pub artefact: &'static str,
    /// File name of the document.
    pub file: String,
    place: Place,
}

/// A document of a report: the name of a file, and its bytes.
pub type ReportDocument = (String, Vec<u8>);

/// The name in a line of houses.
#[derive(Deserialize)]
struct Named {
    name: String,
}

impl Pictured {
    fn bytes(&self) -> Result<&'static [u8]> {
        match self {
            Self::File(path) => shipped_bytes(path),
            Self::Line(path, line) => {
                let mut lines = shipped_bytes(path)?.split(|byte| *byte == b'\n');
                Ok(lines.nth(*line).unwrap_or_default())
            }
        }
    }

    /// The name of the file that it is opened as.
    fn file(&self) -> Option<String> {
        match self {
            Self::File(path) => path.rsplit('/').next().map(str::to_owned),
            Self::Line(..) => {
                let named: Named = serde_json::from_slice(self.bytes().ok()?).ok()?;
                Some(format!("{}.building.json", named.name))
            }
        }
    }
}

impl Shown {
    /// The name without its ending, by which it is chosen.
    pub fn name(&self) -> &str {
        let end = self.file.find('.').unwrap_or(self.file.len());
        &self.file[..end]
    }

    /// True if `PAPER/ARTEFACT/DOCUMENT`, of which the first and the last may be left out, names it.
    fn is_named(&self, wanted: &str) -> bool {
        let mut words: Vec<&str> = wanted.split('/').collect();
        if words.len() > 1 && words[0] == self.paper {
            words.remove(0);
        }
        match words[..] {
            [artefact] => artefact == self.artefact,
            [artefact, name] => {
                artefact == self.artefact && (name == self.name() || name == self.file)
            }
            _ => false,
        }
    }

    fn bytes(&self, report: &Path) -> Result<Vec<u8>> {
        match &self.place {
            Place::Shipped(document) => document.bytes().map(<[u8]>::to_vec),
            Place::Report(file) => read_bytes(&report.join(self.paper).join(file)),
        }
    }
}

/// True for the plain name of a file that can be edited: a record of another report leads nowhere else.
fn is_document(file: &str) -> bool {
    let plain = Path::new(file).file_name().is_some_and(|name| name == file);
    plain && ENDINGS.iter().any(|ending| file.ends_with(ending))
}

/// The documents of an artefact; `folder` is that of its paper in the report.
fn of_artefact(experiment: &Experiment, artefact: &'static str, folder: &Path) -> Vec<Shown> {
    let shown = |(file, place)| Shown {
        paper: experiment.slug,
        artefact,
        file,
        place,
    };
    let shipped = (experiment.documents)(artefact).into_iter();
    let shipped = shipped.filter_map(|p| Some((p.file()?, Place::Shipped(p))));
    let run = Run::read(folder);
    let made = run.artefacts.get(artefact).into_iter();
    let files = made.flat_map(|m| m.files.clone());
    let files = files.filter(|f| is_document(f) && folder.join(f).is_file());
    let kept = files.map(|f| (f.clone(), Place::Report(f)));
    shipped.chain(kept).map(shown).collect()
}

/// All documents that pictures of a report show, by paper and artefact. Shipped ones need no report.
pub fn shown(program: &Program, report: &Path) -> Vec<Shown> {
    let artefacts = program
        .experiments
        .iter()
        .flat_map(|e| e.artefacts.iter().map(|a| (*e, a.name)));
    let documents = artefacts.flat_map(|(e, a)| of_artefact(e, a, &report.join(e.slug)));
    documents.collect()
}

/// The command that opens the documents of an artefact, where there are some.
pub(super) fn command(
    program: &Program,
    slug: &str,
    artefact: &str,
    folder: &Path,
) -> Option<String> {
    let experiment = program.experiments.iter().find(|e| e.slug == slug)?;
    let artefact = experiment.artefacts.iter().find(|a| a.name == artefact)?;
    let found = of_artefact(experiment, artefact.name, folder);
    (!found.is_empty()).then(|| format!("edifice studio --report {slug}/{}", artefact.name))
}

/// The documents named `[PAPER/]ARTEFACT[/DOCUMENT]` of a report.
///
/// # Errors
/// [`Error::Option`] with the names that there are, when there is none of this name; those of reading a file.
pub fn documents(program: &Program, wanted: &str, report: &Path) -> Result<Vec<ReportDocument>> {
    let all = shown(program, report);
    let named: Vec<&Shown> = all.iter().filter(|s| s.is_named(wanted)).collect();
    if named.is_empty() {
        return Err(Error::option("--report", no_such(program, wanted, &all)));
    }
    let read = |s: &&Shown| Ok((s.file.clone(), s.bytes(report)?));
    named.iter().map(read).collect()
}

/// The message for a name that names no document.
fn no_such(program: &Program, wanted: &str, all: &[Shown]) -> String {
    let artefact = wanted.rsplit_once('/').map_or(wanted, |(before, _)| before);
    let inside: Vec<&str> = all
        .iter()
        .filter(|s| s.is_named(artefact) && artefact != wanted)
        .map(Shown::name)
        .collect();
    if !inside.is_empty() {
        let near = suggestion(
            wanted.rsplit('/').next().unwrap_or_default(),
            inside.iter().copied(),
        );
        return format!(
            "no document {wanted:?}{near}; {artefact} has {}",
            inside.join(", ")
        );
    }
    let mut names: Vec<String> = all
        .iter()
        .map(|s| format!("{}/{}", s.paper, s.artefact))
        .collect();
    names.dedup();
    let known = program
        .experiments
        .iter()
        .flat_map(|e| e.artefacts.iter().map(|a| (e.slug, a.name)));
    let exists = { known }.any(|(slug, name)| wanted == name || wanted == format!("{slug}/{name}"));
    let near = suggestion(wanted, names.iter().map(String::as_str));
    format!(
        "{wanted:?} {}; pictures with documents are {}",
        match exists {
            true => "keeps no document that can be opened".to_owned(),
            false => format!("is no picture of the report with documents{near}"),
        },
        names.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_of_a_report_leads_out_of_its_folder_nowhere() {
        for file in [
            "../x.facade.json",
            "/x.facade.json",
            "a/x.facade.json",
            "x.json",
            "..",
        ] {
            assert!(!is_document(file), "{file}");
        }
        assert!(is_document("figure_15_c.facade.json"));
    }
}
