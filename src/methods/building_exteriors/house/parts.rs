//! The parts of a house: which triangle of its surface belongs to which wall, roof, window or door.
//!
//! Parts are found in the finished surface, by the finish, the direction and the place of each triangle. A wall or a
//! roof is what is connected in one plane. Frames, panes and leaves belong to the element whose place on its wall is
//! nearest.

use std::collections::BTreeMap;

use edifice_shape::solid::{Finish, Wall};
use edifice_shape::triangles::{Corners, normal};
use edifice_shape::vec3::{dot, norm};
use edifice_shape::{Building, DetailedBuilding, ElementStyle, Part, PartKind, Side, WallRect};
use serde_json::{Map, Value, json};

use super::model::Model;
use super::walls::walls_of_pieces;

/// A part that is above all level, or above all upright, by the upward component of its unit normal.
const LEVEL: f64 = 0.5;
/// Coordinates that differ by less are one plane (m), and directions with a smaller difference one direction.
const SAME: f64 = 1e-4;

/// Splits the surface of a house into named parts.
///
/// Each triangle belongs to exactly one part. Names are the side and the number of a wall, `roof_1`, the side, floor and
/// number of a window or a door, such as `window_front_1_2`.
pub fn parts(building: &Building, model: &Model) -> DetailedBuilding {
    let surface = &model.surface;
    let openings = openings(building, model);
    let ground = surface.positions.iter().map(|p| p[2]);
    let ground = ground.fold(f64::INFINITY, f64::min);
    // Triangles of the surface by the plane or the element that they belong to.
    let mut groups: BTreeMap<Key, Vec<([u32; 3], Finish)>> = BTreeMap::new();
    for (t, finish) in &surface.triangles {
        let corners = t.map(|v| surface.positions[v as usize]);
        let normal = unit_normal(&corners);
        let key = match finish {
            Finish::Frame | Finish::Pane | Finish::Door | Finish::GarageDoor => {
                let middle = [0, 1, 2].map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / 3.0);
                match nearest(&openings, middle) {
                    Some(k) => Key::Opening(k),
                    None => Key::Other(PartKind::BuildingInstallation, "frame"),
                }
            }
            Finish::Chimney => Key::Other(PartKind::BuildingInstallation, "chimney"),
            Finish::Trim => Key::Other(PartKind::BuildingInstallation, "trim"),
            Finish::Deck if normal[2] > LEVEL => {
                Key::Other(PartKind::OuterFloorSurface, "porch_floor")
            }
            Finish::Deck | Finish::Wall if normal[2] < -LEVEL && corners[0][2] < ground + SAME => {
                Key::Other(PartKind::GroundSurface, "ground")
            }
            Finish::Deck => Key::Other(PartKind::BuildingInstallation, "porch_base"),
            Finish::Wall if normal[2] < -LEVEL => {
                Key::Other(PartKind::OuterCeilingSurface, "ceiling")
            }
            Finish::Wall if normal[2] < LEVEL => Key::plane(false, normal, corners[0]),
            Finish::Wall | Finish::Roof => Key::plane(true, normal, corners[0]),
        };
        groups.entry(key).or_default().push((*t, *finish));
    }
    let mut all = DetailedBuilding {
        name: building.name.clone(),
        positions: surface.positions.clone(),
        attributes: attributes(building),
        ..DetailedBuilding::default()
    };
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let mut numbered = |stem: String| {
        let number = numbers.entry(stem.clone()).or_default();
        *number += 1;
        format!("{stem}_{number}")
    };
    for (key, triangles) in &groups {
        match key {
            Key::Plane { roof, normal, .. } => {
                for own in connected(triangles, surface.positions.len()) {
                    let (kind, stem) = match roof {
                        true => (PartKind::RoofSurface, "roof".into()),
                        false => (PartKind::WallSurface, format!("wall_{}", side(*normal))),
                    };
                    all.parts.push(Part::new(kind, numbered(stem), own));
                }
            }
            Key::Other(kind, name) => {
                let name = (*name).to_owned();
                all.parts.push(Part::new(*kind, name, triangles.clone()));
            }
            Key::Opening(_) => {}
        }
    }
    for (k, opening) in openings.iter().enumerate() {
        let Some(triangles) = groups.get(&Key::Opening(k)) else {
            continue;
        };
        let mut own = Part::new(
            opening.kind,
            numbered(opening.stem.clone()),
            triangles.clone(),
        );
        let mut rect = opening.rect();
        if opening.kind == PartKind::Door {
            // The sill was moved up to a floor, a porch or a step: the hole begins at the lowest corner.
            let corners = triangles.iter().flat_map(|(t, _)| all.corners(*t));
            let foot = corners.map(|p| p[2]).fold(f64::INFINITY, f64::min);
            let raised = (foot - rect.corner[2]).clamp(0.0, rect.height / 2.0);
            rect.corner[2] += raised;
            rect.height -= raised;
        }
        own.rect = Some(rect);
        own.wall = wall_of(&all, opening);
        own.attributes = opening.attributes.clone();
        all.parts.push(own);
    }
    all
}

