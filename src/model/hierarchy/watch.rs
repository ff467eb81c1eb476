//! What a search tells of itself, and that it can be stopped.

use std::sync::{Mutex, PoisonError};

use edifice_base::{Progress, Watch, Watched};

use super::Step;

/// A search that is watched: told of with every accepted configuration, whose cost is minus its score, and before every round
/// of EM.
pub(crate) struct Watching<'a> {
    watched: Watched<'a>,
    /// Configurations accepted, and the lowest cost among them.
    accepted: Mutex<(u64, f64)>,
}

impl<'a> Watching<'a> {
    pub fn new(watch: &'a Watch<'a>) -> Self {
        Self {
            watched: Watched::new(watch),
            accepted: Mutex::new((0, f64::INFINITY)),
        }
    }

    /// True if the search shall go on. Once false, it stays false.
    pub fn goes_on(&self) -> bool {
        self.watched.goes_on(Progress::stage("rounds of EM"))
    }

    /// Tells of an accepted configuration.
    pub fn accepted(&self, step: &Step) {
        let (done, best) = {
            let mut accepted = self.accepted.lock().unwrap_or_else(PoisonError::into_inner);
            *accepted = (accepted.0 + 1, accepted.1.min(-step.score));
            *accepted
        };
        let mut progress = Progress::stage("configurations accepted").costs(-step.score, best);
        progress.done = done;
        self.watched.goes_on(progress);
    }

    pub fn ended(&self) -> bool {
        self.watched.is_stopped()
    }
}
