//! The search for exact relations.
//!
//! Columns of numbers are taken in turn and made orthogonal to those before (modified Gram-Schmidt, twice); one of which nothing is left is
//! a combination of the others. The same on logarithms finds products. Coefficients near a simple fraction become it; every relation is then tested on
//! every row, and one that fails is none.
//!
//! # Deviations and readings
//! - Relations hold to [`TOLERANCE`](super::TOLERANCE) of the size of their terms: a column that was rounded after it was computed is not found.
//! - Where rows are too few for a combination of all columns to mean something, or too few have all cells, only pairs of columns are tried.
//! - Of a sum whose one column has a sign of its own (a total), this column is determined: draws of the parts then never contradict it.
//! - Products are sought among columns that no sum determines.
//! - A category copies another only where that is improbable by chance, for all pairs together (e^-20).
//!
//! Source: Golub and Van Loan 2013, Sec. 5.2 (Gram-Schmidt).

use super::apply::{code, number};
use super::{Form, Relation, Relations};
use crate::{Column, Table};

/// Rows that combinations are sought in.
const SOUGHT: usize = 2000;
/// Rows beyond twice the columns that a combination of all columns needs, and that a pair needs in all.
const LEAST: usize = 12;
/// Share of a column's deviation below which nothing is left of it.
const NOTHING: f64 = 1e-8;
/// Share of a column's deviation below which a term is left out.
const NO_TERM: f64 = 1e-7;
/// Logarithm of the probability of any pair of categories that is equal by chance.
const CHANCE: f64 = -20.0;
/// Largest denominator of a simple fraction.
const SIMPLE: u32 = 12;

/// The exact relations of a table, each tested on every row.
///
/// For n rows of p columns O(n p + min(n, 2000) p² + p⁴) steps at most; pairs of categories O(n) each.
///
/// # Examples
/// ```
/// use edifice_model::Table;
/// use edifice_model::tables::relations::find;
/// let noise = |i: u32, k: u32| f64::from((i * 7919 + k * 104_729) % 1009) / 100.0 + 1.0;
/// let column = |f: fn(f64, f64) -> f64| (0..60).map(move |i| Some(f(noise(i, 1), noise(i * i, 2))));
/// let table = Table::new()
///     .real("width", column(|a, _| a))?
///     .real("depth", column(|_, b| b))?
///     .real("area", column(|a, b| a * b))?
///     .real("around", column(|a, b| 2.0 * (a + b)))?;
/// let said: Vec<String> = find(&table).iter().map(|r| r.said()).collect();
/// assert_eq!(said, ["around = 2 width + 2 depth", "area = width * depth"]);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn find(table: &Table) -> Vec<Relation> {
    let mut found = copies(table);
    let numbers: Vec<&Column> = (table.columns().iter())
        .filter(|c| c.categories().is_none())
        .collect();
    for logarithms in [false, true] {
        let left = (numbers.iter().copied())
            .filter(|c| !found.iter().any(|r: &Relation| r.column == c.name()));
        let left: Vec<&Column> = left.collect();
        let more = combinations(&left, table.rows(), logarithms);
        let names = |r: Vec<Combination>| r.into_iter().map(|c| c.relation(&left, logarithms));
        let tested = names(more).filter(|r| holds(r, table));
        found.extend(tested.collect::<Vec<_>>());
    }
    found
}

/// True if the relation holds in every row.
fn holds(relation: &Relation, table: &Table) -> bool {
    let one = std::slice::from_ref(relation);
    Relations::new(one).is_ok_and(|relations| relations.reduce(table).is_ok())
}

/// y = constant + Σ coefficient x, by the places of columns.
struct Combination {
    y: usize,
    constant: f64,
    terms: Vec<(usize, f64)>,
}

impl Combination {
    fn relation(self, columns: &[&Column], logarithms: bool) -> Relation {
        let terms = self.terms.iter();
        let terms = terms.map(|&(x, a)| (columns[x].name().to_owned(), a));
        let terms = terms.collect();
        Relation {
            column: columns[self.y].name().to_owned(),
            form: match logarithms {
                false => Form::Sum {
                    constant: simple(self.constant),
                    terms,
                },
                true => Form::Product {
                    factor: simple(self.constant.exp()),
                    terms,
                },
            },
        }
    }
}