/// The group of a triangle; in the order of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Other(PartKind, &'static str),
    Plane {
        roof: bool,
        /// Unit normal and distance of the plane from the origin, in units of [`SAME`].
        normal: [i64; 3],
        distance: i64,
    },
    Opening(usize),
}

impl Key {
    fn plane(roof: bool, normal: [f64; 3], point: [f64; 3]) -> Self {
        let whole = |v: f64| (v / SAME).round() as i64;
        Key::Plane {
            roof,
            normal: normal.map(whole),
            distance: whole(dot(normal, point)),
        }
    }
}

/// A window or a door in its place.
struct InPlace {
    kind: PartKind,
    stem: String,
    wall: Wall,
    /// Along the wall, then upwards.
    span: [[f64; 2]; 2],
    attributes: Map<String, Value>,
}

impl InPlace {
    /// Squared distance of a point from the element: how far it lies outside its rectangle, and from its plane.
    fn distance(&self, p: [f64; 3]) -> f64 {
        let outside = |v: f64, [low, high]: [f64; 2]| (low - v).max(v - high).max(0.0);
        let all = [
            outside(p[1 - self.wall.axis], self.span[0]),
            outside(p[2], self.span[1]),
            p[self.wall.axis] - self.wall.at,
        ];
        dot(all, all)
    }

    fn rect(&self) -> WallRect {
        let Wall { axis, at, positive } = self.wall;
        let [[u0, u1], [z0, z1]] = self.span;
        // Seen from outside, a front wall and a right wall run with their coordinate, the others against it.
        let with = (axis == 0) == positive;
        let start = if with { u0 } else { u1 };
        let corner = match axis {
            0 => [at, start, z0],
            _ => [start, at, z0],
        };
        let step = if with { 1.0 } else { -1.0 };
        WallRect {
            corner,
            along: if axis == 0 { [0.0, step] } else { [step, 0.0] },
            width: u1 - u0,
            height: z1 - z0,
        }
    }
}

/// All elements that are on the surface, and the garage door.
fn openings(building: &Building, model: &Model) -> Vec<InPlace> {
    let mut found = Vec::new();
    let walls = walls_of_pieces(building);
    for (i, (piece, wall)) in building.facades.iter().zip(&walls).enumerate() {
        for (k, e) in piece.elements.iter().enumerate() {
            let Some(wall) = wall.filter(|_| !model.unplaced.contains(&(i, k))) else {
                continue;
            };
            let (u, z) = (piece.start + e.x, piece.base + e.y);
            let is_door = e.style == ElementStyle::Door;
            let (kind, word) = match is_door {
                true => (PartKind::Door, "door"),
                false => (PartKind::Window, "window"),
            };
            let mut attributes = Map::new();
            attributes.insert("side".into(), json!(piece.side.name()));
            attributes.insert("floor".into(), json!(wall.floor + 1));
            if !is_door {
                attributes.insert("style".into(), json!(e.style));
            }
            found.push(InPlace {
                kind,
                stem: format!("{word}_{}_{}", piece.side.name(), wall.floor + 1),
                wall: wall.wall(),
                span: [[u, u + e.width], [z, z + e.height]],
                attributes,
            });
        }
    }
    found.extend(garage(model));
    found
}

