//! One building while it is read.

use rustc_hash::FxHashMap;
use serde_json::{Map, Value};

use super::element::Element;
use super::error::{CityGmlError, Dropped};
use super::system::System;
use edifice_shape::triangles::{CityBuilding, TriangleMesh, polygon_triangles};

/// The levels of detail that are read.
const LEVELS: usize = 4;
/// Elements whose content is not the outer shell.
const ROOMS: [&str; 3] = [
    "interiorRoom",
    "buildingRoom",
    "interiorBuildingInstallation",
];
/// Coordinates closer than this are one corner, in metres.
const WELD: f64 = 1e-6;

/// A polygon: rings of corners, the outer one first.
type Rings = Vec<Vec<[f64; 3]>>;

/// A surface of a geometry: a polygon in place, or a reference; and whether it is turned over.
#[derive(Clone)]
enum Member {
    Polygon(usize, bool),
    Link(String, bool),
}

/// The geometry of a `Building` or a `BuildingPart`, by level of detail.
#[derive(Default)]
struct Shell {
    solids: [Vec<Member>; LEVELS],
    surfaces: [Vec<Member>; LEVELS],
}

/// A building while it is read.
pub(super) struct Draft {
    pub(super) id: String,
    attributes: Map<String, Value>,
    polygons: Vec<Rings>,
    /// Polygons below each element that has an identifier.
    named: FxHashMap<String, Vec<usize>>,
    shells: Vec<Shell>,
    /// Indices of the shells of the open objects.
    objects: Vec<usize>,
    /// Level of detail of the open geometry, and whether it is a solid.
    geometry: Option<(usize, bool)>,
    polygon: Option<Rings>,
    ring: Option<Vec<f64>>,
    dimension: usize,
    reversed: usize,
    hidden: usize,
    /// Label of the open generic attribute.
    generic: Option<String>,
}

impl Draft {
    pub(super) fn new(id: String) -> Self {
        Self {
            id,
            attributes: Map::new(),
            polygons: Vec::new(),
            named: FxHashMap::default(),
            shells: vec![Shell::default()],
            objects: vec![0],
            geometry: None,
            polygon: None,
            ring: None,
            dimension: 3,
            reversed: 0,
            hidden: 0,
            generic: None,
        }
    }

    /// An element begins, inside those that are open.
    pub(super) fn start(&mut self, element: &Element, open: &[Element], dropped: &mut Dropped) {
        let name = element.name.as_str();
        if ROOMS.contains(&name) {
            self.hidden += 1;
            dropped.rooms += 1;
        }
        if self.hidden > 0 {
            return;
        }
        if let Some(dimension) = element.dimension {
            self.dimension = dimension;
        }
        if element.reversed && name == "OrientableSurface" {
            self.reversed += 1;
        }
        if let Some(level) = level_of(name) {
            self.geometry = Some(level);
        }
        match name {
            "BuildingPart" => {
                self.objects.push(self.shells.len());
                self.shells.push(Shell::default());
            }
            "ImplicitGeometry" => dropped.implicit += 1,
            "Polygon" | "Triangle" | "Rectangle" => self.polygon = Some(Vec::new()),
            "LinearRing" if self.polygon.is_some() => self.ring = Some(Vec::new()),
            _ => {}
        }
        if name.ends_with("Attribute") && is_object(open.last()) {
            self.generic.clone_from(&element.label);
        }
        if let Some(link) = &element.link
            && matches!(
                name,
                "surfaceMember" | "baseSurface" | "exterior" | "surfaceMembers" | "shell"
            )
        {
            let member = Member::Link(link.clone(), self.reversed % 2 == 1);
            self.add(member);
        }
    }

    /// An element ends, inside those that stay open.
    pub(super) fn end(
        &mut self,
        element: Element,
        open: &[Element],
        system: &mut System,
    ) -> Result<(), CityGmlError> {
        let name = element.name.as_str();
        if ROOMS.contains(&name) {
            self.hidden = self.hidden.saturating_sub(1);
            return Ok(());
        }
        if self.hidden > 0 {
            return Ok(());
        }
        match name {
            "posList" | "pos" | "coordinates" => {
                if let Some(ring) = &mut self.ring {
                    numbers(&element.text, ring)?;
                }
            }
            "LinearRing" => {
                if let (Some(ring), Some(polygon)) = (self.ring.take(), &mut self.polygon) {
                    polygon.push(corners(&ring, self.dimension, system)?);
                }
            }
            "Polygon" | "Triangle" | "Rectangle" => {
                if let Some(rings) = self.polygon.take() {
                    self.finish_polygon(rings, &element, open);
                }
            }
            "BuildingPart" => {
                self.objects.pop();
            }
            "OrientableSurface" if element.reversed => {
                self.reversed = self.reversed.saturating_sub(1);
            }
            "value" => {
                if let Some(label) = &self.generic {
                    let value = value(&element.text);
                    self.attributes.entry(label.clone()).or_insert(value);
                }
            }
            _ if name.ends_with("Attribute") => self.generic = None,
            _ => {
                let text = element.text.trim();
                if is_object(open.last()) && !text.is_empty() && self.objects.len() == 1 {
                    self.attributes
                        .entry(name.to_owned())
                        .or_insert_with(|| value(text));
                }
            }
        }
        if level_of(name).is_some() {
            self.geometry = None;
        }
        Ok(())
    }

