//! One facade as an integer grid with constant-time questions.
//!
//! Let `x_0 < ... < x_X` and `y_0 < ... < y_Y` be the distinct edge coordinates. A region is a
//! rectangle of grid cells that cuts no terminal. Three prefix sums answer in constant time what
//! grammar search asks millions of times:
//! - the number of terminals in a region;
//! - whether a full line through a region cuts a terminal;
//! - a hash of the region's contents that does not depend on where the region lies:
//!   `sum_t h(label, w, h) P^(x_t - x_0) Q^(y_t - y_0) mod 2^61 - 1`.

use super::lengths::{Lines, minus};
use super::region::Region;
use edifice_shape::{Axis, Facade};

/// Modulus of the content hash, the Mersenne prime `2^61 - 1`.
const MODULUS: u64 = (1 << 61) - 1;
/// Bases of the content hash for x and y: fixed, so that runs repeat.
const BASE_X: u64 = 1_481_765_933_223_374_113;
const BASE_Y: u64 = 982_451_653_118_811_007;

/// A facade prepared for search.
#[derive(Debug)]
pub(crate) struct LayoutIndex {
    /// Edge coordinates in the facade's unit.
    pub xs: Vec<f64>,
    pub ys: Vec<f64>,
    /// Residues of the edge coordinates, equal for equal distances (see [`super::lengths`]).
    pub residues_x: Vec<u64>,
    pub residues_y: Vec<u64>,
    /// Terminals: rectangle in grid cells and label index.
    pub terminals: Vec<(Region, u32)>,
    /// Terminal that covers each cell, row by row.
    owner: Vec<u32>,
    /// Prefix sums at `[y * (X + 1) + x]`.
    count: Vec<u32>,
    hash: Vec<u64>,
    /// Terminals cut by the vertical line `x` below `y`, by the horizontal line `y` left of `x`.
    cut_x: Vec<u32>,
    cut_y: Vec<u32>,
    /// `P^-x` and `Q^-y` of each edge coordinate.
    inverse_x: Vec<u64>,
    inverse_y: Vec<u64>,
}

impl LayoutIndex {
    /// Prepares a tiling on its lines. `label(name)` numbers the labels.
    pub(crate) fn new(
        index: u16,
        facade: &Facade,
        lines: Lines,
        mut label: impl FnMut(&str) -> u32,
    ) -> Self {
        let Lines { layout, x, y } = lines;
        let terminals: Vec<(Region, u32)> = layout
            .spans
            .iter()
            .zip(&facade.regions)
            .map(|(span, region)| {
                let rect = Region {
                    layout: index,
                    x0: span.left as u16,
                    x1: span.right as u16,
                    y0: span.bottom as u16,
                    y1: span.top as u16,
                };
                (rect, label(&region.label))
            })
            .collect();
        let (xs, ys) = (layout.xs.values().to_vec(), layout.ys.values().to_vec());
        let mut layout = Self {
            inverse_x: powers(inverse(BASE_X), &x),
            inverse_y: powers(inverse(BASE_Y), &y),
            owner: vec![0; (xs.len() - 1) * (ys.len() - 1)],
            count: vec![0; xs.len() * ys.len()],
            hash: vec![0; xs.len() * ys.len()],
            cut_x: vec![0; xs.len() * ys.len()],
            cut_y: vec![0; xs.len() * ys.len()],
            xs,
            ys,
            residues_x: x,
            residues_y: y,
            terminals,
        };
        layout.paint();
        layout.accumulate();
        layout
    }

    fn paint(&mut self) {
        let columns = self.xs.len() - 1;
        for (id, (r, _)) in self.terminals.iter().enumerate() {
            for y in r.y0..r.y1 {
                let row = usize::from(y) * columns;
                self.owner[row + usize::from(r.x0)..row + usize::from(r.x1)].fill(id as u32);
            }
        }
    }

    fn accumulate(&mut self) {
        let stride = self.xs.len();
        let (px, py) = (
            powers(BASE_X, &self.residues_x),
            powers(BASE_Y, &self.residues_y),
        );
        for (r, label) in &self.terminals {
            let (w, h) = (self.extent_x(*r), self.extent_y(*r));
            let own = mix(mix(mix(u64::from(*label) + 1) ^ w) ^ h) % MODULUS;
            let at = (usize::from(r.y0) + 1) * stride + usize::from(r.x0) + 1;
            self.count[at] += 1;
            self.hash[at] = add(
                self.hash[at],
                multiply(own, multiply(px[usize::from(r.x0)], py[usize::from(r.y0)])),
            );
        }
        for y in 1..self.ys.len() {
            for x in 1..stride {
                let (here, left, below, corner) = (
                    y * stride + x,
                    y * stride + x - 1,
                    (y - 1) * stride + x,
                    (y - 1) * stride + x - 1,
                );
                self.count[here] =
                    self.count[here] + self.count[left] + self.count[below] - self.count[corner];
                let sum = add(add(self.hash[here], self.hash[left]), self.hash[below]);
                self.hash[here] = subtract(sum, self.hash[corner]);
            }
        }
        let columns = stride - 1;
        for y in 0..self.ys.len() - 1 {
            for x in 1..columns {
                let cut = self.owner[y * columns + x - 1] == self.owner[y * columns + x];
                self.cut_x[(y + 1) * stride + x] = self.cut_x[y * stride + x] + u32::from(cut);
            }
        }
        for y in 1..self.ys.len() - 1 {
            for x in 0..columns {
                let cut = self.owner[(y - 1) * columns + x] == self.owner[y * columns + x];
                self.cut_y[y * stride + x + 1] = self.cut_y[y * stride + x] + u32::from(cut);
            }
        }
    }

