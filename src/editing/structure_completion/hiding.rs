//! A part of a whole facade is hidden, with all that its file says of the elements that are left.

use edifice_base::rng;
use edifice_shape::{AnnotatedFacade, Facade, Rect};
use edifice_structure_completion::frozen::Digest;
use edifice_structure_completion::sights::Sight;

/// A facade of which a part is hidden.
pub struct Hiding {
    /// The elements that are left, and the unknown rectangles.
    pub partial: AnnotatedFacade,
    /// Number of elements that are hidden.
    pub hidden: usize,
    /// Digest of the whole facade's content, 16 hexadecimal digits.
    pub digest: String,
}

/// There is nothing to hide.
#[derive(Debug, thiserror::Error)]
#[error("the facade has no elements to hide")]
pub struct NothingToHide;

/// Hides a part of a whole facade, by a seed; without one by its frozen mask, which its content alone decides.
///
/// # Errors
/// [`NothingToHide`] for a facade without elements.
pub fn hide(
    whole: &AnnotatedFacade,
    sight: Sight,
    seed: Option<u64>,
) -> Result<Hiding, NothingToHide> {
    let facade = &whole.facade;
    if facade.regions.is_empty() {
        return Err(NothingToHide);
    }
    let (width, height) = (facade.width, facade.height);
    let named = facade.regions.iter().map(|r| (r.label.as_str(), r.rect));
    let named: Vec<(&str, Rect)> = named.collect();
    let (hidden, unknown) = match seed {
        None => sight.split_frozen(width, height, &named),
        Some(seed) => {
            let rects: Vec<Rect> = named.iter().map(|(_, rect)| *rect).collect();
            let stream = &mut rng::stream(seed, "facade hide", 0);
            sight.split(width, height, &rects, stream)
        }
    };
    let mut partial = AnnotatedFacade {
        facade: Facade {
            regions: Vec::new(),
            ..facade.clone()
        },
        notes: Vec::new(),
        unknown,
        photograph: whole.photograph.clone(),
    };
    for ((region, note), hidden) in facade.regions.iter().zip(&whole.notes).zip(&hidden) {
        if !hidden {
            partial.facade.regions.push(region.clone());
            partial.notes.push(note.clone());
        }
    }
    Ok(Hiding {
        hidden: named.len() - partial.facade.regions.len(),
        partial,
        digest: format!("{:016x}", Digest::new(width, height, &named).value),
    })
}
