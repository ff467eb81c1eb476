//! Columns and floors more or less, without a seam.
//!
//! A *band* reaches from one line of a picture to another at which the picture is the same from end to end: what stands
//! between them is repeated or taken away, so that beside every seam stands what stands beside one of these
//! lines already. A band that would double something which the facade has once (a door), or take away all of
//! something, is left alone.

use rand::{Rng, RngExt};

use edifice_shape::{Axis, Facade, LabelGrid, Span, components};

/// Narrowest and widest band, as shares of the side.
const BAND: (f64, f64) = (0.06, 0.45);

/// Thinnest strip of the picture through which a seam may go, as a share of the side.
const THINNEST: f64 = 0.012;

/// Spans along an axis of the elements of a facade, by where they start: the regions of its most frequent label but the one of most area.
fn spans(facade: &Facade, axis: Axis) -> Vec<(f64, f64)> {
    let mut labels: Vec<(&str, f64, usize)> = Vec::new();
    for region in &facade.regions {
        match labels.iter_mut().find(|known| known.0 == region.label) {
            Some(known) => {
                known.1 += region.rect.area();
                known.2 += 1;
            }
            None => labels.push((&region.label, region.rect.area(), 1)),
        }
    }
    labels.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
    let Some(element) = labels.iter().skip(1).rev().max_by_key(|known| known.2) else {
        return Vec::new();
    };
    let own = facade
        .regions
        .iter()
        .filter(|region| region.label == element.0);
    let mut spans: Vec<(f64, f64)> = own
        .map(|r| (r.rect.start(axis), r.rect.end(axis)))
        .collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    spans
}

/// Number of rows (along y) or columns (along x) of elements of a facade, those that overlap counted once; at least 1.
pub(super) fn levels(facade: &Facade, axis: Axis) -> u32 {
    let (mut count, mut reach) = (0, f64::NEG_INFINITY);
    for (start, end) in spans(facade, axis) {
        if start >= reach {
            count += 1;
        }
        reach = reach.max(end);
    }
    count.max(1)
}

/// Number of elements that are not in line: along the axis they overlap the one before, and have other ends.
pub(super) fn out_of_line(facade: &Facade, axis: Axis) -> usize {
    let mut spans = spans(facade, axis);
    let near = 1e-6 * facade.width.max(facade.height);
    spans.dedup_by(|a, b| (a.0 - b.0).abs() <= near && (a.1 - b.1).abs() <= near);
    let next = spans.windows(2);
    next.filter(|pair| pair[1].0 + near < pair[0].1).count()
}

/// The picture with one band more or less along an axis; none where no band fits.
pub(super) fn with_band<R: Rng>(
    grid: &LabelGrid,
    axis: Axis,
    more: bool,
    rng: &mut R,
) -> Option<LabelGrid> {
    let grid = grid.merged();
    let cuts = match axis {
        Axis::X => &grid.xs,
        Axis::Y => &grid.ys,
    };
    let count = cuts.len() - 1;
    let side = cuts[count];
    let middle = |k: usize| 0.5 * (cuts[k] + cuts[k + 1]);
    let wide = |k: usize| cuts[k + 1] - cuts[k] >= THINNEST * side;
    let mut bands = Vec::new();
    for from in (0..count).filter(|&k| wide(k)) {
        // The first line at which the picture is the same, one period further.
        let same = |to: &usize| {
            (0..across(&grid, axis))
                .all(|t| label(&grid, axis, from, t) == label(&grid, axis, *to, t))
        };
        let to = (from + 1..count).find(|to| wide(*to) && same(to));
        if let Some(to) = to {
            let share = (middle(to) - middle(from)) / side;
            if (BAND.0..BAND.1).contains(&share) {
                bands.push((from, to));
            }
        }
    }
    let before = pieces(&grid);
    while !bands.is_empty() {
        let (from, to) = bands.swap_remove(rng.random_range(0..bands.len()));
        // Half a strip ends the part before a seam, half a strip begins the one after it.
        let edited = match more {
            true => joined(&grid, axis, to, from),
            false => joined(&grid, axis, from, to),
        };
        let after = pieces(&edited);
        let fits = before.iter().all(|(label, count)| {
            let now = after
                .iter()
                .find(|other| other.0 == *label)
                .map_or(0, |other| other.1);
            now > 0 && (*count > 1 || now == 1)
        });
        if fits {
            return Some(edited);
        }
    }
    None
}

