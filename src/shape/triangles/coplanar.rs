//! The same surface with fewer triangles: neighbouring coplanar triangles are joined into polygons,
//! corners in the middle of straight edges dropped, and the polygons triangulated anew.

use rustc_hash::FxHashMap;

use super::TriangleMesh;
use super::mesh::normal;
use super::triangulate::{nest, ring_area, triangles};
use crate::vec3::{cross, dot, norm, sub};

/// Merges coplanar neighbours: joined are triangles that share an edge and whose corners lie within
/// `tolerance` metres of the plane of the first. A region whose outline cannot be triangulated to the same
/// area stays as it was. Straight runs of the outline lose their inner corners, so that neighbouring
/// regions need not share every corner any more: the surface stays closed up to `tolerance`.
pub fn merge_coplanar(mesh: &TriangleMesh, tolerance: f64) -> TriangleMesh {
    let mesh = &distinct(mesh);
    let neighbours = neighbours(&mesh.triangles);
    let at = |i: u32| mesh.positions[i as usize];
    let mut region = vec![usize::MAX; mesh.triangles.len()];
    let mut out = TriangleMesh::default();
    for start in 0..mesh.triangles.len() {
        if region[start] != usize::MAX {
            continue;
        }
        let corners = mesh.triangles[start].map(at);
        let n = normal(&corners);
        let length = norm(n);
        if length == 0.0 {
            continue;
        }
        let n = n.map(|v| v / length);
        let mut members = vec![start];
        region[start] = start;
        let mut next = 0;
        while next < members.len() {
            for &other in &neighbours[members[next]] {
                let t = mesh.triangles[other].map(at);
                let flat = |p: &[f64; 3]| dot(sub(*p, corners[0]), n).abs() <= tolerance;
                let m = normal(&t);
                if region[other] == usize::MAX && t.iter().all(flat) && dot(m, n) > 0.9 * norm(m) {
                    region[other] = start;
                    members.push(other);
                }
            }
            next += 1;
        }
        let merged = (members.len() > 1)
            .then(|| outline(mesh, &members, n, tolerance))
            .flatten();
        match merged {
            Some(triangles) if triangles.len() < members.len() => {
                triangles.into_iter().for_each(|t| out.push(t));
            }
            _ => members
                .iter()
                .for_each(|&m| out.push(mesh.triangles[m].map(at))),
        }
    }
    out.welded(tolerance.min(1e-6))
}

/// Without triangles that are there twice.
fn distinct(mesh: &TriangleMesh) -> TriangleMesh {
    let mut known = rustc_hash::FxHashSet::default();
    let first = |t: &[u32; 3]| {
        let least = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
        [0, 1, 2].map(|k| t[(least + k) % 3])
    };
    let triangles = mesh.triangles.iter().filter(|t| known.insert(first(t)));
    TriangleMesh {
        positions: mesh.positions.clone(),
        triangles: triangles.copied().collect(),
    }
}

/// The triangles over each edge of each triangle: those that have it the other way round.
fn neighbours(triangles: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let edges = |t: &[u32; 3]| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3]));
    let mut owners: FxHashMap<(u32, u32), Vec<usize>> = FxHashMap::default();
    for (i, t) in triangles.iter().enumerate() {
        for edge in edges(t) {
            owners.entry(edge).or_default().push(i);
        }
    }
    let beyond = |(a, b)| match (
        owners.get(&(a, b)).map(Vec::as_slice),
        owners.get(&(b, a)).map(Vec::as_slice),
    ) {
        (Some([_]), Some(&[other])) => Some(other),
        _ => None,
    };
    let one = |t| edges(t).into_iter().flat_map(beyond).collect();
    triangles.iter().map(one).collect()
}

