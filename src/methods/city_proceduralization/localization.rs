//! Localization: the place in the city from which some buildings are seen (Fig. 10).
//!
//! A view is a set of buildings near each other, each with width, depth, height and the share of its box that is solid.
//! Every building of the city is a place to stand; what is seen there are the buildings nearest to it. The
//! cost of a place is that of the best one-to-one assignment of the view to what is seen there, by
//! differences of standardized features under a heavy-tailed loss: places are compared by how the buildings look, not by their types alone, because
//! a type is all that is left of a building once it is assigned.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::facades::{FACADE_FEATURES, Facade, WINDOWS};
use edifice_shape::triangles::{City, CityBuilding, OrientedBox, TriangleMesh};

/// Number of features of a building in a view: logarithms of width, depth and height; the solid share.
pub const VIEW_FEATURES: usize = 4;
/// Most buildings in a view.
pub const MOST_SEEN: usize = 10;
/// More buildings are taken as seen at a place than the view has, since the nearest ones may be hidden.
const MORE: usize = 1;
/// Scale of Cauchy's distribution of differences, in standard deviations of a feature.
const SPREAD: f64 = 0.1;
/// Cost of a building that is nearer than others in the view and hidden: its chance is e^-HIDDEN.
const HIDDEN: f64 = 2.0;
/// Greys of a facade's cells are known so well.
const CELL_PRECISION: f64 = 0.02;
/// Standard deviations that a facade with windows and one without are apart in what only one has.
const UNLIKE: f64 = 3.0;

/// A building as it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Width in metres.
    pub width: f64,
    /// Depth in metres.
    pub depth: f64,
    /// Height in metres.
    pub height: f64,
    /// Share of its box that is solid; `None` where the view does not tell.
    pub solid: Option<f64>,
}

/// A building of the city.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmark {
    /// Middle of its plan.
    pub at: [f64; 2],
    /// Its size and solid share, as a view shows them.
    pub seen: Seen,
}

/// The landmarks of a city, with the indices of their buildings; those without triangles are left out.
pub fn landmarks(city: &City) -> (Vec<Landmark>, Vec<usize>) {
    let one = |(i, b): (usize, &CityBuilding)| Some((landmark(&b.mesh)?, i));
    let found: Vec<Option<(Landmark, usize)>> =
        city.buildings.par_iter().enumerate().map(one).collect();
    found.into_iter().flatten().unzip()
}

/// A building as a landmark; `None` without positions.
pub(super) fn landmark(mesh: &TriangleMesh) -> Option<Landmark> {
    let frame = OrientedBox::around(mesh)?;
    let [width, depth, height] = frame.size;
    let volume = mesh.volume_above(frame.base[2]);
    Some(Landmark {
        at: [frame.base[0], frame.base[1]],
        seen: Seen {
            width,
            depth,
            height,
            solid: Some((volume / frame.volume()).clamp(0.0, 1.0)),
        },
    })
}

/// A place where the view may have been taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// The landmark nearest to it.
    pub landmark: usize,
    /// Mean over the features of the view of ln(1 + (d / 0.1)²), d the difference in standard deviations; a building that is
    /// nearer and not in the view adds to it.
    pub cost: f64,
    /// The landmark of each building in the view.
    pub matched: Vec<usize>,
}

/// The features of a building; a share that is not told is not a number.
pub fn features(seen: &Seen) -> [f64; VIEW_FEATURES] {
    let log = |v: f64| v.max(1e-3).ln();
    [
        log(seen.width),
        log(seen.depth),
        log(seen.height),
        seen.solid.unwrap_or(f64::NAN),
    ]
}

/// Standard deviations of features over the city; 1 where all are equal.
pub fn deviations(landmarks: &[Landmark]) -> [f64; VIEW_FEATURES] {
    deviations_of(landmarks.iter().map(|l| features(&l.seen)).collect())
}

