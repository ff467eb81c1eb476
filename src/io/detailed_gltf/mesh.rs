//! Corners of a part as they are drawn: flat normals, texture coordinates in metres.

use std::collections::BTreeMap;

use edifice_scene::palette::Palette;
use edifice_scene::textures::Texture;
use edifice_shape::solid::Finish;
use edifice_shape::vec3::{add, cross, dot, norm, sub};
use edifice_shape::{DetailedBuilding, Part, PartKind};

/// Upward component of a unit normal from which on a face is level.
const LEVEL: f64 = 0.999;
/// Normals whose components differ by less, and distances (m), are those of one plane.
const SAME: f64 = 1e-4;
/// Twice the area of a triangle that has none (m²).
const NOTHING: f64 = 1e-12;

/// Corners of a part, y up, and the indices of its triangles by finish; true for what is level.
#[derive(Debug, Default)]
pub(super) struct Corners {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) coordinates: Vec<[f32; 2]>,
    /// Directions in which the first texture coordinate grows; the last number says that pictures are not mirrored.
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) triangles: BTreeMap<(Finish, bool), Vec<u32>>,
}

/// The corners of a part; a corner stands once for each plane that it is on.
pub(super) fn corners(building: &DetailedBuilding, part: &Part, palette: &Palette) -> Corners {
    let mut out = Corners::default();
    for face in faces(building, part) {
        face.draw(building, palette, &mut out);
    }
    out
}

/// Triangles in one plane.
struct Face {
    normal: [f64; 3],
    triangles: Vec<([u32; 3], Finish)>,
}

/// The triangles of a part by their planes. Walls and roofs are in one plane each.
fn faces(building: &DetailedBuilding, part: &Part) -> Vec<Face> {
    let is_plane = matches!(part.kind, PartKind::WallSurface | PartKind::RoofSurface);
    let mut groups: BTreeMap<([i64; 3], i64), Face> = BTreeMap::new();
    for (t, finish) in &part.triangles {
        let [a, b, c] = building.corners(*t);
        let area = cross(sub(b, a), sub(c, a));
        let length = norm(area);
        if length < NOTHING {
            continue;
        }
        let whole = |v: f64| (v / SAME).round() as i64;
        let unit = area.map(|v| v / length);
        let key = match is_plane {
            true => Default::default(),
            false => (unit.map(whole), whole(dot(unit, a))),
        };
        let face = groups.entry(key).or_insert(Face {
            normal: [0.0; 3],
            triangles: Vec::new(),
        });
        face.normal = add(face.normal, area);
        face.triangles.push((*t, *finish));
    }
    let mut faces: Vec<Face> = groups.into_values().collect();
    for face in &mut faces {
        let length = norm(face.normal).max(f64::MIN_POSITIVE);
        face.normal = face.normal.map(|v| v / length);
    }
    faces
}

impl Face {
    /// Unit vectors in the plane: level, to the right seen from outside, and up or up the slope. On what is level they are
    /// x and y, seen from above.
    fn frame(&self) -> [[f64; 3]; 2] {
        let [x, y, z] = self.normal;
        let level = x.hypot(y);
        let along = match z.abs() > LEVEL || level == 0.0 {
            true => [1.0, 0.0, 0.0],
            false => [-y / level, x / level, 0.0],
        };
        [along, cross(self.normal, along)]
    }

    fn draw(&self, building: &DetailedBuilding, palette: &Palette, out: &mut Corners) {
        let [along, up] = self.frame();
        let flat = |v: u32| {
            let p = building.positions[v as usize];
            [dot(p, along), dot(p, up)]
        };
        let all = || self.triangles.iter().flat_map(|(t, _)| t);
        let lowest = |i: usize| all().map(|&v| flat(v)[i]).fold(f64::INFINITY, f64::min);
        // Courses of upright walls are at the same heights all around the building.
        let is_upright = self.normal[2].abs() < SAME;
        let origin = [lowest(0), if is_upright { 0.0 } else { lowest(1) }];
        let is_level = self.normal[2].abs() > LEVEL;
        let mut known: BTreeMap<(u32, bool), u32> = BTreeMap::new();
        for (t, finish) in &self.triangles {
            let (_, look) = palette.look(*finish, is_level);
            let places = t.map(flat);
            let extent = |i: usize| {
                let own = places.map(|p| p[i]);
                own.into_iter().fold(f64::NEG_INFINITY, f64::max)
                    - own.into_iter().fold(f64::INFINITY, f64::min)
            };
            // Painted pieces have their grain along them.
            let is_turned = look.texture == Some(Texture::Paint) && extent(1) > extent(0);
            for (v, place) in t.iter().zip(places) {
                let index = *known.entry((*v, is_turned)).or_insert_with(|| {
                    let [u, v_up] = [place[0] - origin[0], place[1] - origin[1]];
                    let uv = if is_turned { [v_up, u] } else { [u, -v_up] };
                    out.positions.push(turned(building.positions[*v as usize]));
                    out.normals.push(turned(self.normal));
                    out.coordinates.push(uv.map(|c| c as f32));
                    let [x, y, z] = turned(if is_turned { up } else { along });
                    out.tangents.push([x, y, z, 1.0]);
                    out.positions.len() as u32 - 1
                });
                let key = (*finish, is_level && *finish == Finish::Roof);
                out.triangles.entry(key).or_default().push(index);
            }
        }
    }
}

/// From z up to y up.
fn turned([x, y, z]: [f64; 3]) -> [f32; 3] {
    [x as f32, z as f32, -y as f32]
}
