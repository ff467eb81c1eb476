//! Rows and columns from element boxes: what a segmentation says about the structure of a facade.
//!
//! Segmentations move every edge of every window by itself. Here windows are put back on common lines:
//! 1. The bounding boxes of connected areas labelled `window` (small ones are specks; what a balcony hides of a window belongs
//!    to it) are clustered: *floors* by the height
//!    of their centres, *columns* by the abscissa of their centres; a cluster ends where the next centre is more than half a
//!    median window away. Floors get the median bottom and top of their boxes, columns the median left and right.
//!    A column has windows on two fifths of the floors; those of an attic between the columns make none.
//! 2. A floor has a window in a column where it has a box; where it has one in most columns, in all, but for columns with a
//!    window of another floor at its height (a stairwell's). Windows in no column stay on their floor, as wide as the
//!    others above and below them.
//! 3. Balconies belong to the floor whose windows they overlap or carry. One that is at least four fifths as wide as the
//!    facade is *running* and reaches from side to side; others take the columns that they cover, and a floor with balconies in most
//!    columns has them in all. Bottom and top are medians.
//! 4. Behind them lie horizontal *bands*: the label of `sky`, `roof`, `wall`, `shop` and the like that most of each row shows.
//! 5. Doors (`door`) stand on the ground where they are, each at its own width and height: the largest, and those beside it,
//!    which begin below its middle and are no specks.
//!
//! All of it is painted in this order: bands, windows, balconies, doors. Labels of other kinds are not kept.
//! A picture whose windows lie on these lines already is given back as it is: exact labels stay exact.

mod balconies;
mod bands;
mod boxes;
mod doors;
mod paint;

use std::collections::BTreeSet;

use crate::LabelGrid;

use balconies::{Balconies, balconies};
use bands::bands;
use boxes::{Box4, behind_balconies, boxes, clusters, filled, middle, overlap, without_specks};
use doors::on_the_ground;
use paint::paint;

/// A column has windows on this share of the floors.
const OF_FLOORS: f64 = 0.4;

/// A door this near to the end of a facade, as a share of its width, stands at the end.
const AT_END: f64 = 0.02;

/// The place of a door among the elements of a ground floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DoorPlace {
    /// At the left end of the facade.
    Left,
    /// Between other elements.
    Between,
    /// At the right end of the facade.
    Right,
}

/// The rows and columns of a facade (see the module's first page).
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Lower and upper side of the windows of each floor that has some, from the bottom up, in the unit of the picture.
    pub rows: Vec<[f64; 2]>,
    /// Left and right side of the windows of each column, from the left.
    pub columns: Vec<[f64; 2]>,
    /// True if a ground floor without windows, of shops or a door, lies below the first row.
    pub windowless_ground: bool,
    /// The place of the largest door.
    pub door: Option<DoorPlace>,
    /// Floors with a balcony from side to side, the ground floor is 0.
    pub running: Vec<usize>,
    /// Columns of windows that are no column of the facade, such as those of an attic.
    loose: Vec<[f64; 2]>,
    /// For each row the columns that have a window, then the loose ones.
    windows: Vec<Vec<bool>>,
    balconies: Vec<Balconies>,
    /// The doors on the ground, the largest last.
    doors: Vec<Box4>,
    /// True if each window of the picture is as its row and its column say.
    exact: bool,
}

