//! The path of merges: strips of a label picture given to their neighbours, one after another.

use edifice_shape::LabelGrid;

/// Widest strip that a merge may fill, as a share of its side.
const WIDEST: f64 = 0.04;

/// The rule by which the next merge is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// The one that makes the least area wrong.
    Area,
    /// The one that makes the least area wrong for each label edge that it takes away.
    AreaPerEdge,
}

/// A picture on the path.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// The picture.
    pub grid: LabelGrid,
    /// Area whose label differs from that of the first picture.
    pub wrong: f64,
}

/// A picture with the areas of the first picture's labels in each of its cells.
struct Merging {
    xs: Vec<f64>,
    ys: Vec<f64>,
    cells: Vec<u16>,
    /// Area of each label in each cell.
    areas: Vec<f64>,
    labels: usize,
}

/// The pictures from the first one to the last whose wrong area is at most `limit`, after each merge.
///
/// `O(c l)` for each of at most as many merges as there are lines, for `c` cells and `l` labels.
pub(super) fn merges(first: &LabelGrid, limit: f64, order: Order) -> Vec<State> {
    let first = first.merged();
    let labels = first.labels.len();
    let mut areas = vec![0.0; first.cells.len() * labels];
    for j in 0..first.rows() {
        for i in 0..first.columns() {
            let cell = j * first.columns() + i;
            let area = (first.xs[i + 1] - first.xs[i]) * (first.ys[j + 1] - first.ys[j]);
            areas[cell * labels + usize::from(first.cells[cell])] = area;
        }
    }
    let mut merging = Merging {
        xs: first.xs.clone(),
        ys: first.ys.clone(),
        cells: first.cells.clone(),
        areas,
        labels,
    };
    let mut wrong = 0.0;
    let mut states = vec![State {
        grid: first.clone(),
        wrong,
    }];
    while let Some((added, merge)) = merging.cheapest(order, limit - wrong) {
        wrong += added;
        merging.fill(merge);
        merging.drop_lines();
        let grid = LabelGrid {
            xs: merging.xs.clone(),
            ys: merging.ys.clone(),
            cells: merging.cells.clone(),
            ..first.clone()
        };
        states.push(State { grid, wrong });
    }
    states
}

/// A strip of columns (or rows) and the neighbour that fills it.
#[derive(Debug, Clone, Copy)]
struct Merge {
    columns: bool,
    strip: usize,
    from: usize,
}

impl Merging {
    fn columns(&self) -> usize {
        self.xs.len() - 1
    }

    fn rows(&self) -> usize {
        self.ys.len() - 1
    }

    /// The cell of a strip at a place across it.
    fn cell(&self, columns: bool, strip: usize, across: usize) -> usize {
        match columns {
            true => across * self.columns() + strip,
            false => strip * self.columns() + across,
        }
    }

    /// Area added to what is wrong by a merge, and the length of label edges that it takes away.
    fn price(&self, merge: Merge) -> (f64, f64) {
        let across = if merge.columns {
            self.rows()
        } else {
            self.columns()
        };
        let beyond = match merge.from < merge.strip {
            true => merge.strip + 1,
            false => merge.strip.wrapping_sub(1),
        };
        let strips = if merge.columns {
            self.columns()
        } else {
            self.rows()
        };
        let (mut added, mut edges) = (0.0, 0.0);
        for t in 0..across {
            let own = self.cell(merge.columns, merge.strip, t);
            let (old, new) = (
                self.cells[own],
                self.cells[self.cell(merge.columns, merge.from, t)],
            );
            if old != new {
                let areas = &self.areas[own * self.labels..];
                added += areas[usize::from(old)] - areas[usize::from(new)];
                edges += 1.0;
                if beyond < strips {
                    let other = self.cells[self.cell(merge.columns, beyond, t)];
                    edges += f64::from(u8::from(other != old)) - f64::from(u8::from(other != new));
                }
            }
        }
        (added, edges)
    }

    /// The next merge within what may still become wrong, with the area it adds.
    fn cheapest(&self, order: Order, rest: f64) -> Option<(f64, Merge)> {
        let mut best: Option<(f64, f64, Merge)> = None;
        for columns in [true, false] {
            let cuts = if columns { &self.xs } else { &self.ys };
            let strips = cuts.len() - 1;
            let widest = WIDEST * cuts[strips];
            for strip in (0..strips).filter(|&k| cuts[k + 1] - cuts[k] <= widest) {
                for from in [strip.wrapping_sub(1), strip + 1] {
                    if from >= strips {
                        continue;
                    }
                    let merge = Merge {
                        columns,
                        strip,
                        from,
                    };
                    let (added, edges) = self.price(merge);
                    let rank = match order {
                        Order::Area => added,
                        Order::AreaPerEdge => added / (1.0 + edges.max(0.0)),
                    };
                    // Of equal merges the first stays, whatever the order of floating sums.
                    if added <= rest && best.is_none_or(|(least, ..)| rank < least - 1e-9) {
                        best = Some((rank, added, merge));
                    }
                }
            }
        }
        best.map(|(_, added, merge)| (added, merge))
    }

    /// Gives a strip the labels of its neighbour.
    fn fill(&mut self, merge: Merge) {
        let across = if merge.columns {
            self.rows()
        } else {
            self.columns()
        };
        for t in 0..across {
            let from = self.cell(merge.columns, merge.from, t);
            let to = self.cell(merge.columns, merge.strip, t);
            self.cells[to] = self.cells[from];
        }
    }

    /// Takes away the lines that no label edge is on.
    fn drop_lines(&mut self) {
        for columns in [true, false] {
            let (strips, across) = match columns {
                true => (self.columns(), self.rows()),
                false => (self.rows(), self.columns()),
            };
            let label = |k: usize, t: usize| self.cells[self.cell(columns, k, t)];
            let kept: Vec<usize> = (0..strips)
                .filter(|&k| k == 0 || (0..across).any(|t| label(k - 1, t) != label(k, t)))
                .collect();
            if kept.len() == strips {
                continue;
            }
            // The new strip of each old one.
            let strip_of: Vec<usize> = (0..strips)
                .map(|k| kept.partition_point(|&first| first <= k) - 1)
                .collect();
            let width = if columns { kept.len() } else { across };
            let mut cells = vec![0; kept.len() * across];
            let mut areas = vec![0.0; cells.len() * self.labels];
            for (k, &strip) in strip_of.iter().enumerate() {
                for t in 0..across {
                    let old = self.cell(columns, k, t);
                    let new = if columns {
                        t * width + strip
                    } else {
                        strip * width + t
                    };
                    cells[new] = self.cells[old];
                    for l in 0..self.labels {
                        areas[new * self.labels + l] += self.areas[old * self.labels + l];
                    }
                }
            }
            let cuts = if columns { &mut self.xs } else { &mut self.ys };
            let last = cuts[strips];
            *cuts = kept.iter().map(|&k| cuts[k]).chain([last]).collect();
            (self.cells, self.areas) = (cells, areas);
        }
    }
}
