//! Long calls in a thread of their own.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use edifice_base::Watch;
use pyo3::prelude::*;

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

/// As [`detached`], for work that takes a watch: what is interrupted ends soon.
///
/// # Errors
/// As [`detached`].
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Stop(Arc::default());
    let stopped = Arc::clone(&stop.0);
    detached(py, move || {
        work(&|_| match stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })
    })
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
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(failed(
                    "the computation failed inside; please report its input",
                ));
            }
        }
    }
}
