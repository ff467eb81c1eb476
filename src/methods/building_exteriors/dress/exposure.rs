//! Free places on walls: no other building stands before them.

use std::collections::HashMap;

use edifice_shape::triangles::{Corners, TriangleMesh, normal};

use super::walls::WallFace;

/// Side of the squares in which roofs are looked up (m).
const SQUARE: f64 = 4.0;
/// Distance before a wall that must be free (m).
const BEFORE: f64 = 0.4;
/// Largest number of squares that one triangle is entered in.
const MOST: i64 = 4096;

/// The roofs of a city, by the squares that they lie over.
pub(super) struct Roofs {
    triangles: Vec<(u32, Corners)>,
    squares: HashMap<(i64, i64), Vec<u32>>,
}

impl Roofs {
    /// Enters all triangles that are not upright.
    pub(super) fn new<'a>(city: impl Iterator<Item = &'a TriangleMesh>) -> Self {
        let mut all = Self {
            triangles: Vec::new(),
            squares: HashMap::new(),
        };
        for (number, mesh) in city.enumerate() {
            for t in mesh.corners().filter(|t| normal(t)[2] != 0.0) {
                all.enter(number as u32, t);
            }
        }
        all
    }

    fn enter(&mut self, building: u32, t: Corners) {
        let range = |i: usize| {
            let of = |f: fn(f64, f64) -> f64, start| t.iter().map(|p| p[i]).fold(start, f);
            let low = (of(f64::min, f64::INFINITY) / SQUARE).floor();
            let high = (of(f64::max, f64::NEG_INFINITY) / SQUARE).floor();
            (low.abs() < 1e9 && high.abs() < 1e9).then_some(low as i64..=high as i64)
        };
        let (Some(xs), Some(ys)) = (range(0), range(1)) else {
            return;
        };
        if (xs.end() - xs.start() + 1).saturating_mul(ys.end() - ys.start() + 1) > MOST {
            return;
        }
        for x in xs {
            for y in ys.clone() {
                let own = self.squares.entry((x, y)).or_default();
                own.push(self.triangles.len() as u32);
            }
        }
        self.triangles.push((building, t));
    }

    /// The heights of the roofs that lie over a point in plan, with their buildings.
    fn at(&self, p: [f64; 3]) -> impl Iterator<Item = (u32, f64)> {
        let square = |v: f64| (v / SQUARE).floor() as i64;
        let near = self.squares.get(&(square(p[0]), square(p[1])));
        let near = near.into_iter().flatten();
        near.filter_map(move |&k| {
            let (building, t) = &self.triangles[k as usize];
            Some((*building, height(t, p)?))
        })
    }

    /// True if a building's own roof lies over the point.
    pub(super) fn covers(&self, building: usize, p: [f64; 3]) -> bool {
        self.at(p).any(|(b, z)| b as usize == building && z > p[2])
    }

    /// Notes on each wall how high other buildings stand before it.
    pub(super) fn note(&self, building: usize, walls: &mut [WallFace]) {
        for face in walls {
            let columns = face.columns();
            let highest = |u: f64| {
                let p = face.place([u, 0.0], -BEFORE);
                let others = self.at(p).filter(|(b, _)| *b as usize != building);
                others.map(|(_, z)| z).fold(f64::NEG_INFINITY, f64::max)
            };
            face.before = columns.map(highest).collect();
        }
    }
}

/// Height of a triangle at a point in plan, if it lies over or under it.
fn height(t: &Corners, p: [f64; 3]) -> Option<f64> {
    let cross = |i: usize, j: usize| {
        let (a, b) = (t[i], t[j]);
        (a[0] - p[0]) * (b[1] - p[1]) - (a[1] - p[1]) * (b[0] - p[0])
    };
    let weights = [cross(1, 2), cross(2, 0), cross(0, 1)];
    let total: f64 = weights.iter().sum();
    let inside = weights.iter().all(|w| w * total >= 0.0) && total != 0.0;
    inside.then(|| (0..3).map(|i| weights[i] / total * t[i][2]).sum())
}
