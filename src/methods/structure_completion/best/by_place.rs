//! Elements that are asked what stands near a place, without a look at all of them.

use std::cell::Cell;
use std::ops::Deref;

use crate::layout::Element;
use crate::layout::places::Places;
use edifice_shape::Rect;

/// Elements of a facade by place.
#[derive(Debug, Clone)]
pub struct ByPlace {
    elements: Vec<Element>,
    places: Places,
}

impl ByPlace {
    /// An empty set on a facade of this extent, made for some `most` elements of about `size`.
    pub fn new(facade: [f64; 2], size: (f64, f64), most: usize) -> Self {
        Self {
            elements: Vec::new(),
            places: Places::new(facade, [size.0, size.1], most),
        }
    }

    /// Adds an element.
    pub fn push(&mut self, element: Element) {
        self.places
            .insert(self.elements.len() as u32, &element.rect);
        self.elements.push(element);
    }

    /// True if the test, which only elements that meet the rectangle can pass, holds for any.
    pub fn any_near(&self, rect: &Rect, test: impl Fn(&Element) -> bool) -> bool {
        let test = |k: u32| test(&self.elements[k as usize]);
        self.places.any_near(rect, test)
    }

    /// True if one of the elements excludes another one.
    pub fn exclude(&self, other: &Element) -> bool {
        self.any_near(&other.rect, |e| e.excludes(other))
    }

    /// The greatest intersection over union of an element of the same class; 0 where none meets it.
    pub fn best_iou(&self, other: &Element) -> f64 {
        let best = Cell::new(0.0_f64);
        self.any_near(&other.rect, |e| {
            if e.class == other.class {
                best.set(best.get().max(e.rect.iou(&other.rect)));
            }
            false
        });
        best.get()
    }

    /// The elements in the order in which they were added.
    pub fn into_elements(self) -> Vec<Element> {
        self.elements
    }
}

impl Deref for ByPlace {
    type Target = [Element];

    fn deref(&self) -> &[Element] {
        &self.elements
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::layout::Class;
    use edifice_base::rng::stream;

    /// Random elements, some beyond the outline, against a look at all of them.
    #[test]
    fn answers_are_those_of_a_look_at_all() {
        for case in 0..300 {
            let mut rng = stream(1, "by place", case);
            let facade = [rng.random_range(0.1..100.0), rng.random_range(0.1..100.0)];
            let sizes = [(0.0, 1.0), (1.0, 2.0), (f64::NAN, 1e9), (50.0, 0.1)];
            let mut all = ByPlace::new(facade, sizes[case as usize % 4], 20);
            let mut element = || {
                let class = Class::ALL[rng.random_range(0..Class::ALL.len())];
                let side = |rng: &mut edifice_base::rng::Stream, k: usize| {
                    facade[k] * rng.random_range(-0.1..1.1)
                };
                let (x, y) = (side(&mut rng, 0), side(&mut rng, 1));
                let (w, h) = (rng.random_range(0.0..9.0), rng.random_range(0.0..9.0));
                Element::new(class, Rect::new(x, y, w, h))
            };
            for _ in 0..40 {
                let other = element();
                let excluded = all.iter().any(|e| e.excludes(&other));
                assert_eq!(all.exclude(&other), excluded);
                let same = all.iter().filter(|e| e.class == other.class);
                let best = same.map(|e| e.rect.iou(&other.rect)).fold(0.0, f64::max);
                assert_eq!(all.best_iou(&other), best);
                all.push(other);
            }
        }
    }
}
