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
//! Each region is given as a mask, and once more without one: then all that is not seen is unknown, as in the paper. The masks of
//! the published benchmark are [frozen](super::frozen).

use rand::RngExt;

use super::layout::{Element, Layout};
use super::partial::{PartialLayout, hidden_in};
use super::task::Task;
use edifice_base::rng::Stream;
use edifice_shape::Rect;

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
pub struct Sight {
    part: Part,
    masked: bool,
}

/// A value for each element, true where it is hidden; and the unknown rectangles, `None` where all that is not observed is unknown.
pub type Hidden = (Vec<bool>, Option<Vec<Rect>>);

/// Strips that a crown is cut into.
const STRIPS: usize = 5;

impl Sight {
    /// All of them, each region first with and then without a mask.
    pub fn all() -> Vec<Self> {
        let tasks = Task::ALL.into_iter().map(Part::Task);
        let parts = tasks.chain([Part::Tree, Part::Car, Part::Cut]);
        let both = |part: Part| match part {
            Part::Task(Task::R20 | Task::R50) => vec![Self { part, masked: true }],
            _ => [true, false].map(|masked| Self { part, masked }).into(),
        };
        parts.flat_map(both).collect()
    }

    /// The same part with its mask.
    pub fn masked(self) -> Self {
        Self {
            masked: true,
            ..self
        }
    }

    /// True if what is hidden is told as regions.
    pub fn is_masked(self) -> bool {
        self.masked
    }

    /// A task as it is, with its mask where it has one.
    pub fn of(task: Task) -> Self {
        Self {
            part: Part::Task(task),
            masked: true,
        }
    }

    /// Its name in commands, tables and rows.
    pub fn name(self) -> String {
        let mask = if self.masked { "" } else { "_maskless" };
        format!("{}{mask}", self.part.name())
    }

    /// The sight of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|sight| sight.name() == name)
    }

    /// The name of what is hidden: with and without a mask it is the same.
    pub(super) fn part(self) -> &'static str {
        self.part.name()
    }

    /// A whole layout as a partial one, and the elements that it hides.
    pub fn hide(self, layout: &Layout, rng: &mut Stream) -> (PartialLayout, Vec<Element>) {
        let rects: Vec<Rect> = layout.elements.iter().map(|e| e.rect).collect();
        let (hidden, unknown) = self.split(layout.width, layout.height, &rects, rng);
        PartialLayout::parted(layout, &hidden, unknown)
    }

    /// The elements that are hidden, and the unknown rectangles.
    pub fn split(self, width: f64, height: f64, elements: &[Rect], rng: &mut Stream) -> Hidden {
        let (hidden, unknown) = match self.part {
            Part::Task(task) => task.split(width, height, elements, rng),
            Part::Tree => covered(elements, tree(width, height, rng)),
            Part::Car => covered(elements, cars(width, height, rng)),
            Part::Cut => covered(elements, vec![cut(width, height, rng)]),
        };
        (hidden, unknown.filter(|_| self.masked))
    }
}

impl Task {
    /// As [`Sight::hide`], with a mask where the task has one.
    pub fn hide(self, layout: &Layout, rng: &mut Stream) -> (PartialLayout, Vec<Element>) {
        Sight::of(self).hide(layout, rng)
    }
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Part::Task(task) => task.name(),
            Part::Tree => "tree",
            Part::Car => "car",
            Part::Cut => "cut",
        }
    }
}

fn covered(elements: &[Rect], regions: Vec<Rect>) -> Hidden {
    let hidden = elements.iter().map(|e| hidden_in(&regions, e)).collect();
    (hidden, Some(regions))
}

fn cut(w: f64, h: f64, rng: &mut Stream) -> Rect {
    let wide = w * rng.random_range(0.25..0.4);
    let x = if rng.random() { w - wide } else { 0.0 };
    Rect::new(x, 0.0, wide, h)
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
    use crate::made::facades;

    #[test]
    fn what_is_hidden_is_unknown_and_nothing_is_lost() {
        let mut hides = 0;
        for sight in Sight::all() {
            assert_eq!(Sight::named(&sight.name()), Some(sight));
            for layout in facades::several(5, 3) {
                let (partial, hidden) = sight.hide_frozen(&layout);
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
        assert_eq!(Sight::named("roof"), None);
    }
}
