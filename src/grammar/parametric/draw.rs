//! New facades from a library.
//!
//! 1. A facade of the library is drawn, and another one with the same root and counts, if there is one. Between two
//!    such facades every edge is `(1 - t) a + t b` with one `t` from 0 to 1 for all: what is aligned, equal, mirrored or
//!    repeated in both stays so.
//! 2. Along each axis the number of columns or floors is drawn from the facades of the library, and columns and floors
//!    are inserted or taken away until the facade has it, as far as it can be done without a seam: a *band*
//!    reaches from one line of the facade to another at which the picture is the same from end to end, so that
//!    beside every seam stands what stands beside one of these lines already. A band that would double something
//!    which the facade has once (a door), or take away all of something, is left alone.
//!
//! This is not the distribution of codes ([`Library::draw_code`]), which draws every size for itself
//! and is the one that bits speak of.

use rand::{Rng, RngExt};

use super::error::LibraryError;
use super::library::{Library, Member};
use super::tree;
use edifice_shape::{Axis, Facade, LabelGrid, Rect, Region, Span, components, decompose};

/// Narrowest and widest band, as shares of the side.
const BAND: (f64, f64) = (0.06, 0.45);

/// Thinnest strip of the picture through which a seam may go, as a share of the side.
const THINNEST: f64 = 0.012;

impl Library {
    /// Draws a new facade.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] when a member does not fit the rules, which a checked library has not.
    pub fn draw<R: Rng>(&self, rng: &mut R, name: &str) -> Result<Facade, LibraryError> {
        let members = self.members();
        let first = &members[rng.random_range(0..members.len())];
        let alike: Vec<&Member> = members
            .iter()
            .filter(|m| m.parse.root == first.parse.root && m.parse.counts == first.parse.counts)
            .collect();
        let second = alike[rng.random_range(0..alike.len())];
        let between = self.between(first, second, rng.random(), name)?;
        let wrong = |message: String| LibraryError::Invalid {
            place: name.to_owned(),
            message,
        };
        let mut grid = LabelGrid::from_facade(&between, None)
            .map_err(|e| wrong(e.to_string()))?
            .merged();
        for axis in Axis::BOTH {
            let from = levels(&between, axis);
            let other = &members[rng.random_range(0..members.len())];
            let to = levels(&self.facade(&other.parse, name)?, axis);
            for _ in 0..from.abs_diff(to).min(4) {
                match with_band(&grid, axis, to > from, rng) {
                    Some(edited) => grid = edited,
                    None => break,
                }
            }
        }
        Ok(decompose(&grid).map_err(|e| wrong(e.to_string()))?.facade)
    }

    /// The facade between two members of the same root and counts.
    fn between(&self, a: &Member, b: &Member, t: f64, name: &str) -> Result<Facade, LibraryError> {
        let edges = |member: &Member| {
            let mut edges = Vec::new();
            tree::unfold(
                &member.parse,
                self.rules().rules(),
                |label, [x, y], [w, h]| {
                    edges.push((label, [x, y, x + w, y + h].map(f64::from)));
                },
            )?;
            Ok::<_, LibraryError>(edges)
        };
        let (a, b) = (edges(a)?, edges(b)?);
        let cuts = [0, 1].map(|axis| {
            let pairs = a
                .iter()
                .zip(&b)
                .flat_map(|((_, a), (_, b))| [(a[axis], b[axis]), (a[axis + 2], b[axis + 2])]);
            mixed(pairs.collect(), t)
        });
        let place = |axis: usize, a: f64, b: f64| {
            let at = cuts[axis].iter().find(|cut| (cut.0, cut.1) == (a, b));
            at.map_or(0.0, |cut| cut.2) * self.step()
        };
        let regions = a.iter().zip(&b).map(|((label, a), (_, b))| {
            let edge = |k: usize| place(k % 2, a[k], b[k]);
            let label = self.rules().labels()[*label as usize].clone();
            let rect = Rect::new(edge(0), edge(1), edge(2) - edge(0), edge(3) - edge(1));
            Region { label, rect }
        });
        let regions = regions.collect();
        let [width, height] = [0, 1].map(|axis| {
            let last = cuts[axis].iter().map(|cut| cut.2).fold(0.0, f64::max);
            last * self.step()
        });
        Facade::new(name, self.unit(), width, height, regions).map_err(|source| {
            LibraryError::Layout {
                name: name.to_owned(),
                source,
            }
        })
    }
}

/// The places between two: of pairs of coordinates, with a share `t` of the second. Steps from one place to the next that are
/// equal in both stay equal, and none vanishes.
fn mixed(mut pairs: Vec<(f64, f64)>, t: f64) -> Vec<(f64, f64, f64)> {
    let mix = |pair: &(f64, f64)| pair.0 + t * (pair.1 - pair.0);
    pairs.sort_by(|x, y| {
        mix(x)
            .total_cmp(&mix(y))
            .then(x.0.total_cmp(&y.0))
            .then(x.1.total_cmp(&y.1))
    });
    pairs.dedup();
    let mut places: Vec<(f64, f64, f64)> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        let place = match places.last() {
            None => 0.0,
            Some(&(a, b, place)) => place + mix(&(pair.0 - a, pair.1 - b)).round().max(1.0),
        };
        places.push((pair.0, pair.1, place));
    }
    places
}

/// How many rows (along y) or columns (along x) of elements a facade has: spans along the axis of the regions of its most
/// frequent label but the one of most area, those that overlap counted once; at least 1.
fn levels(facade: &Facade, axis: Axis) -> u32 {
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
        return 1;
    };
    let own = facade
        .regions
        .iter()
        .filter(|region| region.label == element.0);
    let mut spans: Vec<(f64, f64)> = own
        .map(|r| (r.rect.start(axis), r.rect.end(axis)))
        .collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut count, mut reach) = (0, f64::NEG_INFINITY);
    for (start, end) in spans {
        if start >= reach {
            count += 1;
        }
        reach = reach.max(end);
    }
    count.max(1)
}

/// The picture with one band more or less along an axis; none where no band fits.
fn with_band<R: Rng>(grid: &LabelGrid, axis: Axis, more: bool, rng: &mut R) -> Option<LabelGrid> {
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
