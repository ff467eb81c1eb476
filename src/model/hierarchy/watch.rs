//! The observer of a search, which may end it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use super::search_step::SearchStep;

/// Called with every accepted configuration, and with `None` before every round of EM, from any thread.
/// [`ControlFlow::Break`] ends the search with the best configuration so far; the observer is not called again.
/// [`learn_observed`](super::learn_observed) has an example.
pub type Observer<'a> = dyn Fn(Option<&SearchStep>) -> ControlFlow<()> + Sync + 'a;

/// An observer, and whether it has ended the search.
pub(crate) struct Watch<'a> {
    observer: &'a Observer<'a>,
    ended: AtomicBool,
}

impl<'a> Watch<'a> {
    pub(super) fn new(observer: &'a Observer<'a>) -> Self {
        Self {
            observer,
            ended: AtomicBool::new(false),
        }
    }

    /// Asks the observer; true if the search shall go on. Once false, it stays false.
    pub(super) fn goes_on(&self) -> bool {
        self.tell(None);
        !self.ended()
    }

    /// Tells of an accepted configuration.
    pub(super) fn accepted(&self, step: &SearchStep) {
        self.tell(Some(step));
    }

    pub(super) fn ended(&self) -> bool {
        self.ended.load(Ordering::Relaxed)
    }

    fn tell(&self, step: Option<&SearchStep>) {
        if !self.ended() && (self.observer)(step).is_break() {
            self.ended.store(true, Ordering::Relaxed);
        }
    }
}
