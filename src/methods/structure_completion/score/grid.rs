//! Grids (Sec. 3.2) extracted from elements, and what the scoring functions need of each.

use crate::layout::{Class, Element};

/// Elements of one class belong to different grids where their sizes differ by a greater factor: e^0.3.
pub(crate) const SIZE_STEP: f64 = 1.349_858_807_576_003;
/// Centres are on different lines where they differ by more than this share of the mean size.
const SAME_LINE: f64 = 0.35;
/// A column is the mirror image of another up to this share of the mean size.
const MIRROR: f64 = 0.35;

/// A grid: elements of one class and nearly one size, on common lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Class of its elements.
    pub class: Class,
    /// Its elements, as indices, ascending.
    pub members: Vec<u32>,
    /// Mean width and height of its elements.
    pub size: [f64; 2],
    /// Lower corner of its bounding box.
    pub low: [f64; 2],
    /// Upper corner of its bounding box.
    pub high: [f64; 2],
    /// Centres of its columns and of its rows, ascending.
    pub lines: [Vec<f64>; 2],
    /// Cells (row, column) that hold an element.
    pub cells: usize,
    /// Mean spacing of neighbours in a row and in a column, centre to centre.
    pub spacing: [Option<f64>; 2],
    /// Root of the variance of these spacings plus that of the elements about their lines; none for a
    /// single element.
    pub deviation: [Option<f64>; 2],
    /// Lower and upper end of each row along x, and of each column along y.
    pub ends: [Vec<[f64; 2]>; 2],
    /// Area of its elements.
    pub area: f64,
    /// Area of those that have a mirror image about the vertical axis of the facade.
    pub symmetric: f64,
}

/// The grids of some elements of one class, each as a list of indices: clusters of log width, and within
/// these of log height, by single linkage.
pub fn clusters(elements: &[Element], of_class: &[u32]) -> Vec<Vec<u32>> {
    let mut all = Vec::new();
    let mut order = of_class.to_vec();
    let width = |i: u32| elements[i as usize].rect.width;
    let height = |i: u32| elements[i as usize].rect.height;
    for mut wide in split(&mut order, width) {
        for mut same in split(&mut wide, height) {
            same.sort_unstable();
            all.push(same);
        }
    }
    all
}

/// Sorts by size and splits where the ratio of neighbours is above e^0.3.
fn split(order: &mut [u32], size: impl Fn(u32) -> f64) -> Vec<Vec<u32>> {
    order.sort_unstable_by(|&a, &b| size(a).total_cmp(&size(b)).then(a.cmp(&b)));
    let runs = order.chunk_by(|&a, &b| size(b) <= SIZE_STEP * size(a));
    runs.map(<[u32]>::to_vec).collect()
}

/// Positions on one axis: lines and the line of each member.
fn lines(at: &[f64], size: f64) -> (Vec<f64>, Vec<u32>) {
    let mut order: Vec<u32> = (0..at.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| at[a as usize].total_cmp(&at[b as usize]).then(a.cmp(&b)));
    let (mut lines, mut of) = (Vec::new(), vec![0; at.len()]);
    let runs = order.chunk_by(|&a, &b| at[b as usize] - at[a as usize] <= SAME_LINE * size);
    for (line, run) in runs.enumerate() {
        let sum: f64 = run.iter().map(|&i| at[i as usize]).sum();
        lines.push(sum / run.len() as f64);
        for &i in run {
            of[i as usize] = line as u32;
        }
    }
    (lines, of)
}

/// Mean, and standard deviation from two values on, of the spacings of members on neighbouring lines of
/// one axis that share their line of the other.
fn spacings(at: &[f64], line: &[u32], across: &[u32], lines: &[f64]) -> (Option<f64>, Option<f64>) {
    let mut order: Vec<(u32, u32, u32)> = (0..at.len())
        .map(|i| (across[i], line[i], i as u32))
        .collect();
    order.sort_unstable();
    let neighbours = order.windows(2).filter_map(|pair| {
        let (a, b) = (pair[0], pair[1]);
        (a.0 == b.0 && b.1 == a.1 + 1).then(|| at[b.2 as usize] - at[a.2 as usize])
    });
    let mut gaps: Vec<f64> = neighbours.collect();
    if gaps.is_empty() {
        gaps = lines.windows(2).map(|w| w[1] - w[0]).collect();
    }
    let n = gaps.len() as f64;
    if gaps.is_empty() {
        return (None, None);
    }
    let mean = gaps.iter().sum::<f64>() / n;
    let variance = gaps.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / n;
    (Some(mean), (gaps.len() > 1).then(|| variance.sqrt()))
}

