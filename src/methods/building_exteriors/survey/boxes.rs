//! Few rectangles of the grid that cover the plan, level by level.

use std::collections::HashMap;

use super::heights::HeightMap;
use super::planes::Planes;

/// A plane that covers less of a cell does not count.
const COVERS: f64 = 0.2;
/// Least height of an eave (m), and eaves nearer than this are one level.
const LEAST: f64 = 2.0;
const SAME: f64 = 0.5;
/// Least extent of a box (m) and least area that it adds (square metres).
const THINNEST: f64 = 0.5;
const ADDS: f64 = 1.0;

/// A rectangle with the height of its eaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Level {
    /// Lower and upper x, lower and upper y.
    pub plan: [f64; 4],
    /// Height of the eaves.
    pub eave: f64,
}

/// Cells of the grid with their level; 0 is outside.
struct Cells {
    size: [usize; 2],
    level: Vec<usize>,
    area: Vec<f64>,
}

/// The boxes of a plan, the highest first.
pub(super) fn boxes(lines: &[Vec<f64>; 2], map: &HeightMap, planes: &Planes) -> Vec<Level> {
    let size = [0, 1].map(|a| lines[a].len().saturating_sub(1));
    let count = size[0] * size[1];
    if count == 0 {
        return Vec::new();
    }
    let mut covered = vec![0_usize; count];
    let mut by_plane: Vec<HashMap<usize, usize>> = vec![HashMap::new(); count];
    for s in map.samples() {
        let at = |axis: usize, v: f64| {
            let k = lines[axis].partition_point(|l| *l <= v);
            k.clamp(1, size[axis]) - 1
        };
        let k = at(0, s.x) * size[1] + at(1, s.y);
        covered[k] += 1;
        *by_plane[k].entry(s.plane).or_default() += 1;
    }
    let area: Vec<f64> = (0..count)
        .map(|k| {
            let (i, j) = (k / size[1], k % size[1]);
            (lines[0][i + 1] - lines[0][i]) * (lines[1][j + 1] - lines[1][j])
        })
        .collect();
    let eave = |k: usize| -> Option<f64> {
        if (covered[k] as f64) * map.cell() < 0.5 * area[k] {
            return None;
        }
        let counts = by_plane[k].iter();
        let large = counts.filter(|(_, n)| **n as f64 > COVERS * covered[k] as f64);
        let least = large
            .map(|(p, _)| planes.eave[*p])
            .fold(f64::INFINITY, f64::min);
        // Many small planes: the lowest of them all.
        let any = || {
            by_plane[k]
                .keys()
                .map(|p| planes.eave[*p])
                .fold(f64::INFINITY, f64::min)
        };
        Some(if least.is_finite() { least } else { any() }.max(LEAST))
    };
    let eaves: Vec<Option<f64>> = (0..count).map(eave).collect();
    let levels = levels(&eaves, &area);
    let nearest = |v: f64| {
        let mut order: Vec<usize> = (0..levels.len()).collect();
        order.sort_by(|&a, &b| (levels[a] - v).abs().total_cmp(&(levels[b] - v).abs()));
        order[0] + 1
    };
    let cells = Cells {
        size,
        level: eaves.iter().map(|e| e.map_or(0, nearest)).collect(),
        area,
    };
    let mut found = Vec::new();
    let mut open = cells.level.clone();
    for level in (1..=levels.len()).rev() {
        while let Some([i0, i1, j0, j1]) = cells.best(&open, level) {
            for i in i0..i1 {
                for j in j0..j1 {
                    open[i * size[1] + j] = 0;
                }
            }
            let plan = [lines[0][i0], lines[0][i1], lines[1][j0], lines[1][j1]];
            if (plan[1] - plan[0]).min(plan[3] - plan[2]) >= THINNEST {
                found.push(Level {
                    plan,
                    eave: levels[level - 1],
                });
            }
        }
    }
    found
}

/// Means of eaves nearer than [`SAME`], weighted by area, lowest first.
fn levels(eaves: &[Option<f64>], area: &[f64]) -> Vec<f64> {
    let known = eaves.iter().zip(area);
    let mut known: Vec<(f64, f64)> = known.filter_map(|(e, a)| Some(((*e)?, *a))).collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for (eave, area) in known {
        match groups.last_mut() {
            Some((sum, weight)) if eave - *sum / *weight < SAME => {
                *sum += eave * area;
                *weight += area;
            }
            _ => groups.push((eave * area, area)),
        }
    }
    groups
        .into_iter()
        .map(|(sum, weight)| sum / weight)
        .collect()
}

impl Cells {
    /// The rectangle of cells of at least `level` that holds the largest area of `open` cells of that level; among
    /// equals the smallest.
    fn best(&self, open: &[usize], level: usize) -> Option<[usize; 4]> {
        let [n, m] = self.size;
        let mut best: Option<(f64, f64, [usize; 4])> = None;
        for i0 in 0..n {
            for j0 in 0..m {
                let mut j_end = m;
                for i1 in i0 + 1..=n {
                    let column = (i1 - 1) * m;
                    let run = (j0..j_end).take_while(|j| self.level[column + j] >= level);
                    j_end = j0 + run.count();
                    if j_end == j0 {
                        break;
                    }
                    for j1 in j0 + 1..=j_end {
                        let cells = (i0..i1).flat_map(|i| (j0..j1).map(move |j| i * m + j));
                        let (mut adds, mut all) = (0.0, 0.0);
                        for k in cells {
                            all += self.area[k];
                            if open[k] == level {
                                adds += self.area[k];
                            }
                        }
                        let better = best.is_none_or(|(most, size, _)| {
                            adds > most + 1e-9 || (adds > most - 1e-9 && all < size - 1e-9)
                        });
                        if adds >= ADDS && better {
                            best = Some((adds, all, [i0, i1, j0, j1]));
                        }
                    }
                }
            }
        }
        best.map(|b| b.2)
    }
}
