//! Printing that survives a closed pipe.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// True once only results, warnings and errors are printed.
static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on messages are not printed, but results, warnings and errors are.
pub(crate) fn quiet() {
    QUIET.store(true, Ordering::Relaxed);
    edifice_experiments::silence();
}

/// True after [`quiet`].
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// The option of a line for programs.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct Json {
    /// Print one line of JSON, for programs
    #[arg(long)]
    json: bool,
}

impl Json {
    /// True if the line was asked for.
    pub(crate) fn is_asked(self) -> bool {
        self.json
    }

    /// Prints the line, if it was asked for.
    pub(crate) fn end(self, value: &serde_json::Value) -> edifice_base::Result<()> {
        match self.json {
            true => line(&value.to_string()),
            false => Ok(()),
        }
    }

    /// Prints a text, and then the line, if it was asked for.
    pub(crate) fn after(self, text: &str, value: &serde_json::Value) -> edifice_base::Result<()> {
        line(text)?;
        self.end(value)
    }
}

/// Prints one line of result to standard output; a reader that has gone away is not an error.
pub(crate) fn line(text: &str) -> edifice_base::Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(
            edifice_base::Error::io("standard output".as_ref(), "write", error),
        ),
        _ => Ok(()),
    }
}

/// Prints a message to standard error; after [`quiet`], only a warning.
pub(crate) fn message(text: &str) {
    if is_quiet() && !text.starts_with("warning") {
        return;
    }
    say(text);
}

fn say(text: &str) {
    // Nobody is left to tell when standard error itself is closed.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints an error.
pub(crate) fn error(error: &edifice_base::Error) {
    say(&format!("error: {error}"));
}
