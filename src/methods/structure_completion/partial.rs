//! Partial layouts: elements that are observed, wall that is known, and the rest, which is unknown.

use super::layout::places::Places;
use super::layout::{Class, Element, Layout};
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
#[non_exhaustive]
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
}

/// Elements of one class that share more than this of the smaller one show one thing.
const TWICE: f64 = 0.5;

/// Two observed elements that exclude each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overlap {
    /// Index of one element.
    pub first: usize,
    /// Index of the other, which comes later.
    pub second: usize,
    /// True if they are of one class and share more than half of the smaller one: one thing, drawn twice.
    pub twice: bool,
}

/// True if the centre of an element lies in one of the regions.
pub fn hidden_in(regions: &[Rect], element: &Rect) -> bool {
    let (x, y) = element.centre();
    regions.iter().any(|region| region.contains(x, y))
}

impl PartialLayout {
    /// A whole layout whose content in these rectangles is not known, and the elements that they hide: those whose centre lies in
    /// one.
    pub fn hiding(layout: &Layout, unknown: Vec<Rect>) -> (Self, Vec<Element>) {
        let is_hidden = |e: &Element| hidden_in(&unknown, &e.rect);
        let hidden: Vec<bool> = layout.elements.iter().map(is_hidden).collect();
        Self::parted(layout, &hidden, Some(unknown))
    }

    /// A whole layout of which some elements are hidden, and these; `hidden` has a value for each element, `unknown` is that of
    /// the partial layout.
    pub fn parted(
        layout: &Layout,
        hidden: &[bool],
        unknown: Option<Vec<Rect>>,
    ) -> (Self, Vec<Element>) {
        let side = |wanted: bool| {
            let elements = layout.elements.iter().zip(hidden);
            let kept = elements.filter(move |(_, hidden)| **hidden == wanted);
            kept.map(|(e, _)| *e).collect::<Vec<Element>>()
        };
        let partial = Self {
            width: layout.width,
            height: layout.height,
            observed: side(false),
            unknown,
            forbidden: Vec::new(),
        };
        (partial, side(true))
    }

    /// Checks the observed elements against the outline and the unknown part.
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
        Ok(())
    }

    /// Pairs of observed elements of which the second excludes the first, as annotations of real facades have them: for
    /// each element the first one before it that it excludes, in the order of the elements.
    pub fn overlaps(&self) -> Vec<Overlap> {
        let count = self.observed.len();
        let mean = |size: fn(&Rect) -> f64| {
            let sizes = self.observed.iter().map(|e| size(&e.rect));
            sizes.sum::<f64>() / count.max(1) as f64
        };
        let size = [mean(|r| r.width), mean(|r| r.height)];
        let mut places = Places::new([self.width, self.height], size, count);
        let mut found = Vec::new();
        for (second, b) in self.observed.iter().enumerate() {
            let excluded = |first: u32| self.observed[first as usize].excludes(b);
            if places.any_near(&b.rect, excluded) {
                let mut earlier = self.observed[..second].iter();
                found.extend(earlier.position(|a| a.excludes(b)).map(|first| {
                    let a = &self.observed[first];
                    let least = a.rect.area().min(b.rect.area());
                    let twice = a.class == b.class && a.rect.overlap(&b.rect) > TWICE * least;
                    Overlap {
                        first,
                        second,
                        twice,
                    }
                }));
            }
            places.insert(second as u32, &b.rect);
        }
        found
    }

    /// The layout without the second of each pair of elements that show one thing twice.
    pub fn without_duplicates(&self) -> Self {
        let twice = self.overlaps().into_iter().filter(|o| o.twice);
        let dropped: Vec<usize> = twice.map(|o| o.second).collect();
        let kept = self
            .observed
            .iter()
            .enumerate()
            .filter(|(k, _)| !dropped.contains(k));
        Self {
            observed: kept.map(|(_, e)| *e).collect(),
            ..self.clone()
        }
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
