//! The data that ships with the project, as part of the program: an installed one needs no checkout.

use std::path::{Path, PathBuf};

use include_dir::{Dir, DirEntry, include_dir};

use edifice_base::{Error, Result};

/// `datasets/` of the checkout that the program was built from.
static DATASETS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR");

/// Nothing ships under this name.
#[derive(Debug, thiserror::Error)]
#[error("nothing of this name ships with the project")]
struct NotShipped;

/// Every shipped file: its path below `datasets/`, with `/` between folders, and its bytes.
pub fn files() -> Vec<(String, &'static [u8])> {
    let mut found = Vec::new();
    // At the top stand the crate's own sources.
    let mut folders: Vec<&Dir<'static>> = DATASETS.dirs().collect();
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

/// The bytes of a shipped file, named by its path below `datasets/`.
///
/// # Errors
/// [`Error::Content`] when there is none of this name.
pub fn shipped_bytes(name: &str) -> Result<&'static [u8]> {
    let file = DATASETS.get_file(name);
    let file = file.ok_or_else(|| Error::content(&Path::new("datasets").join(name), NotShipped))?;
    Ok(file.contents())
}

/// The text of a shipped file, named by its path below `datasets/`; none when there is none of this name, or it is no text.
pub fn shipped_text(name: &str) -> Option<&'static str> {
    DATASETS.get_file(name)?.contents_utf8()
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
        // Tasks of a sweep may be reading it.
        Some(DirEntry::Dir(_)) if is_whole(name, folder) => {}
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

/// True if a shipped folder stands below `folder` with all its files and no others.
fn is_whole(name: &str, folder: &Path) -> bool {
    let within = format!("{name}/");
    let mut wanted = 0;
    for (path, bytes) in files() {
        if path.starts_with(&within) {
            wanted += 1;
            if std::fs::read(folder.join(path)).ok().as_deref() != Some(bytes) {
                return false;
            }
        }
    }
    count(&folder.join(name)).is_some_and(|found| found == wanted)
}

/// Files below a folder.
fn count(folder: &Path) -> Option<usize> {
    let mut found = 0;
    for entry in std::fs::read_dir(folder).ok()? {
        let path = entry.ok()?.path();
        found += if path.is_dir() { count(&path)? } else { 1 };
    }
    Some(found)
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    }
    std::fs::write(path, bytes).map_err(|e| Error::io(path, "write", e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_carries_what_the_checkout_has() {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let mut found = Vec::new();
        let top = std::fs::read_dir(&root).unwrap().map(|e| e.unwrap().path());
        let mut folders: Vec<PathBuf> = top.filter(|path| path.is_dir()).collect();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => found.push(path),
                }
            }
        }
        let name = |path: &PathBuf| {
            let below = path.strip_prefix(&root).unwrap().to_string_lossy();
            below.replace('\\', "/")
        };
        let mut names: Vec<String> = found.iter().map(name).collect();
        names.sort_unstable();
        let carried = files();
        let ours: Vec<&String> = carried.iter().map(|(name, _)| name).collect();
        assert!(ours.len() > 70);
        // A file that is new needs `touch datasets/mod.rs`.
        assert_eq!(ours, names.iter().collect::<Vec<_>>());
        for (name, bytes) in &carried {
            assert!(std::fs::read(root.join(name)).unwrap() == *bytes, "{name}");
        }
    }

    #[test]
    fn files_and_folders_are_unpacked_and_others_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = unpack("model/asia.bif", folder.path()).unwrap();
        assert!(
            std::fs::read_to_string(file)
                .unwrap()
                .contains("network asia")
        );
        std::fs::write(folder.path().join("model/old.bif"), b"x").unwrap();
        let whole = unpack("model", folder.path()).unwrap();
        assert!(whole.join("asia.bif").exists() && !whole.join("old.bif").exists());
        let message = unpack("model/alarm.bif", folder.path())
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("datasets/model/alarm.bif: nothing"),
            "{message}"
        );
    }
}
