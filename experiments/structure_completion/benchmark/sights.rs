//! The parts that the benchmark hides: the tasks of the method, and what hides facades in photographs.
//!
//! | part | hidden |
//! | --- | --- |
//! | `r20`, `r50` | all but a random 20 or 50 % of the elements; nothing is known of the rest |
//! | `side50`, `corner36`, `bottom40` | one half, all but an upper corner of 0.6 x 0.6, the lowest 40 % |
//! | `tree` | a crown of 0.36 W x 0.44 H before the lower floors, and its trunk |
//! | `car` | one or two boxes on the ground, each up to 0.35 W wide and 0.2 H high |
//! | `cut` | a strip of 0.25 to 0.4 W at one side, where the picture ends |
//!
//! Each region is given as a mask, and once more without one: then all that is not seen is unknown, as in the paper.

use rand::RngExt;

use edifice_base::rng::Stream;
use edifice_shape::Rect;
use edifice_structure_completion::layout::{Element, Layout};
use edifice_structure_completion::partial::PartialLayout;
use edifice_structure_completion::task::Task;

/// The part that is hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Task(Task),
    Tree,
    Car,
    Cut,
}

/// A part that is hidden, with or without a mask.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sight {
    part: Part,
    masked: bool,
}

/// Strips that a crown is cut into.
const STRIPS: usize = 5;

impl Sight {
    /// All of them, each region first with and then without a mask.
    pub(crate) fn all() -> Vec<Self> {
        let tasks = Task::ALL.into_iter().map(Part::Task);
        let parts = tasks.chain([Part::Tree, Part::Car, Part::Cut]);
        let both = |part: Part| match part {
            Part::Task(Task::R20 | Task::R50) => vec![Self { part, masked: true }],
            _ => [true, false].map(|masked| Self { part, masked }).into(),
        };
        parts.flat_map(both).collect()
    }

    /// Its name in tables and rows.
    pub(crate) fn name(self) -> String {
        let part = match self.part {
            Part::Task(task) => task.name(),
            Part::Tree => "tree",
            Part::Car => "car",
            Part::Cut => "cut",
        };
        let mask = if self.masked { "" } else { "_maskless" };
        format!("{part}{mask}")
    }

    /// A whole layout as a partial one, and the elements that are hidden.
    pub(crate) fn hide(self, layout: &Layout, rng: &mut Stream) -> (PartialLayout, Vec<Element>) {
        let (w, h) = (layout.width, layout.height);
        let regions = match self.part {
            Part::Task(task) => {
                let (mut partial, hidden) = task.hide(layout, rng);
                if !self.masked {
                    partial.unknown = None;
                }
                return (partial, hidden);
            }
            Part::Tree => tree(w, h, rng),
            Part::Car => cars(w, h, rng),
            Part::Cut => {
                let wide = w * rng.random_range(0.25..0.4);
                let x = if rng.random() { w - wide } else { 0.0 };
                vec![Rect::new(x, 0.0, wide, h)]
            }
        };
        let (mut partial, hidden) = PartialLayout::hiding(layout, regions);
        if !self.masked {
            partial.unknown = None;
        }
        (partial, hidden)
    }
}

fn tree(w: f64, h: f64, rng: &mut Stream) -> Vec<Rect> {
    let (x, y) = (
        w * rng.random_range(0.2..0.8),
        h * rng.random_range(0.3..0.5),
    );
    let (across, up) = (0.18 * w, 0.22 * h);
    let strip = |k: usize| {
        let from = 2.0 * k as f64 / STRIPS as f64 - 1.0;
        let middle = from + 1.0 / STRIPS as f64;
        let half = across * (1.0 - middle * middle).sqrt();
        let (left, right) = ((x - half).max(0.0), (x + half).min(w));
        Rect::new(left, y + from * up, right - left, 2.0 * up / STRIPS as f64)
    };
    let mut regions: Vec<Rect> = (0..STRIPS).map(strip).collect();
    regions.push(Rect::new(x - 0.03 * w, 0.0, 0.06 * w, y - up));
    regions
}

fn cars(w: f64, h: f64, rng: &mut Stream) -> Vec<Rect> {
    let count = rng.random_range(1..=2);
    let mut car = |_| {
        let (wide, high) = (
            w * rng.random_range(0.2..0.35),
            h * rng.random_range(0.1..0.2),
        );
        Rect::new(rng.random_range(0.0..w - wide), 0.0, wide, high)
    };
    (0..count).map(&mut car).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use edifice_structure_completion::made::facades;

    #[test]
    fn what_is_hidden_is_unknown_and_nothing_is_lost() {
        let mut hides = 0;
        for (k, sight) in Sight::all().into_iter().enumerate() {
            for layout in facades::several(5, 3) {
                let rng = &mut stream(1, "sights", k as u64);
                let (partial, hidden) = sight.hide(&layout, rng);
                assert_eq!(
                    partial.observed.len() + hidden.len(),
                    layout.elements.len(),
                    "{}",
                    sight.name()
                );
                partial.check().expect("a partial layout");
                hides += usize::from(!hidden.is_empty());
                for e in &hidden {
                    let (x, y) = e.rect.centre();
                    assert!(partial.is_unknown(x, y));
                }
            }
        }
        assert!(hides > 50, "{hides}");
    }
}
