//! Representatives of types: medoids under the mismatched volume.

use rayon::prelude::*;

use super::components::{CELLS, Component};
use super::nearest::Nearest;
use super::types::Use;

/// Number of rounds of finding medoids.
const ROUNDS: usize = 3;
/// Representatives that a component is compared with, nearest in features first.
const CANDIDATES: usize = 12;
/// Members that are tried as medoid, nearest to the mean first.
const TRIED: usize = 12;

/// The distinct components as a table of features.
pub(super) struct Table<'a> {
    /// Features, row after row, and how many a row has.
    pub(super) rows: Vec<f64>,
    pub(super) d: usize,
    /// Volume of each, in cubic metres.
    pub(super) weights: Vec<f64>,
    pub(super) forms: Vec<Form<'a>>,
}

/// The form by which components are compared, up to quarter turns: height map and greys.
#[derive(Clone, Copy)]
pub(super) struct Form<'a> {
    heights: &'a [f32],
    looks: &'a [f32],
}

impl<'a> Form<'a> {
    pub(super) fn of(component: &'a Component) -> Self {
        Self {
            heights: &component.heights,
            looks: &component.looks,
        }
    }
}

impl Table<'_> {
    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.d..(i + 1) * self.d]
    }

    /// Rounds of: a medoid for each type; the best medoid, and quarter turn, for each component. Medoids and uses.
    pub(super) fn medoids(&self, mut uses: Vec<Use>, count: usize) -> (Vec<usize>, Vec<Use>) {
        let mut medoids = self.choose(&uses, count, &[]);
        for _ in 0..ROUNDS {
            uses = self.assign(&medoids, &uses);
            medoids = self.choose(&uses, count, &medoids);
        }
        let uses = self.assign(&medoids, &uses);
        (medoids, uses)
    }

    /// The member of each type with the least mismatched volume to the others, of those nearest to the mean.
    fn choose(&self, uses: &[Use], count: usize, before: &[usize]) -> Vec<usize> {
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (i, u) in uses.iter().enumerate() {
            members[u.kind].push(i);
        }
        let medoid = |(kind, list): (usize, &Vec<usize>)| {
            let total: f64 = list.iter().map(|&i| self.weights[i]).sum();
            let mean = |k: usize| {
                list.iter()
                    .map(|&i| self.weights[i] * self.row(i)[k])
                    .sum::<f64>()
                    / total
            };
            let mean: Vec<f64> = (0..self.d).map(mean).collect();
            let mut near = list.clone();
            let far = |i: usize| square(self.row(i), &mean);
            near.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
            near.truncate(TRIED);
            near.extend(before.get(kind));
            let mut best = (f64::INFINITY, 0);
            for m in near {
                let mut cost = 0.0;
                for &i in list {
                    let turned = uses[i].quarter;
                    cost += self.weights[i] * mismatch(self.forms[m], self.forms[i], turned);
                    if cost > best.0 {
                        break;
                    }
                }
                if (cost, m) < best {
                    best = (cost, m);
                }
            }
            best.1
        };
        members.par_iter().enumerate().map(medoid).collect()
    }

    /// The best of the present type and the types whose medoids are nearest in features.
    fn assign(&self, medoids: &[usize], uses: &[Use]) -> Vec<Use> {
        let nearest = Nearest::new(&self.rows, self.d, medoids);
        let best = |i: usize| {
            let mut best = (f64::INFINITY, uses[i]);
            let near = nearest.of(self.row(i), CANDIDATES).into_iter();
            for kind in near.chain([uses[i].kind]) {
                for quarter in 0..4 {
                    let (medoid, own) = (self.forms[medoids[kind]], self.forms[i]);
                    let cost = mismatch_below(medoid, own, quarter, best.0);
                    if cost < best.0 {
                        best = (cost, Use { kind, quarter });
                    }
                }
            }
            best.1
        };
        (0..uses.len()).into_par_iter().map(best).collect()
    }
}

/// Weight of differences of looks, from 0 to 1, against shares of the volume.
const LOOKS_WEIGHT: f64 = 0.25;

/// Mean difference of two height maps, the first one turned by quarters counterclockwise: the mismatched
/// share of the box; and that of looks.
fn mismatch(template: Form, component: Form, quarter: u8) -> f64 {
    mismatch_below(template, component, quarter, f64::INFINITY)
}

/// As [`mismatch`]; infinite as soon as it is not below `limit`.
fn mismatch_below(template: Form, component: Form, quarter: u8, limit: f64) -> f64 {
    let apart = looks_apart(template.looks, component.looks, quarter);
    let (template, component, limit) = (template.heights, component.heights, limit - apart);
    let last = CELLS - 1;
    let cells = (CELLS * CELLS) as f64;
    let mut sum = 0.0f32;
    for y in 0..CELLS {
        for x in 0..CELLS {
            // Where the cell comes from.
            let (u, v) = match quarter {
                0 => (x, y),
                1 => (y, last - x),
                2 => (last - x, last - y),
                _ => (last - y, x),
            };
            sum += (template[v * CELLS + u] - component[y * CELLS + x]).abs();
        }
        if f64::from(sum) / cells >= limit {
            return f64::INFINITY;
        }
    }
    f64::from(sum) / cells + apart
}

/// Weighted mean difference of looks: a template that is turned by a quarter shows on each side what it had on the one before.
fn looks_apart(template: &[f32], component: &[f32], quarter: u8) -> f64 {
    match (template.is_empty(), component.is_empty()) {
        (true, true) => return 0.0,
        (false, false) => {}
        // What shows a texture is not like what shows none.
        _ => return LOOKS_WEIGHT,
    }
    let (n, side) = (component.len(), component.len() / 4);
    let from = |i: usize| (i + (4 - usize::from(quarter)) * side) % n;
    let sum: f32 = (0..n)
        .map(|i| (template[from(i)] - component[i]).abs())
        .sum();
    LOOKS_WEIGHT * f64::from(sum) / n as f64
}

pub(super) fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}
