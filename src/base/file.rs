//! Whole files in, whole files out: a file appears whole or not at all.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

use crate::{Error, Result};

/// Largest file that a reader accepts, in bytes.
const MAX_FILE_BYTES: u64 = 1 << 30;

/// Temporary files are named `.edifice-RANDOM.tmp`.
const PREFIX: &str = ".edifice-";
const SUFFIX: &str = ".tmp";

/// Media type by the ending of a file's name.
pub fn media_type(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "json" | "jsonl" => "application/json",
        "csv" => "text/csv",
        "toml" => "application/toml",
        "txt" | "bif" | "cga" | "py" => "text/plain",
        "xml" | "gml" => "application/xml",
        "gz" => "application/gzip",
        _ => "application/octet-stream",
    }
}

/// Reads a whole file.
///
/// # Errors
/// [`Error::Io`] naming the path; files above 1 GiB are refused before they are read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let metadata = std::fs::metadata(path).map_err(|e| Error::io(path, "read", e))?;
    if metadata.len() > MAX_FILE_BYTES {
        let message = format!("{} bytes, more than {MAX_FILE_BYTES}", metadata.len());
        let error = io::Error::new(io::ErrorKind::FileTooLarge, message);
        return Err(Error::io(path, "read", error));
    }
    std::fs::read(path).map_err(|e| Error::io(path, "read", e))
}

/// Writes `bytes` to `path` so that a reader sees the old file or the whole new one, never a part:
/// a temporary file in the same folder is written, then renamed. Symbolic links are followed;
/// pipes and devices are written directly.
///
/// A writer that is killed leaves its temporary file; the first write of another process into the
/// folder removes it. Writers hold an advisory lock on their temporary file, so that one that still
/// runs, in this process or another, keeps it.
///
/// # Errors
/// [`Error::Io`] naming `path` when its folder does not exist or cannot be written, when it is a
/// folder, or when an existing file is read-only; nothing is left behind.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, bytes).map_err(|e| Error::io(path, "write", e))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(metadata) if !metadata.is_file() => return std::fs::write(path, bytes),
        Ok(metadata) if metadata.permissions().readonly() => {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        Ok(_) => std::fs::canonicalize(path)?,
        Err(_) => path.to_path_buf(),
    };
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    };
    if !folder.exists() {
        let problem = format!("there is no folder {}", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, problem));
    }
    remove_left_over(&folder);
    // The system's error names the temporary file, which means nothing to the user: keep its kind.
    let mut file = temporary(&folder).map_err(|e| e.kind())?;
    file.write_all(bytes)?;
    file.persist(target).map_err(|e| e.error)?;
    Ok(())
}

/// A new temporary file in `folder`, locked.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        // The default of 0600 suits secrets; results follow the user's umask like any other file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    loop {
        let file = builder.tempfile_in(folder)?;
        match file.as_file().lock() {
            // Between its creation and the lock another process may have taken it for left over.
            Ok(()) if !file.path().exists() => {}
            Ok(()) => return Ok(file),
            // Where there are no locks, nobody removes what is not his.
            Err(e) if e.kind() == io::ErrorKind::Unsupported => return Ok(file),
            Err(e) => return Err(e),
        }
    }
}

/// Removes the temporary files of killed writers from `folder`, once per process and folder. What
/// cannot be listed, locked or removed stays: it is in nobody's way.
fn remove_left_over(folder: &Path) {
    static DONE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut done = DONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Ok(folder) = std::fs::canonicalize(folder) else {
        return;
    };
    if done.insert(folder.clone()) {
        remove_from(&folder);
    }
}

fn remove_from(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let ours = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if ours
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(read_bytes(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn temporary_files_of_killed_writers_are_removed_and_of_running_ones_kept() {
        let folder = tempfile::tempdir().unwrap();
        let dead = folder.path().join(".edifice-killed.tmp");
        std::fs::write(&dead, b"half").unwrap();
        let alive = temporary(folder.path()).unwrap();
        let alien = folder.path().join("edifice-notes.tmp");
        std::fs::write(&alien, b"mine").unwrap();
        write_atomic(&folder.path().join("a.txt"), b"one").unwrap();
        assert!(!dead.exists());
        assert!(alive.path().exists() && alien.exists());
    }

    #[test]
    fn writers_in_one_folder_do_not_disturb_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let write = &|name: usize| {
            for k in 0..50 {
                // As other processes do at their first write, at any moment.
                remove_from(folder.path());
                let path = folder.path().join(format!("{name}.txt"));
                write_atomic(&path, format!("{name} {k}").as_bytes()).unwrap();
            }
        };
        std::thread::scope(|s| {
            for name in 0..4 {
                s.spawn(move || write(name));
            }
        });
        for name in 0..4 {
            let text = read_bytes(&folder.path().join(format!("{name}.txt"))).unwrap();
            assert_eq!(text, format!("{name} 49").as_bytes());
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4);
    }

    #[test]
    fn unwritable_outputs_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none/a.txt");
        let message = write_atomic(&missing, b"x").unwrap_err().to_string();
        assert!(message.contains("none/a.txt: cannot write"), "{message}");
        let named = format!(
            "there is no folder {}",
            folder.path().join("none").display()
        );
        assert!(message.contains(&named), "{message}");
        let message = write_atomic(folder.path(), b"x").unwrap_err().to_string();
        assert!(message.contains("directory"), "{message}");
        let locked = folder.path().join("locked.txt");
        std::fs::write(&locked, b"old").unwrap();
        let mut permissions = std::fs::metadata(&locked).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&locked, permissions).unwrap();
        assert!(write_atomic(&locked, b"new").is_err());
        assert_eq!(read_bytes(&locked).unwrap(), b"old");
    }
}
