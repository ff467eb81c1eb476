//! Long calls in a thread of their own.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use edifice_base::{Progress, Watch};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors::failed;

/// Between two looks for a signal.
const PAUSE: Duration = Duration::from_millis(50);
/// Stack of the thread.
const STACK: usize = 64 << 20;

/// Ends a computation that nobody waits for any more, when it is dropped.
pub struct Stop(pub Arc<AtomicBool>);

impl Drop for Stop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// As [`detached`], for work that takes a watch: what is interrupted ends soon. With a name, a bar of `tqdm` shows the progress.
///
/// # Errors
/// As [`detached`]; `ImportError` where a bar is asked for and there is no `tqdm`.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    bar: Option<&'static str>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let bar = bar.map(|name| Bar::new(py, name)).transpose()?;
    let stop = Stop(Arc::default());
    let stopped = Arc::clone(&stop.0);
    let last = Arc::new(Mutex::new(None));
    let told = Arc::clone(&last);
    let shown = bar.is_some();
    let work = move || {
        work(&|progress| {
            // A step that comes while the last one is looked at is not shown.
            if shown && let Ok(mut told) = told.try_lock() {
                *told = Some(progress);
            }
            match stopped.load(Ordering::Relaxed) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        })
    };
    let show = || match (&bar, last.lock().ok().and_then(|told| *told)) {
        (Some(bar), Some(progress)) => bar.show(py, &progress),
        _ => Ok(()),
    };
    let found = polled(py, work, show);
    if let Some(bar) = &bar {
        show()?;
        bar.0.call_method0(py, "close")?;
    }
    found
}

/// A bar of `tqdm`, in a notebook or a terminal.
struct Bar(Py<PyAny>);

impl Bar {
    fn new(py: Python<'_>, name: &str) -> PyResult<Self> {
        let about = PyDict::new(py);
        about.set_item("desc", name)?;
        let made = py
            .import("tqdm.auto")?
            .call_method("tqdm", (), Some(&about))?;
        Ok(Self(made.unbind()))
    }

    fn show(&self, py: Python<'_>, progress: &Progress) -> PyResult<()> {
        let bar = self.0.bind(py);
        bar.setattr("n", progress.done)?;
        bar.setattr("total", progress.most)?;
        let best = progress.best.map(|best| format!(", best {best:.6}"));
        let text = format!("{}{}", progress.stage, best.unwrap_or_default());
        bar.call_method1("set_postfix_str", (text,))?;
        Ok(())
    }
}

/// Runs `work` in a thread of its own with the interpreter released, and answers Ctrl-C within `PAUSE`. Work that has been left ends in the
/// background; nobody waits for its result.
///
/// # Errors
/// `KeyboardInterrupt`, or whatever a handler of a signal raises; an `EdificeError` when the work panics.
pub fn detached<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    polled(py, work, || Ok(()))
}

/// As [`detached`]; `look` is called between two looks for a signal.
fn polled<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
    mut look: impl FnMut() -> PyResult<()>,
) -> PyResult<T> {
    let (send, mut receive) = channel();
    let thread = std::thread::Builder::new().stack_size(STACK);
    thread.spawn(move || {
        // Nobody listens any more when the call was interrupted.
        let _ = send.send(work());
    })?;
    loop {
        let (back, found) = py.detach(move || {
            let found = receive.recv_timeout(PAUSE);
            (receive, found)
        });
        receive = back;
        match found {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                look()?;
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(failed(
                    "the computation failed inside; please report its input",
                ));
            }
        }
    }
}
