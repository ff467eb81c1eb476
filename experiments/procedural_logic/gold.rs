//! The gold standard of retrieval: architectural changes (Sec. 5.4).
//!
//! "We defined a gold standard distance function as the number of architectural changes in the
//! number of floors, window columns, door placement and location of running balconies." The
//! authors' annotation is not published. Ours takes
//! - *floors* and *window columns* from the independent hand annotation that comes with ECP2011
//!   (`facade_annotation_floorlines.txt`: floor lines; `column_annotation.txt`: left and right side
//!   of each column), as they stand, also where they disagree with the labels;
//! - *running balconies* from the labels: pixel rows that are balcony over at least nine tenths of
//!   the width; connected rows are one balcony, which belongs to the floor whose floor line is
//!   nearest to its bottom edge;
//! - *doors* from the labels: connected columns of pixels with a door. Where a door stands is told
//!   in one of three ways, [`Doors`].
//!
//! Doors and running balconies are thus read off the very labels that the method compares. What the
//! hand annotation says alone, with its own running balconies and without doors, is
//! [`Annotations::by_hand`].
//!
//! The shipped layouts come without annotation: [`super::outline`] counts their floors and columns.

use std::collections::BTreeMap;
use std::path::Path;

use edifice_base::{Error, Result, file};
use edifice_shape::LabelGrid;

/// The meaning of "door placement".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doors {
    /// The place in the layout of the ground floor: at its left end, at its right end, or between
    /// other elements. Section 5.4 compares "not [...] the sizes of architectural elements, but the
    /// procedural layout", and a distance that is blind to sizes sees this and no more.
    Layout,
    /// The third of the facade's width that holds the middle of the door.
    Third,
    /// The window column nearest to the middle of the door.
    Column,
}

impl Doors {
    /// All readings, the one of the figures first.
    pub const ALL: [Self; 3] = [Self::Layout, Self::Third, Self::Column];

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Layout => "layout",
            Self::Third => "third",
            Self::Column => "column",
        }
    }
}

/// The facts of the gold standard about a facade.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Architecture {
    /// Number of floors annotated, the ground floor included.
    pub floors: usize,
    /// Number of window columns annotated.
    pub columns: usize,
    /// Each door from left to right, under each reading of [`Doors::ALL`].
    pub doors: [Vec<usize>; 3],
    /// Floors with a running balcony, counted from the ground floor as 0.
    pub balconies: Vec<usize>,
}

impl Architecture {
    /// Floors and window columns alone.
    pub fn floors_and_columns(&self) -> Self {
        Self {
            floors: self.floors,
            columns: self.columns,
            doors: Default::default(),
            balconies: Vec::new(),
        }
    }

    /// Number of architectural changes between two facades; zero is "deemed identical".
    pub fn changes(&self, other: &Self, doors: Doors) -> usize {
        let (mine, theirs) = (&self.doors[doors as usize], &other.doors[doors as usize]);
        let missing =
            |from: &[usize], of: &[usize]| from.iter().filter(|f| !of.contains(f)).count();
        self.floors.abs_diff(other.floors)
            + self.columns.abs_diff(other.columns)
            + usize::from(mine != theirs)
            + missing(&self.balconies, &other.balconies)
            + missing(&other.balconies, &self.balconies)
    }

    /// The architecture of a label image with annotated floor lines (fractions of the height from
    /// the top, lowest floor first) and window columns (left and right, fractions of the width).
    pub fn new(grid: &LabelGrid, floor_lines: &[f64], columns: &[(f64, f64)]) -> Self {
        let doors = doors(grid);
        let width = grid.xs[grid.columns()];
        let middle = |&(left, right): &(f64, f64)| (left + right) / 2.0 / width;
        let layout = |&(left, right): &(f64, f64)| match (left <= 0.0, right >= width) {
            (true, _) => 0,
            (false, false) => 1,
            (false, true) => 2,
        };
        let column = |door: &(f64, f64)| {
            let centres = columns.iter().map(|(left, right)| (left + right) / 2.0);
            nearest(centres, middle(door))
        };
        Self {
            floors: floor_lines.len(),
            columns: columns.len(),
            doors: [
                doors.iter().map(layout).collect(),
                doors.iter().map(|d| (middle(d) * 3.0) as usize).collect(),
                doors.iter().map(column).collect(),
            ],
            balconies: running_balconies(grid)
                .into_iter()
                .map(|bottom| nearest(floor_lines.iter().copied(), 1.0 - bottom) + 1)
                .collect(),
        }
    }
}

/// Left and right side of each door.
fn doors(grid: &LabelGrid) -> Vec<(f64, f64)> {
    let Some(door) = label(grid, "door") else {
        return Vec::new();
    };
    let holds = |i: usize| (0..grid.rows()).any(|j| grid.at(i, j) == door);
    runs(grid.columns(), holds)
        .into_iter()
        .map(|(from, to)| (grid.xs[from], grid.xs[to]))
        .collect()
}

/// Bottom edge of each running balcony, as a fraction of the height from the bottom.
fn running_balconies(grid: &LabelGrid) -> Vec<f64> {
    let Some(balcony) = label(grid, "balcony") else {
        return Vec::new();
    };
    let width = grid.xs[grid.columns()];
    let height = grid.ys[grid.rows()];
    let covered = |j: usize| -> f64 {
        let cells = (0..grid.columns()).filter(|&i| grid.at(i, j) == balcony);
        cells.map(|i| grid.xs[i + 1] - grid.xs[i]).sum()
    };
    runs(grid.rows(), |j| covered(j) >= 0.9 * width)
        .into_iter()
        .map(|(from, _)| grid.ys[from] / height)
        .collect()
}

