//! Work that takes longer than an answer may: it goes on beside the server, tells how far it is, and can be stopped.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use serde_json::{Value, json};

use edifice_editing::work::Work;

/// Ended jobs that are remembered.
const REMEMBERED: usize = 100;

/// A piece of work.
pub struct Job {
    id: String,
    /// The work itself, which tells its progress and can be stopped.
    pub work: Work,
    start: Instant,
    place: Mutex<JobState>,
}

/// The document of a job, and the job's end.
struct JobState {
    document: Option<String>,
    end: Option<(End, f64)>,
}

/// The end of a job.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The document is as the work left it.
    Done,
    /// The document is as it was before, since the work was stopped.
    Stopped,
    /// The document is as it was before, and why.
    Failed(String),
}

impl Job {
    /// The work is over; whether it still counts: not after it was stopped.
    pub fn end(&self, end: End) -> bool {
        let mut place = self.place.lock().unwrap_or_else(PoisonError::into_inner);
        let counts = place.end.is_none();
        if counts {
            place.end = Some((end, self.start.elapsed().as_secs_f64()));
        }
        counts
    }

    /// Stops it. Whoever waits is free at once; the method itself ends at its next step, and what it makes is dropped.
    pub fn stop(&self) {
        self.work.stop();
        self.end(End::Stopped);
    }

    /// True if it is over.
    pub fn is_over(&self) -> bool {
        let place = self.place.lock().unwrap_or_else(PoisonError::into_inner);
        place.end.is_some()
    }

    /// Says which document it made.
    pub fn made(&self, document: &str) {
        let mut place = self.place.lock().unwrap_or_else(PoisonError::into_inner);
        place.document = Some(document.to_owned());
    }

    /// The state of the job, as a page gets it.
    pub fn shown(&self) -> Value {
        let told = self.work.told();
        let place = self.place.lock().unwrap_or_else(PoisonError::into_inner);
        let (state, error) = match &place.end {
            None => ("running", None),
            Some((End::Done, _)) => ("done", None),
            Some((End::Stopped, _)) => ("stopped", None),
            Some((End::Failed(error), _)) => ("failed", Some(error)),
        };
        let seconds = place.end.as_ref().map(|(_, seconds)| *seconds);
        json!({
            "id": self.id, "document": place.document, "state": state, "error": error, "step": told.step, "part": told.part,
            "seconds": seconds.unwrap_or_else(|| self.start.elapsed().as_secs_f64()),
        })
    }
}

/// All jobs.
#[derive(Default)]
pub(crate) struct Jobs {
    begun: Mutex<(u64, Vec<Arc<Job>>)>,
}

impl Jobs {
    /// Begins a job, for a document that is there already or for one to be opened.
    pub(crate) fn begin(&self, document: Option<&str>) -> Arc<Job> {
        let mut begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let (count, list) = &mut *begun;
        *count += 1;
        let job = Arc::new(Job {
            id: format!("j{count}"),
            work: Work::default(),
            start: Instant::now(),
            place: Mutex::new(JobState {
                document: document.map(str::to_owned),
                end: None,
            }),
        });
        list.push(job.clone());
        let ended = list.iter().filter(|j| j.is_over()).count();
        if ended > REMEMBERED
            && let Some(oldest) = list.iter().position(|j| j.is_over())
        {
            list.remove(oldest);
        }
        job
    }

    /// The job of an id.
    pub(crate) fn get(&self, id: &str) -> Option<Arc<Job>> {
        let begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        begun.1.iter().find(|j| j.id == id).cloned()
    }
}
