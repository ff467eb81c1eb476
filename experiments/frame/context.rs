//! The context that an artefact's function is given.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

use super::document::Document;
use super::journal::Journal;
use super::options::{Budget, Options};
use super::own::Own;
use super::progress::{self, Progress};
use super::provenance::{self, Comparison};
use super::times::Times;
use edifice_base::{Error, Result};
use edifice_datasets as datasets;
use edifice_report as report;
use edifice_report::{Figure, Row, Table};

/// Set when the user asked to stop; units under way finish, no new one starts.
pub(super) static STOP: AtomicBool = AtomicBool::new(false);

/// Folder of journals and unpacked data sets, below a paper's folder; removed by a run that succeeds.
pub(super) const WORK: &str = ".work";

/// Beginnings of the metrics of times and memory.
const TIMES: [&str; 2] = ["seconds", "peak_memory"];

/// Folder of the unpacked data sets, below that one.
pub(super) const DATASETS: &str = "datasets";

/// Two units of work with one name: the journal could not tell them apart.
#[derive(Debug, thiserror::Error)]
#[error("two units of work are both called {0:?}")]
struct DuplicateUnit(String);

/// The options of the run and the artefact in the making.
pub struct Context<'a> {
    pub(super) options: &'a Options,
    pub(super) slug: &'static str,
    pub(super) artefact: &'static str,
    pub(super) folder: PathBuf,
    pub(super) settings: BTreeMap<String, serde_json::Value>,
    pub(super) data: BTreeMap<String, String>,
    pub(super) rows: Vec<Row>,
    pub(super) document: Document,
    pub(super) comparisons: Vec<Comparison>,
    pub(super) files: Vec<String>,
    pub(super) times: Times,
    pub(super) skipped: Option<String>,
    batches: usize,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        options: &'a Options,
        slug: &'static str,
        artefact: &'static str,
        title: &str,
        folder: PathBuf,
    ) -> Self {
        Self {
            options,
            slug,
            artefact,
            folder,
            settings: BTreeMap::new(),
            data: BTreeMap::new(),
            rows: Vec::new(),
            document: Document::new(artefact, title),
            comparisons: Vec::new(),
            files: Vec::new(),
            times: Times::new(artefact, title),
            skipped: None,
            batches: 0,
        }
    }

    /// The budget of the run.
    pub fn budget(&self) -> Budget {
        self.options.budget
    }

    /// Seed of all random streams.
    pub fn seed(&self) -> u64 {
        self.options.seed
    }

    /// Folder with the real data sets, when the user has it.
    pub fn data(&self) -> Option<&Path> {
        self.options.data.as_deref()
    }

    /// Notes a setting: it goes to `run.json` and into the key of the journal, so call it before
    /// [`Context::units`].
    pub fn setting(&mut self, name: &str, value: impl Into<serde_json::Value>) {
        self.settings.insert(name.to_string(), value.into());
    }

    /// Path of a copy of a file or folder of `datasets/`, which is part of the program; its digest is
    /// recorded.
    ///
    /// # Errors
    /// [`Error::Content`] when nothing of this name ships, [`Error::Io`] when the copy cannot be made.
    pub fn shipped(&mut self, name: &str) -> Result<PathBuf> {
        let path = datasets::unpack(name, &self.work().join(DATASETS))?;
        self.data
            .insert(format!("datasets/{name}"), provenance::digest(&path)?);
        Ok(path)
    }

    /// Path of a file or folder below the real data, with its digest recorded; `None` without
    /// `--data` or when it is not there.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read.
    pub fn real(&mut self, name: &str) -> Result<Option<PathBuf>> {
        let Some(path) = self.data().map(|data| data.join(name)) else {
            return Ok(None);
        };
        if !path.exists() {
            self.note(format!("`{name}` is not in the data folder: left out."));
            return Ok(None);
        }
        self.data
            .insert(format!("DATA/{name}"), provenance::digest(&path)?);
        Ok(Some(path))
    }

    /// Facades of one's own (`--dataset`), with their digests recorded.
    ///
    /// # Errors
    /// [`Error::Io`] when they cannot be read.
    pub fn own(&mut self) -> Result<Vec<Own>> {
        let own = self.options.own.clone();
        for set in &own {
            for file in &set.files {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let name = format!("{}/{name}", set.name);
                self.data.insert(name, provenance::digest(file)?);
            }
        }
        Ok(own)
    }

    /// Runs `work` on every unit, on all threads, and returns the results in the order of the
    /// units. Results of an earlier run with the same settings are taken from the journal.
    ///
    /// `key` names a unit within the artefact, for example `shipped/a/adp_best/3`.
    ///
    /// # Errors
    /// The first failure in the order of the units; [`Error::Interrupted`] after Ctrl-C.
    pub fn units<T, R>(
        &mut self,
        units: &[T],
        key: impl Fn(&T) -> String + Sync,
        work: impl Fn(&T) -> Result<R> + Sync,
    ) -> Result<Vec<R>>
    where
        T: Sync,
        R: Serialize + DeserializeOwned + Send,
    {
        let mut seen = HashSet::new();
        for unit in units {
            let key = key(unit);
            if !seen.insert(key.clone()) {
                return Err(Error::method(DuplicateUnit(key)));
            }
        }
        self.batches += 1;
        let journal = Journal::open(&self.journal_path())?;
        let mut results: Vec<Option<Result<R>>> = units
            .iter()
            .map(|unit| journal.get(&key(unit)).map(Ok))
            .collect();
        let missing: Vec<usize> = (0..units.len()).filter(|&u| results[u].is_none()).collect();
        let finished = units.len() - missing.len();
        let name = format!("{} {}", self.slug, self.artefact);
        let progress = Progress::new(&name, units.len() as u64, finished as u64);
        let one = |unit: &T| {
            if STOP.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            let result = work(unit)?;
            journal.put(&key(unit), &result)?;
            progress.step();
            Ok(result)
        };
        let (done, received) = mpsc::channel();
        on_all_threads(missing.len(), &|m| {
            // The receiver lives until all are done.
            let _ = done.send((missing[m], one(&units[missing[m]])));
        });
        drop(done);
        for (unit, result) in received {
            results[unit] = Some(result);
        }
        results.into_iter().flatten().collect()
    }

    /// The journal's file: other settings, data, seed or build have another.
    fn journal_path(&self) -> PathBuf {
        let mut hash = Sha256::new();
        let about = serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "build": build(),
            "artefact": self.artefact,
            "batch": self.batches,
            "seed": self.options.seed,
            "budget": self.options.budget,
            "settings": self.settings,
            "data": self.data,
        });
        hash.update(about.to_string().as_bytes());
        let name = format!(
            "{}-{}-{}.jsonl",
            self.artefact,
            self.batches,
            &provenance::hex(&hash.finalize())[..16]
        );
        self.work().join(name)
    }

    /// Folder of what only a run in progress needs.
    fn work(&self) -> PathBuf {
        self.folder.join(WORK)
    }

    /// Adds an observation to `<artefact>.csv`, or to `<artefact>.times.csv` if it is of time or memory; the experiment's name is
    /// filled in.
    pub fn observe(&mut self, mut row: Row) {
        row.experiment = self.slug.to_string();
        match TIMES.iter().any(|metric| row.metric.starts_with(metric)) {
            true => self.times.rows.push(row),
            false => self.rows.push(row),
        }
    }

    /// Adds a table to `<artefact>.md`. One that has columns of times ([`Table::times`]) stands whole in `<artefact>.times.md`, and
    /// without them here.
    pub fn table(&mut self, table: &Table) {
        self.document.block(table.without_times().markdown());
        if table.has_times() {
            self.times.document.block(table.markdown());
        }
    }

    /// Adds a table of times alone to `<artefact>.times.md`.
    pub fn table_of_times(&mut self, table: &Table) {
        self.times.document.block(table.markdown());
    }

    /// Shows a picture of times in `<artefact>.times.md`, as [`Context::figure`] does in `<artefact>.md`; its files are called
    /// `<name>.times.png` and so on.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be written.
    pub fn figure_of_times(&mut self, name: &str, figure: &Figure) -> Result<()> {
        let name = format!("{name}.times");
        let files = report::write_report_figure(&self.folder, &name, figure)?;
        self.times.files.extend(files);
        self.times.document.image(&name, figure.caption());
        Ok(())
    }

    /// Writes `<name>.png` and, unless it is long ([`report::MOST_SVG_BYTES`]), `<name>.svg`, and shows
    /// the picture in `<artefact>.md`. The artefact's own picture has the artefact's name; further ones
    /// append to it (`figure_14_right`).
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be written.
    pub fn figure(&mut self, name: &str, figure: &Figure) -> Result<()> {
        let files = report::write_report_figure(&self.folder, name, figure)?;
        self.files.extend(files);
        self.document.image(name, figure.caption());
        Ok(())
    }

    /// Writes another file beside the artefact, for example `figure_16.glb`, and links it, unless it is a scene; a PNG is brought to 256 colours.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be written.
    pub fn attach(&mut self, name: &str, bytes: &[u8], what: &str) -> Result<()> {
        let path = self.folder.join(name);
        if name.ends_with(".png") {
            let few = report::few_colours(bytes).map_err(|e| Error::content(&path, e))?;
            edifice_base::file::write_atomic(&path, &few)?;
        } else {
            edifice_base::file::write_atomic(&path, bytes)?;
        }
        self.files.push(name.to_string());
        // Scenes are not kept in the repository: pages name them.
        self.document.block(match name.ends_with(".glb") {
            true => format!("`{name}`: {what}"),
            false => format!("[{name}]({name}): {what}"),
        });
        Ok(())
    }

    /// Sets a quantity beside what the paper printed.
    pub fn compare(
        &mut self,
        quantity: impl Into<String>,
        printed: impl Into<String>,
        ours: impl Into<String>,
    ) {
        self.comparisons.push(Comparison {
            quantity: quantity.into(),
            printed: printed.into(),
            ours: ours.into(),
        });
    }

    /// Sets a time or a size of memory beside what the paper printed, in `<artefact>.times.md`.
    pub fn compare_times(
        &mut self,
        quantity: impl Into<String>,
        printed: impl Into<String>,
        ours: impl Into<String>,
    ) {
        self.times.comparisons.push(Comparison {
            quantity: quantity.into(),
            printed: printed.into(),
            ours: ours.into(),
        });
    }

    /// Adds a paragraph to `<artefact>.md`: a reading, a deviation, a reason.
    pub fn note(&mut self, text: impl Into<String>) {
        self.document.block(text.into());
    }

    /// Says that the artefact cannot be made here, and why; return `Ok(())` after it.
    pub fn skip(&mut self, reason: impl Into<String>) {
        let reason = reason.into();
        progress::line(&format!("{} {}: {reason}", self.slug, self.artefact));
        self.skipped = Some(reason);
    }
}

/// Calls `work` with every number below `count`, on all threads. Without a type parameter: it is compiled once, not for each kind of unit.
fn on_all_threads(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

/// Length and age of the running program: a rebuilt one must not reuse what an older one found.
fn build() -> String {
    std::env::current_exe()
        .and_then(std::fs::metadata)
        .map(|meta| format!("{} {:?}", meta.len(), meta.modified().ok()))
        .unwrap_or_default()
}
