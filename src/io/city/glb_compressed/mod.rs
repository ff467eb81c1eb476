//! Instance grammars as small binary glTF 2.0: as [`super::glb`] writes them, with `KHR_mesh_quantization` and
//! `EXT_meshopt_compression`.
//!
//! There is one buffer view of each kind (corners, triangles, places, turns, sizes, buildings), compressed as a whole by the
//! codecs of meshoptimizer. Corners are integers along the sides of their template's box, so fine that none is farther than 2.5 cm
//! from its place along a side in the largest instance; places and sizes of instances are rounded as finely, so that no corner is farther
//! than 5 cm from its place along a side. A mesh with instances takes some hundred bytes of JSON: where
//! its instances are fewer bytes drawn out, they are written into one mesh for each square of the plan (`squares`), each corner
//! with its `_BUILDING`. Identifiers of buildings are a property table (`EXT_structural_metadata`). Templates with pictures are written as in plain files.

mod identifiers;
mod shape;
mod squares;
mod streams;
mod views;

use serde_json::json;

use self::shape::Shape;
use self::squares::Squares;
use self::streams::Streams;
use super::glb::{Glb, GlbError, INSTANCING, by_template, rotation, turned};
use super::meshopt_views::EXTENSION;
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar, TemplateInstance};
use edifice_shape::triangles::TriangleMesh;

/// Steps of corners, in metres.
const STEP: f64 = 0.05;
/// Steps along a side at most.
const STEPS: f64 = 65535.0;
/// Bytes of JSON for a mesh and a node with instances,
const JSON_BYTES: f64 = 765.0;
/// and of an instance, a corner and a triangle, compressed: about.
const INSTANCE_BYTES: f64 = 16.0;
const CORNER_BYTES: f64 = 4.0;
const TRIANGLE_BYTES: f64 = 1.2;

/// The bytes of a file.
///
/// # Errors
/// [`GlbError`].
pub fn to_bytes(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
) -> Result<Vec<u8>, GlbError> {
    write(Glb::default(), grammar, derivation)
}

/// The bytes of a tile of 3D Tiles: with normals, and with the origin left to the tileset.
///
/// # Errors
/// [`GlbError`].
pub(super) fn tile_to_bytes(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
) -> Result<Vec<u8>, GlbError> {
    write(Glb::tile(), grammar, derivation)
}

fn write(
    mut file: Glb,
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
) -> Result<Vec<u8>, GlbError> {
    let mut streams = Streams::default();
    let mut squares = Squares::default();
    let mut is_instanced = false;
    for (template, instances) in by_template(grammar, derivation) {
        let shape = Shape::new(&template.mesh, file.is_tile);
        if shape.mesh.triangles.is_empty() {
            continue;
        }
        if template.texture.is_none() && is_less_drawn_out(&shape.mesh, &instances) {
            squares.add(shape, &instances);
            continue;
        }
        is_instanced = true;
        match template.texture.is_some() {
            true => file.instanced(template, &instances),
            false => {
                let name = &template.symbol;
                instanced(&mut file, &mut streams, name, &shape, &instances);
            }
        }
    }
    for square in squares.all() {
        let mesh = &square.shape.mesh;
        let corners: Vec<[f64; 3]> = mesh.positions.iter().map(|&p| y_up(p)).collect();
        let grid = Grid::around(&corners, [1.0; 3]);
        let mut primitive = streams.primitive(&mut file, &grid.corners(&corners), &square.shape);
        primitive["attributes"]["_BUILDING"] =
            json!(streams.buildings(&mut file, square.buildings.iter().copied()));
        file.meshes.push(json!({ "primitives": [primitive] }));
        file.node(
            json!({ "mesh": file.meshes.len() - 1, "translation": grid.low.map(|v| v as f32),
            "scale": grid.step.map(|v| v as f32) }),
        );
    }
    let ids: Vec<&str> = derivation.buildings.iter().map(|b| b.0.as_str()).collect();
    streams.write(&mut file, &ids)?;
    let mut required = vec!["KHR_mesh_quantization", EXTENSION];
    if is_instanced {
        required.push(INSTANCING);
    }
    file.finish(grammar, derivation, &required)
}

