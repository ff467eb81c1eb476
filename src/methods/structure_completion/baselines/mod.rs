//! Baselines of completion: simple ways to complete a layout. Each returns one completion.

mod lattice;
mod low_rank;
mod mirror;
mod nearest;

pub use lattice::lattice;
pub use low_rank::low_rank;
pub(super) use low_rank::{Cells, cells};
pub use mirror::mirror;
pub use nearest::nearest;

use super::completion::{Completed, Completion, Reason};
use super::layout::Element;
use super::partial::PartialLayout;

/// The elements that may be added, in order, each where none of the earlier ones excludes it.
fn completion(
    partial: &PartialLayout,
    elements: impl IntoIterator<Item = Element>,
    reason: Reason,
) -> Completion {
    let mut added: Vec<Completed> = Vec::new();
    for element in elements {
        let taken = added.iter().any(|a| {
            let same = a.element.class == element.class && a.element.rect.iou(&element.rect) > 0.3;
            same || a.element.excludes(&element)
        });
        if partial.allows(&element) && !taken {
            added.push(Completed {
                element,
                probability: 1.0,
                reason,
            });
        }
    }
    Completion {
        added,
        score: 0.0,
        mass: 1.0,
    }
}
