//! The studio: documents of [`edifice_editing`] in a page served on this machine, `edifice studio`.
//!
//! # What is asked and answered
//! Every answer of `/api` is JSON, but for exports and scripts; an error is `{"error": "..."}` with the status 400 (no
//! JSON), 404, 409 (changed in another tab, or a file that would be overwritten) or 422 (a command that cannot be done).
//!
//! | request | body | answer |
//! | --- | --- | --- |
//! | `GET /api/documents` | | `version`, `readOnly`, `documents` (each `id`, `kind`, `name`, `revision`, `unsaved`, `job`), `examples` |
//! | `POST /api/documents` | `{"example": ID}` | a document, or a job |
//! | `GET /api/documents/ID` | | a document |
//! | `POST /api/documents/ID/edit` | `{"commands": [...], "revision": N}` | the document after the [commands](edifice_editing), or a job |
//! | `POST /api/documents/ID/ask` | `{"ask": ...}` | what the editor says; the document stays as it is |
//! | `POST /api/documents/ID/undo`, `redo` | `{}` | the document |
//! | `POST /api/documents/ID/save` | `{"overwrite": true}` or `{}` | `file`, `script`: names of the files written |
//! | `GET /api/documents/ID/script` | | the commands as a shell script |
//! | `GET /api/documents/ID/export/FORMAT` | | the document in that format |
//!
//! | `GET /api/jobs/J` | | a job |
//! | `POST /api/jobs/J/stop` | `{}` | the job, stopped |
//!
//! Work that takes longer than 0.3 s is a job: the answer is `{"job": {...}}` with the status 202, and the page asks for the
//! job until it is over. A job: `id`, `document` (of one that is opened, once it is there), `state` (`running`, `done`,
//! `stopped`, `failed`), `error`, `step` in words, `part` from 0 to 1 or null, `seconds`. One job at a time works on a document;
//! `job` in its summary shows it to every tab. A job that is stopped changes nothing; its method ends at its next step.
//!
//! A document: `id`, `kind`, `name`, `revision`, `undo`, `redo`, `unsaved`, `file`, `formats`, `warnings`, `log` (each `said`,
//! `commands`, `done`), `milliseconds` of the last edit, and `view`, what its editor shows.
//!
//! # Who may ask
//! Only a page of this server, opened by whoever started it ([`guard`]): requests are looked at before they are routed.
//! Files are named by the command line alone; the page knows them by an id.

mod api;
mod assets;
mod document;
pub mod guard;
mod jobs;
mod server;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

pub use api::router;
pub use document::{Open, SaveError};
pub use server::{Running, start};

use edifice_base::Result;

/// The settings that the studio is started with.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Files to open.
    pub files: Vec<PathBuf>,
    /// Port; 0 takes a free one.
    pub port: u16,
    /// Never write a file.
    pub read_only: bool,
    /// Limits of requests.
    pub limits: guard::Limits,
}

/// The open documents.
pub struct Studio {
    documents: Mutex<Vec<Arc<Mutex<Open>>>>,
    jobs: jobs::Jobs,
    read_only: bool,
}

/// Most documents open at once.
const MOST: usize = 200;

/// Too many documents.
#[derive(Debug, thiserror::Error)]
#[error("{MOST} documents are open: end the studio and start it again to open more")]
struct TooMany;

impl Studio {
    /// Opens the files.
    ///
    /// # Errors
    /// The first file that cannot be read, or that no editor knows.
    pub fn new(settings: &Settings) -> Result<Self> {
        let open = settings.files.iter().map(|path| {
            let document = Open::file(path)?;
            Ok(Arc::new(Mutex::new(document)))
        });
        Ok(Self {
            documents: Mutex::new(open.collect::<Result<_>>()?),
            jobs: jobs::Jobs::default(),
            read_only: settings.read_only,
        })
    }

    /// Adds a document; its id.
    ///
    /// # Errors
    /// When there are too many.
    fn add(&self, document: Open) -> Result<String> {
        let mut all = self
            .documents
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if all.len() >= MOST {
            return Err(edifice_base::Error::method(TooMany));
        }
        all.push(Arc::new(Mutex::new(document)));
        Ok(format!("d{}", all.len()))
    }

    fn all(&self) -> Vec<Arc<Mutex<Open>>> {
        let all = self.documents.lock();
        all.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The document of an id, `d1` for the first.
    fn get(&self, id: &str) -> Option<Arc<Mutex<Open>>> {
        let number = id.strip_prefix('d')?.parse::<usize>().ok()?;
        self.all().get(number.checked_sub(1)?).cloned()
    }
}
