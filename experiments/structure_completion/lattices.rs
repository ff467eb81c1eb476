//! Lattices of windows in cells (Hensel et al. 2021): a benchmark that others have published, as a check from outside.
//!
//! A pair is a lattice of cells of which windows are missing one by one, and the whole one. Cells have no size of their own:
//! rows and columns stand where edges of windows do. They are taken as unit squares, runs of cells in a row that go on
//! with the same ends in the next row as one window, and the outline as the given cells with a margin of one cell. All that is not
//! given is unknown. What is completed is read back as the cells whose centre it covers, and the measures are
//!
//! ```text
//! IoU = |completed & whole| / |completed | whole|,   precision of what is added = |added & whole| / |added|
//! ```
//!
//! The lattices were made from facades of Graz and CMP; the default model has seen neither. Beside it stand the given cells, the closure of their
//! rows and columns (a cell is on where its row and its column have one), and a vote: the weight of a row for another is their
//! containment times their Jaccard index, and a cell is on where the mean of the votes along rows and along columns is at
//! least one half.

use super::row;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_io::lattice_npz::{self, Lattice, LatticePair};
use edifice_report::{Align, Table};
use edifice_shape::Rect;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::model::shipped_model;
use edifice_structure_completion::partial::PartialLayout;

/// The sets: name, file.
const SETS: [(&str, &str); 2] = [
    ("graz", "facades/hensel_lattices/graz.npz"),
    ("cmp", "facades/hensel_lattices/cmp.npz"),
];
/// The methods that are compared.
const COLUMNS: [&str; 6] = ["given", "closure", "vote", "lattice", "low_rank", "default"];

/// Completes the lattices of both sets.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let most = ctx.budget().choose(5, 100, usize::MAX);
    ctx.setting("pairs", most.min(1_000_000));
    let model = shipped_model().map_err(Error::method)?;
    let title = "Whole-lattice IoU, and precision of the added cells";
    let mut table = Table::new(title)
        .column("set and measure", Align::Left)
        .numbers(COLUMNS);
    let seed = ctx.seed();
    let mut pairs: Vec<(&str, usize, LatticePair)> = Vec::new();
    for (set, file) in SETS {
        if let Some(path) = ctx.real(file)? {
            let all = lattice_npz::read(&path)?;
            let every = all.len().div_ceil(most).max(1);
            let some = all.into_iter().enumerate().step_by(every);
            pairs.extend(some.map(|(k, pair)| (set, k, pair)));
        }
    }
    if pairs.is_empty() {
        ctx.skip("the published lattices are not in the data folder");
        return Ok(());
    }
    let key = |p: &(&str, usize, LatticePair)| format!("{}/{}", p.0, p.1);
    let work = |(set, k, pair): &(&str, usize, LatticePair)| -> Result<Vec<[f64; 2]>> {
        let by = |method: Method| {
            let rng = &mut stream(seed, &format!("lattices/{set}"), *k as u64);
            completed(&pair.given, |partial| {
                let done = complete(method, partial, &model, 1, rng);
                let all = done.first().into_iter().flat_map(|c| &c.added);
                all.map(|a| a.element).collect()
            })
        };
        let each = [
            pair.given.clone(),
            closure(&pair.given),
            vote(&pair.given),
            by(Method::Lattice),
            by(Method::LowRank),
            by(Method::Best),
        ];
        Ok(each.iter().map(|found| measured(found, pair)).collect())
    };
    let found = ctx.units(&pairs, key, work)?;
    for (set, _) in SETS {
        for (measure, name) in ["iou", "precision"].into_iter().enumerate() {
            let mut cells = vec![format!("{set}: {name}")];
            for (column, method) in COLUMNS.into_iter().enumerate() {
                let own = pairs.iter().zip(&found).filter(|(p, _)| p.0 == set);
                let values = own.map(|(_, f)| f[column][measure]);
                let values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                if values.is_empty() {
                    cells.push("–".into());
                    continue;
                }
                ctx.observe(row(set, method, "all".into(), Some(seed), name, mean));
                cells.push(format!("{mean:.3}"));
            }
            table.row(cells);
        }
    }
    ctx.table(&table);
    ctx.note(format!(
        "{} pairs, evenly from those published.",
        pairs.len()
    ));
    Ok(())
}

/// IoU of the whole lattice, and precision of what is added; not a number where nothing is.
fn measured(found: &Lattice, pair: &LatticePair) -> [f64; 2] {
    let (mut both, mut either, mut right, mut added) = (0.0, 0.0, 0.0, 0.0);
    for ((found, given), whole) in found
        .cells
        .iter()
        .zip(&pair.given.cells)
        .zip(&pair.whole.cells)
    {
        let one = |test: bool| f64::from(u8::from(test));
        both += one(*found && *whole);
        either += one(*found || *whole);
        added += one(*found && !*given);
        right += one(*found && !*given && *whole);
    }
    [both / either, right / added]
}

/// The windows of a lattice: left and right end, upper and lower row, ends and lower row exclusive.
fn windows(lattice: &Lattice) -> Vec<[usize; 4]> {
    let mut done: Vec<[usize; 4]> = Vec::new();
    for r in 0..lattice.rows {
        let line = &lattice.cells[r * lattice.columns..(r + 1) * lattice.columns];
        let mut c = 0;
        while c < line.len() {
            let from = c;
            while c < line.len() && line[c] {
                c += 1;
            }
            if c > from {
                let above = done
                    .iter_mut()
                    .find(|w| w[0] == from && w[1] == c && w[3] == r);
                match above {
                    Some(window) => window[3] = r + 1,
                    None => done.push([from, c, r, r + 1]),
                }
            }
            c += 1;
        }
    }
    done
}

