//! Whole files in, whole files out: a file appears whole or not at all.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::{Error, Result};

/// Largest file that a reader accepts, in bytes.
const MAX_FILE_BYTES: u64 = 1 << 30;

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
    let mut builder = tempfile::Builder::new();
    builder.prefix(".edifice-").suffix(".tmp");
    #[cfg(unix)]
    {
        // The default of 0600 suits secrets; results follow the user's umask like any other file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // The system's error names the temporary file, which means nothing to the user: keep its kind.
    let mut file = builder.tempfile_in(folder).map_err(|e| e.kind())?;
    file.write_all(bytes)?;
    file.persist(target).map_err(|e| e.error)?;
    Ok(())
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
    fn unwritable_outputs_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none/a.txt");
        let message = write_atomic(&missing, b"x").unwrap_err().to_string();
        assert!(message.contains("none/a.txt: cannot write"), "{message}");
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
