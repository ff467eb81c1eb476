//! Long work: what it says of itself while it runs, and that it can be stopped.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use edifice_base::Ended;

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

    /// The answer of a watch: [`ControlFlow::Break`] once somebody asked it to stop.
    pub fn go_on(&self) -> ControlFlow<()> {
        match self.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Checks that a method was not stopped.
    ///
    /// # Errors
    /// [`Stopped`]: what a stopped method has found until then is no edit.
    pub fn whole(&self, ended: Ended) -> Result<(), Stopped> {
        match ended {
            Ended::Finished => Ok(()),
            Ended::Interrupted => Err(Stopped),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stopped_work_is_told_of_no_more() {
        let work = Work::default();
        let mut steps = 0;
        for k in 0..10 {
            if work.tell("counting", Some(f64::from(k) / 10.0)).is_err() {
                break;
            }
            steps += 1;
            if k == 3 {
                work.clone().stop();
            }
        }
        assert_eq!((steps, work.go_on()), (4, ControlFlow::Break(())));
        assert_eq!(work.told().part, Some(0.4));
        assert_eq!(work.whole(Ended::Interrupted), Err(Stopped));
        assert_eq!(Work::default().go_on(), ControlFlow::Continue(()));
    }
}
