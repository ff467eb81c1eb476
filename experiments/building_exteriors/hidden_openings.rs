//! The surveyed buildings of Ingolstadt with their windows and doors hidden.

use std::collections::BTreeMap;
use std::path::Path;

use edifice_base::Result;
use edifice_io::{json, read_bytes};
use edifice_shape::triangles::{TriangleMesh, polygon_triangles};
use edifice_shape::{PartKind, WallRect};
use serde::Deserialize;

/// A building without its openings, and these.
pub(super) struct Hidden {
    pub name: String,
    pub mesh: TriangleMesh,
    pub truth: Vec<(PartKind, WallRect)>,
}

#[derive(Deserialize)]
struct Survey {
    buildings: Vec<Surveyed>,
}

#[derive(Deserialize)]
struct Surveyed {
    id: String,
    origin: [f64; 3],
    polys: Vec<Polygon>,
}

#[derive(Deserialize)]
struct Polygon {
    /// Class of the surface.
    s: Option<String>,
    /// The element that it belongs to.
    o: Option<String>,
    /// Rings, the outer one first, their first corner given again at the end.
    r: Vec<Vec<[f64; 3]>>,
}

impl Polygon {
    /// The outer ring at its place.
    fn ring(&self, shift: [f64; 3]) -> Vec<[f64; 3]> {
        let mut ring: Vec<[f64; 3]> = self.r.first().cloned().unwrap_or_default();
        ring.pop();
        for p in &mut ring {
            *p = [0, 1, 2].map(|i| p[i] + shift[i]);
        }
        ring
    }
}

/// Walls, roofs and ground of each building with the holes of their walls closed, and the rectangles around its windows
/// and doors on their walls.
///
/// # Errors
/// Names the file when it is not what it should be.
pub(super) fn ingolstadt(path: &Path) -> Result<Vec<Hidden>> {
    let survey: Survey = json::parse_json(&read_bytes(path)?, path)?;
    let base = survey.buildings.first().map_or([0.0; 3], |b| b.origin);
    let hidden = |b: &Surveyed| {
        let shift = [0, 1, 2].map(|i| b.origin[i] - base[i]);
        let mut mesh = TriangleMesh::default();
        let mut elements: BTreeMap<(&str, &str), Vec<Vec<[f64; 3]>>> = BTreeMap::new();
        for p in &b.polys {
            match (p.s.as_deref(), p.o.as_deref()) {
                (Some(kind @ ("Window" | "Door")), Some(element)) => {
                    let own = elements.entry((kind, element)).or_default();
                    own.push(p.ring(shift));
                }
                (Some(kind), _) if kind.ends_with("Surface") => {
                    for t in polygon_triangles(&[p.ring(shift)]) {
                        mesh.push(t);
                    }
                }
                _ => {}
            }
        }
        let truth = elements.iter().filter_map(|((kind, _), rings)| {
            let kind = match *kind {
                "Window" => PartKind::Window,
                _ => PartKind::Door,
            };
            Some((kind, rectangle(rings)?))
        });
        Hidden {
            name: b.id.clone(),
            truth: truth.collect(),
            mesh: mesh.welded(1e-3),
        }
    };
    Ok(survey.buildings.iter().map(hidden).collect())
}

/// The rectangle around the polygons of an element on its wall; `None` for one in a roof.
fn rectangle(rings: &[Vec<[f64; 3]>]) -> Option<WallRect> {
    // Twice the area of a ring seen along x and y, by Newell's method.
    let area = |ring: &Vec<[f64; 3]>| {
        let mut n = [0.0; 2];
        for (i, p) in ring.iter().enumerate() {
            let q = ring[(i + 1) % ring.len()];
            n[0] += (p[1] - q[1]) * (p[2] + q[2]);
            n[1] += (p[2] - q[2]) * (p[0] + q[0]);
        }
        n
    };
    let areas: Vec<[f64; 2]> = rings.iter().map(area).collect();
    let sum = areas
        .iter()
        .fold([0.0; 2], |s, n| [s[0] + n[0], s[1] + n[1]]);
    let size = |n: &[f64; 2]| n[0].hypot(n[1]);
    // The polygons of a whole box add up to nothing: then the largest of them.
    let largest = areas
        .iter()
        .copied()
        .max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let n = if size(&sum) > 1e-6 { sum } else { largest };
    let length = size(&n);
    let out = [n[0] / length, n[1] / length];
    if !out[0].is_finite() {
        return None;
    }
    let along = [-out[1], out[0]];
    let points = || rings.iter().flatten();
    let count = points().count() as f64;
    let depth = points().map(|p| out[0] * p[0] + out[1] * p[1]).sum::<f64>() / count;
    let range = |of: &dyn Fn(&[f64; 3]) -> f64| {
        let low = points().map(of).fold(f64::INFINITY, f64::min);
        [low, points().map(of).fold(f64::NEG_INFINITY, f64::max)]
    };
    let u = range(&|p| along[0] * p[0] + along[1] * p[1]);
    let z = range(&|p| p[2]);
    Some(WallRect {
        corner: [
            along[0] * u[0] + out[0] * depth,
            along[1] * u[0] + out[1] * depth,
            z[0],
        ],
        along,
        width: u[1] - u[0],
        height: z[1] - z[0],
    })
}