/// The columns that are combinations of others, of their logarithms if asked for.
fn combinations(columns: &[&Column], rows: usize, logarithms: bool) -> Vec<Combination> {
    let value = |c: usize, row: usize| {
        let x = number(columns[c], row)?;
        Some(if logarithms { x.ln() } else { x })
    };
    // Columns that vary, and have logarithms where these are asked for.
    let varies = |c: &usize| {
        let known = (0..rows).filter_map(|row| number(columns[*c], row));
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        known.for_each(|x| (least, most) = (least.min(x), most.max(x)));
        least < most && (!logarithms || least > 0.0)
    };
    let used: Vec<usize> = (0..columns.len()).filter(varies).collect();
    let complete = (0..rows).filter(|&row| used.iter().all(|&c| value(c, row).is_some()));
    let complete: Vec<usize> = complete.collect();
    if complete.len() < 2 * used.len() + LEAST {
        return pairs(&used, rows, &value);
    }
    let step = complete.len().div_ceil(SOUGHT);
    let chosen: Vec<usize> = complete.into_iter().step_by(step).collect();
    let series = |c: &usize| chosen.iter().filter_map(|&row| value(*c, row)).collect();
    let series: Vec<Vec<f64>> = used.iter().map(series).collect();
    let mut found = orthogonalized(&series);
    if !logarithms {
        determine_totals(&mut found);
    }
    for one in &mut found {
        one.y = used[one.y];
        one.terms.iter_mut().for_each(|(x, _)| *x = used[*x]);
    }
    found
}

/// Each series that earlier ones combine to, by earlier ones that none combine to.
fn orthogonalized(series: &[Vec<f64>]) -> Vec<Combination> {
    let n = series.first().map_or(0, Vec::len) as f64;
    let means: Vec<f64> = series.iter().map(|s| s.iter().sum::<f64>() / n).collect();
    // Orthonormal directions, and for each its combination of the centred series of the basis.
    let mut directions: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut basis: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for (y, own) in series.iter().enumerate() {
        let mut left: Vec<f64> = own.iter().map(|v| v - means[y]).collect();
        let size = length(&left);
        let mut coefficients = vec![0.0; basis.len()];
        for _ in 0..2 {
            for (direction, made_of) in &directions {
                let along: f64 = left.iter().zip(direction).map(|(a, b)| a * b).sum();
                left.iter_mut()
                    .zip(direction)
                    .for_each(|(l, d)| *l -= along * d);
                for (c, m) in coefficients.iter_mut().zip(made_of) {
                    *c += along * m;
                }
            }
        }
        let rest = length(&left);
        if rest <= NOTHING * size {
            let terms = basis.iter().zip(&coefficients);
            let terms = terms.filter(|&(x, a)| {
                let spread: f64 = series[*x].iter().map(|v| (v - means[*x]).powi(2)).sum();
                a.abs() * spread.sqrt() > NO_TERM * size
            });
            let terms: Vec<(usize, f64)> = terms.map(|(x, a)| (*x, simple(*a))).collect();
            let sum = terms.iter().map(|(x, a)| a * means[*x]);
            let constant = means[y] - sum.sum::<f64>();
            let scale = terms.iter().map(|(x, a)| (a * means[*x]).abs());
            let scale = scale.sum::<f64>() + means[y].abs() + size / n.sqrt();
            let constant = if constant.abs() <= 1e-9 * scale {
                0.0
            } else {
                constant
            };
            found.push(Combination { y, constant, terms });
            continue;
        }
        let mut made_of: Vec<f64> = coefficients.iter().map(|c| -c / rest).collect();
        made_of.push(1.0 / rest);
        left.iter_mut().for_each(|l| *l /= rest);
        directions.push((left, made_of));
        basis.push(y);
    }
    found
}

/// Solves each combination for its one column with a sign of its own, the others' combinations restated.
fn determine_totals(found: &mut [Combination]) {
    for at in 0..found.len() {
        // All on one side: -y + Σ a x.
        let negative = found[at].terms.iter().filter(|(_, a)| *a < 0.0).count();
        let positive = found[at].terms.len() - negative;
        if positive != 1 || negative == 0 {
            continue;
        }
        let Some(place) = found[at].terms.iter().position(|(_, a)| *a > 0.0) else {
            continue;
        };
        let one = &mut found[at];
        let (total, a) = one.terms.remove(place);
        let part = std::mem::replace(&mut one.y, total);
        one.constant = -one.constant / a;
        one.terms.iter_mut().for_each(|(_, b)| *b = simple(-*b / a));
        one.terms.push((part, simple(1.0 / a)));
        one.terms.sort_by_key(|(x, _)| *x);
        let (constant, made_of) = (one.constant, one.terms.clone());
        for (_, other) in found.iter_mut().enumerate().filter(|(o, _)| *o != at) {
            let Some(place) = other.terms.iter().position(|(x, _)| *x == total) else {
                continue;
            };
            let (_, weight) = other.terms.remove(place);
            other.constant += weight * constant;
            for &(x, b) in &made_of {
                match other.terms.iter_mut().find(|(own, _)| *own == x) {
                    Some((_, own)) => *own += weight * b,
                    None => other.terms.push((x, weight * b)),
                }
            }
            let largest = made_of.iter().map(|(_, b)| (weight * b).abs());
            let largest = largest.fold(0.0, f64::max);
            other.terms.retain(|(_, b)| b.abs() > NO_TERM * largest);
            other.terms.iter_mut().for_each(|(_, b)| *b = simple(*b));
            other.terms.sort_by_key(|(x, _)| *x);
        }
    }
}