    fn finish_polygon(&mut self, rings: Rings, element: &Element, open: &[Element]) {
        let number = self.polygons.len();
        self.polygons.push(rings);
        let ids = open.iter().rev().take_while(|e| !is_object(Some(e)));
        for id in ids.chain([element]).filter_map(|e| e.id.as_ref()) {
            self.named.entry(id.clone()).or_default().push(number);
        }
        self.add(Member::Polygon(number, self.reversed % 2 == 1));
    }

    /// Adds a surface to the geometry that is open.
    fn add(&mut self, member: Member) {
        let (Some((level, solid)), Some(&object)) = (self.geometry, self.objects.last()) else {
            return;
        };
        let shell = &mut self.shells[object];
        let list = if solid {
            &mut shell.solids
        } else {
            &mut shell.surfaces
        };
        list[level].push(member);
    }

    /// The building, when all of it is read.
    pub(super) fn finish(self, dropped: &mut Dropped) -> CityBuilding {
        let mut mesh = TriangleMesh::default();
        for shell in &self.shells {
            let level = (1..LEVELS)
                .rev()
                .find(|&l| !shell.solids[l].is_empty() || !shell.surfaces[l].is_empty());
            let Some(level) = level else { continue };
            let members = match shell.solids[level].is_empty() {
                true => &shell.surfaces[level],
                false => &shell.solids[level],
            };
            for member in members {
                let (numbers, reversed) = match member {
                    Member::Polygon(number, reversed) => (vec![*number], *reversed),
                    Member::Link(id, reversed) => match self.named.get(id) {
                        Some(numbers) => (numbers.clone(), *reversed),
                        None => {
                            dropped.references += 1;
                            continue;
                        }
                    },
                };
                for number in numbers {
                    self.draw(number, reversed, &mut mesh, dropped);
                }
            }
        }
        CityBuilding {
            id: self.id,
            attributes: self.attributes,
            mesh: mesh.welded(WELD),
            ..CityBuilding::default()
        }
    }

    fn draw(&self, number: usize, reversed: bool, mesh: &mut TriangleMesh, dropped: &mut Dropped) {
        let triangles = polygon_triangles(&self.polygons[number]);
        dropped.degenerate += usize::from(triangles.is_empty());
        for mut corners in triangles {
            if reversed {
                corners.swap(1, 2);
            }
            mesh.push(corners);
        }
    }
}

/// True if an element is a building or a part of one.
fn is_object(element: Option<&Element>) -> bool {
    element.is_some_and(|e| matches!(e.name.as_str(), "Building" | "BuildingPart"))
}

/// The level of detail of `lod2Solid`, `lod3MultiSurface`, `lod2Geometry` and the like, and whether it is a solid; of
/// footprints, roof edges, curves and points, `None`.
fn level_of(name: &str) -> Option<(usize, bool)> {
    let rest = name.strip_prefix("lod")?;
    let level = rest.chars().next()?.to_digit(10)? as usize;
    let solid = match &rest[1..] {
        "Solid" => true,
        "MultiSurface" | "Geometry" => false,
        _ => return None,
    };
    (level < LEVELS).then_some((level, solid))
}

/// Appends the numbers of a text.
fn numbers(text: &str, out: &mut Vec<f64>) -> Result<(), CityGmlError> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',');
    for word in words.filter(|w| !w.is_empty()) {
        let number: Option<f64> = word.parse().ok().filter(|v: &f64| v.is_finite());
        out.push(number.ok_or_else(|| CityGmlError::Coordinate(word.to_owned()))?);
    }
    Ok(())
}

/// The corners of a ring, without the last where it is the first again.
fn corners(
    ring: &[f64],
    dimension: usize,
    system: &mut System,
) -> Result<Vec<[f64; 3]>, CityGmlError> {
    let wrong = || CityGmlError::Dimension {
        count: ring.len(),
        dimension,
    };
    if !(2..=3).contains(&dimension) || !ring.len().is_multiple_of(dimension) {
        return Err(wrong());
    }
    let corner = |c: &[f64]| system.metres([c[0], c[1], c.get(2).copied().unwrap_or(0.0)]);
    let mut out: Vec<[f64; 3]> = ring.chunks_exact(dimension).map(corner).collect();
    if out.len() > 1 && out.first() == out.last() {
        out.pop();
    }
    Ok(out)
}

/// A text as a number where it is one; codes and counts stay whole.
fn value(text: &str) -> Value {
    let text = text.trim();
    match (text.parse::<i64>(), text.parse::<f64>()) {
        (Ok(whole), _) if !text.starts_with('0') => whole.into(),
        (_, Ok(number)) if number.is_finite() && !text.starts_with('0') => number.into(),
        _ => text.into(),
    }
}
