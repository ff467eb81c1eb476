//! One facade as an integer grid with constant-time questions.
//!
//! Let `x_0 < ... < x_X` and `y_0 < ... < y_Y` be the distinct edge coordinates. A region is a
//! rectangle of grid cells that cuts no terminal. Three prefix sums answer in constant time what
//! grammar search asks millions of times:
//! - the number of terminals in a region;
//! - whether a full line through a region cuts a terminal;
//! - a hash of the region's contents that does not depend on where the region lies:
//!   `sum_t h(label, w, h) P^(x_t - x_0) Q^(y_t - y_0) mod 2^61 - 1`.

use crate::shape::Facade;

/// Modulus of the content hash, the Mersenne prime `2^61 - 1`.
const MODULUS: u64 = (1 << 61) - 1;
/// Bases of the content hash for x and y: fixed, so that runs repeat.
const BASE_X: u64 = 1_481_765_933_223_374_113;
const BASE_Y: u64 = 982_451_653_118_811_007;

/// A rectangle of grid cells of one sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Region {
    pub sheet: u16,
    pub x0: u16,
    pub x1: u16,
    pub y0: u16,
    pub y1: u16,
}

/// A facade prepared for search.
#[derive(Debug)]
pub(crate) struct Sheet {
    /// Edge coordinates in the facade's unit.
    pub xs: Vec<f64>,
    pub ys: Vec<f64>,
    /// Edge coordinates in quanta, from 0.
    pub qx: Vec<i64>,
    pub qy: Vec<i64>,
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

impl Sheet {
    /// Prepares a tiling. `label(name)` numbers the labels, `quantum` is the length unit in which
    /// sizes are compared. The caller has checked that the facade is a tiling.
    pub fn new(
        index: u16,
        facade: &Facade,
        quantum: f64,
        mut label: impl FnMut(&str) -> u32,
    ) -> Self {
        let quanta = |v: f64| (v / quantum).round() as i64;
        let (xs, qx) = edges(
            facade
                .regions
                .iter()
                .flat_map(|r| [r.rect.x, r.rect.right()]),
            quanta,
        );
        let (ys, qy) = edges(
            facade.regions.iter().flat_map(|r| [r.rect.y, r.rect.top()]),
            quanta,
        );
        let at = |edges: &[i64], v: f64| edges.partition_point(|&e| e < quanta(v)) as u16;
        let terminals: Vec<(Region, u32)> = facade
            .regions
            .iter()
            .map(|r| {
                let (x0, x1) = (at(&qx, r.rect.x), at(&qx, r.rect.right()));
                let (y0, y1) = (at(&qy, r.rect.y), at(&qy, r.rect.top()));
                (
                    Region {
                        sheet: index,
                        x0,
                        x1,
                        y0,
                        y1,
                    },
                    label(&r.label),
                )
            })
            .collect();
        let mut sheet = Self {
            inverse_x: powers(inverse(BASE_X), &qx),
            inverse_y: powers(inverse(BASE_Y), &qy),
            owner: vec![0; (xs.len() - 1) * (ys.len() - 1)],
            count: vec![0; xs.len() * ys.len()],
            hash: vec![0; xs.len() * ys.len()],
            cut_x: vec![0; xs.len() * ys.len()],
            cut_y: vec![0; xs.len() * ys.len()],
            xs,
            ys,
            qx,
            qy,
            terminals,
        };
        sheet.paint();
        sheet.accumulate();
        sheet
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
        let (px, py) = (powers(BASE_X, &self.qx), powers(BASE_Y, &self.qy));
        for (r, label) in &self.terminals {
            let (w, h) = (self.extent_x(*r), self.extent_y(*r));
            let own = mix(mix(mix(u64::from(*label) + 1) ^ w as u64) ^ h as u64) % MODULUS;
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

    /// The whole sheet.
    pub fn root(&self, index: u16) -> Region {
        Region {
            sheet: index,
            x0: 0,
            x1: (self.xs.len() - 1) as u16,
            y0: 0,
            y1: (self.ys.len() - 1) as u16,
        }
    }

    /// Width of a region in quanta.
    pub fn extent_x(&self, r: Region) -> i64 {
        self.qx[usize::from(r.x1)] - self.qx[usize::from(r.x0)]
    }

    /// Height of a region in quanta.
    pub fn extent_y(&self, r: Region) -> i64 {
        self.qy[usize::from(r.y1)] - self.qy[usize::from(r.y0)]
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
    pub fn terminals_in(&self, r: Region) -> u32 {
        let [a, b, c, d] = self.corner_sums(&self.count, r);
        a + d - b - c
    }

    /// Hash of the contents, independent of the region's place.
    pub fn hash_of(&self, r: Region) -> u64 {
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
    pub fn terminal_label(&self, r: Region) -> Option<u32> {
        let cell = usize::from(r.y0) * (self.xs.len() - 1) + usize::from(r.x0);
        let (rect, label) = self.terminals[self.owner[cell] as usize];
        (rect.x0 == r.x0 && rect.x1 == r.x1 && rect.y0 == r.y0 && rect.y1 == r.y1).then_some(label)
    }

    /// Whether the vertical line at grid index `x` cuts a terminal between rows `y0` and `y1`.
    pub fn cuts_terminal_x(&self, x: u16, y0: u16, y1: u16) -> bool {
        let at = |y: u16| self.cut_x[usize::from(y) * self.xs.len() + usize::from(x)];
        at(y1) > at(y0)
    }

    /// Whether the horizontal line at grid index `y` cuts a terminal between columns `x0` and `x1`.
    pub fn cuts_terminal_y(&self, y: u16, x0: u16, x1: u16) -> bool {
        let row = usize::from(y) * self.xs.len();
        self.cut_y[row + usize::from(x1)] > self.cut_y[row + usize::from(x0)]
    }
}

/// Distinct coordinates in ascending order, in units and in quanta.
fn edges(values: impl Iterator<Item = f64>, quanta: impl Fn(f64) -> i64) -> (Vec<f64>, Vec<i64>) {
    let mut all: Vec<(i64, f64)> = values.map(|v| (quanta(v), v)).collect();
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.dedup_by_key(|e| e.0);
    let origin = all.first().map_or(0, |e| e.0);
    (
        all.iter().map(|e| e.1).collect(),
        all.iter().map(|e| e.0 - origin).collect(),
    )
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

fn powers(base: u64, exponents: &[i64]) -> Vec<u64> {
    exponents.iter().map(|&e| power(base, e as u64)).collect()
}

/// Finalizer of SplitMix64.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
