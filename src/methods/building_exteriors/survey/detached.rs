//! Which buildings of a city touch a larger neighbour.

use std::collections::HashMap;

use super::surfaces::{is_wall, plan_area};
use edifice_shape::triangles::{TriangleMesh, normal};
use edifice_shape::vec3::norm;

/// Walls nearer than this touch (m); neighbours of a smaller plan (square metres) are sheds, which do not count.
const TOUCHES: f64 = 0.4;
const SHED: f64 = 30.0;
/// Side of the squares in which walls are looked up (m).
const SQUARE: f64 = 4.0;

/// A stretch of wall in plan.
type Stretch = [[f64; 2]; 2];

/// For each building whether a wall of another one of more than 30 square metres lies within 0.4 m. Walls are looked up
/// in a grid: time is linear in walls for a city of usual density.
pub fn attached(meshes: &[&TriangleMesh]) -> Vec<bool> {
    let walls: Vec<Vec<Stretch>> = meshes.iter().map(|m| stretches(m)).collect();
    let large: Vec<bool> = meshes.iter().map(|m| plan_area(m) > SHED).collect();
    let mut grid: HashMap<(i64, i64), Vec<(u32, u32)>> = HashMap::new();
    for (b, own) in walls.iter().enumerate().filter(|(b, _)| large[*b]) {
        for (k, stretch) in own.iter().enumerate() {
            for square in squares(stretch) {
                grid.entry(square).or_default().push((b as u32, k as u32));
            }
        }
    }
    let touches = |b: usize| {
        walls[b].iter().any(|stretch| {
            squares(stretch).iter().any(|square| {
                let near = grid.get(square).into_iter().flatten();
                near.filter(|(o, _)| *o as usize != b)
                    .any(|(o, k)| distance(stretch, &walls[*o as usize][*k as usize]) < TOUCHES)
            })
        })
    };
    (0..meshes.len()).map(touches).collect()
}

/// The walls of a mesh in plan, each once.
fn stretches(mesh: &TriangleMesh) -> Vec<Stretch> {
    let mut out: Vec<Stretch> = Vec::new();
    for t in mesh.corners() {
        let n = normal(&t);
        let length = norm(n);
        if length == 0.0 || !is_wall(n, length) {
            continue;
        }
        // An upright triangle seen from above is a line: its longest side.
        let ends = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| [[t[i][0], t[i][1]], [t[j][0], t[j][1]]]);
        let long = |s: &Stretch| (s[0][0] - s[1][0]).hypot(s[0][1] - s[1][1]);
        if let Some(stretch) = ends.into_iter().max_by(|a, b| long(a).total_cmp(&long(b))) {
            let whole = stretch
                .iter()
                .flatten()
                .all(|v| v.is_finite() && v.abs() < 1e9);
            if whole && long(&stretch) < 1e3 && !out.contains(&stretch) {
                out.push(stretch);
            }
        }
    }
    out
}

/// Squares that a stretch, widened by the distance of touching, may lie in.
fn squares(s: &Stretch) -> Vec<(i64, i64)> {
    let pieces = ((s[0][0] - s[1][0]).hypot(s[0][1] - s[1][1]) / SQUARE)
        .ceil()
        .max(1.0);
    let mut out = Vec::new();
    let at = |share: f64| [0, 1].map(|k| s[0][k] + share * (s[1][k] - s[0][k]));
    for i in 0..pieces as usize {
        let (a, b) = (at(i as f64 / pieces), at((i + 1) as f64 / pieces));
        let range = |k: usize| {
            let low = (a[k].min(b[k]) - TOUCHES) / SQUARE;
            let high = (a[k].max(b[k]) + TOUCHES) / SQUARE;
            low.floor() as i64..=high.floor() as i64
        };
        for x in range(0) {
            out.extend(range(1).map(|y| (x, y)));
        }
    }
    out.sort_unstable();
    out.dedup();
    out
}

/// Distance between two stretches.
fn distance(a: &Stretch, b: &Stretch) -> f64 {
    if cross(a, b) {
        return 0.0;
    }
    let ends = [
        to_point(a, b[0]),
        to_point(a, b[1]),
        to_point(b, a[0]),
        to_point(b, a[1]),
    ];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

fn to_point(s: &Stretch, p: [f64; 2]) -> f64 {
    let d = [s[1][0] - s[0][0], s[1][1] - s[0][1]];
    let length = d[0] * d[0] + d[1] * d[1];
    let along = ((p[0] - s[0][0]) * d[0] + (p[1] - s[0][1]) * d[1]) / length.max(1e-12);
    let share = along.clamp(0.0, 1.0);
    (p[0] - s[0][0] - share * d[0]).hypot(p[1] - s[0][1] - share * d[1])
}

fn cross(a: &Stretch, b: &Stretch) -> bool {
    let side = |s: &Stretch, p: [f64; 2]| {
        (s[1][0] - s[0][0]) * (p[1] - s[0][1]) - (s[1][1] - s[0][1]) * (p[0] - s[0][0])
    };
    side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0
}