fn deviations_of<const N: usize>(rows: Vec<[f64; N]>) -> [f64; N] {
    std::array::from_fn(|k| {
        let own = || rows.iter().map(|r| r[k]).filter(|v| v.is_finite());
        let n = own().count().max(1) as f64;
        let mean = own().sum::<f64>() / n;
        let variance = own().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        if variance > 0.0 { variance.sqrt() } else { 1.0 }
    })
}

/// The `top` places where `view` fits best, the best first. At most [`MOST_SEEN`] buildings of the view are used.
///
/// O(n (log n + 2^s s)) for n landmarks and s buildings in the view.
pub fn locate(landmarks: &[Landmark], view: &[Seen], top: usize) -> Vec<Located> {
    let view = &view[..view.len().min(MOST_SEEN)];
    if view.is_empty() || landmarks.len() < view.len() {
        return Vec::new();
    }
    let scale = deviations(landmarks);
    let wanted: Vec<[f64; VIEW_FEATURES]> = view.iter().map(features).collect();
    let own: Vec<[f64; VIEW_FEATURES]> = landmarks.iter().map(|l| features(&l.seen)).collect();
    let cost = |q: usize, l: usize| {
        let terms = (0..VIEW_FEATURES).map(|k| (wanted[q][k] - own[l][k]) / scale[k]);
        terms.filter(|t| t.is_finite()).map(lost).sum::<f64>()
    };
    places(landmarks, [view.len(), VIEW_FEATURES], top, cost)
}

/// As [`locate`], from rectified photographs of facades of buildings near each other: a building costs what the facade of it does
/// that is most like the photograph. `facades`: those of each landmark ([`super::facades::facades`]).
pub fn locate_facades(
    landmarks: &[Landmark],
    facades: &[Vec<Facade>],
    view: &[Facade],
    top: usize,
) -> Vec<Located> {
    let view = &view[..view.len().min(MOST_SEEN)];
    if view.is_empty() || landmarks.len() < view.len() {
        return Vec::new();
    }
    let mut scale = deviations_of(facades.iter().flatten().copied().collect());
    // Where all facades are alike, what drawing them in pixels changes must not decide.
    for cell in &mut scale[WINDOWS..] {
        *cell = cell.max(CELL_PRECISION / SPREAD);
    }
    let apart = |a: &Facade, b: &Facade| {
        let term = |k: usize| match (a[k].is_finite(), b[k].is_finite()) {
            (true, true) => lost((a[k] - b[k]) / scale[k]),
            (false, false) => 0.0,
            _ => lost(UNLIKE),
        };
        (0..FACADE_FEATURES).map(term).sum::<f64>()
    };
    let none = FACADE_FEATURES as f64 * lost(UNLIKE);
    let cost = |q: usize, l: usize| {
        let sides = facades[l].iter().map(|f| apart(&view[q], f));
        sides.fold(none, f64::min)
    };
    places(landmarks, [view.len(), FACADE_FEATURES], top, cost)
}

/// The `top` places at which `count` things in view, which `cost` compares with landmarks, fit best; costs are told by thing and
/// feature.
fn places(
    landmarks: &[Landmark],
    [count, features]: [usize; 2],
    top: usize,
    cost: impl Fn(usize, usize) -> f64 + Sync,
) -> Vec<Located> {
    let index = Nearest::new(landmarks);
    let shown = (count + MORE).min(landmarks.len());
    let mut found: Vec<Located> = (0..landmarks.len())
        .into_par_iter()
        .map(|i| {
            let near = index.nearest(landmarks, i, shown);
            let (cost, matched) = assign(count, near.len(), |q, n| cost(q, near[n]));
            Located {
                landmark: i,
                cost: cost / (count * features) as f64,
                matched: matched.into_iter().map(|n| near[n]).collect(),
            }
        })
        .collect();
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(a.landmark.cmp(&b.landmark)));
    one_place_each(landmarks, found, top)
}

/// Cost of a difference of a standardized feature: the negative logarithm of Cauchy's density. A template's solid share may
/// be far from that of the building it stands for; such a difference must not outweigh all others.
fn lost(difference: f64) -> f64 {
    (difference / SPREAD).powi(2).ln_1p()
}

