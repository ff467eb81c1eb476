//! The same surface with fewer triangles: neighbouring coplanar triangles are joined into polygons,
//! corners in the middle of straight edges dropped, and the polygons triangulated anew.

mod outline;

use rustc_hash::{FxHashMap, FxHashSet};

use self::outline::{Outline, edges};
use super::TriangleMesh;
use super::mesh::normal;
use crate::vec3::{dot, norm, sub};

/// Merges coplanar neighbours: joined are triangles that share an edge and whose corners lie within
/// `tolerance` metres of the plane of the first. A region whose outline cannot be triangulated to the same
/// area stays as it was. Straight runs of the outline lose their inner corners. Where each edge is met by as many triangles from
/// one side as from the other, it still is: neighbouring regions drop the same corners. Elsewhere they need not share every corner,
/// and the surface is the same up to `tolerance`.
pub fn merge_coplanar(mesh: &TriangleMesh, tolerance: f64) -> TriangleMesh {
    if !is_closed(&mesh.triangles) {
        return merged_open(mesh, tolerance);
    }
    let merged = merged_closed(mesh, tolerance);
    match merged.filter(|m| is_closed(&m.triangles)) {
        Some(merged) => merged,
        None => mesh.clone(),
    }
}

/// True if each edge is met by as many triangles from one side as from the other.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let mut excess: FxHashMap<(u32, u32), i64> = FxHashMap::default();
    for (a, b) in triangles.iter().flat_map(edges) {
        *excess.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
    }
    excess.values().all(|&n| n == 0)
}

/// Each region drops the corners that its own outline does not need.
fn merged_open(mesh: &TriangleMesh, tolerance: f64) -> TriangleMesh {
    let mesh = &distinct(mesh);
    let mut out = TriangleMesh::default();
    for region in regions(mesh, tolerance) {
        // A region of one triangle without area is nothing.
        let Some(n) = region.normal else { continue };
        let merged = (region.members.len() > 1)
            .then(|| Outline::of(mesh, &region.members, n))
            .flatten()
            .and_then(|o| o.triangulated(&o.straightened(tolerance), tolerance));
        push(&mut out, mesh, &region, merged);
    }
    out.welded(tolerance.min(1e-6))
}

/// Adds a region's new triangles, or its own where they are no fewer.
fn push(out: &mut TriangleMesh, mesh: &TriangleMesh, region: &Region, new: Option<Vec<[u32; 3]>>) {
    let new = new.filter(|t| t.len() < region.members.len());
    let own = || region.members.iter().map(|&m| mesh.triangles[m]);
    for t in new.unwrap_or_else(|| own().collect()) {
        out.push(t.map(|i| mesh.positions[i as usize]));
    }
}

/// A corner is dropped where no region's outline needs it; `None` where no such set of corners is found.
fn merged_closed(mesh: &TriangleMesh, tolerance: f64) -> Option<TriangleMesh> {
    let regions = regions(mesh, tolerance);
    let outline = |r: &Region| match r.normal {
        Some(n) if r.members.len() > 1 => Outline::of(mesh, &r.members, n),
        _ => None,
    };
    let outlines: Vec<Option<Outline>> = regions.iter().map(outline).collect();
    let mut stays = vec![false; mesh.positions.len()];
    let all = |region: &Region, stays: &mut Vec<bool>| {
        let corners = region.members.iter().flat_map(|&m| mesh.triangles[m]);
        corners.for_each(|i| stays[i as usize] = true);
    };
    for (region, outline) in regions.iter().zip(&outlines) {
        match outline {
            Some(outline) => outline
                .straightened(tolerance)
                .into_iter()
                .flatten()
                .for_each(|i| stays[i as usize] = true),
            None => all(region, &mut stays),
        }
    }
    let mut is_as_it_was: Vec<bool> = outlines.iter().map(Option::is_none).collect();
    for _ in 0..ROUNDS {
        let mut out = TriangleMesh::default();
        let mut is_settled = true;
        for (k, region) in regions.iter().enumerate() {
            let own = outlines[k].as_ref().filter(|_| !is_as_it_was[k]);
            let new = own.and_then(|o| {
                o.triangulated(&o.with_corners(&stays), tolerance)
                    .filter(|t| t.len() < region.members.len())
            });
            if own.is_some() && new.is_none() {
                // Its triangles stay, and so do all of their corners.
                is_as_it_was[k] = true;
                all(region, &mut stays);
                is_settled = false;
            }
            push(&mut out, mesh, region, new);
        }
        if is_settled {
            return Some(out.welded(tolerance.min(1e-9)));
        }
    }
    None
}

/// Most rounds in which regions that cannot be merged are found.
const ROUNDS: usize = 20;

/// Connected triangles near a plane.
struct Region {
    members: Vec<usize>,
    /// Of length 1; `None` for a single triangle without an area.
    normal: Option<[f64; 3]>,
}

fn regions(mesh: &TriangleMesh, tolerance: f64) -> Vec<Region> {
    let neighbours = neighbours(&mesh.triangles);
    let at = |i: u32| mesh.positions[i as usize];
    let mut is_taken = vec![false; mesh.triangles.len()];
    let mut out = Vec::new();
    for start in 0..mesh.triangles.len() {
        if is_taken[start] {
            continue;
        }
        is_taken[start] = true;
        let mut members = vec![start];
        let corners = mesh.triangles[start].map(at);
        let n = normal(&corners);
        let length = norm(n);
        let normal_of = (length > 0.0).then(|| n.map(|v| v / length));
        let mut next = 0;
        while let (Some(n), Some(&member)) = (normal_of, members.get(next)) {
            for &other in &neighbours[member] {
                let t = mesh.triangles[other].map(at);
                let flat = |p: &[f64; 3]| dot(sub(*p, corners[0]), n).abs() <= tolerance;
                let m = normal(&t);
                if !is_taken[other] && t.iter().all(flat) && dot(m, n) > 0.9 * norm(m) {
                    is_taken[other] = true;
                    members.push(other);
                }
            }
            next += 1;
        }
        out.push(Region {
            members,
            normal: normal_of,
        });
    }
    out
}

/// Without triangles that are there twice.
fn distinct(mesh: &TriangleMesh) -> TriangleMesh {
    let mut known = FxHashSet::default();
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