/// True if the instances take fewer bytes each with corners of its own.
fn is_less_drawn_out(mesh: &TriangleMesh, instances: &[&TemplateInstance]) -> bool {
    let n = instances.len() as f64;
    let shape =
        CORNER_BYTES * mesh.positions.len() as f64 + TRIANGLE_BYTES * mesh.triangles.len() as f64;
    let known = instances.iter().all(|i| i.building.is_some());
    known && n * shape < JSON_BYTES + shape + n * INSTANCE_BYTES
}

/// Adds a mesh and its instances to a file.
fn instanced(
    file: &mut Glb,
    streams: &mut Streams,
    name: &str,
    shape: &Shape,
    instances: &[&TemplateInstance],
) {
    let corners: Vec<[f64; 3]> = shape.mesh.positions.iter().map(|&p| y_up(p)).collect();
    let size = |k: usize| {
        instances
            .iter()
            .map(|i| i.size[k].abs())
            .fold(0.0, f64::max)
    };
    let grid = Grid::around(&corners, [size(0), size(2), size(1)]);
    let primitive = streams.primitive(file, &grid.corners(&corners), shape);
    file.meshes
        .push(json!({ "name": name, "primitives": [primitive] }));
    let [x, y, z] = grid.low;
    let low = [x, -z, y];
    let places = instances.iter().map(|i| turned(i.place(low)));
    let sizes = instances.iter().map(|i| {
        let [w, d, h] = i.size;
        std::array::from_fn(|k| ([w, h, d][k] * grid.step[k]) as f32)
    });
    let attributes = json!({
        "TRANSLATION": streams.places(file, places),
        "ROTATION": streams.turns(file, instances.iter().map(|i| rotation(i))),
        "SCALE": streams.sizes(file, sizes, grid.largest),
        "_BUILDING": streams.buildings(file, instances.iter().map(|i| i.building)),
    });
    file.node(json!({ "mesh": file.meshes.len() - 1,
        "extensions": { INSTANCING: { "attributes": attributes } } }));
}

/// z up to y up.
fn y_up([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, z, -y]
}

/// A grid of integers within a box.
struct Grid {
    low: [f64; 3],
    step: [f64; 3],
    /// The largest side of an instance, in metres.
    largest: f64,
}

impl Grid {
    /// The grid over some points of which the largest instance has `size`.
    fn around(points: &[[f64; 3]], size: [f64; 3]) -> Self {
        let bound = |k: usize, start: f64, pick: fn(f64, f64) -> f64| {
            points.iter().map(|p| p[k]).fold(start, pick)
        };
        let low: [f64; 3] = std::array::from_fn(|k| bound(k, f64::INFINITY, f64::min));
        let sides: [f64; 3] =
            std::array::from_fn(|k| bound(k, f64::NEG_INFINITY, f64::max) - low[k]);
        let step = std::array::from_fn(|k| {
            let side = sides[k];
            let steps = (side * size[k] / STEP).ceil().clamp(1.0, STEPS);
            // A flat box has one layer of points.
            if side > 0.0 { side / steps } else { 1.0 }
        });
        let largest = (0..3).map(|k| sides[k] * size[k]).fold(0.0, f64::max);
        Self { low, step, largest }
    }

    fn corners(&self, points: &[[f64; 3]]) -> Vec<[u16; 3]> {
        let whole = |p: &[f64; 3], k: usize| ((p[k] - self.low[k]) / self.step[k]).round() as u16;
        points
            .iter()
            .map(|p| std::array::from_fn(|k| whole(p, k)))
            .collect()
    }
}