/// The `top` first of `found`, of the places where the same buildings are seen only the one nearest to them.
fn one_place_each(landmarks: &[Landmark], found: Vec<Located>, top: usize) -> Vec<Located> {
    let mut index: FxHashMap<Vec<usize>, usize> = FxHashMap::default();
    let mut places: Vec<(f64, Located)> = Vec::new();
    for place in found {
        let from = landmarks[place.landmark].at;
        let far = |&l: &usize| {
            let at = landmarks[l].at;
            (at[0] - from[0]).hypot(at[1] - from[1])
        };
        let away: f64 = place.matched.iter().map(far).sum();
        let mut seen = place.matched.clone();
        seen.sort_unstable();
        match index.get(&seen) {
            Some(&known) => {
                let better = away < places[known].0;
                if better {
                    places[known] = (away, place);
                }
            }
            None if places.len() < top => {
                index.insert(seen, places.len());
                places.push((away, place));
            }
            None => {}
        }
    }
    places.into_iter().map(|p| p.1).collect()
}

/// The cheapest assignment of `rows` rows to different ones of `columns` columns, the nearest first, by dynamic programming over
/// sets of columns; passing over a column before the last one used costs [`HIDDEN`].
fn assign(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> (f64, Vec<usize>) {
    let costs: Vec<Vec<f64>> = (0..rows)
        .map(|r| (0..columns).map(|c| cost(r, c)).collect())
        .collect();
    let sets = 1usize << columns;
    let mut best = vec![f64::INFINITY; sets];
    let mut last = vec![usize::MAX; sets];
    best[0] = 0.0;
    for set in 0..sets {
        let row = set.count_ones() as usize;
        if row >= rows || !best[set].is_finite() {
            continue;
        }
        for c in (0..columns).filter(|c| set >> c & 1 == 0) {
            let (next, now) = (set | 1 << c, best[set] + costs[row][c]);
            if now < best[next] {
                best[next] = now;
                last[next] = c;
            }
        }
    }
    let full = (0..sets).filter(|s| s.count_ones() as usize == rows);
    // Columns passed over before the last one used.
    let hidden = |set: usize| (set.ilog2() as usize + 1).saturating_sub(rows) as f64;
    let whole = |set: usize| best[set] + HIDDEN * hidden(set);
    let Some(mut set) = full.min_by(|&a, &b| whole(a).total_cmp(&whole(b))) else {
        return (f64::INFINITY, Vec::new());
    };
    let total = whole(set);
    let mut matched = vec![0; rows];
    for row in (0..rows).rev() {
        matched[row] = last[set];
        set &= !(1 << last[set]);
    }
    (total, matched)
}

/// Landmarks on a grid.
pub(super) struct Nearest {
    cell: f64,
    grid: FxHashMap<[i64; 2], Vec<usize>>,
    widest: i64,
}

impl Nearest {
    pub(super) fn new(landmarks: &[Landmark]) -> Self {
        let bound = |k: usize, pick: fn(f64, f64) -> f64, from: f64| {
            landmarks.iter().map(|l| l.at[k]).fold(from, pick)
        };
        let extent = |k| bound(k, f64::max, f64::NEG_INFINITY) - bound(k, f64::min, f64::INFINITY);
        let area = extent(0).max(1.0) * extent(1).max(1.0);
        let cell = (2.0 * area / landmarks.len().max(1) as f64).sqrt().max(1.0);
        let mut grid: FxHashMap<[i64; 2], Vec<usize>> = Default::default();
        for (i, l) in landmarks.iter().enumerate() {
            let key = l.at.map(|v| (v / cell).floor() as i64);
            grid.entry(key).or_default().push(i);
        }
        let widest = (extent(0).max(extent(1)) / cell) as i64 + 2;
        Self { cell, grid, widest }
    }

    /// The `count` landmarks nearest to landmark `i`, itself the first.
    pub(super) fn nearest(&self, landmarks: &[Landmark], i: usize, count: usize) -> Vec<usize> {
        let at = landmarks[i].at;
        let [x, y] = at.map(|v| (v / self.cell).floor() as i64);
        let far = |j: usize| (landmarks[j].at[0] - at[0]).hypot(landmarks[j].at[1] - at[1]);
        let mut near: Vec<(f64, usize)> = Vec::new();
        for ring in 0..=self.widest {
            // Where one stands far from the others, looking at all is shorter than looking at all rings between.
            if (2 * ring + 1).saturating_mul(2 * ring + 1) > 4 * landmarks.len() as i64 + 9 {
                near = (0..landmarks.len()).map(|j| (far(j), j)).collect();
                break;
            }
            let edge = |d: i64| d.abs() == ring;
            let cells = (-ring..=ring).flat_map(|u| (-ring..=ring).map(move |v| (u, v)));
            for (u, v) in cells.filter(|&(u, v)| edge(u) || edge(v)) {
                let members = self.grid.get(&[x + u, y + v]).into_iter().flatten();
                near.extend(members.map(|&j| (far(j), j)));
            }
            // Nothing outside the rings seen is nearer than this.
            let sure = ring as f64 * self.cell;
            if near.iter().filter(|n| n.0 <= sure).count() >= count {
                break;
            }
        }
        near.sort_by(|a, b| {
            a.0.total_cmp(&b.0)
                .then((a.1 != i).cmp(&(b.1 != i)))
                .then(a.1.cmp(&b.1))
        });
        near.truncate(count);
        near.into_iter().map(|n| n.1).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assignment_is_that_of_all_permutations() {
        let cost = |r: usize, c: usize| ((r * 7 + c * c * 3 + r * c * 5) % 11) as f64;
        let mut least = f64::INFINITY;
        let passed = |last: usize| HIDDEN * (last as f64 - 2.0);
        for a in 0..4 {
            for b in (0..4).filter(|b| *b != a) {
                for c in (0..4).filter(|c| *c != a && *c != b) {
                    let last = a.max(b).max(c);
                    least = least.min(cost(0, a) + cost(1, b) + cost(2, c) + passed(last));
                }
            }
        }
        let (found, matched) = assign(3, 4, cost);
        assert_eq!(found, least);
        let sum: f64 = matched.iter().enumerate().map(|(r, &c)| cost(r, c)).sum();
        let last = matched.iter().max().unwrap();
        assert_eq!(sum + passed(*last), least);
    }

    #[test]
    fn a_pyramid_fills_a_third_of_its_box() {
        let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]];
        let mut positions = corners.map(|[x, y]| [x, y, 2.0]).to_vec();
        positions.push([3.0, 2.0, 11.0]);
        let mut triangles: Vec<[u32; 3]> = (0..4).map(|i| [i, (i + 1) % 4, 4]).collect();
        triangles.extend([[0, 2, 1], [0, 3, 2]]);
        let mesh = TriangleMesh {
            positions,
            triangles,
        };
        let seen = landmark(&mesh).unwrap().seen;
        assert!((seen.solid.unwrap() - 1.0 / 3.0).abs() < 1e-9, "{seen:?}");
        assert!((seen.width - 6.0).abs() < 1e-9 && (seen.height - 9.0).abs() < 1e-9);
    }

    #[test]
    fn the_nearest_are_the_nearest() {
        let landmarks: Vec<Landmark> = (0..60)
            .map(|i| Landmark {
                at: [f64::from(i * 37 % 61) * 3.0, f64::from(i * 11 % 59) * 5.0],
                seen: Seen {
                    width: 1.0,
                    depth: 1.0,
                    height: 1.0,
                    solid: None,
                },
            })
            .collect();
        let index = Nearest::new(&landmarks);
        for i in 0..60 {
            let far = |j: &usize| {
                let (a, b) = (landmarks[i].at, landmarks[*j].at);
                (a[0] - b[0]).hypot(a[1] - b[1])
            };
            let mut slow: Vec<usize> = (0..60).collect();
            slow.sort_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
            let found = index.nearest(&landmarks, i, 7);
            assert_eq!(
                found.iter().map(far).collect::<Vec<_>>(),
                slow[..7].iter().map(far).collect::<Vec<_>>()
            );
        }
    }
}
