//! Houses as glTF with textures, and as OBJ with colours: what is written, read again by the test itself.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use edifice::io::{building_json, city, detailed_gltf, surface_obj};
use edifice::methods::building_exteriors::house::parts::parts;
use edifice::methods::building_exteriors::house::scene::{COLOURS, palette};
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::scene::textures::{Texture, tile};
use edifice::shape::solid::Finish;
use edifice::shape::vec3::{cross, dot, norm, sub};
use edifice::shape::{DetailedBuilding, PartKind};
use serde_json::Value;

/// Some of the shipped houses, as parts.
fn houses() -> Vec<DetailedBuilding> {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    let buildings = building_json::read(&shipped).unwrap();
    let some = buildings.iter().step_by(23);
    some.map(|b| parts(b, &model(b, Joining::Boxes).unwrap()))
        .collect()
}

/// A file taken apart.
struct Glb {
    document: Value,
    binary: Vec<u8>,
}

impl Glb {
    fn of(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(&bytes[..4], b"glTF");
        assert_eq!((word(4), word(8)), (2, bytes.len()));
        let json = word(12);
        assert_eq!(&bytes[16..20], b"JSON");
        let binary = 20 + json;
        assert_eq!(&bytes[binary + 4..binary + 8], b"BIN\0");
        assert_eq!(binary + 8 + word(binary), bytes.len());
        Self {
            document: serde_json::from_slice(&bytes[20..binary]).unwrap(),
            binary: bytes[binary + 8..].to_vec(),
        }
    }

    fn number(value: &Value) -> usize {
        value.as_u64().unwrap_or(0) as usize
    }

    /// The bytes of an accessor, so many for each of its elements.
    fn elements(&self, accessor: &Value, size: usize) -> Vec<&[u8]> {
        let accessor = &self.document["accessors"][Self::number(accessor)];
        let view = &self.document["bufferViews"][Self::number(&accessor["bufferView"])];
        let start = Self::number(&view["byteOffset"]) + Self::number(&accessor["byteOffset"]);
        let count = Self::number(&accessor["count"]);
        let bytes = &self.binary[start..start + count * size];
        bytes.chunks_exact(size).collect()
    }

    fn vectors<const N: usize>(&self, accessor: &Value) -> Vec<[f64; N]> {
        let elements = self.elements(accessor, 4 * N);
        let number =
            |b: &[u8], i: usize| f32::from_le_bytes(b[4 * i..4 * i + 4].try_into().unwrap());
        let vector = |b: &&[u8]| std::array::from_fn(|i| f64::from(number(b, i)));
        elements.iter().map(vector).collect()
    }

    /// Corners of each triangle of a primitive, whose indices have 16 bits.
    fn triangles(&self, primitive: &Value) -> Vec<[usize; 3]> {
        let indices = self.elements(&primitive["indices"], 2);
        let index = |b: &[u8]| usize::from(u16::from_le_bytes(b.try_into().unwrap()));
        let triples = indices.chunks_exact(3);
        triples.map(|t| [0, 1, 2].map(|i| index(t[i]))).collect()
    }
}

#[test]
fn nodes_are_the_parts_of_a_house_and_files_are_small() {
    let mut largest = 0;
    for (k, house) in houses().iter().enumerate() {
        let palette = palette(k);
        let bytes = detailed_gltf::to_bytes(house, &palette).unwrap();
        assert!(bytes == detailed_gltf::to_bytes(house, &palette).unwrap());
        largest = largest.max(bytes.len());
        let glb = Glb::of(&bytes);
        let nodes = glb.document["nodes"].as_array().unwrap();
        assert_eq!(nodes.len(), house.parts.len() + 1);
        let root = &nodes[0];
        assert_eq!(glb.document["scenes"][0]["nodes"], serde_json::json!([0]));
        assert_eq!(root["name"], house.name.as_str());
        assert_eq!(root["extras"]["kind"], "Building");
        let mut parent: HashMap<usize, usize> = HashMap::new();
        for (p, node) in nodes.iter().enumerate() {
            for child in node["children"].as_array().into_iter().flatten() {
                assert_eq!(parent.insert(Glb::number(child), p), None);
            }
        }
        assert_eq!(parent.len(), house.parts.len());
        for (i, (part, node)) in house.parts.iter().zip(&nodes[1..]).enumerate() {
            assert_eq!(node["name"], part.name.as_str());
            assert_eq!(node["extras"]["kind"], part.kind.name());
            for (key, value) in &part.attributes {
                assert_eq!(&node["extras"][key], value);
            }
            assert_eq!(parent[&(i + 1)], part.wall.map_or(0, |w| w + 1));
            // All triangles are there, each with a material.
            let mesh = &glb.document["meshes"][Glb::number(&node["mesh"])];
            let primitives = mesh["primitives"].as_array().unwrap();
            let count = primitives.iter().map(|p| glb.triangles(p).len());
            assert_eq!(count.sum::<usize>(), part.triangles.len(), "{}", part.name);
            assert!(primitives.iter().all(|p| p["material"].is_u64()));
        }
        let used = serde_json::json!(["KHR_materials_transmission", "KHR_texture_transform"]);
        assert_eq!(glb.document["extensionsUsed"], used);
        assert!(glb.document.get("extensionsRequired").is_none());
    }
    assert!(largest < 600_000, "{largest} bytes");
}

