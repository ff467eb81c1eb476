//! A city as a scene: a mesh a building, on ground that is as high as they stand.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use super::drawing::{Drawing, Drawn, seen};
use super::terrain::Terrain;
use edifice_scene::{Group, Instance, Material, Mesh, Scene};
use edifice_shape::triangles::{City, CityBuilding, Painted, corner_bits};

/// Textures are drawn in about so many pieces.
const MOST_PIECES: f64 = 600_000.0;
/// No piece is halved below this length, in metres.
const FINEST: f64 = 0.25;
/// The upper bits of a colour, which tell its material.
const COARSE: u8 = 0xf8;
/// Triangles of a mesh that casts its own shadow.
const MOST_TRIANGLES: usize = 80;
/// Index of the material of what is not painted.
const BUILDING: usize = 0;
/// Ground around the buildings: a share of the extent, and metres at most.
const MARGIN: (f64, f64) = (0.03, 50.0);

fn material(name: &str, color: [u8; 3]) -> Material {
    Material {
        name: name.to_owned(),
        color,
        roughness: 0.9,
    }
}

/// The scene of a city, its origin moved to `middle` (in the reference system); painted surfaces in pieces of one colour each.
pub(super) fn scene(drawn: &Drawn, drawing: &Drawing, middle: [f64; 3]) -> Scene {
    let city = drawn.city;
    let shift = [0, 1, 2].map(|k| middle[k] - city.origin[k]);
    // z up to y up.
    let turned = |p: [f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|k| (p[k] - shift[k]) as f32);
        [x, z, -y]
    };
    let mut scene = Scene {
        materials: vec![
            material("building", [214, 208, 198]),
            material("ground", [150, 152, 150]),
        ],
        ..Scene::default()
    };
    let fine = fineness(city);
    let mut colours: FxHashMap<[u8; 3], usize> = FxHashMap::default();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut bases: Vec<([f64; 2], f64)> = Vec::new();
    for (number, b) in city.buildings.iter().enumerate() {
        let Some(bounds) = b.mesh.bounds().filter(|_| !b.mesh.triangles.is_empty()) else {
            continue;
        };
        if !seen(&bounds, city, drawing) {
            continue;
        }
        let (l, h) = bounds;
        for k in 0..2 {
            low[k] = low[k].min(l[k]);
            high[k] = high[k].max(h[k]);
        }
        bases.push(([0, 1].map(|k| (l[k] + h[k]) / 2.0), l[2]));
        let plain = drawn.colours.and_then(|c| c.get(number));
        let mut parts: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        let mut mesh = Mesh {
            name: b.id.clone(),
            positions: b.mesh.positions.iter().map(|&p| turned(p)).collect(),
            parts: Vec::new(),
        };
        let mut of_colour = |colour: [u8; 3], scene: &mut Scene| {
            let next = scene.materials.len();
            let material = *colours.entry(colour).or_insert(next);
            if material == next {
                scene.materials.push(self::material("colour", colour));
            }
            material
        };
        let own = plain.map_or(BUILDING, |&c| of_colour(c, &mut scene));
        let paint: &[Painted] = if plain.is_some() { &[] } else { &b.paint };
        let painted: FxHashSet<_> = paint.iter().map(|p| corner_bits(p.corners)).collect();
        let inverted = is_inverted(b, l[2]);
        for t in &b.mesh.triangles {
            let corners = t.map(|i| b.mesh.positions[i as usize]);
            if !painted.contains(&corner_bits(corners)) {
                let [i, j, k] = *t;
                let t = if inverted { [i, k, j] } else { [i, j, k] };
                parts.entry(own).or_default().extend(t);
            }
        }
        for piece in paint.iter().flat_map(|p| p.pieces(fine)) {
            let colour = piece.colour([1.0 / 3.0; 3]).map(|v| v & COARSE);
            let material = of_colour(colour, &mut scene);
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(piece.corners.map(turned));
            let own = parts.entry(material).or_default();
            own.extend([first, first + 1, first + 2]);
        }
        mesh.parts.extend(parts);
        scene.meshes.extend(small(mesh));
    }
    if low[0] <= high[0] {
        scene
            .meshes
            .extend(small(ground(&bases, low, high, &turned)));
    }
    scene.groups.push(Group {
        name: city.name.clone(),
        yaw: 0.0,
        translation: [0.0; 3],
        instances: (0..scene.meshes.len())
            .map(|m| Instance::at(m, [0.0; 3]))
            .collect(),
    });
    scene
}

/// A mesh in pieces of few triangles: the renderer lets larger meshes cast the shadow of their boxes.
fn small(mesh: Mesh) -> Vec<Mesh> {
    if mesh.triangles() <= MOST_TRIANGLES {
        return vec![mesh];
    }
    let mut out = Vec::new();
    for (material, indices) in &mesh.parts {
        for chunk in indices.chunks(3 * MOST_TRIANGLES) {
            let mut known: FxHashMap<u32, u32> = FxHashMap::default();
            let mut positions = Vec::new();
            let own = chunk.iter().map(|&i| {
                *known.entry(i).or_insert_with(|| {
                    positions.push(mesh.positions[i as usize]);
                    positions.len() as u32 - 1
                })
            });
            let own = own.collect();
            out.push(Mesh {
                name: mesh.name.clone(),
                positions,
                parts: vec![(*material, own)],
            });
        }
    }
    out
}

/// Length of the pieces that painted surfaces are drawn in.
fn fineness(city: &City) -> f64 {
    let paint = || city.buildings.iter().flat_map(|b| &b.paint);
    let area: f64 = paint().map(Painted::area).sum();
    // Slivers are cut by their length, whatever their area.
    let length: f64 = paint().map(Painted::longest).sum();
    let fine = (2.0 * area / MOST_PIECES).sqrt();
    fine.max(length / MOST_PIECES).max(FINEST)
}

/// True if the surface of a building faces inwards.
fn is_inverted(building: &CityBuilding, base: f64) -> bool {
    building.mesh.volume_above(base) < 0.0
}

/// The ground under the buildings and around them.
fn ground(
    bases: &[([f64; 2], f64)],
    low: [f64; 2],
    high: [f64; 2],
    turned: &impl Fn([f64; 3]) -> [f32; 3],
) -> Mesh {
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let margin = (MARGIN.0 * extent).min(MARGIN.1);
    let terrain = Terrain::under(bases, low.map(|v| v - margin), high.map(|v| v + margin));
    let [columns, rows] = terrain.size;
    let corner = |at: usize| {
        let [x, y] = [at % columns, at / columns].map(|n| n as f64 * terrain.side);
        turned([
            terrain.corner[0] + x,
            terrain.corner[1] + y,
            terrain.heights[at],
        ])
    };
    let mut indices = Vec::new();
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            let first = (j * columns + i) as u32;
            let above = first + columns as u32;
            indices.extend([first, first + 1, above + 1, first, above + 1, above]);
        }
    }
    Mesh {
        name: "ground".to_owned(),
        positions: (0..columns * rows).map(corner).collect(),
        parts: vec![(1, indices)],
    }
}
