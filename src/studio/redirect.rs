//! A file that leads the browser to the studio.
//!
//! The arguments of a process can be read by every user of the machine, so that the address with its token is no argument of the
//! program that opens the browser: the argument is a file that only this user reads, and the page in it goes on to the address.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::private;
use edifice_base::{Error, Result};

const ENDING: &str = ".open.html";

/// The file, for as long as the studio runs; it is removed in the end.
pub struct Redirect {
    path: PathBuf,
    // Held open for its lock.
    _file: File,
}

impl Redirect {
    /// Writes it into the folder of the studio's state, and removes those of studios that were killed.
    ///
    /// # Errors
    /// When it cannot be written for this user alone.
    pub fn new(folder: &Path, address: &str) -> Result<Self> {
        let fail = |path: &Path| {
            let path = path.to_path_buf();
            move |e| Error::io(&path, "write", e)
        };
        private::make_folder(folder).map_err(fail(folder))?;
        for old in private::files(folder, ENDING) {
            if private::take_file(&old).is_some() {
                // One that stays is in nobody's way: its token opens nothing any more.
                let _ = std::fs::remove_file(&old);
            }
        }
        let path = folder.join(format!("{}{ENDING}", private::random_name(8)?));
        let mut file = private::make_file(&path).map_err(fail(&path))?;
        let page = format!(
            "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
             <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n<title>Edifice studio</title>\n\
             <p><a href=\"{address}\">Edifice studio</a></p>\n"
        );
        file.write_all(page.as_bytes()).map_err(fail(&path))?;
        Ok(Self { path, _file: file })
    }

    /// The file's place.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Redirect {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}
