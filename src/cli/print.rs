//! Printing that survives a closed pipe.

use std::io::Write;

/// Prints one line of result to standard output; a reader that has gone away is not an error.
pub fn line(text: &str) -> edifice_base::Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(
            edifice_base::Error::io("standard output".as_ref(), "write", error),
        ),
        _ => Ok(()),
    }
}

/// Prints a message to standard error.
pub fn message(text: &str) {
    // Nobody is left to tell when standard error itself is closed.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints an error.
pub fn error(error: &edifice_base::Error) {
    message(&format!("error: {error}"));
}
