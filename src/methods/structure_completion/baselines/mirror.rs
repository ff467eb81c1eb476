//! Mirror images about the facade's vertical axis.

use super::completion;
use crate::methods::structure_completion::completion::{Completion, Reason};
use crate::methods::structure_completion::layout::Element;
use crate::methods::structure_completion::partial::PartialLayout;
use crate::shape::Rect;

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
