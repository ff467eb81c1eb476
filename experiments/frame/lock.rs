//! One run at a time in a folder of the report.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::Path;

use super::progress;
use edifice_base::{Error, Result};

/// Name of the file that is locked. It is empty and stays: two processes could lock a file of this
/// name at once if one removed it while the other waits for it.
const NAME: &str = ".lock";

/// Another process writes here.
#[derive(Debug, thiserror::Error)]
#[error("another run writes here; wait until it has finished, or choose another --out")]
struct Busy;

/// The right to write into a folder, until it is dropped or the process ends, however it ends.
pub struct Lock(#[expect(dead_code, reason = "held, not read")] File);

impl Lock {
    /// Takes the folder.
    ///
    /// # Errors
    /// [`Error::Content`] that names the folder when another run has it.
    pub fn take(folder: &Path) -> Result<Self> {
        let file = open(folder)?;
        exclusive(&file, folder)?;
        Ok(Self(file))
    }

    /// Takes a file, which is made where it is not there; `None` while another process has it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn claim(path: &Path) -> Result<Option<Self>> {
        let file = open_file(path)?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self(file))),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(e)) => unsupported(path, e).map(|()| Some(Self(file))),
        }
    }

    /// Takes the folder as soon as no other process has it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn wait(folder: &Path) -> Result<Self> {
        let file = open(folder)?;
        file.lock().or_else(|e| unsupported(folder, e))?;
        Ok(Self(file))
    }
}

/// Locks an open file; `path` stands in the error when another process has it.
///
/// # Errors
/// [`Error::Content`] then, [`Error::Io`].
pub fn exclusive(file: &File, path: &Path) -> Result<()> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(Error::content(path, Busy)),
        Err(TryLockError::Error(e)) => unsupported(path, e),
    }
}

fn open(folder: &Path) -> Result<File> {
    open_file(&folder.join(NAME))
}

fn open_file(path: &Path) -> Result<File> {
    OpenOptions::new()
        .create(true)
        .truncate(false)
        .read(true)
        .write(true)
        .open(path)
        .map_err(|e| Error::io(path, "create", e))
}

/// Goes on, with a warning, where the file system has no locks.
fn unsupported(path: &Path, error: std::io::Error) -> Result<()> {
    if error.kind() != ErrorKind::Unsupported {
        return Err(Error::io(path, "lock", error));
    }
    progress::line(&format!(
        "{}: no locks on this file system; start no second run there",
        path.display()
    ));
    Ok(())
}