/// Number of strips across an axis.
fn across(grid: &LabelGrid, axis: Axis) -> usize {
    match axis {
        Axis::X => grid.rows(),
        Axis::Y => grid.columns(),
    }
}

fn label(grid: &LabelGrid, axis: Axis, along: usize, across: usize) -> u16 {
    match axis {
        Axis::X => grid.at(along, across),
        Axis::Y => grid.at(across, along),
    }
}

/// The picture up to the middle of strip `end`, then from the middle of strip `start`.
fn joined(grid: &LabelGrid, axis: Axis, end: usize, start: usize) -> LabelGrid {
    let cuts = match axis {
        Axis::X => &grid.xs,
        Axis::Y => &grid.ys,
    };
    // Strips in order; the seam strip has half of either width, the larger half from the first.
    let half = |k: usize| ((cuts[k + 1] - cuts[k]) / 2.0).ceil();
    let mut strips: Vec<(usize, f64)> = (0..end).map(|k| (k, cuts[k + 1] - cuts[k])).collect();
    strips.push((
        end,
        half(end) + (cuts[start + 1] - cuts[start]) - half(start),
    ));
    strips.extend((start + 1..cuts.len() - 1).map(|k| (k, cuts[k + 1] - cuts[k])));
    let mut new_cuts = vec![0.0];
    for &(_, width) in &strips {
        new_cuts.push(new_cuts[new_cuts.len() - 1] + width);
    }
    let mut out = grid.clone();
    let count = across(grid, axis);
    match axis {
        Axis::X => {
            out.cells = (0..count)
                .flat_map(|t| strips.iter().map(move |&(k, _)| (k, t)))
                .map(|(k, t)| label(grid, axis, k, t))
                .collect();
            out.xs = new_cuts;
        }
        Axis::Y => {
            out.cells = strips
                .iter()
                .flat_map(|&(k, _)| (0..count).map(move |t| (k, t)))
                .map(|(k, t)| label(grid, axis, k, t))
                .collect();
            out.ys = new_cuts;
        }
    }
    out
}

/// Number of connected areas of each label.
fn pieces(grid: &LabelGrid) -> Vec<(u16, usize)> {
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let mut of_cell = vec![0; grid.cells.len()];
    let found = components(grid, whole, &mut of_cell);
    let mut counts: Vec<(u16, usize)> = Vec::new();
    for component in found {
        match counts.iter_mut().find(|known| known.0 == component.label) {
            Some(known) => known.1 += 1,
            None => counts.push((component.label, 1)),
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_more_and_a_band_less() {
        let labels = vec!["wall".to_string(), "window".to_string()];
        let grid = LabelGrid {
            name: "g".into(),
            unit: "px".into(),
            xs: [0.0, 4.0, 7.0, 11.0, 14.0, 18.0].to_vec(),
            ys: vec![0.0, 2.0, 4.0, 6.0],
            labels,
            cells: vec![0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0],
        };
        let more = joined(&grid, Axis::X, 2, 0);
        assert_eq!(more.check(), Ok(()));
        assert_eq!(more.merged().columns(), 7);
        assert_eq!(more.xs[more.xs.len() - 1], 25.0);
        let less = joined(&grid, Axis::X, 0, 2);
        assert_eq!(less.check(), Ok(()));
        assert_eq!(less.merged().columns(), 3);
    }
}
