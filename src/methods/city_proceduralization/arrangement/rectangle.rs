//! Rectangles of buildings in the plan, and pairs of them that are near each other.

use rustc_hash::FxHashMap;

/// Side of the cells by which neighbours are found, in metres.
const CELL: f64 = 40.0;
/// Rectangles of larger extents, in metres, have no neighbours: they would be in too many cells.
const LARGEST: f64 = 4000.0;
/// Cells beyond are not told apart.
const FARTHEST: f64 = 1e12;

/// A rectangle in the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub(super) at: [f64; 2],
    /// Degrees.
    pub(super) turn: f64,
    /// Half its width and depth.
    pub(super) half: [f64; 2],
}

impl Rectangle {
    /// Unit vectors along its width and its depth.
    fn axes(&self) -> [[f64; 2]; 2] {
        let (sin, cos) = self.turn.to_radians().sin_cos();
        [[cos, sin], [-sin, cos]]
    }

    /// The place of another one's middle in the frame of this one.
    pub(super) fn own(&self, other: &Self) -> [f64; 2] {
        let away = [0, 1].map(|k| other.at[k] - self.at[k]);
        self.axes().map(|a| a[0] * away[0] + a[1] * away[1])
    }

    fn corners(&self) -> [[f64; 2]; 4] {
        let [u, v] = self.axes();
        let [w, d] = self.half;
        [[w, d], [-w, d], [-w, -d], [w, -d]]
            .map(|[x, y]| [0, 1].map(|k| self.at[k] + x * u[k] + y * v[k]))
    }

    /// Metres from this one to another; 0 where they overlap.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let outside = |one: &Self, corners: &[[f64; 2]; 4]| {
            (0..2).any(|k| {
                let axis = one.axes()[k];
                let along =
                    |p: &[f64; 2]| (p[0] - one.at[0]) * axis[0] + (p[1] - one.at[1]) * axis[1];
                corners.iter().all(|p| along(p) > one.half[k])
                    || corners.iter().all(|p| along(p) < -one.half[k])
            })
        };
        let (a, b) = (self.corners(), other.corners());
        if !outside(self, &b) && !outside(other, &a) {
            return 0.0;
        }
        // Of two convex shapes apart, a corner of one is nearest to a point of the other.
        let far = |one: &Self, p: &[f64; 2]| {
            let away = [p[0] - one.at[0], p[1] - one.at[1]];
            let [x, y] = [0, 1].map(|k| {
                let axis = one.axes()[k];
                let along = away[0] * axis[0] + away[1] * axis[1];
                (along.abs() - one.half[k]).max(0.0)
            });
            x.hypot(y)
        };
        let own = b.iter().map(|p| far(self, p));
        own.chain(a.iter().map(|p| far(other, p)))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Pairs of rectangles at most `reach` metres apart, the smaller index first.
pub(super) fn near(plan: &[Rectangle], reach: f64) -> Vec<[usize; 2]> {
    let mut cells: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
    let mut out = Vec::new();
    for (j, r) in plan.iter().enumerate() {
        let corners = r.corners();
        let bound = |axis: usize| {
            let values = || corners.iter().map(|p| p[axis]);
            let low = values().fold(f64::INFINITY, f64::min) - reach / 2.0;
            [
                low,
                values().fold(f64::NEG_INFINITY, f64::max) + reach / 2.0,
            ]
        };
        let [x, y] = [bound(0), bound(1)];
        let usable = |b: [f64; 2]| b[1] - b[0] <= LARGEST && b[0].abs() <= FARTHEST;
        if !(usable(x) && usable(y)) {
            continue;
        }
        let [x, y] = [x, y].map(|b| b.map(|v| (v / CELL).floor() as i64));
        let mut known: Vec<usize> = Vec::new();
        for cx in x[0]..=x[1] {
            for cy in y[0]..=y[1] {
                let list = cells.entry([cx, cy]).or_default();
                known.extend(list.iter());
                list.push(j);
            }
        }
        known.sort_unstable();
        known.dedup();
        known.retain(|&i| plan[i].distance(r) <= reach);
        out.extend(known.into_iter().map(|i| [i, j]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::RngExt;

    /// Distances of points on the outlines, which are not below and hardly above the distance.
    #[test]
    fn distances_are_those_of_sampled_outlines() {
        let mut rng = stream(3, "rectangles", 0);
        for _ in 0..300 {
            let mut one = || Rectangle {
                at: [rng.random_range(-20.0..20.0), rng.random_range(-20.0..20.0)],
                turn: rng.random_range(0.0..360.0),
                half: [rng.random_range(0.5..8.0), rng.random_range(0.5..8.0)],
            };
            let (a, b) = (one(), one());
            let outline = |r: &Rectangle| -> Vec<[f64; 2]> {
                let corners = r.corners();
                let on = |i: usize| {
                    let (p, q) = (corners[i / 60], corners[(i / 60 + 1) % 4]);
                    let t = (i % 60) as f64 / 60.0;
                    [0, 1].map(|k| p[k] + t * (q[k] - p[k]))
                };
                (0..240).map(on).collect()
            };
            let (p, q) = (outline(&a), outline(&b));
            let pairs = p.iter().flat_map(|p| q.iter().map(move |q| (p, q)));
            let sampled = pairs
                .map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]))
                .fold(f64::INFINITY, f64::min);
            let distance = a.distance(&b);
            assert!((a.distance(&b) - b.distance(&a)).abs() < 1e-9);
            if distance > 0.0 {
                assert!(distance <= sampled + 1e-9 && sampled < distance + 0.4);
            } else {
                let inside = |r: &Rectangle, p: &[f64; 2]| {
                    let at = Rectangle { at: *p, ..*r };
                    let own = r.own(&at);
                    (0..2).all(|k| own[k].abs() <= r.half[k] + 0.3)
                };
                assert!(p.iter().any(|p| inside(&b, p)) || q.iter().any(|q| inside(&a, q)));
            }
        }
    }

    #[test]
    fn all_pairs_that_are_near_are_found() {
        let mut rng = stream(4, "rectangles", 0);
        let mut one = |_| Rectangle {
            at: [rng.random_range(0.0..400.0), rng.random_range(0.0..400.0)],
            turn: rng.random_range(0.0..360.0),
            half: [rng.random_range(1.0..30.0), rng.random_range(1.0..9.0)],
        };
        let plan: Vec<Rectangle> = (0..200).map(&mut one).collect();
        let mut all = Vec::new();
        for j in 0..plan.len() {
            all.extend(
                (0..j)
                    .filter(|&i| plan[i].distance(&plan[j]) <= 8.0)
                    .map(|i| [i, j]),
            );
        }
        let mut found = near(&plan, 8.0);
        found.sort_unstable();
        all.sort_unstable();
        assert!(all.len() > 100);
        assert_eq!(found, all);
    }
}
