//! The studio: documents of [`edifice_editing`] in a page served on this machine, `edifice studio`.
//!
//! # What is asked and answered
//! Every answer of `/api` is JSON, but for exports and scripts; an error is `{"error": "..."}` with the status 400 (no
//! JSON), 404, 409 (changed in another tab, or a file that would be overwritten) or 422 (a command that cannot be done).
//!
//! | request | body | answer |
//! | --- | --- | --- |
//! | `GET /api/documents` | | `version`, `readOnly`, `documents` (each `id`, `kind`, `name`, `revision`, `unsaved`, `job`, and `mergesIn`, the unit in which it is merged with others of its kind, or null), `examples`, `unsaved` (work of a studio that ended: each `id`, `kind`, `name`, `file`, `edits`, `seconds` since then) |
//! | `POST /api/documents` | `{"example": ID}` | a document, or a job |
//! | `GET /api/documents/ID` | | a document; with `?shows=N` as for an edit |
//! | `POST /api/documents/ID/edit` | `{"commands": [...], "revision": N}` | the document after the [commands](edifice_editing), or a job |
//! | `POST /api/documents/ID/ask` | `{"ask": ...}`, or `{"preview": [...]}` with commands | what the editor says, or the `view` that the commands would make; the document stays as it is |
//! | `POST /api/documents/ID/undo`, `redo` | `{}`, or `{"shows": N}` as for an edit | the document |
//! | `POST /api/documents/ID/save` | `{"overwrite": true}` or `{}` | `file`, `script`: names of the files written |
//! | `POST /api/documents/ID/close` | `{"discard": true}` or `{}` | `{}`; 409 for a document with unsaved work that is not to be discarded |
//! | `GET /api/documents/ID/script` | | the commands as a shell script |
//! | `GET /api/documents/ID/export/FORMAT` | | the document in that format |
//! | `POST /api/unsaved/ID/open` | `{}` | the document with all that was done to it, or a job |
//! | `POST /api/unsaved/ID/discard` | `{}` | `{}` |
//! | `GET /api/jobs/J` | | a job |
//! | `POST /api/jobs/J/stop` | `{}` | the job, stopped |
//!
//! Work that takes longer than 0.3 s is a job: the answer is `{"job": {...}}` with the status 202, and the page asks for the
//! job until it is over. A job: `id`, `document` (of one that is opened, once it is there), `state` (`running`, `done`,
//! `stopped`, `failed`), `error`, `step` in words, `part` from 0 to 1 or null, `seconds`. One job at a time works on a document;
//! `job` in its summary shows it to every tab. A job that is stopped changes nothing; its method ends at its next step.
//!
//! A document: `id`, `kind`, `name`, `revision`, `undo`, `redo`, `unsaved`, `file`, `formats`, `warnings`, `log` (each `said`,
//! `commands`, `done`), `milliseconds` of the last edit, and `view`, what its editor shows. Whoever edits with `"shows": N`, the
//! revision whose view he has, may get `difference` in place of `view`: `set`, `at`, `numbers` and `gone` (`difference`). Long answers
//! are compressed with gzip for who accepts it.
//!
//! # What is kept
//! What is done to a document stands in its `journal` before it is answered, so that a studio that is killed loses at most the
//! last command; the next one offers the rest (`recovery`). All that is kept, and the file that leads the browser here
//! ([`redirect`]), is for this user alone ([`private`]).
//!
//! # Who may ask
//! Only a page of this server, opened by whoever started it ([`guard`]): requests are looked at before they are routed.
//! Files are named by the command line alone; the page knows them by an id.

mod answers;
mod api;
mod assets;
mod compressed;
mod difference;
mod document;
pub mod guard;
mod jobs;
mod journal;
pub mod private;
mod recovery;
pub mod redirect;
mod server;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use api::router;
pub use document::{Open, SaveError};
pub use server::{Running, start};

use edifice_base::Result;

/// The settings that the studio is started with.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Files to open.
    pub files: Vec<PathBuf>,
    /// Documents to open that are copies of what stands elsewhere, each under a file name: they are saved in the present folder.
    pub copies: Vec<(String, Vec<u8>)>,
    /// Port; 0 takes a free one.
    pub port: u16,
    /// Never write a file.
    pub read_only: bool,
    /// Folder of the journals; without one nothing is kept for the case that the studio ends.
    pub state: Option<PathBuf>,
    /// Limits of requests.
    pub limits: guard::Limits,
}

