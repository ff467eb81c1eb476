//! Component types and their representatives (Sec. IV.D).

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::component::Component;
use super::features::{Points, paper_features};
use super::medoids::{Form, Price, Table};
use super::nearest::square;
use super::pruning::pruned;
use super::settings::{ProceduralizeError, Representative};
pub use super::uses::Use;
use edifice_base::{Progress, Watched, rng};
use edifice_cluster::{WardTree, kmeans, lloyd, means, ward};
use edifice_shape::triangles::{merge_coplanar, repair};
use rayon::prelude::*;

/// The types of a city.
#[derive(Debug, Clone, PartialEq)]
pub struct Types {
    /// Component that represents each type.
    pub representatives: Vec<usize>,
    /// The type of each component.
    pub uses: Vec<Use>,
}

/// k-means, with k halved level by level until at most `k` clusters are left; each level groups the centres of
/// the level before, weighted by their members. Stopped, the types are those of the last level.
pub fn paper_types(
    components: &[Component],
    k: usize,
    weights: &[f64; 11],
    representative: Representative,
    seed: u64,
    watched: &Watched,
) -> Types {
    let points = paper_features(components, weights);
    let labels = halving(&points, k, seed, watched);
    let count = labels.iter().max().map_or(0, |m| m + 1);
    let mut members = vec![Vec::new(); count];
    for (i, &l) in labels.iter().enumerate() {
        members[l].push(i);
    }
    let choose = |list: &Vec<usize>| match representative {
        Representative::FewestPolygons => list
            .iter()
            .copied()
            .min_by_key(|&i| components[i].mesh.triangles.len()),
        Representative::Nearest => {
            let n = list.len() as f64;
            let mean = |k: usize| list.iter().map(|&i| points.row(i)[k]).sum::<f64>() / n;
            let mean: Vec<f64> = (0..points.dimension).map(mean).collect();
            let far = |i: usize| square(points.row(i), &mean);
            list.iter()
                .copied()
                .min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)))
        }
    };
    Types {
        representatives: members.iter().filter_map(choose).collect(),
        uses: labels
            .into_iter()
            .map(|kind| Use { kind, quarter: 0 })
            .collect(),
    }
}

/// Steps of Lloyd at each level.
const LLOYD_STEPS: usize = 10;

fn halving(points: &Points, k: usize, seed: u64, watched: &Watched) -> Vec<usize> {
    let n = points.values.len() / points.dimension;
    let mut labels: Vec<usize> = (0..n).collect();
    let mut centres = points.values.clone();
    let mut weights = vec![1.0; n];
    let mut level = 0;
    while weights.len() > k.max(1) && watched.goes_on(Progress::stage("levels of k-means")) {
        // The levels are n/2, n/4, ...; the last one is the k asked for.
        let target = (n >> (level + 1)).max(k).max(1).min(weights.len() - 1);
        let mut stream = rng::stream(seed, "city halving", level as u64);
        let found = kmeans(
            &centres,
            points.dimension,
            &weights,
            target,
            LLOYD_STEPS,
            &mut stream,
        );
        let (numbers, count) = renumbered(&found.labels);
        labels.iter_mut().for_each(|l| *l = numbers[*l]);
        let mut next = vec![0.0; count];
        for (&c, w) in numbers.iter().zip(&weights) {
            next[c] += w;
        }
        let zero = vec![0.0; count * points.dimension];
        centres = means(&centres, points.dimension, &weights, &numbers, zero);
        weights = next;
        level += 1;
    }
    renumbered(&labels).0
}

/// Labels numbered by their first points, and how many there are.
fn renumbered(labels: &[usize]) -> (Vec<usize>, usize) {
    let mut numbers = FxHashMap::default();
    let mut out = Vec::with_capacity(labels.len());
    for &l in labels {
        let next = numbers.len();
        out.push(*numbers.entry(l).or_insert(next));
    }
    (out, numbers.len())
}

