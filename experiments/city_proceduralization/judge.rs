//! The judges of synthesis and localization: measures of the derived triangles, not numbers that the methods report
//! themselves.

use std::collections::BTreeMap;

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

use edifice_base::rng::stream;
use edifice_city_proceduralization::localization::{
    Landmark, Seen, deviations, features, landmarks, locate,
};
use edifice_city_proceduralization::synthesis::Shape;
use edifice_grammar::instance::InstanceGrammar;
use edifice_shape::triangles::{City, TriangleMesh, VolumeRaster, surface_samples};

/// Cells in which plans are measured, in metres.
const CELL: f64 = 0.5;
/// Points on plans that tell what lies inside a shape.
const POINTS: usize = 100_000;
/// Greatest distance of buildings that stand together, in metres.
const TOGETHER: f64 = 30.0;

/// Measures of a city against the one that its grammar was made from.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Judged {
    /// Wasserstein distance over standard deviation: width, depth, height, distance to the nearest neighbour.
    pub wasserstein: [f64; 4],
    /// Jensen-Shannon divergence (base 2) of the frequencies with which types stand together.
    pub divergence: f64,
    /// The same between random halves of the original.
    pub floor: f64,
    /// The same when the types of the new city are shuffled.
    pub shuffled: f64,
    /// Share of plan area that lies under another building.
    pub overlap: f64,
    /// Share of plan area inside the shape.
    pub inside: f64,
    /// Plan area over the shape's, over the same of the original in the rectangle around it.
    pub fill: f64,
    /// Buildings.
    pub buildings: f64,
}

/// Judges `made`, a city that fills `shape`, against `original`.
pub(crate) fn judge(
    original: &InstanceGrammar,
    made: &InstanceGrammar,
    shape: &Shape,
    seed: u64,
) -> Judged {
    let mut rng = stream(seed, "city judge", 0);
    let [(old, old_kinds), (new, new_kinds)] = [original, made].map(typed);
    let [(a, ka), (b, kb)] = [(&old, &old_kinds), (&new, &new_kinds)].map(|(c, k)| {
        let (marks, index) = landmarks(c);
        let kinds: Vec<String> = index.iter().map(|&i| k[i].clone()).collect();
        (marks, kinds)
    });
    let columns = [columns(&a), columns(&b)];
    let wasserstein = std::array::from_fn(|k| {
        let spread = deviation(&columns[0][k]);
        distance(columns[0][k].clone(), columns[1][k].clone()) / spread
    });
    let whole = together(&a, &ka, &(0..a.len()).collect::<Vec<_>>());
    let mut order: Vec<usize> = (0..b.len()).collect();
    order.shuffle(&mut rng);
    let shuffled: Vec<String> = order.iter().map(|&i| kb[i].clone()).collect();
    let all: Vec<usize> = (0..b.len()).collect();
    // Halves of the original by chance squares, so that neighbours stay together.
    let side = 100.0;
    let mut coin: BTreeMap<[i64; 2], bool> = BTreeMap::new();
    let half = |l: &Landmark, coin: &mut BTreeMap<[i64; 2], bool>, rng: &mut _| {
        let key = l.at.map(|v| (v / side).floor() as i64);
        *coin
            .entry(key)
            .or_insert_with(|| Rng::next_u32(rng) & 1 == 0)
    };
    let sides: Vec<bool> = a.iter().map(|l| half(l, &mut coin, &mut rng)).collect();
    let of = |which: bool| {
        (0..a.len())
            .filter(|&i| sides[i] == which)
            .collect::<Vec<_>>()
    };
    let plans = plan_areas(&new, Some(shape));
    let old_plans = plan_areas(&old, None);
    let old_extent = extent(&a);
    Judged {
        wasserstein,
        divergence: jensen_shannon(&whole, &together(&b, &kb, &all)),
        floor: jensen_shannon(
            &together(&a, &ka, &of(true)),
            &together(&a, &ka, &of(false)),
        ),
        shuffled: jensen_shannon(&whole, &together(&b, &shuffled, &all)),
        overlap: 1.0 - plans.united / plans.sum,
        inside: plans.inside,
        fill: plans.united / shape.area() / (old_plans.united / old_extent),
        buildings: b.len() as f64,
    }
}

