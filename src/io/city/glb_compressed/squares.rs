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

impl Square {
    fn add(&mut self, shape: &Shape, instance: &TemplateInstance) {
        let mesh = &mut self.shape.mesh;
        let first = mesh.positions.len() as u32;
        let corners = shape.mesh.positions.iter().map(|&p| instance.place(p));
        mesh.positions.extend(corners);
        let triangles = shape.mesh.triangles.iter();
        mesh.triangles
            .extend(triangles.map(|t| t.map(|i| first + i)));
        self.buildings
            .resize(mesh.positions.len(), instance.building);
        let normals = shape.normals.iter().map(|&n| placed(instance, n));
        self.shape.normals.extend(normals);
    }
}

/// Instances by squares.
#[derive(Default)]
pub(super) struct Squares<'a> {
    shapes: Vec<Shape>,
    /// Each instance with the index of its shape.
    instances: BTreeMap<[i64; 2], Vec<(usize, &'a TemplateInstance)>>,
}

impl<'a> Squares<'a> {
    /// Adds the instances of a mesh, each to the square of its place.
    pub(super) fn add(&mut self, shape: Shape, instances: &[&'a TemplateInstance]) {
        for &instance in instances {
            let cell = [0, 1].map(|k| (instance.at[k] / SIDE).floor() as i64);
            let square = self.instances.entry(cell).or_default();
            square.push((self.shapes.len(), instance));
        }
        self.shapes.push(shape);
    }

    /// The squares that hold instances, in the order of their places. Instances are in the order of their buildings, of which neighbours
    /// follow each other: the codec takes few bytes where a corner is near the one before.
    pub(super) fn all(mut self) -> impl Iterator<Item = Square> {
        let squares = std::mem::take(&mut self.instances).into_values();
        squares.map(move |mut instances| {
            instances.sort_by_key(|(shape, instance)| (instance.building, *shape));
            let mut square = Square::default();
            for (shape, instance) in instances {
                square.add(&self.shapes[shape], instance);
            }
            square
        })
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
