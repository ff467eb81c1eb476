//! Columns of solid material on a square grid, and what two solids share.
//!
//! A cell's column is solid where its vertical line through the cell's middle is inside: from the top
//! down, a triangle that faces up is entered, one that faces down is left; what is not left reaches
//! down to the solid's lowest point. A missing bottom face therefore does not matter.

use rayon::prelude::*;

use std::ops::Range;

use super::TriangleMesh;

/// Most columns that triangles cross in all, and most cells along a side: cells are coarsened until that holds, so that
/// coordinates far away, which a damaged file gives, take neither memory nor time.
const MOST_CROSSINGS: f64 = 6e8;
const MOST_CELLS: f64 = 131_072.0;
/// Few triangles cross at most so many, and for each triangle so many more: those of a city cross some hundred columns each, and a
/// handful of enormous ones is not worth minutes.
const FEW_CROSSINGS: f64 = 5e7;
const CROSSINGS_EACH: f64 = 1e4;
/// Rows of cells that are measured at once: bounds the memory.
const STRIP: i64 = 128;

/// Volumes of two solids, of what they share, and of both together, in cubic metres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overlap {
    /// Volume of the first.
    pub first: f64,
    /// Volume of the second.
    pub second: f64,
    /// Volume in both.
    pub intersection: f64,
}

impl Overlap {
    /// Volume in at least one.
    pub fn union(&self) -> f64 {
        self.first + self.second - self.intersection
    }

    /// Intersection over union; 1 for two empty solids.
    pub fn iou(&self) -> f64 {
        match self.union() > 0.0 {
            true => self.intersection / self.union(),
            false => 1.0,
        }
    }
}

/// A square grid on the plane: cell (i, j) has its middle at ((i + 1/2) size, (j + 1/2) size).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeRaster {
    /// Side of a cell, in metres.
    pub size: f64,
}

/// A crossing of a column with a triangle: cell in the strip, height, +1 facing up or -1 facing down.
type Crossing = (u64, f32, i8);

