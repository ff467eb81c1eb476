//! Mirror images about the facade's vertical axis.

use super::completion;
use crate::completion::{Completion, Reason};
use crate::layout::Element;
use crate::partial::PartialLayout;
use edifice_shape::Rect;

/// Adds the mirror image of every observed element where it may stand.
pub fn mirror(partial: &PartialLayout) -> Completion {
    let images = partial.observed.iter().map(|e| {
        let r = e.rect;
        Element::new(
            e.class,
            Rect {
                x: partial.width - r.right(),
                ..r
            },
        )
    });
    completion(partial, images, Reason::Symmetry)
}
