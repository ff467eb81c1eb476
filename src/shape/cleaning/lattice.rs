//! Rows and columns from element boxes: what a segmentation says about the structure of a facade.
//!
//! Segmentations move every edge of every window by itself. Here windows are put back on common lines:
//! 1. The bounding boxes of connected areas labelled `window` (small ones are specks) are clustered: *floors* by the height
//!    of their centres, *columns* by the abscissa of their centres; a cluster ends where the next centre is more than half a
//!    median window away. Floors get the median bottom and top of their boxes, columns the median left and right.
//! 2. A floor has a window in a column where it has a box; where it has one in most columns, in all.
//! 3. Balconies belong to the floor whose windows they overlap or carry. One that is at least half as wide as the
//!    facade is *running* and reaches from side to side; others take the columns that they cover, and a floor with balconies in most
//!    columns has them in all. Bottom and top are medians.
//! 4. Behind them lie horizontal *bands*: the label of `sky`, `roof`, `wall`, `shop` and the like that most of each row shows.
//! 5. The largest `door` stands on the ground where it is, at its own width and height.
//!
//! What was found is painted in this order: bands, windows, balconies, door. Labels of other kinds are not kept.
//! A picture whose windows lie on these lines already is given back as it is: exact labels stay exact.

mod bands;

use crate::{LabelGrid, Span, components};

use bands::bands;

/// A window smaller than this share of the median one is a speck.
const SPECK: f64 = 0.3;

/// What most columns have, all have.
const MOST: f64 = 0.7;

/// A balcony this wide, as a share of the facade, runs from side to side.
const RUNNING: f64 = 0.5;

/// A box: left, right, bottom, top.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Box4 {
    x: [f64; 2],
    y: [f64; 2],
}

