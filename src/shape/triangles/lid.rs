//! Horizontal sections as triangles: what closes a part that was cut off.

use rustc_hash::FxHashMap;

use super::clip::{clip_to_slabs, crossing};
use super::mesh::plan_area;
use super::triangulate::{nest, ring_area, triangles};
use super::{Corners, TriangleMesh};

/// Rings of less than this area are left out, in square metres.
const LEAST_AREA: f64 = 1e-4;
/// Ends of segments closer than this meet, in metres.
const WELD: f64 = 1e-3;
/// Greatest difference of a section from A(z), as a share of A(z).
const CLOSE: f64 = 0.01;
/// Faces closer to the plane than this lie in it, in metres.
const LEVEL: f64 = 1e-5;
/// Open chains beyond this number are not joined.
const MOST_CHAINS: usize = 64;

/// The section of a welded mesh just above the height `z`, as triangles facing up.
///
/// If the mesh is closed there, the section is chained from the crossings of triangles with the plane. Open meshes and
/// such with T-junctions leave gaps: ends of chains are joined to the nearest beginnings. When the result does not have
/// the area A(z), the roofs above z, laid down on the plane, are tried; what is nearer to A(z) is taken. Corners on the
/// plane count as below it.
pub fn section_lid(mesh: &TriangleMesh, z: f64) -> TriangleMesh {
    let chained = chained_lid(mesh, z);
    let above = clip_to_slabs(mesh, &[z]).pop().unwrap_or_default();
    let section: f64 = above.corners().map(|t| plan_area(&t)).sum();
    let far = |lid: &TriangleMesh| (lid.area() - section).abs();
    // Without roofs A(z) says nothing.
    if section <= LEAST_AREA || far(&chained) <= CLOSE * section {
        return chained;
    }
    let mut laid = TriangleMesh::default();
    for t in above.corners().filter(|t| plan_area(t) > 0.0) {
        laid.push(t.map(|p| [p[0], p[1], z]));
    }
    match far(&laid) < far(&chained) {
        true => laid.welded(1e-6),
        false => chained,
    }
}

/// The faces that close the part of a mesh below the cut at `z`, and, turned over, the part above it: the section there
/// without the part that horizontal faces at `z` close already.
///
/// With areas H of faces at `z` that look up and D of those that look down, A(z-) = A(z+) + H - D, and A(z+) - D is open.
/// Stacked closed bodies leave nothing open; without faces that look down the section above is, without
/// faces that look up the section below. Where both kinds meet in one plane the section above is taken.
pub fn closing_lid(mesh: &TriangleMesh, z: f64) -> TriangleMesh {
    let (mut up, mut down) = (0.0, 0.0);
    for t in mesh.corners() {
        if t.iter().all(|p| (p[2] - z).abs() <= LEVEL) {
            let area = plan_area(&t);
            up += area.max(0.0);
            down -= area.min(0.0);
        }
    }
    let lid = section_lid(mesh, z);
    let little = CLOSE * lid.area();
    if down <= little {
        return lid;
    }
    if lid.area() - down <= little {
        return TriangleMesh::default();
    }
    if up > little {
        return lid;
    }
    let mut below = section_lid(mesh, z - 2.0 * LEVEL);
    below.positions.iter_mut().for_each(|p| p[2] = z);
    below
}

fn chained_lid(mesh: &TriangleMesh, z: f64) -> TriangleMesh {
    let rings: Vec<Vec<[f64; 2]>> = rings(mesh, z)
        .into_iter()
        .filter(|ring| ring.len() > 2 && ring_area(ring).abs() > LEAST_AREA)
        .collect();
    let mut lid = TriangleMesh::default();
    for polygon in nest(&rings) {
        let parts: Vec<&[[f64; 2]]> = polygon.iter().map(|&i| rings[i].as_slice()).collect();
        for t in triangles(&parts) {
            let corners = t.map(|(r, k)| [parts[r][k][0], parts[r][k][1], z]);
            match plan_area(&corners) > 0.0 {
                true => lid.push(corners),
                false => lid.push([corners[0], corners[2], corners[1]]),
            }
        }
    }
    lid.welded(1e-6)
}

/// The rings of the section, material to the left: segments chained by the places of their ends, then open
/// chains joined end to nearest beginning.
fn rings(mesh: &TriangleMesh, z: f64) -> Vec<Vec<[f64; 2]>> {
    type Key = [i64; 2];
    let key = |p: [f64; 2]| p.map(|v| (v / WELD).round() as i64);
    let mut next: FxHashMap<Key, Vec<[f64; 2]>> = FxHashMap::default();
    let mut ends: FxHashMap<Key, isize> = FxHashMap::default();
    let mut order: Vec<[f64; 2]> = Vec::new();
    for t in mesh.corners() {
        let Some((from, to)) = segment(&t, z) else {
            continue;
        };
        if key(from) != key(to) {
            next.entry(key(from)).or_default().push(to);
            *ends.entry(key(from)).or_default() += 1;
            *ends.entry(key(to)).or_default() -= 1;
            order.push(from);
        }
    }
    // Chains of open meshes begin where more begins than ends; take those first, so that they stay whole.
    let (open, closed): (Vec<_>, Vec<_>) = order.into_iter().partition(|&p| ends[&key(p)] > 0);
    let (mut rings, mut chains) = (Vec::new(), Vec::new());
    for start in open.into_iter().chain(closed) {
        let mut chain = vec![start];
        let mut at = start;
        while let Some(to) = next.get_mut(&key(at)).and_then(Vec::pop) {
            at = to;
            if key(at) == key(start) {
                break;
            }
            chain.push(at);
        }
        match key(at) == key(start) {
            true if chain.len() > 1 => rings.push(chain),
            true => {}
            false => chains.push(chain),
        }
    }
    // Many open chains are no outline with gaps but a soup.
    if chains.len() <= MOST_CHAINS {
        rings.extend(joined(chains));
    }
    rings
}

/// Joins the end of each chain to the beginning of the nearest, the nearest pair first.
fn joined(chains: Vec<Vec<[f64; 2]>>) -> Vec<Vec<[f64; 2]>> {
    let n = chains.len();
    let gap = |i: usize, j: usize| {
        let (p, q) = (chains[i][chains[i].len() - 1], chains[j][0]);
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let mut pairs: Vec<(f64, usize, usize)> = pairs.map(|(i, j)| (gap(i, j), i, j)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut after, mut taken) = (vec![None; n], vec![false; n]);
    for (_, i, j) in pairs {
        if after[i].is_none() && !taken[j] {
            after[i] = Some(j);
            taken[j] = true;
        }
    }
    let mut rings = Vec::new();
    for start in 0..n {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = after[at].take() {
            ring.extend(&chains[at]);
            at = to;
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// The segment where a triangle crosses the plane, material to the left.
fn segment(t: &Corners, z: f64) -> Option<([f64; 2], [f64; 2])> {
    let above = t.map(|p| p[2] > z);
    let (mut from, mut to) = (None, None);
    for k in 0..3 {
        let (p, q) = (k, (k + 1) % 3);
        let point = || {
            let cut = crossing(t[p], t[q], z);
            Some([cut[0], cut[1]])
        };
        match (above[p], above[q]) {
            // Seen from outside, the edge that leads down is on the left.
            (true, false) => from = point(),
            (false, true) => to = point(),
            _ => {}
        }
    }
    from.zip(to)
}
