//! Errors of files and commands: the failure and its place.
//!
//! Each layer has its own error type with one variant per way to be wrong, carrying the culprit
//! (`LayoutError`, `GrammarError`, ...). [`Error`] is what a user of files and commands meets: it
//! adds the path, and the place inside the file, to such a cause.

use std::path::{Path, PathBuf};

/// Result of an operation on files or of a command.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Any cause, from any layer.
pub type Cause = Box<dyn std::error::Error + Send + Sync + 'static>;

/// A failure with its place: which file, where in it, and why.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused to read or write.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// File or folder concerned.
        path: PathBuf,
        /// The attempted action, as a verb: `read`, `create`, ...
        action: &'static str,
        /// The system's answer.
        source: std::io::Error,
    },
    /// The content of a file is not what its format promises.
    #[error("{}{place}: {source}", named(path))]
    Input {
        /// File concerned; empty for bytes that are in no file.
        path: PathBuf,
        /// Place in the file: `line 3, column 7`, `regions[17].width`, `pixel (3, 9)`, ...
        place: String,
        /// The defect at that place.
        source: Cause,
    },
    /// The content of a file as a whole cannot serve.
    #[error("{}{source}", named(path))]
    Content {
        /// File concerned; empty for bytes that are in no file.
        path: PathBuf,
        /// The defect of the content.
        source: Cause,
    },
    /// A value that the user gave on the command line cannot serve.
    #[error("{option}: {message}")]
    Option {
        /// The option or argument.
        option: String,
        /// Why it cannot serve.
        message: String,
    },
    /// A method failed on valid input.
    #[error("{0}")]
    Method(#[source] Cause),
    /// The user asked to stop; what was finished is kept.
    #[error("interrupted; finished work is kept, run the same command again to resume")]
    Interrupted,
}

/// The path before what is wrong; nothing for bytes that are in no file.
fn named(path: &Path) -> String {
    match path.as_os_str().is_empty() {
        true => String::new(),
        false => format!("{}: ", path.display()),
    }
}

impl Error {
    /// Wraps an I/O error with its path and the verb that failed.
    pub fn io(path: &Path, action: &'static str, source: std::io::Error) -> Self {
        Self::Io {
            path: path.to_path_buf(),
            action,
            source,
        }
    }

    /// Wraps a cause with its file and the place in it.
    pub fn input(path: &Path, place: impl Into<String>, source: impl Into<Cause>) -> Self {
        Self::Input {
            path: path.to_path_buf(),
            place: place.into(),
            source: source.into(),
        }
    }

    /// Wraps a cause with its file.
    pub fn content(path: &Path, source: impl Into<Cause>) -> Self {
        Self::Content {
            path: path.to_path_buf(),
            source: source.into(),
        }
    }

    /// A bad command-line value.
    pub fn option(option: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Option {
            option: option.into(),
            message: message.into(),
        }
    }

    /// A method's own failure.
    pub fn method(source: impl Into<Cause>) -> Self {
        Self::Method(source.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_in_no_file_are_named_by_their_place_alone() {
        let said = |path: &str| Error::input(Path::new(path), "line 3", "no number").to_string();
        assert_eq!(said("a.csv"), "a.csv: line 3: no number");
        assert_eq!(said(""), "line 3: no number");
        assert_eq!(Error::content(Path::new(""), "empty").to_string(), "empty");
    }
}