#[test]
fn normals_follow_triangles_and_texture_coordinates_are_metres() {
    for (k, house) in houses().iter().enumerate().take(4) {
        let glb = Glb::of(&detailed_gltf::to_bytes(house, &palette(k)).unwrap());
        for (part, node) in house
            .parts
            .iter()
            .zip(&glb.document["nodes"].as_array().unwrap()[1..])
        {
            let mesh = &glb.document["meshes"][Glb::number(&node["mesh"])];
            for primitive in mesh["primitives"].as_array().unwrap() {
                let own = &primitive["attributes"];
                let positions = glb.vectors::<3>(&own["POSITION"]);
                let normals = glb.vectors::<3>(&own["NORMAL"]);
                let coordinates = glb.vectors::<2>(&own["TEXCOORD_0"]);
                let tangents = match own.get("TANGENT") {
                    Some(tangents) => glb.vectors::<4>(tangents),
                    None => Vec::new(),
                };
                let material = &glb.document["materials"][Glb::number(&primitive["material"])];
                let has_relief = material.get("normalTexture").is_some();
                assert!(!has_relief || tangents.len() == positions.len());
                for t in glb.triangles(primitive) {
                    let place = format!("{} {}", house.name, part.name);
                    let [a, b, c] = t.map(|i| positions[i]);
                    let area = cross(sub(b, a), sub(c, a));
                    for i in t {
                        assert!((norm(normals[i]) - 1.0).abs() < 1e-6, "{place}");
                        assert!(dot(normals[i], area) > 0.999 * norm(area) - 1e-6, "{place}");
                    }
                    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                        let edge = sub(positions[t[i]], positions[t[j]]);
                        let metres = norm(edge);
                        let [p, q] = [coordinates[t[i]], coordinates[t[j]]];
                        if let Some(&[x, y, z, hand]) = tangents.get(t[i]) {
                            assert_eq!(hand, 1.0);
                            assert!((norm([x, y, z]) - 1.0).abs() < 1e-6, "{place}");
                            let along = dot([x, y, z], edge);
                            assert!((along - (p[0] - q[0])).abs() < 1e-4, "{place}");
                        }
                        let flat = (p[0] - q[0]).hypot(p[1] - q[1]);
                        assert!((flat - metres).abs() < 1e-4, "{place}: {flat}, {metres}");
                    }
                    // Upwards on a wall is upwards in the picture, whose second coordinate goes down.
                    if part.kind == PartKind::WallSurface {
                        for i in t {
                            let down = coordinates[i][1];
                            assert!((down + positions[i][1]).abs() < 1e-4, "{place}");
                        }
                    }
                    // Pictures are not mirrored.
                    let [p, q, r] = t.map(|i| coordinates[i]);
                    let turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
                    assert!(turn <= 1e-6, "{place}");
                }
            }
        }
    }
}

#[test]
fn textures_go_on_over_their_edges() {
    for texture in Texture::ALL {
        let tile = tile(texture, [150, 80, 60]);
        for pixels in [Some(&tile.base), tile.normal.as_ref()]
            .into_iter()
            .flatten()
        {
            let (side, channels) = (pixels.side, pixels.channels);
            assert_eq!(pixels.bytes.len(), side * side * channels);
            assert!(side == 128 || side == 256);
            let byte = |row: usize, column: usize, c: usize| {
                i32::from(pixels.bytes[(row % side * side + column % side) * channels + c])
            };
            // The largest difference between neighbours over a line that parts two columns or two rows.
            let over = |is_column: bool, line: usize| {
                let along = (0..side).flat_map(|k| (0..channels).map(move |c| (k, c)));
                let jump = along.map(|(k, c)| match is_column {
                    true => byte(k, line, c) - byte(k, line + 1, c),
                    false => byte(line, k, c) - byte(line + 1, k, c),
                });
                jump.map(i32::abs).max().unwrap()
            };
            for is_column in [true, false] {
                let inside = (0..side - 1).map(|line| over(is_column, line)).max();
                let seam = over(is_column, side - 1);
                assert!(seam <= inside.unwrap(), "{texture:?}: {seam}, {inside:?}");
            }
        }
    }
}

