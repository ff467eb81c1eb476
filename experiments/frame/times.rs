//! Times and memory of an artefact, which differ from run to run: they stand in files of their own, `<artefact>.times.md`, `.times.csv`
//! and `.times.png`, so that all other files are the same wherever the artefact is made again.

use std::path::Path;

use super::document::Document;
use super::provenance::Comparison;
use edifice_base::Result;
use edifice_report::{self as report, Row};

/// The times of one artefact.
pub(super) struct Times {
    artefact: String,
    pub(super) document: Document,
    pub(super) comparisons: Vec<Comparison>,
    pub(super) rows: Vec<Row>,
    /// Files of pictures.
    pub(super) files: Vec<String>,
}

impl Times {
    /// None yet.
    pub(super) fn new(artefact: &str, title: &str) -> Self {
        Self {
            artefact: artefact.to_owned(),
            document: Document::new(artefact, &format!("{title}: times")),
            comparisons: Vec::new(),
            rows: Vec::new(),
            files: Vec::new(),
        }
    }

    /// Writes the files of times into `folder`, where there are times, and returns their names, the page first.
    ///
    /// # Errors
    /// [`edifice_base::Error::Io`] when a file cannot be written, and those of [`report::write_rows`].
    pub(super) fn write(mut self, folder: &Path) -> Result<Vec<String>> {
        let mut files = Vec::new();
        if !self.document.is_empty() || !self.comparisons.is_empty() {
            let page = format!("{}.times.md", self.artefact);
            self.document.block(MACHINE.to_owned());
            let text = self.document.markdown(&self.comparisons, None);
            edifice_base::file::write_atomic(&folder.join(&page), text.as_bytes())?;
            files.push(page);
        }
        if !self.rows.is_empty() {
            let csv = format!("{}.times.csv", self.artefact);
            report::write_rows(&folder.join(&csv), &self.rows)?;
            files.push(csv);
        }
        files.append(&mut self.files);
        Ok(files)
    }
}

/// The last paragraph of a page of times.
const MACHINE: &str =
    "The machine and the commit of the run stand in [provenance.json](provenance.json).";
