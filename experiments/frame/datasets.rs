//! The data that ships with the project, as part of the program: an installed one needs no checkout.

use std::path::{Path, PathBuf};

use include_dir::{Dir, DirEntry, include_dir};

use crate::{Error, Result};

/// `datasets/` of the checkout that the program was built from.
static DATASETS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/datasets");

/// Nothing ships under this name.
#[derive(Debug, thiserror::Error)]
#[error("nothing of this name ships with the project")]
struct NotShipped;

/// Every shipped file: its path below `datasets/`, with `/` between folders, and its bytes.
pub fn files() -> Vec<(String, &'static [u8])> {
    let mut found = Vec::new();
    let mut folders = vec![&DATASETS];
    while let Some(folder) = folders.pop() {
        folders.extend(folder.dirs());
        found.extend(folder.files().map(|file| {
            let path = file.path().to_string_lossy().replace('\\', "/");
            (path, file.contents())
        }));
    }
    found.sort_unstable();
    found
}

/// Writes a shipped file or folder below `folder` and returns its path there.
///
/// # Errors
/// [`Error::Content`] when there is none of this name, [`Error::Io`].
pub fn unpack(name: &str, folder: &Path) -> Result<PathBuf> {
    let place = folder.join(name);
    match DATASETS.get_entry(name) {
        None => {
            let named = Path::new("datasets").join(name);
            return Err(Error::content(&named, NotShipped));
        }
        Some(DirEntry::File(file)) => write(&place, file.contents())?,
        Some(DirEntry::Dir(_)) => {
            // The digest is over the folder's files: none that an older program left may stay.
            match std::fs::remove_dir_all(&place) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                    return Err(Error::io(&place, "remove", e));
                }
                _ => {}
            }
            let within = format!("{name}/");
            for (path, bytes) in files() {
                if path.starts_with(&within) {
                    write(&folder.join(path), bytes)?;
                }
            }
        }
    }
    Ok(place)
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    }
    std::fs::write(path, bytes).map_err(|e| Error::io(path, "write", e))
}
