//! Partial layouts: elements that are observed, wall that is known, and the rest, which is unknown.

use super::layout::places::Places;
use super::layout::{Class, Element};
use edifice_shape::Rect;

/// The input of a completion.
#[derive(Debug, Clone, PartialEq)]
pub struct PartialLayout {
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// Observed elements; they are never moved.
    pub observed: Vec<Element>,
    /// Rectangles whose content is not known. `None`: all that is not observed is unknown (Sec. 1, as in
    /// the paper).
    pub unknown: Option<Vec<Rect>>,
    /// Rectangles that no added element may enter.
    pub forbidden: Vec<Rect>,
}

/// Why a partial layout cannot be completed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PartialError {
    /// An observed element reaches outside the outline.
    #[error("element {index} ({}) at ({}, {}) reaches outside the outline of {width} x {height}", class.name(), rect.x, rect.y)]
    Outside {
        /// Index of the element.
        index: usize,
        /// Class of the element.
        class: Class,
        /// Bounding box of the element.
        rect: Rect,
        /// Width of the outline.
        width: f64,
        /// Height of the outline.
        height: f64,
    },
    /// An observed element has its centre in an unknown rectangle.
    #[error("element {index} ({}) at ({}, {}) is observed, but lies in unknown[{unknown}]", class.name(), rect.x, rect.y)]
    InUnknown {
        /// Index of the element.
        index: usize,
        /// Class of the element.
        class: Class,
        /// Bounding box of the element.
        rect: Rect,
        /// Index of the unknown rectangle.
        unknown: usize,
    },
    /// Two observed elements exclude each other.
    #[error("elements {first} ({}) and {second} ({}) overlap", first_class.name(), second_class.name())]
    Overlap {
        /// Index of one element.
        first: usize,
        /// Class of the first element.
        first_class: Class,
        /// Index of the other.
        second: usize,
        /// Class of the other element.
        second_class: Class,
    },
}

impl PartialLayout {
    /// Checks the observed elements against the outline, the unknown part and each other.
    ///
    /// # Errors
    /// The first that is wrong.
    pub fn check(&self) -> Result<(), PartialError> {
        let (width, height) = (self.width, self.height);
        let slack = 1e-9 * width.max(height);
        for (index, &Element { class, rect }) in self.observed.iter().enumerate() {
            if rect.x < -slack
                || rect.y < -slack
                || rect.right() > width + slack
                || rect.top() > height + slack
            {
                return Err(PartialError::Outside {
                    index,
                    class,
                    rect,
                    width,
                    height,
                });
            }
            let (x, y) = rect.centre();
            let mut unknown = self.unknown.iter().flatten();
            if let Some(unknown) = unknown.position(|u| u.contains(x, y)) {
                return Err(PartialError::InUnknown {
                    index,
                    class,
                    rect,
                    unknown,
                });
            }
        }
        let count = self.observed.len();
        let mean = |size: fn(&Rect) -> f64| {
            let sizes = self.observed.iter().map(|e| size(&e.rect));
            sizes.sum::<f64>() / count.max(1) as f64
        };
        let size = [mean(|r| r.width), mean(|r| r.height)];
        let mut places = Places::new([width, height], size, count);
        for (second, b) in self.observed.iter().enumerate() {
            let excluded = |first: u32| self.observed[first as usize].excludes(b);
            if !places.any_near(&b.rect, excluded) {
                places.insert(second as u32, &b.rect);
                continue;
            }
            let mut earlier = self.observed[..second].iter();
            if let Some(first) = earlier.position(|a| a.excludes(b)) {
                return Err(PartialError::Overlap {
                    first,
                    first_class: self.observed[first].class,
                    second,
                    second_class: b.class,
                });
            }
        }
        Ok(())
    }

    /// True if a point may hold something that is not known.
    pub fn is_unknown(&self, x: f64, y: f64) -> bool {
        match &self.unknown {
            None => true,
            Some(rects) => rects.iter().any(|r| r.contains(x, y)),
        }
    }

    /// True if there is anything to complete.
    pub fn has_unknown(&self) -> bool {
        self.unknown.as_ref().is_none_or(|rects| {
            let outline = Rect::new(0.0, 0.0, self.width, self.height);
            rects.iter().any(|r| r.overlap(&outline) > 0.0)
        })
    }

    /// True if an added element may stand there: within the outline, its centre in the unknown part,
    /// outside forbidden rectangles, and no observed element excludes it.
    pub fn allows(&self, element: &Element) -> bool {
        self.has_room(element) && self.observed.iter().all(|o| !o.excludes(element))
    }

    /// The same but for the observed elements.
    pub fn has_room(&self, element: &Element) -> bool {
        let r = &element.rect;
        let (x, y) = r.centre();
        let slack = 1e-9 * self.width.max(self.height);
        r.width > 0.0
            && r.height > 0.0
            && r.x >= -slack
            && r.y >= -slack
            && r.right() <= self.width + slack
            && r.top() <= self.height + slack
            && self.is_unknown(x, y)
            && self.forbidden.iter().all(|f| f.overlap(r) <= 0.0)
    }

    /// The observed elements of a class.
    pub fn of(&self, class: Class) -> impl Iterator<Item = &Element> {
        self.observed.iter().filter(move |e| e.class == class)
    }
}
