//! Cities as Wavefront OBJ, written.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::pictures::ending;
use edifice_base::Result;
use edifice_io::{file_stem, write_atomic};
use edifice_shape::triangles::{City, CityBuilding, Painted, Surface, corner_bits};

/// The material of what has no other.
const PLAIN: &str = "plain";

/// The text of a file: an object a building, in the input's own coordinates, to the millimetre.
pub fn to_string(city: &City) -> String {
    text(city, None, &Materials::default())
}

/// Writes a city; where its surfaces have pictures, its materials (`NAME.mtl`) and their pictures stand beside it. Each file is
/// written whole or not at all, `path` the last.
///
/// # Errors
/// [`edifice_base::Error::Io`] when a file cannot be written.
pub fn write(city: &City, path: &Path) -> Result<()> {
    let stem = file_stem(path);
    let materials = Materials::of(city, &stem);
    if materials.pictures.is_empty() {
        return write_atomic(path, to_string(city).as_bytes());
    }
    for (name, bytes) in &materials.pictures {
        write_atomic(&path.with_file_name(name), bytes)?;
    }
    let library = format!("{stem}.mtl");
    write_atomic(&path.with_file_name(&library), materials.text.as_bytes())?;
    let text = text(city, Some(&library), &materials);
    write_atomic(path, text.as_bytes())
}

/// The materials of a city whose surfaces have pictures.
#[derive(Default)]
struct Materials {
    /// Names by address: surfaces are shared.
    names: FxHashMap<*const Surface, String>,
    pictures: BTreeMap<String, Arc<[u8]>>,
    text: String,
}

impl Materials {
    fn of(city: &City, stem: &str) -> Self {
        let mut out = Self {
            text: format!("newmtl {PLAIN}\nKd 0.75 0.73 0.7\n"),
            ..Self::default()
        };
        for painted in city.buildings.iter().flat_map(|b| &b.paint) {
            let surface = &painted.surface;
            let number = out.names.len() + 1;
            let name = match out.names.entry(Arc::as_ptr(surface)) {
                std::collections::hash_map::Entry::Occupied(_) => continue,
                std::collections::hash_map::Entry::Vacant(new) => new.insert(format!("m{number}")),
            };
            // Writing to a String cannot fail.
            let _ = match &**surface {
                Surface::Plain(colour) => {
                    let [r, g, b] = colour.map(|v| f64::from(v) / 255.0);
                    writeln!(out.text, "newmtl {name}\nKd {r:.4} {g:.4} {b:.4}")
                }
                Surface::Texture(texture) => {
                    let file = format!("{stem}-{number}.{}", ending(&texture.file));
                    let _ = writeln!(out.text, "newmtl {name}\nKd 1 1 1\nmap_Kd {file}");
                    out.pictures.insert(file, texture.file.clone());
                    Ok(())
                }
            };
        }
        out
    }
}

fn text(city: &City, library: Option<&str>, materials: &Materials) -> String {
    let mut out = String::from("# metres, z up\n");
    if let Some(library) = library {
        let _ = writeln!(out, "mtllib {library}");
    }
    let (mut first, mut coordinates) = (1, 1);
    for b in &city.buildings {
        let _ = writeln!(out, "o {}", b.id.replace(['\n', '\r'], " "));
        for p in &b.mesh.positions {
            let [x, y, z] = [0, 1, 2].map(|k| p[k] + city.origin[k]);
            let _ = writeln!(out, "v {x:.3} {y:.3} {z:.3}");
        }
        let painted: FxHashMap<[[u64; 3]; 3], &Painted> = match library {
            Some(_) => b
                .paint
                .iter()
                .map(|p| (corner_bits(p.corners), p))
                .collect(),
            None => FxHashMap::default(),
        };
        let mut current: Option<&str> = None;
        for t in &b.mesh.triangles {
            let [i, j, k] = t.map(|i| i as usize + first);
            let looks = painted.get(&corner_bits(corners(b, t)));
            let name = looks.and_then(|p| materials.names.get(&Arc::as_ptr(&p.surface)));
            let Some((looks, name)) = looks.zip(name) else {
                if current.take().is_some() {
                    let _ = writeln!(out, "usemtl {PLAIN}");
                }
                let _ = writeln!(out, "f {i} {j} {k}");
                continue;
            };
            if current.replace(name) != Some(name) {
                let _ = writeln!(out, "usemtl {name}");
            }
            for [u, v] in looks.uv {
                let _ = writeln!(out, "vt {u:.6} {v:.6}");
            }
            let [l, m, n] = [0, 1, 2].map(|c| coordinates + c);
            let _ = writeln!(out, "f {i}/{l} {j}/{m} {k}/{n}");
            coordinates += 3;
        }
        if current.is_some() {
            let _ = writeln!(out, "usemtl {PLAIN}");
        }
        first += b.mesh.positions.len();
    }
    out
}

fn corners(building: &CityBuilding, triangle: &[u32; 3]) -> [[f64; 3]; 3] {
    triangle.map(|i| building.mesh.positions[i as usize])
}
