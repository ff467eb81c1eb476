//! Drawn garages and porches put where they fit the drawn plan.
//!
//! A model draws plan and parts nearly independently: no public source has both. A drawn porch that leaves a strip of half
//! a metre to the corner, or a garage in the middle, asks for slivers of rooms. Here drawn parts are moved: a garage to the
//! nearer side of the bounding box, front porches to its front, back porches to its back, gaps to corners and to the garage
//! either closed or wide enough for a room. Their exposure is what such a place has in a plan that is whole around them.
//! A porch for which the house has no room is left out. Values that are given stay, and so does the rest of their part.

use super::super::mass::target::PARTS;
use super::AttributeRow;

/// Narrowest gap beside a part (m): smaller ones are closed.
const GAP: f64 = 1.6;
/// Depth of the house that is left behind a porch, and narrowest and shallowest porch (m).
const BEHIND: f64 = 3.0;
const LEAST: [f64; 2] = [1.5, 1.2];
/// A part is at most this share of the plan.
const MOST: f64 = 0.35;

/// Moves the drawn parts of a row; `given` has its evidence.
pub(super) fn settle(row: &mut AttributeRow, given: &AttributeRow) {
    let (Some(w), Some(d)) = (row[0], row[1]) else {
        return;
    };
    for (k, (_, c, _)) in PARTS.into_iter().enumerate() {
        let drawn = given[c..c + 6].iter().all(Option::is_none);
        let known = row[c..c + 6].iter().all(Option::is_some);
        if !drawn || !known || row[c + 2] == Some(0.0) {
            continue;
        }
        let own = [0, 1, 2, 3].map(|i| row[c + i].unwrap_or(0.0));
        let garage = match k {
            0 => None,
            _ => rect(row, [w, d], PARTS[0].1),
        };
        let area = w * d * row[3].unwrap_or(1.0);
        let placed = match k {
            0 => Some(garage_at(own, [w, d])),
            _ => porch_at(own, [w, d], k == 1, garage),
        };
        match placed.filter(|[x, y]| (x[1] - x[0]) * (y[1] - y[0]) <= MOST * area) {
            Some(edges) => write(row, c, edges, [w, d]),
            None => row[c..c + 6].fill(Some(0.0)),
        }
    }
}

/// Area of the parts, above which no upper floor stands (square metres).
pub(super) fn area(row: &AttributeRow) -> f64 {
    let own = |c: usize| row[c + 2].unwrap_or(0.0) * row[c + 3].unwrap_or(0.0);
    PARTS.iter().map(|(_, c, _)| own(*c)).sum()
}

type Edges = [[f64; 2]; 2];

/// Edges of a part from the left front corner of the bounding box; `None` without one.
fn rect(row: &AttributeRow, extents: [f64; 2], c: usize) -> Option<Edges> {
    let size = |axis: usize| row[c + 2 + axis].filter(|v| *v > 0.0);
    let (w, d) = (size(0)?, size(1)?);
    let (x, y) = (row[c]? * extents[0], row[c + 1]? * extents[1]);
    Some([[x - w / 2.0, x + w / 2.0], [y - d / 2.0, y + d / 2.0]])
}

fn garage_at([x, y, w, d]: [f64; 4], extents: [f64; 2]) -> Edges {
    let w = w.min(0.6 * extents[0]);
    let d = d.min(extents[1]);
    let left = if x < 0.5 { 0.0 } else { extents[0] - w };
    let low = y * extents[1] - d / 2.0;
    [[left, left + w], closed([low, low + d], [0.0, extents[1]])]
}

fn porch_at(
    [x, _, w, d]: [f64; 4],
    extents: [f64; 2],
    front: bool,
    garage: Option<Edges>,
) -> Option<Edges> {
    let d = d.min(extents[1] - BEHIND);
    let (mut low, mut high) = (0.0, extents[0]);
    // A porch stands beside the garage, never before or behind it.
    if let Some([gx, gy]) = garage {
        let apart = match front {
            true => gy[0] >= d + BEHIND,
            false => gy[1] <= extents[1] - d - BEHIND,
        };
        match gx[0] <= 0.0 {
            _ if apart => {}
            true => low = gx[1],
            false => high = gx[0],
        }
    }
    let w = w.min(high - low);
    if w < LEAST[0] || d < LEAST[1] {
        return None;
    }
    let left = x * extents[0] - w / 2.0;
    let along = closed([left, left + w], [low, high]);
    let across = match front {
        true => [0.0, d],
        false => [extents[1] - d, extents[1]],
    };
    Some([along, across])
}

/// An interval within another, moved so that no gap at an end is narrower than [`GAP`].
fn closed([low, high]: [f64; 2], [from, to]: [f64; 2]) -> [f64; 2] {
    let size = high - low;
    let mut at = low.clamp(from, (to - size).max(from));
    if at - from < GAP {
        at = from;
    } else if to - size - at < GAP {
        at = to - size;
    }
    [at, at + size]
}

/// Place, size and exposure: the edges on the bounding box are in the open air.
fn write(row: &mut AttributeRow, c: usize, [x, y]: Edges, [w, d]: [f64; 2]) {
    let (own_w, own_d) = (x[1] - x[0], y[1] - y[0]);
    let on = |v: f64, end: f64, length: f64| if (v - end).abs() < 1e-6 { length } else { 0.0 };
    let open =
        on(x[0], 0.0, own_d) + on(x[1], w, own_d) + on(y[0], 0.0, own_w) + on(y[1], d, own_w);
    let values = [
        (x[0] + x[1]) / 2.0 / w,
        (y[0] + y[1]) / 2.0 / d,
        own_w,
        own_d,
    ];
    for (i, value) in values.into_iter().enumerate() {
        row[c + i] = Some(value);
    }
    row[c + 5] = Some(open / (2.0 * (own_w + own_d)));
}
