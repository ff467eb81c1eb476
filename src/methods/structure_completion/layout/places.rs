//! Items by place: what is near a rectangle, or next on a line, without a look at all items.
//!
//! The facade is cut into cells of about the mean size of an element; an item is listed in every cell that its
//! rectangle meets. For elements that hardly overlap a query looks at a bounded number of items.

use edifice_shape::Rect;

/// Ends the list of a cell.
const END: u32 = u32::MAX;

/// Items by cell.
#[derive(Debug, Clone)]
pub(in super::super) struct Places {
    cell: [f64; 2],
    counts: [usize; 2],
    /// The entry of each cell that was made last.
    heads: Vec<u32>,
    /// Items, each with the entry of its cell that was made before.
    entries: Vec<(u32, u32)>,
}

fn spans(rect: &Rect) -> [(f64, f64); 2] {
    [(rect.x, rect.right()), (rect.y, rect.top())]
}

impl Places {
    /// No items yet, on a facade of this extent, with cells of about this size, but at most four for each of `most` items.
    pub(crate) fn new(facade: [f64; 2], size: [f64; 2], most: usize) -> Self {
        let limit = 2 * most.isqrt().max(1);
        // A size that is no number gives one cell.
        let counts = [0, 1].map(|axis| ((facade[axis] / size[axis]) as usize).clamp(1, limit));
        Self {
            cell: [0, 1].map(|axis| facade[axis] / counts[axis] as f64),
            heads: vec![END; counts[0] * counts[1]],
            entries: Vec::new(),
            counts,
        }
    }

    /// The cell along an axis; what lies outside the facade belongs to the outermost one.
    fn cell_of(&self, axis: usize, at: f64) -> usize {
        ((at / self.cell[axis]).max(0.0) as usize).min(self.counts[axis] - 1)
    }

    /// Numbers of the items of a cell, the latest first.
    fn of_cell(&self, column: usize, row: usize) -> impl Iterator<Item = u32> + '_ {
        let mut at = self.heads[row * self.counts[0] + column];
        std::iter::from_fn(move || {
            let (item, next) = *self.entries.get(at as usize)?;
            at = next;
            Some(item)
        })
    }

    /// Lists an item.
    pub(crate) fn insert(&mut self, item: u32, rect: &Rect) {
        let [across, up] = spans(rect);
        for row in self.cell_of(1, up.0)..=self.cell_of(1, up.1) {
            for column in self.cell_of(0, across.0)..=self.cell_of(0, across.1) {
                let head = &mut self.heads[row * self.counts[0] + column];
                self.entries.push((item, *head));
                *head = self.entries.len() as u32 - 1;
            }
        }
    }

    /// True if the test holds for an item that may meet the rectangle; one item may be tested several times.
    pub(crate) fn any_near(&self, rect: &Rect, test: impl Fn(u32) -> bool) -> bool {
        let [across, up] = spans(rect);
        let columns = self.cell_of(0, across.0)..=self.cell_of(0, across.1);
        let mut rows = self.cell_of(1, up.0)..=self.cell_of(1, up.1);
        rows.any(|row| (columns.clone()).any(|column| self.of_cell(column, row).any(&test)))
    }

    /// The least distance that `distance` gives to an item whose centre lies along an axis from `at`, forward or
    /// backward, and across it within `strip`. `distance` gives `None` for items that do not count, and else the
    /// distance of the centre from `at` along the axis.
    pub(crate) fn next(
        &self,
        (axis, forward): (usize, bool),
        at: f64,
        strip: (f64, f64),
        distance: impl Fn(u32) -> Option<f64>,
    ) -> Option<f64> {
        let lines = self.cell_of(1 - axis, strip.0)..=self.cell_of(1 - axis, strip.1);
        let first = self.cell_of(axis, at);
        let mut least = f64::INFINITY;
        let steps = if forward {
            self.counts[axis] - 1 - first
        } else {
            first
        };
        for step in 0..=steps {
            let cell = if forward { first + step } else { first - step };
            for line in lines.clone() {
                let (column, row) = if axis == 0 {
                    (cell, line)
                } else {
                    (line, cell)
                };
                for item in self.of_cell(column, row) {
                    least = distance(item).map_or(least, |d| d.min(least));
                }
            }
            // Centres in further cells are at least this far.
            let end = (cell + usize::from(forward)) as f64 * self.cell[axis];
            if least <= (end - at).abs() {
                break;
            }
        }
        least.is_finite().then_some(least)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use edifice_base::rng::stream;

    /// Random rectangles, some beyond the outline, against a look at all of them.
    #[test]
    fn what_is_near_is_found() {
        let mut rng = stream(1, "places", 0);
        for case in 0..300 {
            let facade = [rng.random_range(1.0..200.0), rng.random_range(1.0..200.0)];
            let size = match case % 4 {
                0 => [0.0, 0.01],
                1 => [f64::NAN, 1e9],
                _ => [rng.random_range(1.0..30.0), rng.random_range(1.0..30.0)],
            };
            let mut places = Places::new(facade, size, 30);
            let mut rect = || {
                let (w, h) = (rng.random_range(0.1..40.0), rng.random_range(0.1..40.0));
                let x = rng.random_range(-0.1..1.0) * facade[0];
                Rect::new(x, rng.random_range(-0.1..1.0) * facade[1], w, h)
            };
            let rects: Vec<Rect> = (0..40).map(|_| rect()).collect();
            for (i, r) in rects.iter().enumerate() {
                places.insert(i as u32, r);
            }
            for _ in 0..20 {
                let r = rect();
                let meets = |i: u32| rects[i as usize].overlap(&r) > 0.0;
                let all = (0..rects.len() as u32).any(meets);
                assert_eq!(places.any_near(&r, meets), all);
                let (x, y) = r.centre();
                let at = [x.clamp(0.0, facade[0]), y.clamp(0.0, facade[1])];
                for (axis, forward) in [(0, true), (0, false), (1, true), (1, false)] {
                    let across = 1 - axis;
                    let strip = (at[across] - 5.0, at[across] + 5.0);
                    let distance = |i: u32| {
                        let (x, y) = rects[i as usize].centre();
                        let c = [x.clamp(0.0, facade[0]), y.clamp(0.0, facade[1])];
                        let ahead = if forward {
                            c[axis] - at[axis]
                        } else {
                            at[axis] - c[axis]
                        };
                        let within = strip.0 <= c[across] && c[across] <= strip.1;
                        (within && ahead > 0.0).then_some(ahead)
                    };
                    let all = (0..rects.len() as u32).filter_map(distance);
                    let all = all.fold(f64::INFINITY, f64::min);
                    let found = places.next((axis, forward), at[axis], strip, distance);
                    assert_eq!(found.unwrap_or(f64::INFINITY), all);
                }
            }
        }
    }
}
