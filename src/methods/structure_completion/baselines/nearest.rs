//! The nearest facade of the database, scaled to the outline.

use super::completion;
use crate::completion::{Completion, Reason};
use crate::layout::{Element, Layout};
use crate::measure::agreement;
use crate::model::Model;
use crate::partial::PartialLayout;
use edifice_shape::Rect;

/// Pastes the facade whose elements in the known part agree best with the observed ones (F1 at an intersection over
/// union of 0.25, then the share of observed elements that it has; the first of equals).
pub fn nearest(partial: &PartialLayout, model: &Model) -> Completion {
    let scaled: Vec<Vec<Element>> = model
        .examples
        .iter()
        .map(|e| fitted(&e.layout, partial.width, partial.height))
        .collect();
    let score = |elements: &Vec<Element>| {
        let known: Vec<Element> = match partial.unknown {
            // Nothing is known to be wall: what the database has more is not held against it.
            None => elements.clone(),
            Some(_) => elements
                .iter()
                .filter(|e| {
                    let (x, y) = e.rect.centre();
                    !partial.is_unknown(x, y)
                })
                .copied()
                .collect(),
        };
        let agreement = agreement(&known, &partial.observed, 0.25);
        if partial.unknown.is_some() {
            agreement.f1
        } else {
            agreement.recall
        }
    };
    let mut best: Option<(f64, &Vec<Element>)> = None;
    for elements in &scaled {
        let score = score(elements);
        if best.is_none_or(|b| score > b.0) {
            best = Some((score, elements));
        }
    }
    let pasted = best.map(|b| b.1.clone()).unwrap_or_default();
    completion(partial, pasted, Reason::Database)
}

/// The elements of a layout scaled to another outline.
pub(super) fn fitted(layout: &Layout, width: f64, height: f64) -> Vec<Element> {
    let (x, y) = (width / layout.width, height / layout.height);
    let scale = |e: &Element| {
        let r = e.rect;
        Element::new(
            e.class,
            Rect::new(r.x * x, r.y * y, r.width * x, r.height * y),
        )
    };
    layout.elements.iter().map(scale).collect()
}