    /// The whole layout of this index as a region.
    pub(crate) fn root(&self, index: u16) -> Region {
        Region {
            layout: index,
            x0: 0,
            x1: (self.xs.len() - 1) as u16,
            y0: 0,
            y1: (self.ys.len() - 1) as u16,
        }
    }

    /// Residue of the width of a region.
    pub(crate) fn extent_x(&self, r: Region) -> u64 {
        let at = |line: u16| self.residues_x[usize::from(line)];
        minus(at(r.x1), at(r.x0))
    }

    /// Residue of the height of a region.
    pub(crate) fn extent_y(&self, r: Region) -> u64 {
        let at = |line: u16| self.residues_y[usize::from(line)];
        minus(at(r.y1), at(r.y0))
    }

    /// Edge coordinates along an axis, and their residues.
    pub(crate) fn lines(&self, axis: Axis) -> (&[f64], &[u64]) {
        match axis {
            Axis::X => (&self.xs, &self.residues_x),
            Axis::Y => (&self.ys, &self.residues_y),
        }
    }

    fn corner_sums<T: Copy>(&self, table: &[T], r: Region) -> [T; 4] {
        let stride = self.xs.len();
        let at = |x: u16, y: u16| table[usize::from(y) * stride + usize::from(x)];
        [
            at(r.x1, r.y1),
            at(r.x0, r.y1),
            at(r.x1, r.y0),
            at(r.x0, r.y0),
        ]
    }

    /// Number of terminals in a region.
    pub(crate) fn terminals_in(&self, r: Region) -> u32 {
        let [a, b, c, d] = self.corner_sums(&self.count, r);
        a + d - b - c
    }

    /// Hash of the contents, independent of the region's place.
    pub(crate) fn hash_of(&self, r: Region) -> u64 {
        let [a, b, c, d] = self.corner_sums(&self.hash, r);
        let sum = subtract(subtract(add(a, d), b), c);
        multiply(
            sum,
            multiply(
                self.inverse_x[usize::from(r.x0)],
                self.inverse_y[usize::from(r.y0)],
            ),
        )
    }

    /// Label of the region when it is a single terminal.
    pub(crate) fn terminal_label(&self, r: Region) -> Option<u32> {
        let cell = usize::from(r.y0) * (self.xs.len() - 1) + usize::from(r.x0);
        let (rect, label) = self.terminals[self.owner[cell] as usize];
        (rect.x0 == r.x0 && rect.x1 == r.x1 && rect.y0 == r.y0 && rect.y1 == r.y1).then_some(label)
    }

    /// True if the vertical line at grid index `x` cuts a terminal between rows `y0` and `y1`.
    pub(crate) fn cuts_terminal_x(&self, x: u16, y0: u16, y1: u16) -> bool {
        let at = |y: u16| self.cut_x[usize::from(y) * self.xs.len() + usize::from(x)];
        at(y1) > at(y0)
    }

    /// True if the horizontal line at grid index `y` cuts a terminal between columns `x0` and `x1`.
    pub(crate) fn cuts_terminal_y(&self, y: u16, x0: u16, x1: u16) -> bool {
        let row = usize::from(y) * self.xs.len();
        self.cut_y[row + usize::from(x1)] > self.cut_y[row + usize::from(x0)]
    }
}

fn add(a: u64, b: u64) -> u64 {
    let s = a + b;
    if s >= MODULUS { s - MODULUS } else { s }
}

fn subtract(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + MODULUS - b }
}

fn multiply(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    add(
        (product & u128::from(MODULUS)) as u64,
        (product >> 61) as u64,
    )
}

fn power(base: u64, exponent: u64) -> u64 {
    let (mut result, mut square, mut rest) = (1, base, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result = multiply(result, square);
        }
        square = multiply(square, square);
        rest >>= 1;
    }
    result
}

/// Fermat: `a^(p-2) = 1/a`.
fn inverse(a: u64) -> u64 {
    power(a, MODULUS - 2)
}

fn powers(base: u64, exponents: &[u64]) -> Vec<u64> {
    exponents.iter().map(|&e| power(base, e)).collect()
}

/// Finalizer of SplitMix64.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