/// A type for each template that the input states, in the order of their numbers; `None` where it does not state one for
/// every component.
pub fn stated_types(components: &[Component]) -> Option<Types> {
    let mut first: BTreeMap<usize, usize> = BTreeMap::new();
    for (i, c) in components.iter().enumerate() {
        first.entry(c.stated?).or_insert(i);
    }
    let kinds: FxHashMap<usize, usize> = first.keys().enumerate().map(|(k, &t)| (t, k)).collect();
    let one = |c: &Component| Use {
        kind: c.stated.map_or(0, |t| kinds[&t]),
        quarter: 0,
    };
    Some(Types {
        uses: components.iter().map(one).collect(),
        representatives: first.into_values().collect(),
    })
}

/// A share in 255 steps.
fn step_of(share: f32) -> u8 {
    (share * 255.0).round() as u8
}

/// Steps of a box within which components are the same.
const SAME: f64 = 65_536.0;

/// A type for each distinct component: components whose triangles are the same, to 16 bits of their boxes, and
/// whose looks are, are of one type.
pub fn distinct_types(components: &[Component]) -> Types {
    let mut known: FxHashMap<Vec<i64>, usize> = FxHashMap::default();
    let mut types = Types {
        representatives: Vec::new(),
        uses: Vec::with_capacity(components.len()),
    };
    for (i, c) in components.iter().enumerate() {
        let triangles = c.mesh.corners().map(|t| {
            let mut t = t.map(|p| p.map(|v| (v * SAME).round() as i64));
            // From the least corner on, in the same sense.
            let first = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
            t.rotate_left(first);
            t
        });
        let mut triangles: Vec<[[i64; 3]; 3]> = triangles.collect();
        triangles.sort_unstable();
        let looks = c.looks.iter().map(|v| i64::from(step_of(*v)));
        let key = triangles
            .into_iter()
            .flatten()
            .flatten()
            .chain(looks)
            .collect();
        let kind = *known.entry(key).or_insert_with(|| {
            types.representatives.push(i);
            types.representatives.len() - 1
        });
        types.uses.push(Use { kind, quarter: 0 });
    }
    types
}

/// Ward's hierarchy of the geometric features of components, weighted by volume, equal components joined first.
pub struct TypeTree<'a> {
    /// Indices of the distinct components.
    distinct: Vec<usize>,
    /// The distinct component that each is equal to.
    group: Vec<usize>,
    table: Table<'a>,
    tree: WardTree,
}

impl<'a> TypeTree<'a> {
    /// The hierarchy over the geometric features `points` of `components`. With [`Representative::FewestPolygons`] triangles have a
    /// higher price, those of templates, too.
    ///
    /// # Errors
    /// [`ProceduralizeError::Ward`].
    pub fn new(
        components: &'a [Component],
        points: &Points,
        representative: Representative,
    ) -> Result<Self, ProceduralizeError> {
        let once = vec![1.0; components.len()];
        Self::weighted(components, points, &once, representative)
    }

    /// The hierarchy over components that stand for others: `times`, how many components each stands for; its volume is theirs.
    pub(super) fn weighted(
        components: &'a [Component],
        points: &Points,
        times: &[f64],
        representative: Representative,
    ) -> Result<Self, ProceduralizeError> {
        let d = points.dimension;
        // Equal components first: the hierarchy is over distinct ones.
        let mut known: FxHashMap<Vec<u8>, usize> = FxHashMap::default();
        let mut distinct: Vec<usize> = Vec::new();
        let mut weights: Vec<f64> = Vec::new();
        let mut counts: Vec<f64> = Vec::new();
        let mut group = Vec::with_capacity(components.len());
        for (i, c) in components.iter().enumerate() {
            let key: Vec<u8> = c
                .heights
                .iter()
                .chain(&c.looks)
                .copied()
                .map(step_of)
                .collect();
            let g = *known.entry(key).or_insert_with(|| {
                distinct.push(i);
                weights.push(0.0);
                counts.push(0.0);
                distinct.len() - 1
            });
            weights[g] += c.volume.max(1e-3);
            counts[g] += times[i];
            group.push(g);
        }
        let rows: Vec<f64> = distinct
            .iter()
            .flat_map(|&i| points.row(i).to_vec())
            .collect();
        let tree = ward(&rows, d, &weights)?;
        let forms = distinct.iter().map(|&i| Form::of(&components[i]));
        let triangles = distinct
            .par_iter()
            .map(|&i| template_triangles(&components[i]));
        let table = Table {
            rows,
            d,
            weights,
            counts,
            triangles: triangles.collect(),
            few: representative == Representative::FewestPolygons,
            forms: forms.collect(),
        };
        Ok(Self {
            distinct,
            group,
            table,
            tree,
        })
    }

