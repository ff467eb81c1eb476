//! Lengths that are equal up to floating-point noise, made exactly equal.
//!
//! Coordinates come in any unit (inches, thirds, metres), so that equal sizes differ in their last digits and no grid
//! of rounded positions keeps them equal. Let `e_1, ..., e_n` be the *elementary intervals* between consecutive lines
//! along one axis, of all facades. Terminals whose extents agree up to [`SAME`] form a class; any two of a class that
//! span the intervals `S` and `S'` give the relation
//!
//! ```text
//! sum_{i in S} e_i = sum_{i in S'} e_i.
//! ```
//!
//! The integer solutions of all relations form a lattice. [`residues`] evaluates one random point of it modulo
//! [`ORDER`]: sums of intervals have equal residues when their equality follows from the relations, and otherwise with
//! a probability of about `2^-60`. That is all that region types need: two regions have equal contents when their
//! terminals agree one by one, and the offset of a terminal is a sum of the extents of terminals between it and the
//! side of the region.
//!
//! The lattice is found by elimination over the integers. A row whose smallest coefficient is not a unit is
//! shortened by Euclid's algorithm: `a x + b y + ... = 0` with `t = x + round(b / a) y + ...` becomes a row in `t`
//! with smaller coefficients.

use std::collections::BTreeMap;

use edifice_shape::{Axis, Facade, IndexedLayout, LayoutError};

/// Lengths within this fraction of a facade's longer side are equal, except for chains of such lengths that
/// together spread over ten times as much.
const SAME: f64 = 1e-7;
/// Spread of a class, in units of its tolerance.
const SPREAD: f64 = 10.0;
/// Noise of coordinates themselves: below it there is nothing to tell apart.
const LEAST: f64 = 1e-14;

/// Residues of lengths are taken modulo `2^61 - 2`, the order of the multiplicative group in which contents are hashed.
pub(crate) const ORDER: u64 = (1 << 61) - 2;

/// `a + b` modulo [`ORDER`].
pub(crate) fn plus(a: u64, b: u64) -> u64 {
    (a + b) % ORDER
}

/// `a - b` modulo [`ORDER`].
pub(crate) fn minus(a: u64, b: u64) -> u64 {
    (a + ORDER - b) % ORDER
}

/// `n a` modulo [`ORDER`].
pub(crate) fn times(a: u64, n: u64) -> u64 {
    (u128::from(a) * u128::from(n) % u128::from(ORDER)) as u64
}

/// A facade on the grid of its lines, and the residue of every line's position along x and along y.
pub(crate) struct Lines {
    pub layout: IndexedLayout,
    pub x: Vec<u64>,
    pub y: Vec<u64>,
}

/// The lines of facades whose tilings were checked.
///
/// # Errors
/// The index of a facade with a region that is too thin, which a check of the tiling has excluded.
pub(crate) fn lines(facades: &[Facade]) -> Result<Vec<Lines>, (usize, LayoutError)> {
    let layouts = facades.iter().map(Facade::indexed).enumerate();
    let layouts: Vec<IndexedLayout> = layouts
        .map(|(index, layout)| layout.map_err(|error| (index, error)))
        .collect::<Result<_, _>>()?;
    let side = facades.iter().map(|f| f.width.max(f.height));
    let side = side.fold(f64::INFINITY, f64::min);
    let [xs, ys] = Axis::BOTH.map(|axis| positions(&layouts, axis, side));
    let layouts = layouts.into_iter().zip(xs).zip(ys);
    Ok(layouts
        .map(|((layout, x), y)| Lines { layout, x, y })
        .collect())
}

/// Residues of the positions of all lines along an axis, by facade.
fn positions(layouts: &[IndexedLayout], axis: Axis, side: f64) -> Vec<Vec<u64>> {
    let (spans, first) = spans(layouts, axis);
    let mut tolerance = SAME;
    let residues = loop {
        if let Some(residues) = residues(&classes(&spans, tolerance * side), first[layouts.len()]) {
            break residues;
        }
        // Noise as large as the differences between sizes: what is merged contradicts itself.
        tolerance /= 10.0;
        if tolerance < LEAST {
            break (0..first[layouts.len()] as u64).map(random).collect();
        }
    };
    first
        .windows(2)
        .map(|w| {
            let mut at = vec![0];
            for residue in &residues[w[0]..w[1]] {
                at.push(plus(at[at.len() - 1], *residue));
            }
            at
        })
        .collect()
}

