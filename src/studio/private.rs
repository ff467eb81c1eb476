//! Files for this user alone, in the folder where programs keep their state.
//!
//! The folder has the mode 0700 and its files 0600: no other user of the machine reads them. It holds the journals of documents
//! (`journal`) and, while a studio runs, the file that leads the browser to it ([`super::redirect`]).

use std::fs::{DirBuilder, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// The folder of the studio's state, by the customs of the system: `$XDG_STATE_HOME/edifice/studio`, otherwise
/// `~/.local/state/edifice/studio`; on a Mac below `~/Library/Application Support`, on Windows below `%LOCALAPPDATA%`.
/// `None` where the environment names no such place.
pub fn state_folder() -> Option<PathBuf> {
    let place = |name: &str| {
        let path = PathBuf::from(std::env::var_os(name)?);
        path.is_absolute().then_some(path)
    };
    let base = match std::env::consts::OS {
        "windows" => place("LOCALAPPDATA")?,
        "macos" => place("XDG_STATE_HOME")
            .or_else(|| Some(place("HOME")?.join("Library/Application Support")))?,
        _ => place("XDG_STATE_HOME").or_else(|| Some(place("HOME")?.join(".local/state")))?,
    };
    Some(base.join("edifice").join("studio"))
}

/// Makes a folder that only its user enters, or makes one that is there such a folder.
///
/// # Errors
/// Those of the system: also for a folder that belongs to another user.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
        builder.mode(0o700).create(folder)?;
        std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o700))
    }
    #[cfg(not(unix))]
    builder.create(folder)
}

/// Makes a new file that only its user reads, and locks it for as long as it is open.
///
/// # Errors
/// Those of the system: also for a file that is there.
pub fn make_file(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).append(true).create_new(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.mode(0o600);
    }
    let file = options.open(path)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(std::fs::TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        // Where there are no locks the file still serves.
        Err(std::fs::TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(file),
        Err(std::fs::TryLockError::Error(e)) => Err(e),
    }
}

/// Opens a file that [`make_file`] made and that no running program holds; `None` if one does, or it cannot be opened.
pub fn take_file(path: &Path) -> Option<File> {
    let mut options = OpenOptions::new();
    let file = options.read(true).append(true).open(path).ok()?;
    file.try_lock().is_ok().then_some(file)
}

/// Files of a folder whose names end so, in order of name.
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let named = |p: &PathBuf| p.to_string_lossy().ends_with(ending);
    let mut found: Vec<PathBuf> = entries.map(|e| e.path()).filter(named).collect();
    found.sort();
    found
}

/// A name that no other file has: hexadecimal digits of bytes from the operating system.
///
/// # Errors
/// When the system gives none.
pub fn random_name(bytes: usize) -> edifice_base::Result<String> {
    let mut random = vec![0_u8; bytes];
    getrandom::fill(&mut random).map_err(edifice_base::Error::method)?;
    Ok(random.iter().map(|b| format!("{b:02x}")).collect())
}
