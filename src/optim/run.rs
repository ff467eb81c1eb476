//! What a run tells of itself, the same for every optimizer.

use argmin::core::observers::Observe;
use argmin::core::{Error, KV, State};

/// One iteration of a run.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Step {
    /// Iterations done before this one.
    pub iteration: u64,
    /// Cost of what this iteration found.
    pub cost: f64,
    /// Lowest cost so far.
    pub best: f64,
}

/// Passes every iteration on to a closure.
pub(super) struct Steps<F>(pub F);

impl<I, F> Observe<I> for Steps<F>
where
    I: State<Float = f64>,
    F: FnMut(Step),
{
    fn observe_iter(&mut self, state: &I, _: &KV) -> Result<(), Error> {
        (self.0)(Step {
            iteration: state.get_iter(),
            cost: state.get_cost(),
            best: state.get_best_cost(),
        });
        Ok(())
    }
}