impl VolumeRaster {
    /// A raster for solids: this one, or, where they are too large for it, the finest of twice, four times ... its cells that is not.
    pub fn fitted(&self, first: &[&TriangleMesh], second: &[&TriangleMesh]) -> Self {
        let (mut area, mut low, mut high) = (0.0, [f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut triangles = 0;
        for mesh in first.iter().chain(second) {
            area += mesh
                .corners()
                .map(|t| super::mesh::plan_area(&t).abs())
                .sum::<f64>();
            triangles += mesh.triangles.len();
            if let Some((l, h)) = mesh.bounds() {
                low = [0, 1].map(|k| low[k].min(l[k]));
                high = [0, 1].map(|k| high[k].max(h[k]));
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let most = (FEW_CROSSINGS + CROSSINGS_EACH * triangles as f64).min(MOST_CROSSINGS);
        let mut size = self.size;
        while size.is_finite() && (area / (size * size) > most || extent / size > MOST_CELLS) {
            size *= 2.0;
        }
        Self { size }
    }

    /// Compares two sets of solids, on [`VolumeRaster::fitted`] cells; the solids of one set may overlap, and count once where
    /// they do.
    pub fn compare(&self, first: &[&TriangleMesh], second: &[&TriangleMesh]) -> Overlap {
        self.fitted(first, second).compared(first, second)
    }

    fn compared(&self, first: &[&TriangleMesh], second: &[&TriangleMesh]) -> Overlap {
        let strips = self.strips(first, second);
        let area = self.size * self.size;
        let parts: Vec<Overlap> = strips
            .par_iter()
            .map(|(strip, [a, b])| {
                let columns = [(first, a), (second, b)].map(|(set, members)| {
                    let mut intervals = Vec::new();
                    for &m in members {
                        self.columns(set[m], *strip, &ALL, &mut intervals);
                    }
                    united(intervals)
                });
                shared(&columns[0], &columns[1])
            })
            .collect();
        let mut sum = Overlap::default();
        for part in parts {
            sum.first += part.first * area;
            sum.second += part.second * area;
            sum.intersection += part.intersection * area;
        }
        sum
    }

    /// Strips in order, with the solids that reach into each.
    fn strips(&self, a: &[&TriangleMesh], b: &[&TriangleMesh]) -> Vec<(i64, [Vec<usize>; 2])> {
        let mut strips = std::collections::BTreeMap::<i64, [Vec<usize>; 2]>::new();
        for (k, set) in [a, b].into_iter().enumerate() {
            for (m, mesh) in set.iter().enumerate() {
                let Some((low, high)) = mesh.bounds() else {
                    continue;
                };
                let strip = |y: f64| (y / self.size).floor() as i64;
                for s in strip(low[1]).div_euclid(STRIP)..=strip(high[1]).div_euclid(STRIP) {
                    strips.entry(s).or_default()[k].push(m);
                }
            }
        }
        strips.into_iter().collect()
    }

    /// The solid intervals of a mesh in a strip, in cells of a range: cell, lower and upper end.
    fn columns(
        &self,
        mesh: &TriangleMesh,
        strip: i64,
        within: &Range<i64>,
        out: &mut Vec<(u64, f32, f32)>,
    ) {
        let Some((low, _)) = mesh.bounds() else {
            return;
        };
        let mut crossings: Vec<Crossing> = Vec::new();
        for t in mesh.corners() {
            self.cross(&t, strip, within, &mut crossings);
        }
        crossings.sort_unstable_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(b.1.total_cmp(&a.1))
                .then(b.2.cmp(&a.2))
        });
        for column in crossings.chunk_by(|a, b| a.0 == b.0) {
            let heights = column.iter().map(|c| (c.1, c.2));
            solid_intervals(heights, low[2] as f32, |bottom, top| {
                out.push((column[0].0, bottom, top));
            });
        }
    }

    /// Crossings of a triangle with the columns of a strip. Each column crosses a closed surface's plan
    /// consistently: edges are half open, and computed from the same end in both of their triangles.
    fn cross(&self, t: &super::Corners, strip: i64, within: &Range<i64>, out: &mut Vec<Crossing>) {
        let area = super::mesh::plan_area(t);
        if area == 0.0 {
            return;
        }
        let sign = if area > 0.0 { 1 } else { -1 };
        let n = super::mesh::normal(t);
        let ys = [t[0][1], t[1][1], t[2][1]];
        let low = ys[0].min(ys[1]).min(ys[2]);
        let high = ys[0].max(ys[1]).max(ys[2]);
        // First row whose middle is at or above a height.
        let row = |y: f64| (y / self.size - 0.5).ceil() as i64;
        let rows = row(low).max(strip * STRIP)..row(high).min((strip + 1) * STRIP);
        for j in rows {
            let y = (j as f64 + 0.5) * self.size;
            let mut ends = [0.0; 3];
            let mut count = 0;
            for k in 0..3 {
                let (p, q) = (t[k], t[(k + 1) % 3]);
                let (p, q) = if p[1] < q[1] { (p, q) } else { (q, p) };
                if p[1] <= y && y < q[1] {
                    ends[count] = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
                    count += 1;
                }
            }
            if count != 2 {
                continue;
            }
            let first = row(ends[0].min(ends[1])).max(within.start);
            for i in first..row(ends[0].max(ends[1])).min(within.end) {
                let x = (i as f64 + 0.5) * self.size;
                let z = t[0][2] - (n[0] * (x - t[0][0]) + n[1] * (y - t[0][1])) / n[2];
                let cell = (((j - strip * STRIP) as u64) << 48) | ((i + (1 << 46)) as u64);
                out.push((cell, z as f32, sign));
            }
        }
    }
}

/// All columns that a cell's number can tell.
const ALL: Range<i64> = -(1 << 46)..1 << 46;

/// The solid share, from 0 to 1, of each column of the unit box (x and y from -1/2 to 1/2, z from 0 to 1):
/// `cells` x `cells` means of `samples` x `samples` columns, row after row from low y to high.
pub fn height_map(unit: &TriangleMesh, cells: usize, samples: usize) -> Vec<f32> {
    let side = cells * samples;
    let scale = side as f64;
    let scaled = unit
        .positions
        .iter()
        .map(|p| [(p[0] + 0.5) * scale, (p[1] + 0.5) * scale, p[2]]);
    let mesh = TriangleMesh {
        positions: scaled.collect(),
        triangles: unit.triangles.clone(),
    };
    let raster = VolumeRaster { size: 1.0 };
    let mut heights = vec![0.0; cells * cells];
    let weight = 1.0 / (samples * samples) as f32;
    for strip in 0..(side as i64 + STRIP - 1) / STRIP {
        let mut intervals = Vec::new();
        raster.columns(&mesh, strip, &(0..side as i64), &mut intervals);
        for (cell, bottom, top) in intervals {
            let row = (cell >> 48) as i64 + strip * STRIP;
            let column = (cell & ((1 << 48) - 1)) as i64 - (1 << 46);
            let within = |v: i64| (0..side as i64).contains(&v);
            if within(row) && within(column) {
                let at = row as usize / samples * cells + column as usize / samples;
                heights[at] += weight * (top.min(1.0) - bottom.max(0.0)).max(0.0);
            }
        }
    }
    heights
}

/// Calls `found` with each solid interval of a column, from the top down. `crossings`: heights with +1
/// for a surface that faces up and -1 for one that faces down, from the top down, at equal heights up
/// first.
pub fn solid_intervals(
    crossings: impl Iterator<Item = (f32, i8)>,
    floor: f32,
    mut found: impl FnMut(f32, f32),
) {
    let (mut depth, mut top) = (0, 0.0);
    for (z, sign) in crossings {
        if sign > 0 {
            if depth == 0 {
                top = z;
            }
            depth += 1;
        } else if depth > 0 {
            depth -= 1;
            if depth == 0 && top > z {
                found(z, top);
            }
        }
    }
    if depth > 0 && top > floor {
        found(floor, top);
    }
}

/// Sorts intervals by cell and height and joins those that overlap.
fn united(mut intervals: Vec<(u64, f32, f32)>) -> Vec<(u64, f32, f32)> {
    intervals.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut out: Vec<(u64, f32, f32)> = Vec::with_capacity(intervals.len());
    for next in intervals {
        match out.last_mut() {
            Some(last) if last.0 == next.0 && next.1 <= last.2 => last.2 = last.2.max(next.2),
            _ => out.push(next),
        }
    }
    out
}

/// Heights of two lists of disjoint sorted intervals, and of their intersection, for cells of area 1.
fn shared(a: &[(u64, f32, f32)], b: &[(u64, f32, f32)]) -> Overlap {
    let total = |list: &[(u64, f32, f32)]| list.iter().map(|i| f64::from(i.2 - i.1)).sum();
    let mut overlap = Overlap {
        first: total(a),
        second: total(b),
        intersection: 0.0,
    };
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        let (p, q) = (a[i], b[j]);
        if p.0 == q.0 {
            let common = p.2.min(q.2) - p.1.max(q.1);
            overlap.intersection += f64::from(common.max(0.0));
        }
        // Whichever ends first has nothing more to share.
        if (p.0, p.2) < (q.0, q.2) {
            i += 1;
        } else {
            j += 1;
        }
    }
    overlap
}
