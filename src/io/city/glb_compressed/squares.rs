//! Instances that are drawn out, by squares of the plan.

use std::collections::BTreeMap;

use super::super::faceted::unit;
use super::shape::Shape;
use edifice_grammar::instance::TemplateInstance;

/// Side of a square, in metres: so large that it holds many buildings, and not larger than corners can be told apart in.
const SIDE: f64 = 1000.0;

/// The instances of a square.
#[derive(Default)]
pub(super) struct Square {
    /// All of them, z up, in the coordinates of the city.
    pub(super) shape: Shape,
    /// The building of each corner.
    pub(super) buildings: Vec<Option<usize>>,
}

/// Squares that hold instances.
#[derive(Default)]
pub(super) struct Squares(BTreeMap<[i64; 2], Square>);

impl Squares {
    /// Adds the instances of a mesh, each to the square of its place.
    pub(super) fn add(&mut self, shape: &Shape, instances: &[&TemplateInstance]) {
        for instance in instances {
            let cell = [0, 1].map(|k| (instance.at[k] / SIDE).floor() as i64);
            let square = self.0.entry(cell).or_default();
            let mesh = &mut square.shape.mesh;
            let first = mesh.positions.len() as u32;
            let corners = shape.mesh.positions.iter().map(|&p| instance.place(p));
            mesh.positions.extend(corners);
            let triangles = shape.mesh.triangles.iter();
            mesh.triangles
                .extend(triangles.map(|t| t.map(|i| first + i)));
            square
                .buildings
                .resize(mesh.positions.len(), instance.building);
            let normals = shape.normals.iter().map(|&n| placed(instance, n));
            square.shape.normals.extend(normals);
        }
    }

    /// All of them, in the order of their places.
    pub(super) fn all(&self) -> impl Iterator<Item = &Square> {
        self.0.values()
    }
}

/// The normal of an instance where its template has one.
fn placed(instance: &TemplateInstance, normal: [f64; 3]) -> [f64; 3] {
    // A side that is longer turns normals away from it.
    let [x, y, z] = [0, 1, 2].map(|k| match instance.size[k] {
        0.0 => 0.0,
        size => normal[k] / size,
    });
    let (sin, cos) = instance.turn.to_radians().sin_cos();
    let turned = [x * cos - y * sin, x * sin + y * cos, z];
    unit(turned).unwrap_or([0.0, 0.0, 1.0])
}
