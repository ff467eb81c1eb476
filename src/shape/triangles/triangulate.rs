//! Polygons with holes as triangles.

use earcut::Earcut;

use super::Corners;

/// Signed area of a ring, positive when counterclockwise.
pub(super) fn ring_area(ring: &[[f64; 2]]) -> f64 {
    let n = ring.len();
    let cross = |i: usize| {
        let (p, q) = (ring[i], ring[(i + 1) % n]);
        p[0] * q[1] - p[1] * q[0]
    };
    (0..n).map(cross).sum::<f64>() / 2.0
}

/// True if a point lies inside a ring (even-odd rule).
pub(super) fn inside(ring: &[[f64; 2]], p: [f64; 2]) -> bool {
    let mut odd = false;
    for (i, a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            odd ^= x > p[0];
        }
    }
    odd
}

/// Groups rings into polygons: each counterclockwise ring with the clockwise rings for which it is the
/// smallest that contains them. Clockwise rings outside all others are left out. Result: indices of
/// rings, the outer one first.
pub(super) fn nest(rings: &[Vec<[f64; 2]>]) -> Vec<Vec<usize>> {
    let areas: Vec<f64> = rings.iter().map(|r| ring_area(r)).collect();
    let mut outers: Vec<usize> = (0..rings.len()).filter(|&i| areas[i] > 0.0).collect();
    outers.sort_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
    let mut polygons: Vec<Vec<usize>> = outers.iter().map(|&i| vec![i]).collect();
    for hole in (0..rings.len()).filter(|&i| areas[i] < 0.0) {
        let around = |p: &&mut Vec<usize>| {
            areas[p[0]] > -areas[hole] && inside(&rings[p[0]], rings[hole][0])
        };
        if let Some(polygon) = polygons.iter_mut().find(around) {
            polygon.push(hole);
        }
    }
    polygons
}

/// Triangles of a polygon given by its rings, the outer one first, as pairs of ring and corner.
pub(super) fn triangles(rings: &[&[[f64; 2]]]) -> Vec<[(usize, usize); 3]> {
    let mut at = Vec::new();
    let mut holes = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        if r > 0 {
            holes.push(at.len() as u32);
        }
        at.extend((0..ring.len()).map(|k| (r, k)));
    }
    let points = at.iter().map(|&(r, k)| rings[r][k]);
    let mut found: Vec<u32> = Vec::new();
    Earcut::new().earcut(points, &holes, &mut found);
    let corner = |i: u32| at[i as usize];
    found
        .chunks_exact(3)
        .map(|t| [corner(t[0]), corner(t[1]), corner(t[2])])
        .collect()
}

/// Triangles of a plane polygon in space, the outer ring first; in its Newell plane, facing as the outer
/// ring does. Nothing for rings without area.
pub fn polygon_triangles(rings: &[Vec<[f64; 3]>]) -> Vec<Corners> {
    let Some(outer) = rings.first() else {
        return Vec::new();
    };
    let mut n = [0.0; 3];
    for (i, p) in outer.iter().enumerate() {
        let q = outer[(i + 1) % outer.len()];
        for (k, sum) in n.iter_mut().enumerate() {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            *sum += (p[a] - q[a]) * (p[b] + q[b]);
        }
    }
    // Seen along the axis that the polygon faces most, the others in right-handed order.
    let longer = |a: &usize, b: &usize| n[*a].abs().total_cmp(&n[*b].abs());
    let axis = (0..3).max_by(longer).unwrap_or(2);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let flat = |ring: &Vec<[f64; 3]>| ring.iter().map(|p| [p[u], p[v]]).collect();
    let plans: Vec<Vec<[f64; 2]>> = rings.iter().map(flat).collect();
    let parts: Vec<&[[f64; 2]]> = plans.iter().map(Vec::as_slice).collect();
    let facing = ring_area(&plans[0]);
    let mut out = Vec::new();
    for t in triangles(&parts) {
        let plan = t.map(|(r, k)| plans[r][k]);
        let [a, b, c] = t.map(|(r, k)| rings[r][k]);
        match ring_area(&plan) * facing {
            area if area > 0.0 => out.push([a, b, c]),
            area if area < 0.0 => out.push([a, c, b]),
            _ => {}
        }
    }
    out
}
