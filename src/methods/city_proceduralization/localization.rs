//! Where in the city one is, from the buildings that one sees (Fig. 10).
//!
//! A view is a set of buildings near each other, each with width, depth, height and the share of its box that is solid.
//! Every building of the city is a place to stand; what is seen there are the buildings nearest to it. The
//! cost of a place is that of the best one-to-one assignment of the view to what is seen there, by squared
//! differences of standardized features: places are compared by how the buildings look, not by their types alone, because
//! a type is all that is left of a building once it is assigned.

use rayon::prelude::*;

use crate::shape::triangles::{City, CityBuilding, OrientedBox};

/// What is measured of a building in a view: logarithms of width, depth, height; the solid share.
pub const VIEW_FEATURES: usize = 4;
/// Most buildings in a view.
pub const MOST_SEEN: usize = 10;
/// More buildings are taken as seen at a place than the view has, since the nearest ones may be hidden.
const MORE: usize = 1;

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
    /// How it looks.
    pub seen: Seen,
}

/// The landmarks of a city, with the indices of their buildings; those without triangles are left out.
pub fn landmarks(city: &City) -> (Vec<Landmark>, Vec<usize>) {
    let one = |(i, building): (usize, &CityBuilding)| {
        let frame = OrientedBox::around(&building.mesh)?;
        let [width, depth, height] = frame.size;
        let volume = building.mesh.volume_above(frame.base[2]);
        let seen = Seen {
            width,
            depth,
            height,
            solid: Some((volume / frame.volume()).clamp(0.0, 1.0)),
        };
        let at = [frame.base[0], frame.base[1]];
        Some((Landmark { at, seen }, i))
    };
    let found: Vec<Option<(Landmark, usize)>> =
        city.buildings.par_iter().enumerate().map(one).collect();
    found.into_iter().flatten().unzip()
}

/// A place where the view may have been taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// The landmark nearest to it.
    pub landmark: usize,
    /// Mean squared difference of standardized features.
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
    let rows: Vec<[f64; VIEW_FEATURES]> = landmarks.iter().map(|l| features(&l.seen)).collect();
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
    let index = Nearest::new(landmarks);
    let shown = (view.len() + MORE).min(landmarks.len());
    let mut found: Vec<Located> = (0..landmarks.len())
        .into_par_iter()
        .map(|i| {
            let near = index.nearest(landmarks, i, shown);
            let cost = |q: usize, n: usize| {
                let terms = (0..VIEW_FEATURES).map(|k| (wanted[q][k] - own[near[n]][k]) / scale[k]);
                terms.filter(|t| t.is_finite()).map(|t| t * t).sum::<f64>()
            };
            let (cost, matched) = assign(view.len(), near.len(), cost);
            Located {
                landmark: i,
                cost: cost / (view.len() * VIEW_FEATURES) as f64,
                matched: matched.into_iter().map(|n| near[n]).collect(),
            }
        })
        .collect();
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(a.landmark.cmp(&b.landmark)));
    found.truncate(top);
    found
}

/// The cheapest assignment of `rows` rows to different ones of `columns` columns, by dynamic programming over sets
/// of columns.
fn assign(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> (f64, Vec<usize>) {
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
            let (next, now) = (set | 1 << c, best[set] + cost(row, c));
            if now < best[next] {
                best[next] = now;
                last[next] = c;
            }
        }
    }
    let full = (0..sets).filter(|s| s.count_ones() as usize == rows);
    let Some(mut set) = full.min_by(|&a, &b| best[a].total_cmp(&best[b])) else {
        return (f64::INFINITY, Vec::new());
    };
    let total = best[set];
    let mut matched = vec![0; rows];
    for row in (0..rows).rev() {
        matched[row] = last[set];
        set &= !(1 << last[set]);
    }
    (total, matched)
}

/// Landmarks on a grid.
struct Nearest {
    cell: f64,
    grid: rustc_hash::FxHashMap<[i64; 2], Vec<usize>>,
    widest: i64,
}

impl Nearest {
    fn new(landmarks: &[Landmark]) -> Self {
        let bound = |k: usize, pick: fn(f64, f64) -> f64, from: f64| {
            landmarks.iter().map(|l| l.at[k]).fold(from, pick)
        };
        let extent = |k| bound(k, f64::max, f64::NEG_INFINITY) - bound(k, f64::min, f64::INFINITY);
        let area = extent(0).max(1.0) * extent(1).max(1.0);
        let cell = (2.0 * area / landmarks.len().max(1) as f64).sqrt().max(1.0);
        let mut grid: rustc_hash::FxHashMap<[i64; 2], Vec<usize>> = Default::default();
        for (i, l) in landmarks.iter().enumerate() {
            let key = l.at.map(|v| (v / cell).floor() as i64);
            grid.entry(key).or_default().push(i);
        }
        let widest = (extent(0).max(extent(1)) / cell) as i64 + 2;
        Self { cell, grid, widest }
    }

    /// The `count` landmarks nearest to landmark `i`, itself the first.
    fn nearest(&self, landmarks: &[Landmark], i: usize, count: usize) -> Vec<usize> {
        let at = landmarks[i].at;
        let [x, y] = at.map(|v| (v / self.cell).floor() as i64);
        let far = |j: usize| (landmarks[j].at[0] - at[0]).hypot(landmarks[j].at[1] - at[1]);
        let mut near: Vec<(f64, usize)> = Vec::new();
        for ring in 0..=self.widest {
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
        for a in 0..4 {
            for b in (0..4).filter(|b| *b != a) {
                for c in (0..4).filter(|c| *c != a && *c != b) {
                    least = least.min(cost(0, a) + cost(1, b) + cost(2, c));
                }
            }
        }
        let (found, matched) = assign(3, 4, cost);
        assert_eq!(found, least);
        let sum: f64 = matched.iter().enumerate().map(|(r, &c)| cost(r, c)).sum();
        assert_eq!(sum, least);
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
