//! Representatives of types: medoids under the mismatched volume, at the price of triangles.
//!
//! With D the mismatched volume of all components in their types, B the triangles of the templates and U those of all components'
//! templates, types minimize D U^a, or D B U^a for few polygons: few bytes and few derived triangles count beside what is mismatched,
//! in proportion and without a unit. Around given types that is the sum D + p B + q U with the prices p = D / B (0 in D U^a) and
//! q = a D / U, in cubic metres for a triangle; prices are those of the round before.

use rayon::prelude::*;

use super::component::{CELLS, Component};
use super::nearest::{Nearest, square};
use super::uses::Use;

/// Number of rounds of finding medoids.
const ROUNDS: usize = 3;
/// Representatives that a component is compared with, nearest in features first.
pub(super) const CANDIDATES: usize = 12;
/// Members that are tried as medoid, nearest to the mean first.
const TRIED: usize = 12;
/// Members that are tried as medoid beside them: of the nearest to the mean, those of fewest triangles.
const SIMPLE: usize = 8;
const AMONG: usize = 64;
/// The power a of derived triangles, and for few polygons. With the first, fewer triangles are derived at the same
/// intersection over union as without a price (midtown 0.89 of its own triangles in place of 1.62, Delft 1.75 in place of 2.59).
const DERIVED: f64 = 0.12;
const DERIVED_FEW: f64 = 0.2;
/// Cost of a template beside its triangles, in triangles.
const TEMPLATE: f64 = 6.0;

/// The distinct components as a table of features.
pub(super) struct Table<'a> {
    /// Features, row after row, and how many a row has.
    pub(super) rows: Vec<f64>,
    pub(super) d: usize,
    /// Volume of each, in cubic metres.
    pub(super) weights: Vec<f64>,
    /// Components that are equal to each.
    pub(super) counts: Vec<f64>,
    /// Triangles of each as a template, with those that its holes lack.
    pub(super) triangles: Vec<f64>,
    /// True for few polygons: triangles of templates have a price, too, and simple members far from the mean are tried.
    pub(super) few: bool,
    pub(super) forms: Vec<Form<'a>>,
}

/// Prices of triangles, in cubic metres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Price {
    /// Of a triangle of a template.
    pub(super) template: f64,
    /// Of a derived triangle.
    pub(super) derived: f64,
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

    /// Rounds of: a medoid for each type; the best medoid, and quarter turn, for each component. Medoids, uses and prices, that of
    /// derived triangles so many times the usual.
    pub(super) fn medoids(
        &self,
        mut uses: Vec<Use>,
        count: usize,
        times: f64,
    ) -> (Vec<usize>, Vec<Use>, Price) {
        let mut medoids = self.choose(&uses, count, &[], Price::default());
        let mut price = Price::default();
        for _ in 0..ROUNDS {
            price = self.price(&medoids, &uses, times);
            uses = self.assign(&medoids, &uses, price);
            price = self.price(&medoids, &uses, times);
            medoids = self.choose(&uses, count, &medoids, price);
        }
        let uses = self.assign(&medoids, &uses, price);
        (medoids, uses, price)
    }

    /// The prices around given types; derived triangles cost so many `times` the usual.
    pub(super) fn price(&self, medoids: &[usize], uses: &[Use], times: f64) -> Price {
        let apart = |i: usize| {
            let Use { kind, quarter } = uses[i];
            self.weights[i] * mismatch(self.forms[medoids[kind]], self.forms[i], quarter)
        };
        let apart: Vec<f64> = (0..uses.len()).into_par_iter().map(apart).collect();
        let apart: f64 = apart.iter().sum();
        let mut used = vec![false; medoids.len()];
        uses.iter().for_each(|u| used[u.kind] = true);
        let derived: f64 = (uses.iter().zip(&self.counts))
            .map(|(u, count)| count * self.triangles[medoids[u.kind]])
            .sum();
        if !self.few {
            return Price {
                template: 0.0,
                derived: times * DERIVED * apart / derived.max(1.0),
            };
        }
        let templates: f64 = (medoids.iter().zip(&used))
            .filter(|(_, used)| **used)
            .map(|(&m, _)| self.cost(m))
            .sum();
        Price {
            template: apart / templates.max(1.0),
            derived: times * DERIVED_FEW * apart / derived.max(1.0),
        }
    }

    /// Cost of a template, in triangles.
    pub(super) fn cost(&self, medoid: usize) -> f64 {
        self.triangles[medoid] + TEMPLATE
    }

    /// The member of each type with the least mismatched volume to the others and price of triangles, of those nearest to the mean
    /// and the simple ones near it.
    fn choose(&self, uses: &[Use], count: usize, before: &[usize], price: Price) -> Vec<usize> {
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
            near.truncate(if self.few { AMONG } else { TRIED });
            if near.len() > TRIED {
                let triangles = |i: &usize| self.triangles[*i];
                near[TRIED..].sort_by(|a, b| triangles(a).total_cmp(&triangles(b)));
                near.truncate(TRIED + SIMPLE);
            }
            near.extend(before.get(kind));
            let instances: f64 = list.iter().map(|&i| self.counts[i]).sum();
            let mut best = (f64::INFINITY, 0);
            for m in near {
                let mut cost =
                    price.template * self.cost(m) + price.derived * instances * self.triangles[m];
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

    /// The least cost, as a share of its volume, at which a medoid stands for a component, and the quarter turn; infinite
    /// where it is not below `limit`.
    pub(super) fn share(&self, medoid: usize, i: usize, price: Price, limit: f64) -> (f64, u8) {
        let triangles = self.counts[i] * self.triangles[medoid];
        let price = price.derived * triangles / self.weights[i];
        let (form, own) = (self.forms[medoid], self.forms[i]);
        let mut best = (f64::INFINITY, 0);
        for quarter in 0..4 {
            let below = limit.min(best.0) - price;
            let cost = price + mismatch_below(form, own, quarter, below);
            if cost < best.0 {
                best = (cost, quarter);
            }
        }
        best
    }

    /// The best of the present type and the types whose medoids are nearest in features.
    pub(super) fn assign(&self, medoids: &[usize], uses: &[Use], price: Price) -> Vec<Use> {
        let nearest = Nearest::new(&self.rows, self.d, medoids);
        let best = |i: usize| {
            let mut best = (f64::INFINITY, uses[i]);
            let near = nearest.of(self.row(i), CANDIDATES).into_iter();
            for kind in near.chain([uses[i].kind]) {
                let (cost, quarter) = self.share(medoids[kind], i, price, best.0);
                if cost < best.0 {
                    best = (cost, Use { kind, quarter });
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
pub(super) fn mismatch(template: Form, component: Form, quarter: u8) -> f64 {
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