/// The open documents.
pub struct Studio {
    documents: Mutex<Documents>,
    unsaved: Mutex<Vec<recovery::Offered>>,
    jobs: jobs::Jobs,
    read_only: bool,
    /// Folder of the journals.
    state: Option<PathBuf>,
}

/// Documents by their number, which no other document gets when one is closed.
#[derive(Default)]
struct Documents {
    last: u64,
    open: BTreeMap<u64, Arc<Mutex<Open>>>,
}

/// Most documents open at once.
const MOST: usize = 200;

/// Too many documents.
#[derive(Debug, thiserror::Error)]
#[error("{MOST} documents are open: close one to open another")]
struct TooMany;

impl Studio {
    /// Opens the files and copies, and finds the unsaved work of studios that ended.
    ///
    /// # Errors
    /// The first file that cannot be read, or that no editor knows.
    pub fn new(settings: &Settings) -> Result<Self> {
        let state = settings.state.clone().filter(|_| !settings.read_only);
        let studio = Self {
            documents: Mutex::default(),
            unsaved: Mutex::new(state.as_deref().map(recovery::offered).unwrap_or_default()),
            jobs: jobs::Jobs::default(),
            read_only: settings.read_only,
            state,
        };
        for path in &settings.files {
            studio.add(Open::file(path)?)?;
        }
        for (name, bytes) in &settings.copies {
            studio.add(Open::copy(name, bytes)?)?;
        }
        Ok(studio)
    }

    fn documents(&self) -> MutexGuard<'_, Documents> {
        let all = self.documents.lock();
        all.unwrap_or_else(PoisonError::into_inner)
    }

    /// The unsaved work that is offered.
    fn offered(&self) -> MutexGuard<'_, Vec<recovery::Offered>> {
        let all = self.unsaved.lock();
        all.unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes an offer out of the list.
    fn offer(&self, id: &str) -> Option<recovery::Offered> {
        let mut all = self.offered();
        let at = all.iter().position(|o| o.id() == id)?;
        Some(all.remove(at))
    }

    /// The folder of the journals.
    fn journals(&self) -> Option<&Path> {
        self.state.as_deref()
    }

    /// Adds a document; its id.
    ///
    /// # Errors
    /// When there are too many.
    fn add(&self, document: Open) -> Result<String> {
        let mut all = self.documents();
        if all.open.len() >= MOST {
            return Err(edifice_base::Error::method(TooMany));
        }
        all.last += 1;
        let number = all.last;
        all.open.insert(number, Arc::new(Mutex::new(document)));
        Ok(format!("d{number}"))
    }

    /// All documents with their ids.
    fn all(&self) -> Vec<(String, Arc<Mutex<Open>>)> {
        let all = self.documents();
        let named = all.open.iter().map(|(n, d)| (format!("d{n}"), d.clone()));
        named.collect()
    }

    /// The document of an id, `d1` for the first.
    fn get(&self, id: &str) -> Option<Arc<Mutex<Open>>> {
        self.documents().open.get(&number(id)?).cloned()
    }

    /// Forgets a document.
    fn close(&self, id: &str) {
        if let Some(number) = number(id) {
            self.documents().open.remove(&number);
        }
    }

    /// Names of the documents with unsaved work.
    pub fn unsaved(&self) -> Vec<String> {
        let all = self.all();
        let names = all.iter().filter_map(|(_, document)| {
            let open = document.lock().unwrap_or_else(PoisonError::into_inner);
            open.is_unsaved().then(|| open.stem().to_owned())
        });
        names.collect()
    }

    /// Removes the journals of documents in which nothing is unsaved.
    fn end(&self) {
        for (_, document) in self.all() {
            let mut open = document.lock().unwrap_or_else(PoisonError::into_inner);
            if !open.is_unsaved() {
                open.forget();
            }
        }
    }

    /// Number of documents whose unsaved work is offered.
    pub fn count_offered(&self) -> usize {
        self.offered().len()
    }
}

/// The number in an id.
fn number(id: &str) -> Option<u64> {
    id.strip_prefix('d')?.parse().ok()
}