/// A region's triangles anew; `None` when its outline is not made of simple rings.
fn outline(
    mesh: &TriangleMesh,
    members: &[usize],
    n: [f64; 3],
    tolerance: f64,
) -> Option<Vec<super::Corners>> {
    let mut boundary: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    let mut inner: FxHashMap<(u32, u32), ()> = FxHashMap::default();
    for &m in members {
        let t = mesh.triangles[m];
        for k in 0..3 {
            inner.insert((t[k], t[(k + 1) % 3]), ());
        }
    }
    let mut order = Vec::new();
    for &m in members {
        let t = mesh.triangles[m];
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if !inner.contains_key(&(b, a)) {
                boundary.entry(a).or_default().push(b);
                order.push(a);
            }
        }
    }
    // Axes in the plane, right-handed with the normal.
    let seed = if n[2].abs() < 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let u = cross(seed, n);
    let u = u.map(|v| v / norm(u));
    let v = cross(n, u);
    let flat = |i: u32| {
        let p = mesh.positions[i as usize];
        [dot(p, u), dot(p, v)]
    };
    let mut rings: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut corners: Vec<Vec<u32>> = Vec::new();
    for start in order {
        let Some(mut to) = boundary.get_mut(&start).and_then(Vec::pop) else {
            continue;
        };
        let mut ring = vec![start];
        while to != start {
            let from = ring[ring.len() - 1];
            let ends = boundary.get_mut(&to)?;
            let next = nearest_turn(flat(from), flat(to), ends, flat)?;
            ring.push(to);
            to = ends.swap_remove(next);
        }
        let ring = straightened(ring, flat, tolerance);
        if ring.len() > 2 {
            rings.push(ring.iter().map(|&i| flat(i)).collect());
            corners.push(ring);
        }
    }
    let area: f64 = rings.iter().map(|r| ring_area(r)).sum();
    let mut found = Vec::new();
    let mut made = 0.0;
    for polygon in nest(&rings) {
        let parts: Vec<&[[f64; 2]]> = polygon.iter().map(|&i| rings[i].as_slice()).collect();
        for t in triangles(&parts) {
            let plan = t.map(|(r, k)| parts[r][k]);
            let corner = t.map(|(r, k)| mesh.positions[corners[polygon[r]][k] as usize]);
            let a = ring_area(&plan);
            made += a.abs();
            match a >= 0.0 {
                true => found.push(corner),
                false => found.push([corner[0], corner[2], corner[1]]),
            }
        }
    }
    let whole: f64 = members
        .iter()
        .map(|&m| {
            norm(normal(
                &mesh.triangles[m].map(|i| mesh.positions[i as usize]),
            )) / 2.0
        })
        .sum();
    let same = |a: f64| (a - whole).abs() <= 1e-3 * whole + tolerance;
    (same(area) && same(made)).then_some(found)
}

/// Which of the edges from `at` to `ends` is met first, clockwise from the one that leads back to `from`: it bounds the same part of the
/// region, which lies on the left of both, where the outline passes a corner more than once.
fn nearest_turn(
    from: [f64; 2],
    at: [f64; 2],
    ends: &[u32],
    flat: impl Fn(u32) -> [f64; 2],
) -> Option<usize> {
    let away = |p: [f64; 2]| [p[0] - at[0], p[1] - at[1]];
    let back = away(from);
    let clockwise = |&i: &usize| {
        let d = away(flat(ends[i]));
        let sin = d[0] * back[1] - d[1] * back[0];
        let cos = d[0] * back[0] + d[1] * back[1];
        match sin.atan2(cos) {
            angle if angle > 0.0 => angle,
            angle => angle + std::f64::consts::TAU,
        }
    };
    let turns: Vec<f64> = (0..ends.len()).map(|i| clockwise(&i)).collect();
    (0..ends.len()).min_by(|&a, &b| turns[a].total_cmp(&turns[b]))
}

/// Drops corners that lie within `tolerance` of the line between their neighbours.
fn straightened(ring: Vec<u32>, flat: impl Fn(u32) -> [f64; 2], tolerance: f64) -> Vec<u32> {
    let mut kept: Vec<u32> = Vec::with_capacity(ring.len());
    let n = ring.len();
    for k in 0..n {
        let before = kept.last().copied().unwrap_or(ring[n - 1]);
        let [p, q, r] = [before, ring[k], ring[(k + 1) % n]].map(&flat);
        let d = [r[0] - p[0], r[1] - p[1]];
        let length = d[0].hypot(d[1]);
        let e = [q[0] - p[0], q[1] - p[1]];
        let off = (d[0] * e[1] - d[1] * e[0]).abs();
        let along = (d[0] * e[0] + d[1] * e[1]) / (length * length).max(1e-12);
        if off > tolerance * length || !(0.0..=1.0).contains(&along) {
            kept.push(ring[k]);
        }
    }
    kept
}