/// The garage door: where its leaf is.
fn garage(model: &Model) -> Option<InPlace> {
    let surface = &model.surface;
    let own = || {
        let leaf = surface.triangles.iter();
        leaf.filter(|(_, f)| *f == Finish::GarageDoor)
            .map(|(t, _)| t.map(|v| surface.positions[v as usize]))
    };
    let mut direction = [0.0; 3];
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corners in own() {
        let n = normal(&corners);
        for i in 0..3 {
            direction[i] += n[i];
            low[i] = corners.iter().map(|p| p[i]).fold(low[i], f64::min);
            high[i] = corners.iter().map(|p| p[i]).fold(high[i], f64::max);
        }
    }
    let axis = usize::from(direction[1].abs() > direction[0].abs());
    let positive = direction[axis] > 0.0;
    let at = if positive { high[axis] } else { low[axis] };
    let wall = Wall { axis, at, positive };
    let side = match (axis, positive) {
        (0, true) => Side::Right,
        (0, false) => Side::Left,
        (_, true) => Side::Back,
        (_, false) => Side::Front,
    };
    let mut attributes = Map::new();
    attributes.insert("side".into(), json!(side.name()));
    attributes.insert("floor".into(), json!(1));
    attributes.insert("style".into(), json!("garage"));
    own().next().map(|_| InPlace {
        kind: PartKind::Door,
        stem: format!("garage_door_{}", side.name()),
        wall,
        span: [[low[1 - axis], high[1 - axis]], [low[2], high[2]]],
        attributes,
    })
}

fn nearest(openings: &[InPlace], p: [f64; 3]) -> Option<usize> {
    let far = |k: &usize| openings[*k].distance(p);
    (0..openings.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The unit normal of a triangle; zero without area.
fn unit_normal(corners: &Corners) -> [f64; 3] {
    let n = normal(corners);
    let length = norm(n).max(f64::MIN_POSITIVE);
    n.map(|v| v / length)
}

/// The side that a wall looks to; walls of a tower look to the nearest.
fn side(normal: [i64; 3]) -> &'static str {
    let side = match normal {
        [x, y, _] if x.abs() > y.abs() => [Side::Left, Side::Right][usize::from(x > 0)],
        [_, y, _] => [Side::Front, Side::Back][usize::from(y > 0)],
    };
    side.name()
}

/// Triangles by what hangs together at corners, in the order of their first triangle.
fn connected(triangles: &[([u32; 3], Finish)], corners: usize) -> Vec<Vec<([u32; 3], Finish)>> {
    let mut parent: Vec<u32> = (0..corners as u32).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    for (t, _) in triangles {
        for w in &t[1..] {
            let (a, b) = (root(&mut parent, t[0]), root(&mut parent, *w));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut places: BTreeMap<u32, usize> = BTreeMap::new();
    let mut found: Vec<Vec<([u32; 3], Finish)>> = Vec::new();
    for own in triangles {
        let place = *places
            .entry(root(&mut parent, own.0[0]))
            .or_insert_with(|| {
                found.push(Vec::new());
                found.len() - 1
            });
        found[place].push(*own);
    }
    found
}

/// The attributes of the building as a whole.
fn attributes(building: &Building) -> Map<String, Value> {
    let mut all = Map::new();
    all.insert("storeysAboveGround".into(), json!(building.floors()));
    all.insert("floorHeight".into(), json!(building.floor_height));
    all
}

/// Index of the wall that an element lies in: in its plane, over its middle.
fn wall_of(all: &DetailedBuilding, opening: &InPlace) -> Option<usize> {
    let middle = opening.span.map(|[low, high]| (low + high) / 2.0);
    let Wall { axis, at, positive } = opening.wall;
    let looks = |part: &Part| {
        part.triangles.first().is_some_and(|(t, _)| {
            let corners = all.corners(*t);
            let n = unit_normal(&corners)[axis];
            n.abs() > 0.9 && (n > 0.0) == positive && (corners[0][axis] - at).abs() < 0.2
        })
    };
    let over = |part: &Part| {
        let corners = part.triangles.iter().flat_map(|(t, _)| all.corners(*t));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in corners {
            for (i, v) in [p[1 - axis], p[2]].into_iter().enumerate() {
                low[i] = low[i].min(v);
                high[i] = high[i].max(v);
            }
        }
        (0..2).all(|i| (low[i]..=high[i]).contains(&middle[i]))
    };
    let walls = all.parts.iter().enumerate();
    let mut walls = walls.filter(|(_, p)| p.kind == PartKind::WallSurface && looks(p));
    walls.find(|(_, p)| over(p)).map(|(k, _)| k)
}