impl Lattice {
    /// Reads the lattice off a label picture; a picture without windows has neither rows nor columns.
    /// `O(cells)` and a little for each element.
    pub fn read(grid: &LabelGrid) -> Self {
        let all = boxes(grid);
        let of = |label: &str| -> Vec<Box4> {
            let label = number(grid, label);
            let own = all.iter().filter(|(l, _)| Some(*l) == label);
            own.map(|(_, b)| *b).collect()
        };
        let (width, height) = (grid.xs[grid.columns()], grid.ys[grid.rows()]);
        let on_walls = without_specks(of("balcony"));
        let found = behind_balconies(&of("window"), &on_walls, width.max(height));
        let whole: Vec<Box4> = found.iter().map(|w| w.whole).collect();
        let seen: Vec<Box4> = found.iter().map(|w| w.seen).collect();
        let floors = clusters(&whole, |b| b.y);
        let mut floor_of = vec![0; whole.len()];
        for (number, floor) in floors.iter().enumerate() {
            floor.iter().for_each(|&w| floor_of[w] = number);
        }
        let floors_of =
            |column: &[usize]| -> BTreeSet<usize> { column.iter().map(|&w| floor_of[w]).collect() };
        let (columns, loose): (Vec<_>, Vec<_>) = clusters(&whole, |b| b.x)
            .into_iter()
            .partition(|column| floors_of(column).len() as f64 >= OF_FLOORS * floors.len() as f64);
        let middles = |groups: &[Vec<usize>], boxes: &[Box4], side: fn(&Box4) -> [f64; 2]| {
            let middles = groups.iter().map(|group| middle(group, boxes, side));
            middles.collect::<Vec<_>>()
        };
        let rows = middles(&floors, &whole, |b| b.y);
        let exact = |groups: &[Vec<usize>], side: fn(&Box4) -> [f64; 2]| {
            let mut placed = groups.iter().zip(middles(groups, &seen, side));
            placed.all(|(group, line)| group.iter().all(|&w| side(&seen[w]) == line))
        };
        let spans = middles(&columns, &whole, |b| b.x);
        let balconies = balconies(&on_walls, &rows, &spans, width);
        let found_doors = of("door");
        let below_windows = |b: &Box4| {
            rows.first()
                .is_some_and(|row| 2.0 * b.y[1] <= row[0] + row[1])
        };
        let windowless_ground = found_doors.iter().chain(&of("shop")).any(below_windows);
        let on = [&columns, &loose]
            .map(|groups| groups.iter().map(|g| floors_of(g)).collect::<Vec<_>>());
        let running = balconies.iter().enumerate();
        let running = running.filter(|(_, on)| matches!(on, Balconies::Running(_)));
        let doors = on_the_ground(found_doors);
        Self {
            door: doors.last().map(|door| place(door, width)),
            running: running
                .map(|(row, _)| row + usize::from(windowless_ground))
                .collect(),
            windows: (0..floors.len())
                .map(|floor| {
                    let has = |groups: &[BTreeSet<usize>]| {
                        groups.iter().map(|g| g.contains(&floor)).collect()
                    };
                    let mut all = filled(has(&on[0]));
                    for (has, column) in all.iter_mut().zip(&on[0]) {
                        let over = |&other: &usize| overlap(&rows[other], &rows[floor]);
                        *has &= column.contains(&floor) || !column.iter().any(over);
                    }
                    [all, has(&on[1])].concat()
                })
                .collect(),
            exact: exact(&floors, |b| b.y) && exact(&columns, |b| b.x) && exact(&loose, |b| b.x),
            loose: middles(&loose, &whole, |b| b.x),
            columns: spans,
            windowless_ground,
            balconies,
            doors,
            rows,
        }
    }

    /// Number of floors, a ground floor without windows included.
    pub fn floors(&self) -> usize {
        self.rows.len() + usize::from(self.windowless_ground)
    }

    /// Number of architectural changes between two facades (Weissenberg et al. 2013, Sec. 5.4: "number of floors, window
    /// columns, door placement and location of running balconies").
    pub fn changes(&self, other: &Self) -> usize {
        let missing =
            |from: &[usize], of: &[usize]| from.iter().filter(|f| !of.contains(f)).count();
        self.floors().abs_diff(other.floors())
            + self.columns.len().abs_diff(other.columns.len())
            + usize::from(self.door != other.door)
            + missing(&self.running, &other.running)
            + missing(&other.running, &self.running)
    }
}

/// The facade on common rows and columns (see the module's first page). A picture without windows, or whose windows
/// lie on common lines already, comes back unchanged. `O(cells)` and a little for each element.
pub fn on_lattice(grid: &LabelGrid) -> LabelGrid {
    let lattice = Lattice::read(grid);
    let Some(window) = number(grid, "window") else {
        return grid.clone();
    };
    if lattice.exact {
        return grid.clone();
    }
    let (width, height) = (grid.xs[grid.columns()], grid.ys[grid.rows()]);
    let elements = ["window", "balcony", "door", "void"].map(|label| number(grid, label));
    let behind = bands(grid, &elements).into_iter();
    let x = [0.0, width];
    let mut painted: Vec<(usize, Box4)> = behind.map(|(label, y)| (label, Box4 { x, y })).collect();
    for (&y, has) in lattice.rows.iter().zip(&lattice.windows) {
        let spans = lattice.columns.iter().chain(&lattice.loose).zip(has);
        painted.extend(
            spans
                .filter(|(_, has)| **has)
                .map(|(&x, _)| (window, Box4 { x, y })),
        );
    }
    if let Some(label) = number(grid, "balcony") {
        let all = lattice.balconies.iter().flat_map(Balconies::boxes);
        painted.extend(all.map(|b| (label, *b)));
    }
    if let Some(label) = number(grid, "door") {
        painted.extend(lattice.doors.iter().map(|door| {
            let y = [0.0, door.y[1].min(height)];
            (label, Box4 { x: door.x, y })
        }));
    }
    paint(grid, &painted)
}