fn label(grid: &LabelGrid, name: &str) -> Option<u16> {
    grid.labels.iter().position(|l| l == name).map(|l| l as u16)
}

/// Maximal runs `[from, to)` of indices that hold.
pub(super) fn runs(count: usize, holds: impl Fn(usize) -> bool) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for index in (0..count).filter(|&index| holds(index)) {
        match runs.last_mut() {
            Some(run) if run.1 == index => run.1 = index + 1,
            _ => runs.push((index, index + 1)),
        }
    }
    runs
}

fn nearest(values: impl Iterator<Item = f64>, to: f64) -> usize {
    let distances = values
        .enumerate()
        .map(|(index, value)| (index, (value - to).abs()));
    distances
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |found| found.0)
}

/// The hand annotation of ECP2011, by facade name.
#[derive(Debug, Clone, Default)]
pub struct Annotations {
    floor_lines: BTreeMap<String, Vec<f64>>,
    columns: BTreeMap<String, Vec<(f64, f64)>>,
    /// Lower edges of running balconies, as fractions of the height from the top.
    balconies: BTreeMap<String, Vec<f64>>,
}

/// Least distance of a running balcony's end below the window's own balcony, as a fraction of the height:
/// equal numbers say that there is none, and the annotation repeats a number to about 0.001.
const RUNNING: f64 = 0.01;

/// A line of an annotation file that is not what it should be.
#[derive(Debug, thiserror::Error)]
enum AnnotationError {
    #[error("{0:?} is not a number")]
    Number(String),
    #[error("an odd number of column sides")]
    Odd,
    #[error("{0} numbers, expected one and then groups of four")]
    Groups(usize),
    #[error("no annotation of facade {0}")]
    Missing(String),
}

impl Annotations {
    /// Reads the annotation files of `folder`: floor lines, window columns and, where there is one, balconies.
    ///
    /// # Errors
    /// [`Error::Io`], or [`Error::Input`] with the line that is wrong.
    pub fn read(folder: &Path) -> Result<Self> {
        let mut annotations = Self::default();
        let path = folder.join("facade_annotation_floorlines.txt");
        for (index, line) in lines(&path)?.iter().enumerate() {
            if let Some((name, values)) = line.split_once(',') {
                let values = numbers(&path, index, values)?;
                annotations.floor_lines.insert(stem(name), values);
            }
        }
        let path = folder.join("column_annotation.txt");
        let all = lines(&path)?;
        for (index, pair) in all.chunks(3).enumerate() {
            if let [name, values, ..] = pair {
                let sides = numbers(&path, 3 * index + 1, values)?;
                if sides.len() % 2 == 1 {
                    let place = format!("line {}", 3 * index + 2);
                    return Err(Error::input(&path, place, AnnotationError::Odd));
                }
                let columns = sides.chunks(2).map(|pair| (pair[0], pair[1])).collect();
                annotations.columns.insert(stem(name), columns);
            }
        }
        let path = folder.join("floor_balcony_annotation.txt");
        if !path.exists() {
            return Ok(annotations);
        }
        for (index, pair) in lines(&path)?.chunks(2).enumerate() {
            if let [name, values] = pair {
                let values = numbers(&path, 2 * index + 1, values)?;
                if values.len() % 4 != 1 {
                    let cause = AnnotationError::Groups(values.len());
                    return Err(Error::input(
                        &path,
                        format!("line {}", 2 * index + 2),
                        cause,
                    ));
                }
                // Window top, window bottom, balcony bottom, running balcony bottom.
                let groups = values[1..].chunks(4);
                let running = groups.filter(|group| group[3] - group[2] >= RUNNING);
                let bottoms = running.map(|group| group[3]).collect();
                annotations.balconies.insert(stem(name), bottoms);
            }
        }
        Ok(annotations)
    }

    /// True if balconies are annotated.
    pub fn has_balconies(&self) -> bool {
        !self.balconies.is_empty()
    }

    /// The hand annotation alone of a facade: floors, window columns and running balconies; it has no doors.
    ///
    /// # Errors
    /// [`Error::Method`] when the facade is not annotated.
    pub fn by_hand(&self, name: &str) -> Result<Architecture> {
        match (
            self.floor_lines.get(name),
            self.columns.get(name),
            self.balconies.get(name),
        ) {
            (Some(floors), Some(columns), Some(balconies)) => Ok(Architecture {
                floors: floors.len(),
                columns: columns.len(),
                doors: Default::default(),
                balconies: balconies
                    .iter()
                    .map(|&bottom| nearest(floors.iter().copied(), bottom) + 1)
                    .collect(),
            }),
            _ => Err(Error::method(AnnotationError::Missing(name.to_owned()))),
        }
    }

    /// The architecture of an annotated facade.
    ///
    /// # Errors
    /// [`Error::Method`] when the facade is not annotated.
    pub fn architecture(&self, grid: &LabelGrid) -> Result<Architecture> {
        match (
            self.floor_lines.get(&grid.name),
            self.columns.get(&grid.name),
        ) {
            (Some(floors), Some(columns)) => Ok(Architecture::new(grid, floors, columns)),
            _ => Err(Error::method(AnnotationError::Missing(grid.name.clone()))),
        }
    }
}

fn lines(path: &Path) -> Result<Vec<String>> {
    let bytes = file::read_bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.lines().map(str::to_owned).collect())
}

fn numbers(path: &Path, line: usize, text: &str) -> Result<Vec<f64>> {
    text.split(',')
        .map(|word| {
            let number = word.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            number.ok_or_else(|| {
                let cause = AnnotationError::Number(word.to_owned());
                Error::input(path, format!("line {}", line + 1), cause)
            })
        })
        .collect()
}

fn stem(name: &str) -> String {
    name.trim().trim_end_matches(".jpg").to_owned()
}
