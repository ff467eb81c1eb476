//! Pictures of cities, one beside the other, from one place.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use edifice_scene::render::render;
use edifice_scene::trace::framing;
use edifice_scene::{Group, Instance, Material, Mesh, Scene};
use edifice_shape::triangles::{City, Painted, corner_bits};

/// Space between pictures, in pixels.
const GAP: usize = 8;

/// Approximate number of pieces in which textures are drawn.
const MOST_PIECES: f64 = 600_000.0;
/// No piece is halved below this length, in metres.
const FINEST: f64 = 0.25;
/// The upper bits of a colour, which tell its material.
const COARSE: u8 = 0xf8;
/// Index of the material of what is not painted.
const BUILDING: usize = 0;

/// Direction of the view: from the south-west, downward; y is up.
const VIEW: [f32; 3] = [0.35, -0.55, -0.75];

/// Draws cities from one place, from which the first is seen whole, as a PNG of one row; each picture is `width` x `height` pixels.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn side_by_side(
    cities: &[&City],
    width: usize,
    height: usize,
) -> Result<Vec<u8>, png::EncodingError> {
    let Some(first) = cities.first() else {
        return Ok(Vec::new());
    };
    let camera = framing(&scene(first), VIEW, width as f32 / height as f32);
    let whole = cities.len() * (width + GAP) - GAP.min(cities.len() * (width + GAP));
    let mut rgb = vec![255; whole * height * 3];
    for (i, city) in cities.iter().enumerate() {
        let picture = render(&scene(city), &camera, width, height);
        for (y, row) in picture.rgb.chunks_exact(width * 3).enumerate() {
            let from = (y * whole + i * (width + GAP)) * 3;
            rgb[from..from + row.len()].copy_from_slice(row);
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, whole as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}

/// z up to y up.
fn turned(p: [f64; 3]) -> [f32; 3] {
    [p[0] as f32, p[2] as f32, -p[1] as f32]
}

fn material(name: &str, color: [u8; 3]) -> Material {
    Material {
        name: name.to_owned(),
        color,
        roughness: 0.9,
    }
}

/// A mesh a building, on a ground; painted surfaces in pieces of one colour each.
fn scene(city: &City) -> Scene {
    let paint = || city.buildings.iter().flat_map(|b| &b.paint);
    let area: f64 = paint().map(Painted::area).sum();
    // Slivers are cut by their length, whatever their area.
    let length: f64 = paint().map(Painted::longest).sum();
    let fine = (2.0 * area / MOST_PIECES).sqrt();
    let fine = fine.max(length / MOST_PIECES).max(FINEST);
    let mut colours: FxHashMap<[u8; 3], usize> = FxHashMap::default();
    let mut scene = Scene {
        materials: vec![
            material("building", [214, 208, 198]),
            material("ground", [150, 152, 150]),
        ],
        ..Scene::default()
    };
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for b in city
        .buildings
        .iter()
        .filter(|b| !b.mesh.triangles.is_empty())
    {
        if let Some((l, h)) = b.mesh.bounds() {
            for k in 0..3 {
                low[k] = low[k].min(l[k]);
                high[k] = high[k].max(h[k]);
            }
        }
        let mut parts: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        let mut mesh = Mesh {
            name: b.id.clone(),
            positions: b.mesh.positions.iter().map(|&p| turned(p)).collect(),
            parts: Vec::new(),
        };
        let painted: FxHashSet<_> = b.paint.iter().map(|p| corner_bits(p.corners)).collect();
        for t in &b.mesh.triangles {
            let corners = t.map(|i| b.mesh.positions[i as usize]);
            if !painted.contains(&corner_bits(corners)) {
                parts.entry(BUILDING).or_default().extend(t);
            }
        }
        for piece in b.paint.iter().flat_map(|p| p.pieces(fine)) {
            let colour = piece.colour([1.0 / 3.0; 3]).map(|v| v & COARSE);
            let next = scene.materials.len();
            let material = *colours.entry(colour).or_insert(next);
            if material == next {
                scene.materials.push(self::material("texture", colour));
            }
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(piece.corners.map(turned));
            let own = parts.entry(material).or_default();
            own.extend([first, first + 1, first + 2]);
        }
        mesh.parts.extend(parts);
        scene.meshes.push(mesh);
    }
    let margin = 50.0;
    let corner = |x: f64, y: f64| turned([x, y, low[2]]);
    scene.meshes.push(Mesh {
        name: "ground".to_owned(),
        positions: vec![
            corner(low[0] - margin, low[1] - margin),
            corner(high[0] + margin, low[1] - margin),
            corner(high[0] + margin, high[1] + margin),
            corner(low[0] - margin, high[1] + margin),
        ],
        parts: vec![(1, vec![0, 1, 2, 0, 2, 3])],
    });
    scene.groups.push(Group {
        name: city.name.clone(),
        yaw: 0.0,
        translation: [0.0; 3],
        instances: (0..scene.meshes.len())
            .map(|m| Instance::at(m, [0.0; 3]))
            .collect(),
    });
    scene
}
