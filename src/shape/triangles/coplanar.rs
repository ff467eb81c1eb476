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
    let neighbours = neighbours(mesh);
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
            for &other in neighbours[members[next]].iter().flatten() {
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

/// The neighbour of each triangle over each edge, where exactly two triangles share the edge.
fn neighbours(mesh: &TriangleMesh) -> Vec<[Option<usize>; 3]> {
    let mut edges: FxHashMap<(u32, u32), Vec<(usize, usize)>> = FxHashMap::default();
    for (i, t) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push((i, k));
        }
    }
    let mut out = vec![[None; 3]; mesh.triangles.len()];
    for pair in edges.values() {
        if let [(i, k), (j, l)] = pair[..] {
            out[i][k] = Some(j);
            out[j][l] = Some(i);
        }
    }
    out
}

/// A region's triangles anew; `None` when its outline is not made of simple rings.
fn outline(
    mesh: &TriangleMesh,
    members: &[usize],
    n: [f64; 3],
    tolerance: f64,
) -> Option<Vec<super::Corners>> {
    let mut boundary: FxHashMap<u32, u32> = FxHashMap::default();
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
                // A corner that the outline passes twice.
                if boundary.insert(a, b).is_some() {
                    return None;
                }
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
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = boundary.remove(&at) {
            ring.push(at);
            at = to;
        }
        if ring.is_empty() {
            continue;
        }
        if at != start {
            return None;
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
