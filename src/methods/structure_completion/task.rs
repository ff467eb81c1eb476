//! Tasks of the benchmark: which part of a whole layout is hidden.

use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::partial::hidden_in;
use edifice_base::rng::Stream;
use edifice_shape::Rect;

/// The part of a layout that is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Task {
    /// A random 20 % of the elements are observed; nothing is known of the rest of the facade.
    R20,
    /// A random 50 % of the elements are observed; nothing is known of the rest of the facade.
    R50,
    /// The left or the right half is known.
    Side50,
    /// An upper corner of 0.6 x 0.6 of the extent is known.
    Corner36,
    /// All but the lowest 40 % is known.
    Bottom40,
}

impl Task {
    /// All tasks.
    pub const ALL: [Task; 5] = [
        Task::R20,
        Task::R50,
        Task::Side50,
        Task::Corner36,
        Task::Bottom40,
    ];

    /// Its name in commands and files.
    pub fn name(self) -> &'static str {
        match self {
            Task::R20 => "r20",
            Task::R50 => "r50",
            Task::Side50 => "side50",
            Task::Corner36 => "corner36",
            Task::Bottom40 => "bottom40",
        }
    }

    /// The task of a name.
    pub fn named(name: &str) -> Option<Self> {
        Task::ALL.into_iter().find(|task| task.name() == name)
    }

    /// The unknown rectangles; `None` where elements are hidden one by one.
    fn unknown(self, width: f64, height: f64, rng: &mut Stream) -> Option<Vec<Rect>> {
        let left: bool = rng.random();
        match self {
            Task::R20 | Task::R50 => None,
            Task::Side50 => {
                let half = width / 2.0;
                let x = if left { half } else { 0.0 };
                Some(vec![Rect::new(x, 0.0, half, height)])
            }
            Task::Corner36 => {
                let (side, low) = (0.4 * width, 0.4 * height);
                let x = if left { width - side } else { 0.0 };
                Some(vec![
                    Rect::new(0.0, 0.0, width, low),
                    Rect::new(x, low, side, height - low),
                ])
            }
            Task::Bottom40 => Some(vec![Rect::new(0.0, 0.0, width, 0.4 * height)]),
        }
    }

    /// The indices of the hidden elements, and the unknown rectangles. Hidden are elements whose centre is
    /// unknown, or a random share. At least one element is observed where any could be.
    pub fn split(
        self,
        width: f64,
        height: f64,
        elements: &[Rect],
        rng: &mut Stream,
    ) -> (Vec<bool>, Option<Vec<Rect>>) {
        let unknown = self.unknown(width, height, rng);
        let hidden = match &unknown {
            Some(rects) => elements.iter().map(|e| hidden_in(rects, e)).collect(),
            None => {
                let share = if self == Task::R20 { 0.2 } else { 0.5 };
                let kept = (share * elements.len() as f64).round().max(1.0) as usize;
                let mut order: Vec<usize> = (0..elements.len()).collect();
                order.shuffle(rng);
                let mut hidden = vec![true; elements.len()];
                for &index in order.iter().take(kept) {
                    hidden[index] = false;
                }
                hidden
            }
        };
        (hidden, unknown)
    }
}
