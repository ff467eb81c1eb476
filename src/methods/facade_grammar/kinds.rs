//! Which terminals of a resized facade were equal before (Wu et al. 2014, Sec. 5).

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::grammar::{Derivation, Grammar, GrammarError, derivation};

/// Sizes within this fraction of the facade's longer side are one.
const SAME: f64 = 1e-6;

/// The kind of each terminal region of `resized`, a derivation of start 0 of a deterministic grammar
/// at any size: terminals are of one kind when they have one label and, in the facade at its own
/// size, one width and one height. "Equal terminals have the same size" asks that kinds keep equal
/// sizes; [`align_resized`](super::regularize::align_resized) sees to it.
///
/// # Errors
/// [`GrammarError`] when the grammar does not derive at its own size.
pub fn kinds(grammar: &Grammar, resized: &Derivation) -> Result<Vec<u16>, GrammarError> {
    let own = derivation(grammar, 0)?;
    let unit = SAME * own.facade.width.max(own.facade.height);
    let whole = |size: f64| (size / unit).round() as i64;
    let mut sizes = FxHashMap::default();
    for (origin, region) in own.origins.iter().zip(&own.facade.regions) {
        let size = (whole(region.rect.width), whole(region.rect.height));
        sizes.entry(*origin).or_insert(size);
    }
    let mut numbers = BTreeMap::new();
    let kinds = resized.origins.iter().zip(&resized.facade.regions);
    Ok(kinds
        .map(|(origin, region)| {
            let next = numbers.len() as u16;
            let key = (region.label.as_str(), sizes.get(origin).copied());
            *numbers.entry(key).or_insert(next)
        })
        .collect())
}