/// The number of a label in a picture, whatever its case.
fn number(grid: &LabelGrid, name: &str) -> Option<usize> {
    let mut labels = grid.labels.iter();
    labels.position(|label| label.eq_ignore_ascii_case(name))
}

fn place(door: &Box4, width: f64) -> DoorPlace {
    if door.x[0] <= AT_END * width {
        DoorPlace::Left
    } else if door.x[1] >= (1.0 - AT_END) * width {
        DoorPlace::Right
    } else {
        DoorPlace::Between
    }
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
    fn attic_windows_between_columns_stay_between_them() {
        let mut painted: Vec<Box4> = Vec::new();
        for floor in 0..3 {
            for column in 0..3 {
                let (x, y) = (10.0 + 28.0 * column as f64, 30.0 * floor as f64 + 2.0);
                // One side of one window wavers, so that the picture is not exact.
                let y = [y, y + 20.0 + f64::from(u8::from(floor + column == 0))];
                painted.push(Box4 {
                    x: [x, x + 15.0],
                    y,
                });
            }
        }
        let attic = [[24.0, 36.0], [52.0, 64.0]].map(|x| Box4 {
            x,
            y: [92.0, 104.0],
        });
        painted.extend(attic);
        let blank = LabelGrid {
            name: "f".into(),
            unit: "px".into(),
            xs: vec![0.0, 90.0],
            ys: vec![0.0, 120.0],
            labels: vec!["wall".into(), "window".into()],
            cells: vec![0],
        };
        let wall = Box4 {
            x: [0.0, 90.0],
            y: [0.0, 120.0],
        };
        let boxes = [
            vec![(0, wall)],
            painted.into_iter().map(|b| (1, b)).collect(),
        ]
        .concat();
        let picture = paint(&blank, &boxes);
        let lattice = Lattice::read(&picture);
        assert_eq!((lattice.rows.len(), lattice.columns.len()), (4, 3));
        assert_eq!(lattice.changes(&lattice), 0);
        let clean = on_lattice(&picture);
        assert_ne!(clean, picture);
        let above = super::boxes(&clean).into_iter();
        let above: Vec<Box4> = above
            .filter(|(l, b)| *l == 1 && b.y[0] > 90.0)
            .map(|(_, b)| b)
            .collect();
        assert_eq!(above, attic);
    }

    #[test]
    fn what_a_balcony_hides_of_a_window_is_still_a_floor() {
        let boxes = |narrow: f64| -> Vec<(usize, Box4)> {
            let mut out = vec![(
                0,
                Box4 {
                    x: [0.0, 90.0],
                    y: [0.0, 120.0],
                },
            )];
            for (floor, column) in (0..4).flat_map(|f| (0..3).map(move |c| (f, c))) {
                let (x, y) = (
                    10.0 + 28.0 * f64::from(column),
                    30.0 * f64::from(floor) + 2.0,
                );
                out.push((
                    1,
                    Box4 {
                        x: [x, x + 15.0],
                        y: [y, y + 20.0],
                    },
                ));
            }
            // Of the uppermost windows a strip is seen above the balcony, and one below it.
            out.push((
                2,
                Box4 {
                    x: [narrow, 90.0 - narrow],
                    y: [94.0, 109.0],
                },
            ));
            out
        };
        let blank = LabelGrid {
            name: "f".into(),
            unit: "px".into(),
            xs: vec![0.0, 90.0],
            ys: vec![0.0, 120.0],
            labels: vec!["wall".into(), "window".into(), "balcony".into()],
            cells: vec![0],
        };
        let [running, partial] = [1.0, 20.0].map(|end| Lattice::read(&paint(&blank, &boxes(end))));
        assert_eq!((running.floors(), running.columns.len()), (4, 3));
        assert_eq!(running.running, [3]);
        assert_eq!(partial.floors(), 4);
        assert_eq!(partial.running, [0; 0]);
        // A balcony right above the windows of a floor hides none of them.
        let mut above = boxes(1.0);
        above.last_mut().unwrap().1.y = [82.0, 92.0];
        let above = Lattice::read(&paint(&blank, &above));
        assert_eq!((above.floors(), above.columns.len()), (4, 3));
        assert_eq!(above.running, [3]);
        assert_eq!(running.changes(&partial), 1);
        assert_eq!(partial.changes(&running), 1);
    }

    #[test]
    fn a_picture_without_windows_stays() {
        let mut grid = facade(|_| 0.0);
        grid.labels[2] = "hole".into();
        assert_eq!(on_lattice(&grid), grid);
    }
}