#[test]
fn a_house_looks_like_its_colours_from_afar() {
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    };
    for template in 0..COLOURS {
        let palette = palette(template);
        for look in [palette.wall, palette.roof, palette.chimney, palette.trim] {
            let Some(texture) = look.texture else {
                continue;
            };
            let tile = tile(texture, look.colour);
            let factor = tile.factor(look.colour);
            let count = (tile.base.bytes.len() / tile.base.channels) as f64;
            for (c, factor) in factor.iter().enumerate().take(3) {
                let own = tile.base.bytes.iter().skip(c % tile.base.channels);
                let own = own.step_by(tile.base.channels).map(|&v| linear(v));
                let mean = own.sum::<f64>() / count * factor;
                let wanted = linear(look.colour[c]);
                // Joints have a colour of their own.
                let room = if texture.has_joints() { 0.12 } else { 0.02 };
                assert!(
                    (mean - wanted).abs() < room,
                    "{texture:?}: {mean}, {wanted}"
                );
            }
        }
    }
}

#[test]
fn colours_alone_need_no_textures() {
    let house = houses().swap_remove(0);
    let mut plain = palette(2);
    for look in plain.looks_mut() {
        (look.texture, look.transmission) = (None, 0.0);
    }
    let glb = Glb::of(&detailed_gltf::to_bytes(&house, &plain).unwrap());
    for key in ["images", "textures", "samplers", "extensionsUsed"] {
        assert!(glb.document.get(key).is_none(), "{key}");
    }
    let views = glb.document["bufferViews"].as_array().unwrap();
    assert!(views.iter().all(|v| Glb::number(&v["byteLength"]) > 0));
    for accessor in glb.document["accessors"].as_array().unwrap() {
        assert!(Glb::number(&accessor["bufferView"]) < views.len());
    }
}

#[test]
fn broken_buildings_are_refused() {
    let house = houses().swap_remove(0);
    let refused = |broken: &DetailedBuilding, expected: &str| {
        let error = detailed_gltf::to_bytes(broken, &palette(0)).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    };
    let mut broken = house.clone();
    broken.parts[0].triangles[0].0[0] = 1_000_000;
    refused(&broken, "corner 1000000 does not exist");
    let mut broken = house.clone();
    broken.positions[house.parts[0].triangles[0].0[0] as usize][1] = 1e300;
    refused(&broken, "not finite");
    let mut broken = house.clone();
    broken.parts[1].wall = Some(1);
    refused(&broken, "wall 1 does not exist");
    refused(&DetailedBuilding::default(), "is empty");
}

#[test]
fn an_obj_of_parts_names_its_materials_and_reads_back_closed() {
    for house in houses().iter().take(3) {
        let text = surface_obj::parts_text(house, Some("house.mtl"));
        let lines = |text: &str, key: &str| -> Vec<String> {
            let own = text.lines().filter_map(|l| l.strip_prefix(key));
            own.map(str::to_owned).collect()
        };
        assert_eq!(lines(&text, "mtllib "), ["house.mtl"]);
        let names: Vec<&str> = house.parts.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(lines(&text, "g "), names);
        let materials = surface_obj::mtl(house, &palette(3));
        let known: HashSet<String> = lines(&materials, "newmtl ").into_iter().collect();
        let used: HashSet<String> = lines(&text, "usemtl ").into_iter().collect();
        assert_eq!(known, used);
        assert_eq!(lines(&materials, "Kd ").len(), known.len());
        let read = surface_obj::parse(text.as_bytes(), "house.obj".as_ref()).unwrap();
        assert_eq!(read.positions, house.positions);
        assert_eq!(read.check().unwrap().shells, 1);
    }
}

#[test]
fn a_textured_house_is_one_building_of_a_city() {
    let house = houses().swap_remove(1);
    let bytes = detailed_gltf::to_bytes(&house, &palette(5)).unwrap();
    let city = city::gltf::parse(&bytes, "house.glb".as_ref()).unwrap();
    assert_eq!(city.buildings.len(), 1);
    let building = &city.buildings[0];
    assert_eq!(building.id, house.name);
    assert_eq!(building.mesh.triangles.len(), house.triangles().count());
    let panes = house.triangles().filter(|(_, _, f)| *f == Finish::Pane);
    assert!(panes.count() > 0 && !building.paint.is_empty());
}
