//! Pitches: how closely floors follow each other.

use std::collections::BTreeMap;

use super::in_line::{Piece, is_wall};

/// Least `|ln|` of the ratio of two lengths of elements of different sizes.
const SIZE: f64 = 0.1;

/// True if two elements have one label and about one size.
pub(super) fn of_one_kind(p: &Piece, q: &Piece) -> bool {
    let length = |ends: (f64, f64)| ends.1 - ends.0;
    let near = |a, b| (length(a) / length(b)).ln().abs() < SIZE;
    p.label == q.label && near(p.along, q.along) && near(p.across, q.across)
}

/// For each label the least distance, start to start, of two elements of about one size, one after the other with background
/// between them.
///
/// Panes of one window, with nothing or a frame between them, do not count. Labels of which no element has such a neighbour are left out.
pub(super) fn pitches<'a>(pieces: &[Piece<'a>], noise: f64) -> BTreeMap<&'a str, f64> {
    let beside = |p: &Piece, q: &Piece| {
        let shared = p.across.1.min(q.across.1) - p.across.0.max(q.across.0);
        shared > 0.5 * (p.across.1 - p.across.0).min(q.across.1 - q.across.0)
    };
    let mut out: BTreeMap<&str, f64> = BTreeMap::new();
    for p in pieces.iter().filter(|p| !is_wall(p.label)) {
        let after = pieces
            .iter()
            .filter(|q| of_one_kind(p, q) && q.along.0 >= p.along.1 + noise && beside(p, q))
            .min_by(|a, b| a.along.0.total_cmp(&b.along.0));
        let Some(q) = after else { continue };
        let between = |r: &Piece| {
            is_wall(r.label)
                && r.along.0 >= p.along.1 - noise
                && r.along.1 <= q.along.0 + noise
                && beside(p, r)
        };
        if pieces.iter().any(between) {
            let least = out.entry(p.label).or_insert(f64::INFINITY);
            *least = least.min(q.along.0 - p.along.0);
        }
    }
    out
}