/// The lattice with what `complete` adds to it.
fn completed(given: &Lattice, mut complete: impl FnMut(&PartialLayout) -> Vec<Element>) -> Lattice {
    let windows = windows(given);
    let mut found = given.clone();
    if windows.is_empty() {
        return found;
    }
    let least = |k: usize| windows.iter().map(|w| w[k]).min().unwrap_or(0);
    let most = |k: usize| windows.iter().map(|w| w[k]).max().unwrap_or(0);
    let left = least(0).saturating_sub(1) as f64;
    let bottom = (most(3) + 1).min(given.rows) as f64;
    let right = (most(1) + 1).min(given.columns) as f64;
    let top = least(2).saturating_sub(1) as f64;
    let observed = windows.iter().map(|&[from, to, upper, lower]| {
        let rect = Rect::new(
            from as f64 - left,
            bottom - lower as f64,
            (to - from) as f64,
            (lower - upper) as f64,
        );
        Element::new(Class::Window, rect)
    });
    let partial = PartialLayout {
        width: right - left,
        height: bottom - top,
        observed: observed.collect(),
        unknown: None,
        forbidden: Vec::new(),
    };
    for element in complete(&partial) {
        if element.class != Class::Window {
            continue;
        }
        for r in top as usize..bottom as usize {
            for c in left as usize..right as usize {
                let (x, y) = (c as f64 + 0.5 - left, bottom - r as f64 - 0.5);
                if element.rect.contains(x, y) {
                    found.cells[r * given.columns + c] = true;
                }
            }
        }
    }
    found
}

/// Cells by row, and by column.
fn lines(lattice: &Lattice) -> [Vec<Vec<bool>>; 2] {
    let rows: Vec<Vec<bool>> = lattice
        .cells
        .chunks(lattice.columns)
        .map(<[bool]>::to_vec)
        .collect();
    let column = |c: usize| rows.iter().map(|row| row[c]).collect();
    let columns = (0..lattice.columns).map(column).collect();
    [rows, columns]
}

fn closure(given: &Lattice) -> Lattice {
    let [rows, columns] = lines(given);
    let on = |k: usize| {
        let (r, c) = (k / given.columns, k % given.columns);
        rows[r].contains(&true) && columns[c].contains(&true)
    };
    Lattice {
        cells: (0..given.cells.len()).map(on).collect(),
        ..*given
    }
}

/// Weighted mean of the other lines for each line and place along it.
fn votes(lines: &[Vec<bool>]) -> Vec<Vec<f64>> {
    let count = |line: &[bool]| line.iter().filter(|x| **x).count() as f64;
    let vote = |own: usize| {
        let (mut sums, mut total) = (vec![0.0; lines[own].len()], 0.0);
        for (_, other) in lines.iter().enumerate().filter(|(k, _)| *k != own) {
            let both = lines[own].iter().zip(other).filter(|(a, b)| **a && **b);
            let both = both.count() as f64;
            let either = count(&lines[own]) + count(other) - both;
            let weight = both * both / (count(&lines[own]) * either).max(1.0);
            total += weight;
            for (sum, _) in sums.iter_mut().zip(other).filter(|(_, on)| **on) {
                *sum += weight;
            }
        }
        let share = |s: f64| if total > 0.0 { s / total } else { 0.0 };
        sums.into_iter().map(share).collect()
    };
    (0..lines.len()).map(vote).collect()
}

fn vote(given: &Lattice) -> Lattice {
    let [rows, columns] = lines(given).map(|lines| votes(&lines));
    let on = |k: usize| {
        let (r, c) = (k / given.columns, k % given.columns);
        given.cells[k] || (rows[r][c] + columns[c][r]) / 2.0 >= 0.5
    };
    Lattice {
        cells: (0..given.cells.len()).map(on).collect(),
        ..*given
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(rows: &[&str]) -> Lattice {
        Lattice {
            rows: rows.len(),
            columns: rows[0].len(),
            cells: rows.concat().chars().map(|c| c == '#').collect(),
        }
    }

    #[test]
    fn lattices_by_hand() {
        let given = lattice(&["....", ".##.", ".##.", "#..#"]);
        assert_eq!(windows(&given), [[1, 3, 1, 3], [0, 1, 3, 4], [3, 4, 3, 4]]);
        // Nothing is added, nothing is lost.
        assert_eq!(completed(&given, |_| Vec::new()), given);
        let observed = completed(&given, |partial| partial.observed.clone());
        assert_eq!(observed, given);
        let full = closure(&given);
        assert_eq!(full, lattice(&["....", "####", "####", "####"]));
        let pair = LatticePair {
            whole: full,
            given: given.clone(),
        };
        assert_eq!(measured(&given, &pair)[0], 0.5);
        assert_eq!(measured(&pair.whole, &pair), [1.0, 1.0]);
        let three = lattice(&["##", "##", "#."]);
        assert_eq!(vote(&three), lattice(&["##", "##", "##"]));
    }
}