/// A derived city, and the symbol of each building under the axiom.
fn typed(grammar: &InstanceGrammar) -> (City, Vec<String>) {
    let derivation = grammar.derive().unwrap_or_default();
    let flat = grammar.flat(None);
    let symbols: BTreeMap<&str, &str> = (flat.top().into_iter().flat_map(|r| &r.successors))
        .filter_map(|s| Some((s.id.as_deref()?, s.symbol.as_str())))
        .collect();
    let kind = |id: &str| symbols.get(id).map_or(String::new(), |s| (*s).to_owned());
    let kinds = derivation.buildings.iter().map(|b| kind(&b.0)).collect();
    (derivation.city(grammar), kinds)
}

/// Width, depth, height, distance to the nearest neighbour.
fn columns(marks: &[Landmark]) -> [Vec<f64>; 4] {
    let nearest = |i: usize| {
        let far =
            |j: usize| (marks[i].at[0] - marks[j].at[0]).hypot(marks[i].at[1] - marks[j].at[1]);
        (0..marks.len())
            .filter(|&j| j != i)
            .map(far)
            .fold(f64::INFINITY, f64::min)
    };
    [
        marks.iter().map(|m| m.seen.width).collect(),
        marks.iter().map(|m| m.seen.depth).collect(),
        marks.iter().map(|m| m.seen.height).collect(),
        (0..marks.len()).map(nearest).collect(),
    ]
}

fn deviation(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n)
        .sqrt()
        .max(1e-9)
}

/// Wasserstein distance of two samples: mean difference of their quantiles.
fn distance(mut a: Vec<f64>, mut b: Vec<f64>) -> f64 {
    if a.is_empty() || b.is_empty() {
        return f64::INFINITY;
    }
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let steps = 4 * a.len().max(b.len());
    let at = |v: &[f64], s: usize| v[((s as f64 + 0.5) / steps as f64 * v.len() as f64) as usize];
    (0..steps)
        .map(|s| (at(&a, s) - at(&b, s)).abs())
        .sum::<f64>()
        / steps as f64
}

type Frequencies = BTreeMap<(String, String), f64>;

/// The share of each pair of types among all pairs that stand together, of some of the buildings.
fn together(marks: &[Landmark], kinds: &[String], members: &[usize]) -> Frequencies {
    let mut grid: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    let cell = |i: usize| marks[i].at.map(|v| (v / TOGETHER).floor() as i64);
    for &i in members {
        grid.entry(cell(i)).or_default().push(i);
    }
    let mut counts = Frequencies::new();
    for &i in members {
        let [x, y] = cell(i);
        let around = (-1..=1).flat_map(|u| (-1..=1).map(move |v| [x + u, y + v]));
        for &j in around
            .filter_map(|c| grid.get(&c))
            .flatten()
            .filter(|&&j| j > i)
        {
            let far = (marks[i].at[0] - marks[j].at[0]).hypot(marks[i].at[1] - marks[j].at[1]);
            if far <= TOGETHER {
                let (a, b) = (
                    kinds[i].clone().min(kinds[j].clone()),
                    kinds[i].clone().max(kinds[j].clone()),
                );
                *counts.entry((a, b)).or_default() += 1.0;
            }
        }
    }
    let total: f64 = counts.values().sum();
    counts.values_mut().for_each(|v| *v /= total.max(1.0));
    counts
}