impl Grid {
    /// The grid of some elements of one class in a facade of so much width.
    pub fn new(elements: &[Element], members: Vec<u32>, class: Class, width: f64) -> Self {
        let n = members.len() as f64;
        let mut grid = Self {
            class,
            members: Vec::new(),
            size: [0.0; 2],
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
            lines: [Vec::new(), Vec::new()],
            cells: 0,
            spacing: [None; 2],
            deviation: [None; 2],
            ends: [Vec::new(), Vec::new()],
            area: 0.0,
            symmetric: 0.0,
        };
        let mut at = [Vec::new(), Vec::new()];
        for &member in &members {
            let rect = &elements[member as usize].rect;
            let (start, extent) = ([rect.x, rect.y], [rect.width, rect.height]);
            for axis in 0..2 {
                grid.size[axis] += extent[axis] / n;
                grid.low[axis] = grid.low[axis].min(start[axis]);
                grid.high[axis] = grid.high[axis].max(start[axis] + extent[axis]);
                at[axis].push(start[axis] + extent[axis] / 2.0);
            }
            grid.area += rect.area();
        }
        let (columns, column) = lines(&at[0], grid.size[0]);
        let (rows, row) = lines(&at[1], grid.size[1]);
        (grid.spacing[0], grid.deviation[0]) = spacings(&at[0], &column, &row, &columns);
        (grid.spacing[1], grid.deviation[1]) = spacings(&at[1], &row, &column, &rows);
        if members.len() > 1 {
            for (axis, (line, lines)) in [(&column, &columns), (&row, &rows)].iter().enumerate() {
                let off = |i: usize| (at[axis][i] - lines[line[i] as usize]).powi(2);
                let scatter = (0..members.len()).map(off).sum::<f64>() / n;
                let spacing = grid.deviation[axis].unwrap_or(0.0);
                grid.deviation[axis] = Some((spacing * spacing + scatter).sqrt());
            }
        }
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        grid.ends = [vec![none; rows.len()], vec![none; columns.len()]];
        for (i, &member) in members.iter().enumerate() {
            let r = &elements[member as usize].rect;
            let spans = [(row[i], r.x, r.right()), (column[i], r.y, r.top())];
            for (axis, (line, low, high)) in spans.into_iter().enumerate() {
                let end = &mut grid.ends[axis][line as usize];
                *end = [end[0].min(low), end[1].max(high)];
            }
        }
        let mut cells: Vec<(u32, u32)> = row.iter().copied().zip(column.iter().copied()).collect();
        cells.sort_unstable();
        let mirrored = mirrors(&columns, width, MIRROR * grid.size[0]);
        for (i, &member) in members.iter().enumerate() {
            let image = mirrored[column[i] as usize];
            if image.is_some_and(|c| cells.binary_search(&(row[i], c)).is_ok()) {
                grid.symmetric += elements[member as usize].rect.area();
            }
        }
        cells.dedup();
        grid.cells = cells.len();
        grid.lines = [columns, rows];
        grid.members = members;
        grid
    }

    /// `#elements / (rows columns)` (Eq. 4).
    pub fn completeness(&self) -> f64 {
        let cells = self.lines[0].len() * self.lines[1].len();
        self.cells as f64 / cells as f64
    }

    /// Extent of the bounding box along an axis.
    pub fn extent(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }
}

/// The column at the mirror image of each column about the middle of `width`.
fn mirrors(columns: &[f64], width: f64, tolerance: f64) -> Vec<Option<u32>> {
    let nearest = |x: f64| {
        let after = columns.partition_point(|c| *c < x);
        let near = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let near = near.filter(|&i| i < columns.len() && (columns[i] - x).abs() <= tolerance);
        near.min_by(|&i, &j| (columns[i] - x).abs().total_cmp(&(columns[j] - x).abs()))
    };
    let images = columns.iter().map(|c| nearest(width - c));
    images.map(|i| i.map(|i| i as u32)).collect()
}