/// Terminals along one axis: length, and the elementary intervals that they span.
type SpanOf = (f64, (usize, usize));

/// The distinct spans of terminals over the elementary intervals of all facades, and the first interval of each facade.
fn spans(layouts: &[IndexedLayout], axis: Axis) -> (Vec<SpanOf>, Vec<usize>) {
    let mut first = vec![0];
    let mut spans = BTreeMap::new();
    for layout in layouts {
        let values = match axis {
            Axis::X => layout.xs.values(),
            Axis::Y => layout.ys.values(),
        };
        let offset = first[first.len() - 1];
        for span in &layout.spans {
            let (from, to) = span.along(axis);
            spans.insert((offset + from, offset + to), values[to] - values[from]);
        }
        first.push(offset + values.len() - 1);
    }
    let spans = spans.into_iter().map(|(span, length)| (length, span));
    (spans.collect(), first)
}

/// Spans of equal length.
fn classes(spans: &[SpanOf], tolerance: f64) -> Vec<Vec<(usize, usize)>> {
    let mut sorted = spans.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut classes: Vec<Vec<(usize, usize)>> = Vec::new();
    let (mut least, mut last) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (length, span) in sorted {
        let same = length - last <= tolerance && length - least <= SPREAD * tolerance;
        match classes.last_mut().filter(|_| same) {
            Some(class) => class.push(span),
            None => {
                least = length;
                classes.push(vec![span]);
            }
        }
        last = length;
    }
    classes
}

/// A residue for each elementary interval such that the spans of a class have equal sums; `None` when an interval would
/// vanish, or two classes would be one.
fn residues(classes: &[Vec<(usize, usize)>], intervals: usize) -> Option<Vec<u64>> {
    let mut relations: Vec<Row> = Vec::new();
    for class in classes {
        for pair in class.windows(2) {
            relations.push(difference(pair[0], pair[1]));
        }
    }
    // Short relations first: most say that two intervals are equal.
    relations.sort_by_key(BTreeMap::len);
    let mut lattice = Lattice::new(intervals);
    for relation in relations {
        lattice.add(relation)?;
    }
    let residues = lattice.point(intervals);
    if residues.contains(&0) {
        return None;
    }
    let sum = |&(from, to): &(usize, usize)| residues[from..to].iter().copied().fold(0, plus);
    let mut sums: Vec<u64> = classes.iter().filter_map(|c| c.first()).map(sum).collect();
    sums.sort_unstable();
    sums.windows(2).all(|w| w[0] != w[1]).then_some(residues)
}

/// A sum of variables with integer coefficients, none of them 0.
type Row = BTreeMap<usize, i64>;

/// The sum over one span less the sum over the other.
fn difference(one: (usize, usize), other: (usize, usize)) -> Row {
    let mut row = Row::new();
    for (span, sign) in [(one, 1), (other, -1)] {
        for interval in span.0..span.1 {
            *row.entry(interval).or_insert(0) += sign;
        }
    }
    row.retain(|_, coefficient| *coefficient != 0);
    row
}

/// Integer solutions of homogeneous linear equations: some variables are sums of others, which are free.
struct Lattice {
    /// By variable: when it was defined, and as what.
    defined: Vec<Option<(usize, Row)>>,
    /// Defined variables in the order of their definitions, each by variables that no earlier one defines.
    order: Vec<usize>,
}

impl Lattice {
    fn new(variables: usize) -> Self {
        Self {
            defined: vec![None; variables],
            order: Vec::new(),
        }
    }

    /// Demands that the sum is 0; `None` when coefficients overflow.
    fn add(&mut self, row: Row) -> Option<()> {
        let mut row = self.reduce(row)?;
        while let Some((&variable, &least)) = row.iter().min_by_key(|(_, c)| c.unsigned_abs()) {
            row.remove(&variable);
            // x = -(b / a) y - ..., with a new variable for what the division leaves.
            let mut definition = Row::new();
            let mut rest = Row::new();
            for (&other, &coefficient) in &row {
                let quotient = coefficient.checked_div_euclid(least)?;
                if quotient != 0 {
                    definition.insert(other, quotient.checked_neg()?);
                }
                let remainder = coefficient - quotient * least;
                if remainder != 0 {
                    rest.insert(other, remainder);
                }
            }
            if !rest.is_empty() {
                let fresh = self.defined.len();
                self.defined.push(None);
                definition.insert(fresh, 1);
                rest.insert(fresh, least);
            }
            self.defined[variable] = Some((self.order.len(), definition));
            self.order.push(variable);
            row = rest;
        }
        Some(())
    }

