//! A city: buildings with identifiers, attributes and triangles.

use std::ops::Range;
use std::sync::Arc;

use super::{OrientedBox, Painted, TriangleMesh};

/// A building of a city.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CityBuilding {
    /// Identifier, unique in its city.
    pub id: String,
    /// Further properties as JSON, kept as they were read.
    pub attributes: serde_json::Map<String, serde_json::Value>,
    /// Its surface, relative to the city's origin.
    pub mesh: TriangleMesh,
    /// The parts that make up the surface, if the input names them: all of it, or none. Whoever changes the mesh clears
    /// them.
    pub parts: Vec<Part>,
    /// The paint of the surface, as far as the input gives it, in the same coordinates.
    pub paint: Vec<Painted>,
}

/// A part of a building's mesh that is an instance of a template: a mesh in the unit box (x and y from -1/2 to 1/2, z from
/// 0 to 1) that a box puts into its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Number of the template: parts of one number are instances of the same mesh.
    pub template: usize,
    /// The box that the template is put into.
    pub frame: OrientedBox,
    /// Positions of the building's mesh that belong to it.
    pub positions: Range<usize>,
    /// Triangles of the building's mesh that belong to it.
    pub triangles: Range<usize>,
    /// The picture file of the template's box mapping ([`super::BoxTexture`]), if it has one.
    pub texture: Option<Arc<[u8]>>,
}

/// The distance that a template may reach out of the unit box.
const OUTSIDE: f64 = 1e-6;

impl CityBuilding {
    /// Appends an instance, `placed`, of the template with that number and texture, which `frame` puts into its place. The part
    /// is noted where the template lies in the unit box.
    pub fn append_instance(
        &mut self,
        placed: &TriangleMesh,
        template: usize,
        frame: Option<OrientedBox>,
        texture: Option<Arc<[u8]>>,
    ) {
        let (p, t) = (self.mesh.positions.len(), self.mesh.triangles.len());
        self.mesh.append(placed);
        let inside = |frame: &OrientedBox| {
            let mut unit = placed.positions.iter().map(|&p| frame.to_unit(p));
            unit.all(|[x, y, z]| {
                x.abs().max(y.abs()) <= 0.5 + OUTSIDE && (z - 0.5).abs() <= 0.5 + OUTSIDE
            })
        };
        if let Some(frame) = frame.filter(inside) {
            self.parts.push(Part {
                template,
                frame,
                positions: p..self.mesh.positions.len(),
                triangles: t..self.mesh.triangles.len(),
                texture,
            });
        }
    }

    /// The parts, from the ground up, if they are all of the mesh.
    pub fn stated_parts(&self) -> Option<Vec<(&Part, TriangleMesh)>> {
        let covered: usize = self.parts.iter().map(|p| p.triangles.len()).sum();
        if self.parts.is_empty() || covered != self.mesh.triangles.len() {
            return None;
        }
        let mut parts: Vec<&Part> = self.parts.iter().collect();
        let key = |p: &Part| {
            let [x, y, z] = p.frame.base;
            [z, x, y]
        };
        parts.sort_by(|a, b| {
            let places = key(a).into_iter().zip(key(b));
            let unequal = places.map(|(x, y)| x.total_cmp(&y)).find(|o| o.is_ne());
            unequal.unwrap_or_else(|| a.template.cmp(&b.template))
        });
        Some(parts.into_iter().map(|p| (p, self.unit(p))).collect())
    }

    /// The template of a part.
    fn unit(&self, part: &Part) -> TriangleMesh {
        let first = part.positions.start as u32;
        let positions = self.mesh.positions[part.positions.clone()].iter();
        let triangles = self.mesh.triangles[part.triangles.clone()].iter();
        TriangleMesh {
            positions: positions.map(|&p| part.frame.to_unit(p)).collect(),
            triangles: triangles.map(|t| t.map(|i| i - first)).collect(),
        }
    }
}

/// Buildings in one frame: metres, z up.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct City {
    /// Name.
    pub name: String,
    /// Coordinate reference system, when the input says it.
    pub reference_system: Option<String>,
    /// The shift from these coordinates to those of the reference system.
    pub origin: [f64; 3],
    /// The buildings.
    pub buildings: Vec<CityBuilding>,
    /// Notes on what a reader left out or changed, in words.
    pub notes: Vec<String>,
}

impl City {
    /// Triangles of all buildings.
    pub fn triangles(&self) -> usize {
        self.buildings.iter().map(|b| b.mesh.triangles.len()).sum()
    }

    /// Appends the buildings of another city, moved into this one's frame.
    pub fn merge(&mut self, other: Self) {
        let shift = [0, 1, 2].map(|k| other.origin[k] - self.origin[k]);
        self.notes.extend(other.notes);
        let templates = self.buildings.iter().flat_map(|b| &b.parts);
        let known = templates.map(|p| p.template + 1).max().unwrap_or(0);
        for mut building in other.buildings {
            let parts = building.parts.iter_mut();
            let bases = parts.map(|part| {
                part.template += known;
                &mut part.frame.base
            });
            let paint = building.paint.iter_mut().flat_map(|p| &mut p.corners);
            for p in bases.chain(&mut building.mesh.positions).chain(paint) {
                *p = [0, 1, 2].map(|k| p[k] + shift[k]);
            }
            self.buildings.push(building);
        }
    }

    /// Moves whole metres, those of the lower corner, from the coordinates to the origin.
    pub fn take_off_origin(&mut self) {
        let positions = self.buildings.iter().flat_map(|b| &b.mesh.positions);
        let low = positions.fold([f64::INFINITY; 3], |low, p| {
            [0, 1, 2].map(|k| p[k].min(low[k]))
        });
        if !low.iter().all(|v| v.is_finite()) {
            return;
        }
        let shift = [low[0].floor(), low[1].floor(), 0.0];
        for building in &mut self.buildings {
            let bases = building.parts.iter_mut().map(|p| &mut p.frame.base);
            let paint = building.paint.iter_mut().flat_map(|p| &mut p.corners);
            for p in bases.chain(&mut building.mesh.positions).chain(paint) {
                *p = [0, 1, 2].map(|k| p[k] - shift[k]);
            }
        }
        self.origin = [0, 1, 2].map(|k| self.origin[k] + shift[k]);
    }

    /// Makes identifiers unique: one that occurs again gets a number.
    pub fn number_duplicates(&mut self) {
        let mut seen = rustc_hash::FxHashSet::default();
        for building in &mut self.buildings {
            let mut number = 1;
            let mut id = building.id.clone();
            while !seen.insert(id.clone()) {
                number += 1;
                id = format!("{}#{number}", building.id);
            }
            building.id = id;
        }
    }
}