impl Box4 {
    fn area(&self) -> f64 {
        (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
    }
}

/// The facade on common rows and columns (see the module's first page). A picture without windows, or whose windows
/// lie on common lines already, comes back unchanged. `O(cells)` and a little for each element.
pub fn on_lattice(grid: &LabelGrid) -> LabelGrid {
    let number = |name: &str| {
        grid.labels
            .iter()
            .position(|l| l.eq_ignore_ascii_case(name))
    };
    let Some(window) = number("window") else {
        return grid.clone();
    };
    let all = boxes(grid);
    let of = |label: Option<usize>| -> Vec<Box4> {
        let own = all.iter().filter(|(l, _)| Some(*l) == label);
        own.map(|(_, b)| *b).collect()
    };
    let windows = without_specks(of(Some(window)));
    if windows.is_empty() {
        return grid.clone();
    }
    let floors = clusters(&windows, |b| b.y);
    let columns = clusters(&windows, |b| b.x);
    let rows: Vec<[f64; 2]> = floors
        .iter()
        .map(|f| middle(f, &windows, |b| b.y))
        .collect();
    let spans: Vec<[f64; 2]> = columns
        .iter()
        .map(|c| middle(c, &windows, |b| b.x))
        .collect();
    let exact = |groups: &[Vec<usize>], lines: &[[f64; 2]], side: fn(&Box4) -> [f64; 2]| {
        groups
            .iter()
            .zip(lines)
            .all(|(group, line)| group.iter().all(|&w| side(&windows[w]) == *line))
    };
    if exact(&floors, &rows, |b| b.y) && exact(&columns, &spans, |b| b.x) {
        return grid.clone();
    }
    let (width, height) = (grid.xs[grid.columns()], grid.ys[grid.rows()]);
    let mut painted: Vec<(usize, Box4)> = bands(
        grid,
        &[
            Some(window),
            number("balcony"),
            number("door"),
            number("void"),
        ],
    )
    .into_iter()
    .map(|(label, y)| (label, Box4 { x: [0.0, width], y }))
    .collect();
    for (floor, row) in floors.iter().zip(&rows) {
        let has: Vec<bool> = columns
            .iter()
            .map(|c| c.iter().any(|w| floor.contains(w)))
            .collect();
        for (span, _) in spans.iter().zip(filled(has)).filter(|(_, has)| *has) {
            painted.push((window, Box4 { x: *span, y: *row }));
        }
    }
    if let Some(balcony) = number("balcony") {
        let found = without_specks(of(Some(balcony)));
        painted.extend(
            balconies(&found, &rows, &spans, width)
                .into_iter()
                .map(|b| (balcony, b)),
        );
    }
    let doors = of(number("door"));
    if let (Some(label), Some(door)) = (
        number("door"),
        doors
            .into_iter()
            .max_by(|a, b| a.area().total_cmp(&b.area())),
    ) {
        let ground = Box4 {
            x: door.x,
            y: [0.0, door.y[1].min(height)],
        };
        painted.push((label, ground));
    }
    paint(grid, &painted)
}

/// The bounding boxes of all connected areas, with their labels.
fn boxes(grid: &LabelGrid) -> Vec<(usize, Box4)> {
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let found = components(grid, whole, &mut vec![0; grid.cells.len()]);
    let bounds = found.iter().map(|area| {
        let b = area.bounds;
        let x = [grid.xs[b.left], grid.xs[b.right]];
        (
            usize::from(area.label),
            Box4 {
                x,
                y: [grid.ys[b.bottom], grid.ys[b.top]],
            },
        )
    });
    bounds.collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn without_specks(boxes: Vec<Box4>) -> Vec<Box4> {
    let usual = median(boxes.iter().map(Box4::area).collect());
    boxes
        .into_iter()
        .filter(|b| b.area() >= SPECK * usual)
        .collect()
}

/// Indices of boxes in clusters of neighbouring centres along one axis, in order.
fn clusters(boxes: &[Box4], side: impl Fn(&Box4) -> [f64; 2]) -> Vec<Vec<usize>> {
    let centre = |k: usize| side(&boxes[k]).iter().sum::<f64>() / 2.0;
    let usual = median(boxes.iter().map(|b| side(b)[1] - side(b)[0]).collect());
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| centre(a).total_cmp(&centre(b)));
    let mut out: Vec<Vec<usize>> = Vec::new();
    for k in order {
        match out.last_mut() {
            Some(cluster)
                if cluster
                    .last()
                    .is_some_and(|&last| centre(k) - centre(last) <= usual / 2.0) =>
            {
                cluster.push(k);
            }
            _ => out.push(vec![k]),
        }
    }
    out
}

/// Median lower and upper side of a cluster.
fn middle(cluster: &[usize], boxes: &[Box4], side: impl Fn(&Box4) -> [f64; 2]) -> [f64; 2] {
    [0, 1].map(|end| median(cluster.iter().map(|&k| side(&boxes[k])[end]).collect()))
}

/// What most columns have, all have.
fn filled(mut has: Vec<bool>) -> Vec<bool> {
    let count = has.iter().filter(|has| **has).count();
    if count as f64 >= MOST * has.len() as f64 {
        has.fill(true);
    }
    has
}

/// The balconies of all floors.
fn balconies(found: &[Box4], rows: &[[f64; 2]], spans: &[[f64; 2]], width: f64) -> Vec<Box4> {
    let mut of_floor: Vec<Vec<Box4>> = vec![Vec::new(); rows.len()];
    for b in found {
        // The floor whose windows begin nearest to where the balcony ends, within a window's height.
        let distance = |row: &[f64; 2]| (row[0] - b.y[1]).abs().min((row[0] - b.y[0]).abs());
        let nearest =
            (0..rows.len()).min_by(|&i, &j| distance(&rows[i]).total_cmp(&distance(&rows[j])));
        if let Some(floor) = nearest
            && distance(&rows[floor]) <= rows[floor][1] - rows[floor][0]
        {
            of_floor[floor].push(*b);
        }
    }
    let mut out = Vec::new();
    for own in of_floor {
        let (running, single): (Vec<Box4>, Vec<Box4>) = own
            .into_iter()
            .partition(|b| b.x[1] - b.x[0] >= RUNNING * width);
        let y = |boxes: &[Box4]| [0, 1].map(|end| median(boxes.iter().map(|b| b.y[end]).collect()));
        if !running.is_empty() {
            out.push(Box4 {
                x: [0.0, width],
                y: y(&running),
            });
            continue;
        }
        if single.is_empty() {
            continue;
        }
        let covers = |b: &Box4, span: &[f64; 2]| {
            let shared = b.x[1].min(span[1]) - b.x[0].max(span[0]);
            shared >= 0.5 * (span[1] - span[0])
        };
        // Those over several columns reach from the first to the last of them.
        let mut has = vec![false; spans.len()];
        for b in &single {
            let under: Vec<usize> = (0..spans.len()).filter(|&c| covers(b, &spans[c])).collect();
            match under[..] {
                [first, .., last] => out.push(Box4 {
                    x: [spans[first][0], spans[last][1]],
                    y: y(&single),
                }),
                [only] => has[only] = true,
                [] => {}
            }
        }
        let all = filled(has);
        let narrow = spans.iter().zip(all).filter(|(_, has)| *has);
        out.extend(narrow.map(|(span, _)| Box4 {
            x: *span,
            y: y(&single),
        }));
    }
    out
}

/// A grid of the boxes, later ones over earlier ones.
fn paint(grid: &LabelGrid, painted: &[(usize, Box4)]) -> LabelGrid {
    let cuts = |side: fn(&Box4) -> [f64; 2], end: f64| {
        let mut cuts: Vec<f64> = painted
            .iter()
            .flat_map(|(_, b)| side(b))
            .chain([0.0, end])
            .collect();
        cuts.retain(|cut| (0.0..=end).contains(cut));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let xs = cuts(|b| b.x, grid.xs[grid.columns()]);
    let ys = cuts(|b| b.y, grid.ys[grid.rows()]);
    let columns = xs.len() - 1;
    let mut cells = vec![0; columns * (ys.len() - 1)];
    for (label, b) in painted {
        let place = |cuts: &[f64], value: f64| cuts.partition_point(|&cut| cut < value);
        for j in place(&ys, b.y[0])..place(&ys, b.y[1]) {
            for i in place(&xs, b.x[0])..place(&xs, b.x[1]) {
                cells[j * columns + i] = *label as u16;
            }
        }
    }
    LabelGrid {
        xs,
        ys,
        cells,
        ..grid.clone()
    }
    .merged()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three by three windows on a wall under a roof, each side of each window moved by what `moved` says.
    fn facade(moved: impl Fn(usize) -> f64) -> LabelGrid {
        let mut painted = vec![
            (
                0,
                Box4 {
                    x: [0.0, 90.0],
                    y: [0.0, 100.0],
                },
            ),
            (
                1,
                Box4 {
                    x: [0.0, 90.0],
                    y: [100.0, 120.0],
                },
            ),
        ];
        for k in 0..9 {
            let (x, y) = (10.0 + 28.0 * (k % 3) as f64, 10.0 + 30.0 * (k / 3) as f64);
            let side = |n: usize| moved(4 * k + n);
            painted.push((
                2,
                Box4 {
                    x: [x + side(0), x + 15.0 + side(1)],
                    y: [y + side(2), y + 20.0 + side(3)],
                },
            ));
        }
        let blank = LabelGrid {
            name: "f".into(),
            unit: "px".into(),
            xs: vec![0.0, 90.0],
            ys: vec![0.0, 120.0],
            labels: vec!["wall".into(), "roof".into(), "window".into()],
            cells: vec![0],
        };
        paint(&blank, &painted)
    }

    #[test]
    fn exact_labels_stay_and_moved_ones_come_back() {
        let exact = facade(|_| 0.0);
        assert_eq!(on_lattice(&exact), exact);
        // Two of three boxes of each row and column keep their sides: the median is theirs.
        let moved = facade(|side| {
            if side / 4 % 4 == 0 {
                (side % 3) as f64 - 1.0
            } else {
                0.0
            }
        });
        assert_ne!(moved, exact);
        assert_eq!(on_lattice(&moved), exact);
    }

    #[test]
    fn a_picture_without_windows_stays() {
        let mut grid = facade(|_| 0.0);
        grid.labels[2] = "hole".into();
        assert_eq!(on_lattice(&grid), grid);
    }
}