    /// The sum over variables that are not defined.
    fn reduce(&self, mut row: Row) -> Option<Row> {
        // A definition names only variables that are free or defined later.
        let earliest = |row: &Row| {
            let defined = row.keys().filter_map(|&v| {
                let (order, _) = self.defined[v].as_ref()?;
                Some((*order, v))
            });
            defined.min().map(|(_, v)| v)
        };
        while let Some(variable) = earliest(&row) {
            let factor = row.remove(&variable).unwrap_or(0);
            let definition = self.defined[variable].iter().flat_map(|(_, row)| row);
            for (&other, &coefficient) in definition {
                let sum = row.entry(other).or_insert(0);
                *sum = sum.checked_add(coefficient.checked_mul(factor)?)?;
                if *sum == 0 {
                    row.remove(&other);
                }
            }
        }
        Some(row)
    }

    /// A random point: the residues of the first variables.
    fn point(&self, variables: usize) -> Vec<u64> {
        let mut values: Vec<u64> = (0..self.defined.len() as u64).map(random).collect();
        for &variable in self.order.iter().rev() {
            let definition = self.defined[variable].iter().flat_map(|(_, row)| row);
            values[variable] = definition
                .map(|(&other, &c)| {
                    let product = times(values[other], c.unsigned_abs());
                    match c < 0 {
                        true => minus(0, product),
                        false => product,
                    }
                })
                .fold(0, plus);
        }
        values.truncate(variables);
        values
    }
}

/// Fixed random residues, so that runs repeat: SplitMix64 (Steele et al. 2014).
fn random(index: u64) -> u64 {
    let mut z = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) % ORDER
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solved(relations: &[&[(usize, i64)]], variables: usize) -> Vec<u64> {
        let mut lattice = Lattice::new(variables);
        for relation in relations {
            lattice.add(relation.iter().copied().collect()).unwrap();
        }
        lattice.point(variables)
    }

    #[test]
    fn relations_hold_and_nothing_else_does() {
        // 2 a = 3 b, c = a + b: a = 3 t, b = 2 t, c = 5 t.
        let v = solved(&[&[(0, 2), (1, -3)], &[(2, 1), (0, -1), (1, -1)]], 4);
        assert_eq!(times(v[0], 2), times(v[1], 3));
        assert_eq!(v[2], plus(v[0], v[1]));
        // The lattice is saturated: a - b is t itself.
        let t = minus(v[0], v[1]);
        assert_eq!(v[2], times(t, 5));
        assert!(v[3] != v[0] && v[3] != v[2]);
        // 6 a + 10 b + 15 c = 0 has no unit coefficient.
        let v = solved(&[&[(0, 6), (1, 10), (2, 15)]], 3);
        let sum = [times(v[0], 6), times(v[1], 10), times(v[2], 15)];
        assert_eq!(sum.into_iter().fold(0, plus), 0);
        assert!(v.iter().all(|v| *v != 0));
    }

    #[test]
    fn spans_of_one_length_have_one_residue() {
        // Two panes beside a window as wide as both, and a wall between: 1 1 | 3 | 2, with noise.
        let third = 1.0 / 3.0;
        let spans = [
            (third, (0, 1)),
            (third + 1e-16, (1, 2)),
            (1.0, (2, 3)),
            (2.0 * third - 1e-16, (0, 2)),
            (2.0 * third, (3, 4)),
        ];
        let residues = residues(&classes(&spans, 1e-7), 4).unwrap();
        assert_eq!(residues[0], residues[1]);
        assert_eq!(residues[3], times(residues[0], 2));
        assert_ne!(
            residues[2],
            times(residues[0], 3),
            "not a relation of terminals"
        );
    }

    #[test]
    fn contradictions_are_noticed() {
        // 0..1 and 0..2 cannot be equal: interval 1 would vanish.
        assert_eq!(residues(&[vec![(0, 1), (0, 2)]], 2), None);
    }
}
