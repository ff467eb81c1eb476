//! Wanted columns and observed boxes made to agree.

use super::error::CompleteError;
use crate::attributes::COLUMNS;
use crate::mass::target::bounds;
use edifice_shape::{Building, ElementStyle, MassBox, PlanUnion, RoofStyle, Special};

/// Lengths nearer than this are the same (m).
pub(super) const SAME: f64 = 5e-3;

/// The wanted row with what the observed boxes and elements say, and the columns that must stay.
pub(super) fn reconciled(
    partial: &Building,
    wanted: &[f64; 49],
    given: &[bool; 49],
) -> Result<([f64; 49], [bool; 49]), CompleteError> {
    let (mut row, mut known) = (*wanted, *given);
    let hull = bounds(partial);
    for axis in 0..2 {
        let extent = hull[axis][1] - hull[axis][0];
        if given[axis] && extent > row[axis] + SAME {
            return Err(outside(partial, &hull, axis, row[axis]));
        }
        if !given[axis] {
            row[axis] = (row[axis].max(extent) * 1e3).ceil() / 1e3;
        }
    }
    let floors = |row: &[f64; 49]| 1 + row[7..9].iter().filter(|s| **s > 0.02).count();
    let most = partial.boxes.iter().map(|b| partial.floors_of(b)).max();
    if most.unwrap_or(0) > floors(&row) && !given[5..9].contains(&true) {
        raise_floors(&mut row, partial);
    }
    let floors = floors(&row);
    for (index, b) in partial.boxes.iter().enumerate() {
        let own = partial.floors_of(b);
        if own > floors {
            return Err(CompleteError::Floors {
                index,
                floors: own,
                wanted: floors,
            });
        }
    }
    let heights = partial.boxes.iter().map(|b| b.height);
    let highest = heights.fold(floors as f64 * partial.floor_height, f64::max);
    if !given[2] {
        (row[2], known[2]) = (highest, true);
    }
    let plans: Vec<_> = partial.boxes.iter().map(MassBox::plan).collect();
    let covered = PlanUnion::new(&plans).area() / (row[0] * row[1]);
    if !given[3] {
        row[3] = row[3].max(covered.min(1.0));
    }
    for (c, shown) in shown(partial) {
        if shown {
            (row[c], known[c]) = (1.0, true);
        }
    }
    (known[0], known[1]) = (true, true);
    Ok((row, known))
}

/// Moves the shares of the floors (columns 6 to 8), and the floor area ratio with them, so that each floor has at least the
/// area that the observed boxes have there.
fn raise_floors(row: &mut [f64; 49], partial: &Building) {
    let area = |floor: usize| {
        let reaching = partial
            .boxes
            .iter()
            .filter(|b| partial.floors_of(b) > floor);
        let plans: Vec<_> = reaching.map(MassBox::plan).collect();
        PlanUnion::new(&plans).area()
    };
    let bounds = row[0] * row[1];
    let wanted = row[5] * bounds;
    let areas = [0, 1, 2].map(|floor| (row[6 + floor] * wanted).max(area(floor)));
    let total: f64 = areas.iter().sum();
    for (floor, area) in areas.into_iter().enumerate() {
        row[6 + floor] = area / total;
    }
    row[5] = total / bounds;
}

fn outside(partial: &Building, hull: &[[f64; 2]; 2], axis: usize, bound: f64) -> CompleteError {
    let ends = |b: &MassBox| {
        let plan = b.plan();
        let [low, high] = [[plan.x, plan.right()], [plan.y, plan.top()]][axis];
        [low - hull[axis][0], high - hull[axis][0]]
    };
    let beyond = |(_, b): &(usize, &MassBox)| ends(b)[1] > bound + SAME;
    let (index, b) = partial
        .boxes
        .iter()
        .enumerate()
        .find(beyond)
        .unwrap_or((0, &partial.boxes[0]));
    let [low, high] = ends(b);
    CompleteError::Outside {
        index,
        low,
        high,
        column: COLUMNS[axis],
        bound,
    }
}

/// Columns of styles, and whether the partial house shows them.
fn shown(partial: &Building) -> Vec<(usize, bool)> {
    let roof = |style| partial.boxes.iter().any(|b| b.roof.style == style);
    let window = |style| {
        let mut elements = partial.facades.iter().flat_map(|p| &p.elements);
        elements.any(|e| e.style == style)
    };
    vec![
        (39, roof(RoofStyle::Flat)),
        (40, roof(RoofStyle::Gable)),
        (41, roof(RoofStyle::Hip)),
        (42, window(ElementStyle::Sash)),
        (43, window(ElementStyle::Sliding)),
        (44, window(ElementStyle::Casement)),
        (45, window(ElementStyle::Bay)),
        (46, window(ElementStyle::Fixed)),
        (47, partial.special.contains(&Special::Chimney)),
        (48, partial.special.contains(&Special::Tower)),
    ]
}

/// Corners of the house to try: that of the coordinates, then the ends of the observed boxes.
pub(super) fn origins(partial: &Building, row: &[f64; 49]) -> Vec<[f64; 2]> {
    let hull = bounds(partial);
    let ends = |axis: usize| {
        let [low, high] = hull[axis];
        // The corner of the coordinates first, where the house then covers the observed boxes.
        let mut ends = vec![0.0, low, high - row[axis]];
        ends.retain(|o| low >= o - SAME && high <= o + row[axis] + SAME);
        ends.dedup_by(|a, b| (*a - *b).abs() < SAME);
        ends
    };
    let (xs, ys) = (ends(0), ends(1));
    ys.iter()
        .flat_map(|y| xs.iter().map(move |x| [*x, *y]))
        .collect()
}
