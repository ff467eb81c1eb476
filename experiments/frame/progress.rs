//! Progress on standard error: bars on a terminal, plain lines elsewhere.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use edifice_base::{Error, Result};
use indicatif::{ProgressBar, ProgressStyle};

/// True once only warnings are told.
static SILENT: AtomicBool = AtomicBool::new(false);

/// From now on no progress is told by this process, but warnings are.
pub fn silence() {
    SILENT.store(true, Ordering::Relaxed);
}

fn is_silent() -> bool {
    SILENT.load(Ordering::Relaxed)
}

/// Progress of one batch of units.
pub struct Progress {
    bar: Option<ProgressBar>,
    name: String,
    total: u64,
    done: AtomicU64,
    start: Instant,
}

impl Progress {
    /// Starts at `done` of `total` units.
    pub fn new(name: &str, total: u64, done: u64) -> Self {
        let shown = std::io::stderr().is_terminal() && !is_silent();
        let bar = shown.then(|| {
            let bar = ProgressBar::new(total).with_position(done);
            let style = ProgressStyle::with_template(
                "{prefix:32!} {bar:30.cyan/blue} {pos}/{len} {elapsed} (left {eta}) {msg}",
            );
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_prefix(name.to_string());
            bar.enable_steady_tick(std::time::Duration::from_millis(200));
            bar
        });
        if bar.is_none() && done > 0 {
            line(&format!(
                "{name}: {done} of {total} units were finished before"
            ));
        }
        Self {
            bar,
            name: name.to_string(),
            total,
            done: AtomicU64::new(done),
            start: Instant::now(),
        }
    }

    /// One unit more is done; plain lines come at each tenth of a long batch.
    pub fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        match &self.bar {
            Some(bar) => bar.inc(1),
            None if done * 10 / self.total != (done - 1) * 10 / self.total
                && self.start.elapsed().as_secs() >= 5 =>
            {
                let seconds = self.start.elapsed().as_secs();
                line(&format!(
                    "{}: {done} of {} units, {seconds} s",
                    self.name, self.total
                ));
            }
            None => {}
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A line for programs to standard output; a reader that has gone away is no error.
///
/// # Errors
/// [`Error::Io`] when it cannot be written.
pub(crate) fn result(value: &serde_json::Value) -> Result<()> {
    match writeln!(std::io::stdout().lock(), "{value}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io("standard output".as_ref(), "write", e))
        }
        _ => Ok(()),
    }
}

/// A message to standard error; nobody is left to tell when that is closed. After [`silence`], only warnings.
pub(crate) fn line(text: &str) {
    if is_silent() && !text.starts_with("warning") {
        return;
    }
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
