//! Element layouts (Sec. 3.2): labelled rectangles on a wall, cropped to the facade.

pub mod extract;
pub mod lines;
pub(super) mod places;
pub mod scope;

use serde::{Deserialize, Serialize};

use edifice_shape::{Facade, LayoutError, Rect, Region};

/// Label of an element that takes part in completion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// A window.
    Window,
    /// A door.
    Door,
    /// A balcony, which may lie over windows.
    Balcony,
    /// A shop window or shop front.
    Shop,
}

impl Class {
    /// All classes.
    pub const ALL: [Class; 4] = [Class::Window, Class::Door, Class::Balcony, Class::Shop];

    /// The label in files.
    pub fn name(self) -> &'static str {
        match self {
            Class::Window => "window",
            Class::Door => "door",
            Class::Balcony => "balcony",
            Class::Shop => "shop",
        }
    }

    /// Its place in [`Class::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// The class that a label begins with, in any case: `window`, `Window1`, `door_left`.
    pub fn of_label(label: &str) -> Option<Self> {
        let label = label.to_lowercase();
        Class::ALL.into_iter().find(|class| {
            let rest = label.strip_prefix(class.name());
            rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_lowercase() && c != 's'))
        })
    }

    /// True if elements of the two classes may overlap: only a balcony with something else.
    pub fn may_overlap(self, other: Self) -> bool {
        (self == Class::Balcony) != (other == Class::Balcony)
    }
}

/// An element: a class and its bounding box.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// Class of the element.
    pub class: Class,
    /// Its place, in the unit of the layout.
    pub rect: Rect,
}

impl Element {
    /// An element.
    pub fn new(class: Class, rect: Rect) -> Self {
        Self { class, rect }
    }

    /// True if two elements exclude each other: their common area is above a tenth of the smaller
    /// one, and their classes may not overlap.
    pub fn excludes(&self, other: &Element) -> bool {
        let (a, b) = (&self.rect, &other.rect);
        // Nearly all pairs that are asked about lie apart: on which side is not worth a branch.
        let beside = (a.x >= b.right()) | (b.x >= a.right());
        let apart = beside | (a.y >= b.top()) | (b.y >= a.top());
        if apart || self.class.may_overlap(other.class) {
            return false;
        }
        a.overlap(b) > 0.1 * a.area().min(b.area())
    }
}

/// A whole element layout: what the database holds and what a completion is compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// Name of the facade.
    pub name: String,
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// Its elements.
    pub elements: Vec<Element>,
}

impl Layout {
    /// The layout as a facade of element regions, in pixels.
    ///
    /// # Errors
    /// [`LayoutError`] when the outline has no area or an element leaves it.
    pub fn facade(&self) -> Result<Facade, LayoutError> {
        let regions = self.elements.iter().map(|e| Region {
            label: e.class.name().to_string(),
            rect: e.rect,
        });
        let (width, height) = (self.width, self.height);
        Facade::new(self.name.clone(), "px", width, height, regions.collect())
    }

    /// The elements of a class.
    pub fn of(&self, class: Class) -> impl Iterator<Item = &Element> {
        self.elements.iter().filter(move |e| e.class == class)
    }

    /// Number of elements of a class.
    pub fn count(&self, class: Class) -> usize {
        self.of(class).count()
    }
}
