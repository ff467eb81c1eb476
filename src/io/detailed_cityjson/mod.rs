//! Buildings of level of detail 3 as CityJSON 2.0: a solid with named surfaces, openings in their walls.
//!
//! Each building is one `Building` with one geometry of `lod` 3: a `Solid` where the surface is closed and in one piece,
//! else a `MultiSurface`. Boundaries are triangles, so that each is plane. The surface of each triangle has a class of
//! CityJSON 2.0 (Sec. 3.3, `semantics`); windows and doors name their wall as `parent`, walls their openings as
//! `children`. What is attached to a building has no class of its own there: eaves and posts are a `RoofSurface`,
//! chimneys and the bases of porches a `WallSurface`, all with their names.
//!
//! Corners are whole numbers of millimetres where all corners are, to a tenth of a micrometre; else of micrometres.

mod check;
mod read;

use std::fmt::Write;

use rustc_hash::FxHashMap;
use serde_json::{Map, Value, json};

use super::reference_system::standard_name;
use edifice_shape::solid::{Finish, Surface};
use edifice_shape::{DetailedBuilding, Part, PartKind};

pub use check::faults;
pub use read::{Described, Shell, ShellError, parse, shells};

/// The place of buildings: what is added to each coordinate, and the reference system.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Place {
    /// Added to each corner (m).
    pub origin: [f64; 3],
    /// The reference system, for example `EPSG:7415`; names that are none of the Open Geospatial Consortium's are left
    /// out.
    pub reference_system: Option<String>,
}

/// Units of coordinates in metres, and the largest error in units at which the coarser one is taken.
const MILLIMETRE: f64 = 1e-3;
const MICROMETRE: f64 = 1e-6;
const EXACT: f64 = 1e-4;

/// The text of a CityJSON 2.0 file of all buildings.
pub fn to_string(buildings: &[DetailedBuilding], place: &Place) -> String {
    let whole = |v: &f64| (v / MILLIMETRE - (v / MILLIMETRE).round()).abs() < EXACT;
    let positions = buildings.iter().flat_map(|b| &b.positions);
    let scale = match positions.flatten().all(whole) {
        true => MILLIMETRE,
        false => MICROMETRE,
    };
    let mut document = Document::of_unit(scale);
    buildings.iter().for_each(|b| document.add(b));
    document.finish(place)
}

/// A CityJSON 2.0 file that grows building by building: of a city, no more than its text and its corners is in memory.
#[derive(Debug)]
pub struct Document {
    vertices: Vertices,
    /// The members of `CityObjects` so far.
    objects: String,
}

impl Default for Document {
    /// Without buildings, in micrometres.
    fn default() -> Self {
        Self::of_unit(MICROMETRE)
    }
}

impl Document {
    fn of_unit(scale: f64) -> Self {
        let vertices = Vertices {
            scale,
            known: FxHashMap::default(),
            all: Vec::new(),
        };
        Self {
            vertices,
            objects: String::new(),
        }
    }

    /// Adds a building, whose name differs from those of all before it.
    pub fn add(&mut self, building: &DetailedBuilding) {
        let geometry = geometry(building, &mut self.vertices);
        let mut object = json!({ "type": "Building", "geometry": [geometry] });
        if !building.attributes.is_empty() {
            object["attributes"] = Value::Object(building.attributes.clone());
        }
        let comma = if self.objects.is_empty() { "" } else { "," };
        let name = Value::from(building.name.as_str());
        self.objects += &format!("{comma}\n{name}:{object}");
    }

    /// The text of the file.
    pub fn finish(self, place: &Place) -> String {
        let scale = self.vertices.scale;
        let mut head = json!({ "type": "CityJSON", "version": "2.0",
            "transform": { "scale": [scale, scale, scale], "translate": place.origin } });
        if let Some(system) = place.reference_system.as_deref().and_then(standard_name) {
            head["metadata"] = json!({ "referenceSystem": system });
        }
        let mut text = head.to_string();
        // The object goes on.
        text.pop();
        text += ",\n\"CityObjects\":{";
        text += &self.objects;
        drop(self.objects);
        text += "},\n\"vertices\":[";
        for (k, [x, y, z]) in self.vertices.all.iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            // Writing to a string cannot fail.
            let _ = write!(text, "{comma}[{x},{y},{z}]");
        }
        text + "]}\n"
    }
}

/// The corners of all buildings, each once.
#[derive(Debug)]
struct Vertices {
    scale: f64,
    known: FxHashMap<[i64; 3], u32>,
    all: Vec<[i64; 3]>,
}

impl Vertices {
    fn index(&mut self, p: [f64; 3]) -> u32 {
        let key = p.map(|v| (v / self.scale).round() as i64);
        *self.known.entry(key).or_insert_with(|| {
            self.all.push(key);
            self.all.len() as u32 - 1
        })
    }
}

fn geometry(building: &DetailedBuilding, vertices: &mut Vertices) -> Value {
    let mut boundaries = Vec::new();
    let mut values = Vec::new();
    for (part, t, _) in building.triangles() {
        let ring = building.corners(t).map(|p| vertices.index(p));
        // A triangle whose corners are one point in the unit of the file is none.
        if ring[0] != ring[1] && ring[1] != ring[2] && ring[2] != ring[0] {
            boundaries.push([ring]);
            values.push(part);
        }
    }
    let mut children = vec![Vec::new(); building.parts.len()];
    for (k, part) in building.parts.iter().enumerate() {
        if let Some(wall) = part.wall {
            children[wall].push(k);
        }
    }
    let surfaces: Vec<Value> = (building.parts.iter().zip(&children))
        .map(|(part, children)| surface(part, children))
        .collect();
    let corners = boundaries
        .iter()
        .map(|[ring]| ring.map(|v| vertices.all[v as usize]));
    let own = surface_of(corners);
    // Closed, and in one piece.
    match own.check().is_ok_and(|report| report.shells == 1) {
        true => json!({ "type": "Solid", "lod": "3", "boundaries": [boundaries],
            "semantics": { "surfaces": surfaces, "values": [values] } }),
        false => json!({ "type": "MultiSurface", "lod": "3", "boundaries": boundaries,
            "semantics": { "surfaces": surfaces, "values": values } }),
    }
}

/// The description of a part in which others lie.
fn surface(part: &Part, children: &[usize]) -> Value {
    let class = match part.kind {
        PartKind::BuildingInstallation if part.name == "trim" => PartKind::RoofSurface,
        PartKind::BuildingInstallation => PartKind::WallSurface,
        kind => kind,
    };
    let mut surface = Map::new();
    surface.insert("type".into(), json!(class.name()));
    surface.insert("name".into(), json!(part.name));
    if let Some(wall) = part.wall {
        surface.insert("parent".into(), json!(wall));
    }
    if !children.is_empty() {
        surface.insert("children".into(), json!(children));
    }
    for (name, value) in &part.attributes {
        surface.insert(name.clone(), value.clone());
    }
    Value::Object(surface)
}

/// The surface of triangles whose corners are whole numbers.
fn surface_of(triangles: impl Iterator<Item = [[i64; 3]; 3]>) -> Surface {
    let mut surface = Surface::default();
    for corners in triangles {
        let first = surface.positions.len() as u32;
        surface
            .positions
            .extend(corners.map(|p| p.map(|v| v as f64)));
        let own = [first, first + 1, first + 2];
        surface.triangles.push((own, Finish::Wall));
    }
    surface
}
