//! Long work: what it says of itself while it runs, and that it can be stopped.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A piece of work, shared by the thread that does it and whoever watches.
#[derive(Debug, Clone, Default)]
pub struct Work(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    stopped: AtomicBool,
    told: Mutex<Told>,
}

/// The progress of work, as it was told last.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Told {
    /// The present step, in words.
    pub step: String,
    /// The share that is done, from 0 to 1, if it is known.
    pub part: Option<f64>,
}

/// The work was stopped by whoever watches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("stopped: the document is as it was before")]
pub struct Stopped;

impl Work {
    /// Says what is done now, and how much of it.
    ///
    /// # Errors
    /// [`Stopped`] once somebody asked for it: the method then returns.
    pub fn tell(&self, step: &str, part: Option<f64>) -> Result<(), Stopped> {
        let mut told = self.0.told.lock().unwrap_or_else(PoisonError::into_inner);
        step.clone_into(&mut told.step);
        told.part = part;
        match self.is_stopped() {
            true => Err(Stopped),
            false => Ok(()),
        }
    }

    /// As [`Work::tell`] for an observer that can return nothing: when stopped, unwinds to [`stoppable`].
    pub fn tell_or_unwind(&self, step: &str, part: Option<f64>) {
        if let Err(Stopped) = self.tell(step, part) {
            unwind();
        }
    }

    /// Inside a step of which there is nothing new to say: when stopped, unwinds to [`stoppable`].
    pub fn go_on_or_unwind(&self) {
        if self.is_stopped() {
            unwind();
        }
    }

    /// Asks it to stop, which it does at the next step that it tells of.
    pub fn stop(&self) {
        self.0.stopped.store(true, Ordering::Relaxed);
    }

    /// True if it was asked to stop.
    pub fn is_stopped(&self) -> bool {
        self.0.stopped.load(Ordering::Relaxed)
    }

    /// The progress that it told last.
    pub fn told(&self) -> Told {
        let told = self.0.told.lock().unwrap_or_else(PoisonError::into_inner);
        told.clone()
    }
}

/// Leaves the method.
fn unwind() {
    // No panic: its message is not printed, and no hook is called.
    resume_unwind(Box::new(Stopped));
}

/// Runs a method whose observer is told by [`Work::tell_or_unwind`]. What the method owns is dropped when it is stopped.
///
/// # Errors
/// [`Stopped`].
pub fn stoppable<T>(method: impl FnOnce() -> T) -> Result<T, Stopped> {
    catch_unwind(AssertUnwindSafe(method)).map_err(|thrown| match thrown.downcast::<Stopped>() {
        Ok(stopped) => *stopped,
        Err(other) => resume_unwind(other),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stopped_work_leaves_its_method() {
        let work = Work::default();
        let mut steps = 0;
        let done = stoppable(|| {
            for k in 0..10 {
                work.tell_or_unwind("counting", Some(f64::from(k) / 10.0));
                steps += 1;
                if k == 3 {
                    work.clone().stop();
                }
            }
        });
        assert_eq!((done, steps), (Err(Stopped), 4));
        assert_eq!(work.told().part, Some(0.4));
        assert_eq!(stoppable(|| 7), Ok(7));
    }
}
