//! Long calls: what they tell of themselves while they run, and how they are stopped.
//!
//! A long call takes a [`Watch`] and tells it of its [`Progress`], often and from any of its threads. Where the watch answers
//! [`ControlFlow::Break`], the call comes to an end soon, as a rule within a fifth of a second of processor time, and returns
//! the best that it has found so far, with [`Ended::Interrupted`] or another outcome that says so. A call that is never
//! stopped gives the same result whatever its watch.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// The present state of a long call.
///
/// # Examples
/// ```
/// use edifice_base::Progress;
/// let third_walk = Progress::of("walks", 3, 10).costs(12.0, 11.5);
/// assert_eq!(third_walk.share(), Some(0.3));
/// assert_eq!(third_walk.best, Some(11.5));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The present stage in words, such as `walks`.
    pub stage: &'static str,
    /// Steps of the call, or of the stage where the call does not count them through, that are done; 0 where steps are not
    /// counted.
    pub done: u64,
    /// Maximum number of such steps; `None` where it is not known.
    pub most: Option<u64>,
    /// Cost of what the last step found, in the unit of the call. Of a call that maximises a score, minus the score.
    /// `None` between steps.
    pub cost: Option<f64>,
    /// Lowest such cost so far; `None` as long as nothing was found.
    pub best: Option<f64>,
}

impl Progress {
    /// A stage whose steps are not counted.
    pub fn stage(stage: &'static str) -> Self {
        Self {
            stage,
            done: 0,
            most: None,
            cost: None,
            best: None,
        }
    }

    /// Steps done of at most so many.
    pub fn of(stage: &'static str, done: u64, most: u64) -> Self {
        Self {
            done,
            most: Some(most),
            ..Self::stage(stage)
        }
    }

    /// With the cost of what the last step found, and the lowest so far.
    pub fn costs(self, cost: f64, best: f64) -> Self {
        Self {
            cost: Some(cost),
            best: Some(best),
            ..self
        }
    }

    /// Share of the steps that is done, from 0 to 1, where the number of steps is known.
    pub fn share(&self) -> Option<f64> {
        let most = self.most?.max(1);
        Some(self.done.min(most) as f64 / most as f64)
    }
}

/// The observer of a long call, called from any thread; [`ControlFlow::Break`] stops the call. [`unwatched`] never does.
pub type Watch<'a> = dyn Fn(Progress) -> ControlFlow<()> + Sync + 'a;

/// The [`Watch`] of a call that nobody stops.
pub fn unwatched(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The way in which a long call came to its end.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Ended {
    /// All of its steps were made.
    #[default]
    Finished,
    /// It was stopped by its [`Watch`]: the result is the best until then.
    Interrupted,
}

/// A [`Watch`] inside the call that it watches. Once it has stopped the call, it is asked no more.
///
/// # Examples
/// ```
/// use std::ops::ControlFlow;
/// use edifice_base::{Ended, Progress, Watched};
/// let enough = |progress: Progress| match progress.done {
///     0..3 => ControlFlow::Continue(()),
///     _ => ControlFlow::Break(()),
/// };
/// let watched = Watched::new(&enough);
/// let sum: u64 = (0..10).take_while(|&k| watched.goes_on(Progress::of("sum", k, 10))).sum();
/// assert_eq!((sum, watched.ended()), (0 + 1 + 2, Ended::Interrupted));
/// ```
pub struct Watched<'a> {
    watch: &'a Watch<'a>,
    stopped: AtomicBool,
}

impl<'a> Watched<'a> {
    /// A call that is watched.
    pub fn new(watch: &'a Watch<'a>) -> Self {
        Self {
            watch,
            stopped: AtomicBool::new(false),
        }
    }

    /// Tells of progress; true if the call shall go on. Once false, it stays false.
    pub fn goes_on(&self, progress: Progress) -> bool {
        if !self.is_stopped() && (self.watch)(progress).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.is_stopped()
    }

    /// As [`Watched::goes_on`], in the words of a [`Watch`].
    pub fn tell(&self, progress: Progress) -> ControlFlow<()> {
        match self.goes_on(progress) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    }

    /// True if the call was stopped.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The end of the call, once it is over.
    pub fn ended(&self) -> Ended {
        match self.is_stopped() {
            true => Ended::Interrupted,
            false => Ended::Finished,
        }
    }

    /// A watch for a call inside this one: told of that one's progress, and stopped with this one.
    pub fn inner(&self) -> impl Fn(Progress) -> ControlFlow<()> + Sync + '_ {
        |progress| self.tell(progress)
    }
}

impl std::fmt::Debug for Watched<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Watched")
            .field("stopped", &self.is_stopped())
            .finish_non_exhaustive()
    }
}