/// Jensen-Shannon divergence in bits.
fn jensen_shannon(a: &Frequencies, b: &Frequencies) -> f64 {
    let keys: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
    let term = |p: f64, m: f64| if p > 0.0 { p * (p / m).log2() } else { 0.0 };
    let share = |key| {
        let [p, q] = [a, b].map(|f: &Frequencies| f.get(key).copied().unwrap_or(0.0));
        let m = (p + q) / 2.0;
        (term(p, m) + term(q, m)) / 2.0
    };
    keys.into_iter().map(share).sum()
}

struct Plans {
    sum: f64,
    united: f64,
    /// Share of the plans.
    inside: f64,
}

/// Plan areas, measured on a grid of prisms: each building flattened to one metre.
fn plan_areas(city: &City, shape: Option<&Shape>) -> Plans {
    let raster = VolumeRaster { size: CELL };
    let flat: Vec<TriangleMesh> = city.buildings.iter().map(|b| flattened(&b.mesh)).collect();
    let all: Vec<&TriangleMesh> = flat.iter().collect();
    let sum = flat.iter().map(|m| raster.compare(&[m], &[]).first).sum();
    let corners = flat.iter().flat_map(|m| m.corners());
    let points = surface_samples(corners, POINTS, &mut stream(1, "city plans", 0));
    let within = |p: &&[f64; 3]| shape.is_none_or(|s| s.contains([p[0], p[1]]));
    let inside = points.iter().filter(within).count() as f64 / points.len().max(1) as f64;
    Plans {
        sum,
        united: raster.compare(&all, &[]).first,
        inside,
    }
}

/// The faces of a mesh that look up, laid down at 1 m, with a floor at 0.
fn flattened(mesh: &TriangleMesh) -> TriangleMesh {
    let mut out = TriangleMesh::default();
    for t in mesh.corners() {
        if edifice_shape::triangles::plan_area(&t) > 0.0 {
            out.push(t.map(|p| [p[0], p[1], 1.0]));
        }
    }
    // The floor that open columns reach down to.
    if let Some(&[x, y, _]) = out.positions.first() {
        out.positions.push([x, y, 0.0]);
    }
    out
}

fn extent(marks: &[Landmark]) -> f64 {
    let span = |k: usize| {
        let values = marks.iter().map(|m| m.at[k]);
        let (l, h) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        h - l
    };
    (span(0) * span(1)).max(1.0)
}

/// Share of views whose place is found first. A view is a building of `truth` with those nearest to it, `seen` in all,
/// in any order; its features carry `noise`, in standard deviations. It is looked up among `known`, the same buildings
/// as the grammar gives them.
pub(crate) fn rank_one(
    truth: &[Landmark],
    known: &[Landmark],
    noise: f64,
    seen: usize,
    views: usize,
    seed: u64,
) -> f64 {
    if truth.len() < seen || truth.is_empty() {
        return 0.0;
    }
    let mut rng = stream(seed, "city views", 0);
    let scale = deviations(truth);
    let mut right = 0;
    for _ in 0..views {
        let at = rng.random_range(0..truth.len());
        let far = |j: usize| {
            let (a, b) = (truth[at].at, truth[j].at);
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let mut near: Vec<usize> = (0..truth.len()).collect();
        near.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        near.truncate(seen);
        near.shuffle(&mut rng);
        let view: Vec<Seen> = near
            .iter()
            .map(|&i| {
                let f = features(&truth[i].seen);
                let f: [f64; 4] = std::array::from_fn(|k| {
                    let z: f64 = StandardNormal.sample(&mut rng);
                    f[k] + noise * scale[k] * z
                });
                Seen {
                    width: f[0].exp(),
                    depth: f[1].exp(),
                    height: f[2].exp(),
                    solid: Some(f[3]),
                }
            })
            .collect();
        // Right is a place that sees the same buildings: neighbours of each other share their surroundings.
        let mut wanted = near.clone();
        wanted.sort_unstable();
        let best = locate(known, &view, 1);
        let mut found = best.first().map(|l| l.matched.clone()).unwrap_or_default();
        found.sort_unstable();
        right += usize::from(found == wanted);
    }
    right as f64 / views.max(1) as f64
}