    /// The hierarchy cut at more than `k` types; then rounds of Lloyd, and of medoids under the mismatched volume over the four
    /// quarter turns; then, for few polygons, the `k` types of most worth, again with rounds of medoids.
    /// Types that stand for more components come first. Also their prices, that of derived triangles so many `times` the usual.
    pub(super) fn cut(&self, k: usize, times: f64) -> Priced {
        let Table {
            rows, d, weights, ..
        } = &self.table;
        let all = self.distinct.len();
        let k = k.clamp(1, all);
        let surplus = if self.table.few { SURPLUS } else { 1.0 };
        let wide = ((surplus * k as f64) as usize).clamp(k, all);
        let mut labels = self.tree.cut(wide);
        if wide < all {
            let zero = vec![0.0; wide * d];
            let centres = means(rows, *d, weights, &labels, zero);
            labels = lloyd(rows, *d, weights, centres, LLOYD_STEPS).labels;
        }
        let (labels, count) = renumbered(&labels);
        let uses = labels.into_iter().map(|kind| Use { kind, quarter: 0 });
        let (mut medoids, mut uses, mut price) = self.table.medoids(uses.collect(), count, times);
        if medoids.len() > k {
            (medoids, uses) = pruned(&self.table, &medoids, &uses, price, k);
            (medoids, uses, price) = self.table.medoids(uses, medoids.len(), times);
        }
        let types = Types {
            representatives: medoids.iter().map(|&m| self.distinct[m]).collect(),
            uses: self.group.iter().map(|&g| uses[g]).collect(),
        };
        let types = types.by_use();
        let mut triangles = vec![0.0; self.group.len()];
        for (&i, &own) in self.distinct.iter().zip(&self.table.triangles) {
            triangles[i] = own;
        }
        Priced {
            triangles: types
                .representatives
                .iter()
                .map(|&i| triangles[i])
                .collect(),
            types,
            price,
        }
    }
}

/// Triangles of a component as a template. What is left open is not cheaper: a hole counts as about the triangles that would close it.
pub(super) fn template_triangles(component: &Component) -> f64 {
    let merged = merge_coplanar(&component.mesh, COPLANAR);
    (merged.triangles.len() + repair(&component.mesh).1.open_edges) as f64
}

/// Types with what their triangles cost.
#[derive(Debug, Clone)]
pub(super) struct Priced {
    pub(super) types: Types,
    /// Triangles of each template.
    pub(super) triangles: Vec<f64>,
    pub(super) price: Price,
}

impl Priced {
    /// Types whose triangles cost nothing.
    pub(super) fn free(types: Types) -> Self {
        Self {
            triangles: vec![0.0; types.representatives.len()],
            types,
            price: Price::default(),
        }
    }

    /// True for types whose triangles cost nothing.
    pub(super) fn is_free(&self) -> bool {
        self.price == Price::default()
    }
}

/// Types from which those that are asked for are chosen, for each of them.
const SURPLUS: f64 = 2.0;
/// Share of the box within which triangles are coplanar, as where centimetres are written.
const COPLANAR: f64 = 1e-3;

impl Types {
    /// The same types, those of most uses first; those of no use are left out.
    fn by_use(self) -> Self {
        let mut counts = vec![0_usize; self.representatives.len()];
        self.uses.iter().for_each(|u| counts[u.kind] += 1);
        let mut order: Vec<usize> = (0..counts.len()).filter(|&k| counts[k] > 0).collect();
        order.sort_by_key(|&k| std::cmp::Reverse(counts[k]));
        let mut number = vec![0; counts.len()];
        order
            .iter()
            .enumerate()
            .for_each(|(new, &old)| number[old] = new);
        let renamed = |u: Use| Use {
            kind: number[u.kind],
            ..u
        };
        Self {
            representatives: order.iter().map(|&k| self.representatives[k]).collect(),
            uses: self.uses.into_iter().map(renamed).collect(),
        }
    }
}
