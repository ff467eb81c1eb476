//! Openings in the walls of a building, its corners kept.

use edifice_shape::solid::Finish;
use edifice_shape::triangles::{bounded_triangles, normal};
use edifice_shape::vec3::norm;
use edifice_shape::{DetailedBuilding, Part, PartKind, WallRect};
use serde_json::json;

use super::choice::{Element, ElementKind, Probable};
use super::walls::{Faces, Span, WallFace};
use crate::survey::Candidate;

/// Depth of panes and leaves behind the wall, and width of frames (m).
const DEPTH: f64 = 0.1;
const FRAME: f64 = 0.06;
/// Upward component of the unit normal above which a face is a roof, and height over the ground up to which a face that
/// looks down is the ground (m).
const LEVEL: f64 = 0.05;
const GROUND: f64 = 0.5;

/// The building in parts, with the chosen elements.
pub(super) fn dressed(own: &Candidate, faces: &Faces, chosen: &[Probable]) -> DetailedBuilding {
    let mut all = DetailedBuilding {
        name: own.name.to_owned(),
        positions: faces.mesh.positions.clone(),
        parts: Vec::new(),
        attributes: own.attributes.clone(),
    };
    let mut is_wall = vec![false; faces.mesh.triangles.len()];
    for &k in faces.walls.iter().flat_map(|w| &w.triangles) {
        is_wall[k] = true;
    }
    for (kind, name) in [
        (PartKind::GroundSurface, "ground"),
        (PartKind::RoofSurface, "roof"),
        (PartKind::OuterCeilingSurface, "ceiling"),
        (PartKind::WallSurface, "wall"),
    ] {
        let of_kind = |k: &usize| !is_wall[*k] && kind_of(faces, *k) == kind;
        let own = (0..is_wall.len()).filter(of_kind);
        let finish = match kind {
            PartKind::RoofSurface => Finish::Roof,
            _ => Finish::Wall,
        };
        let triangles: Vec<_> = own.map(|k| (faces.mesh.triangles[k], finish)).collect();
        if !triangles.is_empty() {
            all.parts.push(Part::new(kind, name.into(), triangles));
        }
    }
    for (number, face) in faces.walls.iter().enumerate() {
        let own: Vec<&Probable> = chosen.iter().filter(|(e, _)| e.wall == number).collect();
        add_wall(&mut all, faces, number, face, &own);
    }
    all
}

/// The class of a triangle that is part of no plane wall.
fn kind_of(faces: &Faces, triangle: usize) -> PartKind {
    let corners = faces.mesh.corners(triangle);
    let n = normal(&corners);
    match n[2] / norm(n) {
        up if up > LEVEL => PartKind::RoofSurface,
        up if up >= -LEVEL => PartKind::WallSurface,
        _ if corners.iter().all(|p| p[2] < faces.ground + GROUND) => PartKind::GroundSurface,
        _ => PartKind::OuterCeilingSurface,
    }
}

/// A wall with its elements; a wall that cannot be cut stays as it is, without them.
fn add_wall(
    all: &mut DetailedBuilding,
    faces: &Faces,
    number: usize,
    face: &WallFace,
    elements: &[&Probable],
) {
    let wall = all.parts.len();
    let name = format!("wall_{}", number + 1);
    let whole = || {
        let own = face.triangles.iter().map(|&k| faces.mesh.triangles[k]);
        own.map(|t| (t, Finish::Wall)).collect()
    };
    if elements.is_empty() {
        all.parts
            .push(Part::new(PartKind::WallSurface, name, whole()));
        return;
    }
    let kept = all.positions.len();
    let mouths: Vec<[u32; 4]> = elements
        .iter()
        .map(|(e, _)| corners(all, face, e.rect, 0.0))
        .collect();
    // The wall lies to the left of its outline and to the right of an opening that runs counterclockwise.
    let mut edges = face.outline.clone();
    for mouth in &mouths {
        edges.extend((0..4).map(|i| [mouth[(i + 1) % 4], mouth[i]]));
    }
    let place = |v: u32| face.flat(all.positions[v as usize]);
    let Some(triangles) = bounded_triangles(&edges, place) else {
        all.positions.truncate(kept);
        all.parts
            .push(Part::new(PartKind::WallSurface, name, whole()));
        return;
    };
    let triangles = triangles.into_iter().map(|t| (t, Finish::Wall)).collect();
    all.parts
        .push(Part::new(PartKind::WallSurface, name, triangles));
    for (k, ((element, probability), mouth)) in elements.iter().zip(mouths).enumerate() {
        let mut own = opening(all, face, element, mouth);
        own.name = format!(
            "{}_{}_{}_{}",
            own.name,
            number + 1,
            element.storey + 1,
            k + 1
        );
        own.wall = Some(wall);
        own.attributes
            .insert("floor".into(), json!(element.storey + 1));
        if let Some(probability) = probability {
            own.attributes
                .insert("probability".into(), json!(probability));
        }
        all.parts.push(own);
    }
}

/// The corners of a rectangle behind a wall, counterclockwise seen from outside.
fn corners(all: &mut DetailedBuilding, face: &WallFace, [u, z]: Span, depth: f64) -> [u32; 4] {
    let first = all.positions.len() as u32;
    let at = [[u[0], z[0]], [u[1], z[0]], [u[1], z[1]], [u[0], z[1]]];
    all.positions.extend(at.map(|p| face.place(p, depth)));
    [first, first + 1, first + 2, first + 3]
}

/// The triangles between two rectangles, the outer one first.
fn ring(outer: [u32; 4], inner: [u32; 4]) -> impl Iterator<Item = [u32; 3]> {
    (0..4).flat_map(move |i| {
        let j = (i + 1) % 4;
        [
            [outer[i], outer[j], inner[j]],
            [outer[i], inner[j], inner[i]],
        ]
    })
}

/// A window or a door behind its mouth: reveals, a frame around a pane, or a leaf.
fn opening(
    all: &mut DetailedBuilding,
    face: &WallFace,
    element: &Element,
    mouth: [u32; 4],
) -> Part {
    let back = corners(all, face, element.rect, DEPTH);
    let mut triangles: Vec<_> = ring(mouth, back).map(|t| (t, Finish::Frame)).collect();
    let (kind, name) = match element.kind {
        ElementKind::Window => (PartKind::Window, "window"),
        ElementKind::Door => (PartKind::Door, "door"),
    };
    let (leaf, finish) = match element.kind {
        ElementKind::Door => (back, Finish::Door),
        ElementKind::Window => {
            let least = element.rect.map(|[low, high]| high - low);
            let frame = FRAME.min(least[0] / 4.0).min(least[1] / 4.0);
            let glass = element.rect.map(|[low, high]| [low + frame, high - frame]);
            let glass = corners(all, face, glass, DEPTH);
            triangles.extend(ring(back, glass).map(|t| (t, Finish::Frame)));
            (glass, Finish::Pane)
        }
    };
    triangles.extend([
        ([leaf[0], leaf[1], leaf[2]], finish),
        ([leaf[0], leaf[2], leaf[3]], finish),
    ]);
    let [u, z] = element.rect;
    Part {
        rect: Some(WallRect {
            corner: face.place([u[0], z[0]], 0.0),
            along: face.along(),
            width: u[1] - u[0],
            height: z[1] - z[0],
        }),
        ..Part::new(kind, name.into(), triangles)
    }
}
