//! A city: buildings with identifiers, attributes and triangles.

use super::TriangleMesh;

/// A building of a city.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CityBuilding {
    /// Identifier, unique in its city.
    pub id: String,
    /// Further properties as JSON, kept as they were read.
    pub attributes: serde_json::Map<String, serde_json::Value>,
    /// Its surface, relative to the city's origin.
    pub mesh: TriangleMesh,
}

/// Buildings in one frame: metres, z up.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct City {
    /// Name.
    pub name: String,
    /// Coordinate reference system, when the input says it.
    pub reference_system: Option<String>,
    /// What to add to every coordinate to be in the reference system.
    pub origin: [f64; 3],
    /// The buildings.
    pub buildings: Vec<CityBuilding>,
}

impl City {
    /// Triangles of all buildings.
    pub fn triangles(&self) -> usize {
        self.buildings.iter().map(|b| b.mesh.triangles.len()).sum()
    }

    /// Appends the buildings of another city, moved into this one's frame.
    pub fn merge(&mut self, other: Self) {
        let shift = [0, 1, 2].map(|k| other.origin[k] - self.origin[k]);
        for mut building in other.buildings {
            for p in &mut building.mesh.positions {
                *p = [0, 1, 2].map(|k| p[k] + shift[k]);
            }
            self.buildings.push(building);
        }
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