/// Columns that are one earlier column in another unit.
fn pairs(
    used: &[usize],
    rows: usize,
    value: &dyn Fn(usize, usize) -> Option<f64>,
) -> Vec<Combination> {
    let mut found: Vec<Combination> = Vec::new();
    for (at, &y) in used.iter().enumerate() {
        let free = used[..at].iter().copied();
        let determined: Vec<usize> = found.iter().map(|c| c.y).collect();
        for x in free.filter(|x| !determined.contains(x)) {
            let both: Vec<(f64, f64)> = (0..rows)
                .filter_map(|row| value(x, row).zip(value(y, row)))
                .take(SOUGHT)
                .collect();
            if both.len() < LEAST {
                continue;
            }
            let (own, other): (Vec<f64>, Vec<f64>) = both.into_iter().unzip();
            let mut one = orthogonalized(&[own, other]);
            if let Some(mut one) = one.pop().filter(|c| c.y == 1 && !c.terms.is_empty()) {
                one.y = y;
                one.terms.iter_mut().for_each(|(place, _)| *place = x);
                found.push(one);
                break;
            }
        }
    }
    found
}

/// Categories that copy an earlier column of the same categories.
fn copies(table: &Table) -> Vec<Relation> {
    let coded = table.columns().iter();
    let coded: Vec<&Column> = coded.filter(|c| c.categories().is_some()).collect();
    let pairs = (coded.len() * coded.len()) as f64;
    let mut found: Vec<Relation> = Vec::new();
    for (at, y) in coded.iter().enumerate() {
        let same = |x: &&&Column| {
            x.categories() == y.categories()
                && (0..table.rows())
                    .filter_map(|row| code(x, row).zip(code(y, row)))
                    .all(|(a, b)| a == b)
                && log_chance(x, y, table.rows()) + pairs.ln() < CHANCE
        };
        let free = coded[..at].iter();
        let of = free
            .filter(|x| !found.iter().any(|r| r.column == x.name()))
            .find(same);
        found.extend(of.map(|x| Relation {
            column: y.name().to_owned(),
            form: Form::Copy {
                of: x.name().to_owned(),
            },
        }));
    }
    found
}

/// Log probability that the cells known of both are equal by chance, by the shares p of their categories: `n Σ p log p`.
fn log_chance(x: &Column, y: &Column, rows: usize) -> f64 {
    let categories = x.categories().map_or(0, <[String]>::len);
    let mut counts = vec![0.0; categories];
    (0..rows)
        .filter_map(|row| code(x, row).zip(code(y, row)))
        .for_each(|(code, _)| counts[code] += 1.0);
    let n: f64 = counts.iter().sum();
    match n > 0.0 {
        // All arrangements of the same counts are as probable.
        true => (counts.iter().filter(|c| **c > 0.0))
            .map(|c| c * (c / n).ln())
            .sum(),
        false => 0.0,
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The simple fraction that a number is up to rounding, or the number.
fn simple(value: f64) -> f64 {
    let near = |candidate: f64| (value - candidate).abs() <= 1e-9 * value.abs();
    let fractions = (1..=SIMPLE).map(|k| (value * f64::from(k)).round() / f64::from(k));
    let decimal = (value * 1e6).round() / 1e6;
    fractions
        .chain([decimal])
        .find(|c| near(*c))
        .unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_of_large_numbers_has_no_constant() {
        // Whole numbers far from zero: their means are rounded by more than a share of their deviation.
        let noise = |i: u32, k: u32| f64::from((i * 7919 + k * 104_729) % 1009 % 4);
        let column =
            |f: fn(f64, f64) -> f64| (0..61).map(move |i| Some(f(noise(i, 1), noise(i * i, 2))));
        let table = Table::new()
            .real("from", column(|a, _| 33_554_432.0 + a))
            .unwrap()
            .real("to", column(|_, b| 33_554_432.0 + b))
            .unwrap()
            .real("years", column(|a, b| b - a))
            .unwrap();
        let said: Vec<String> = find(&table).iter().map(Relation::said).collect();
        assert_eq!(said, ["to = from + years"]);
    }
}
