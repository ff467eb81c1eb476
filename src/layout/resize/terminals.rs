//! Which terminals of a resized facade were equal before (Wu et al. 2014, Sec. 5).

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use edifice_grammar::Derivation;

/// Sizes within this fraction of the facade's longer side are one.
const SAME: f64 = 1e-6;

/// The class of each terminal region of `resized`, given `own`, a derivation by the same rules at the grammar's
/// own size: terminals are of one class when they have one label and, in the facade at its own
/// size, one width and one height. "Equal terminals have the same size" asks that classes keep equal
/// sizes; [`align_resized`](crate::regularize::align_resized) sees to it.
pub fn terminal_classes(own: &Derivation, resized: &Derivation) -> Vec<usize> {
    let unit = SAME * own.facade.width.max(own.facade.height);
    let whole = |size: f64| (size / unit).round() as i64;
    let mut sizes = FxHashMap::default();
    for (origin, region) in own.origins.iter().zip(&own.facade.regions) {
        let size = (whole(region.rect.width), whole(region.rect.height));
        sizes.entry(*origin).or_insert(size);
    }
    let mut numbers = BTreeMap::new();
    let kinds = resized.origins.iter().zip(&resized.facade.regions);
    kinds
        .map(|(origin, region)| {
            let next = numbers.len();
            let key = (region.label.as_str(), sizes.get(origin).copied());
            *numbers.entry(key).or_insert(next)
        })
        .collect()
}
