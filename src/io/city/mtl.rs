//! Materials of Wavefront OBJ: colours (`Kd`) and textures (`map_Kd`, PNG, JPEG or WebP, in the folder of the file).

use std::path::Path;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::CityError;
use super::pictures;
use edifice_base::{Error, Result};
use edifice_io::read_bytes;
use edifice_shape::triangles::{Surface, Texture};

/// Materials by name.
pub(super) type Materials = FxHashMap<String, Arc<Surface>>;

/// Adds the materials of a file to `materials`.
///
/// # Errors
/// Names the file and the line that is wrong, and textures that are missing.
pub(super) fn read(path: &Path, materials: &mut Materials) -> Result<()> {
    let bytes = read_bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut name: Option<String> = None;
    for (number, line) in text.lines().enumerate() {
        let place = || format!("line {}", number + 1);
        let line = line.trim();
        let (key, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let surface = match key {
            "newmtl" => {
                name = Some(rest.trim().to_owned());
                continue;
            }
            "Kd" => {
                let shares: Option<Vec<f64>> =
                    rest.split_whitespace().map(|w| w.parse().ok()).collect();
                let shares = shares.filter(|s| s.iter().all(|v| v.is_finite()) && s.len() == 3);
                let bad = || CityError::Format(format!("{rest:?} is not a colour"));
                let shares = shares.ok_or_else(|| Error::input(path, place(), bad()))?;
                let level = |k: usize| (shares[k].clamp(0.0, 1.0) * 255.0).round() as u8;
                Surface::Plain(std::array::from_fn(level))
            }
            "map_Kd" => {
                // Options stand before the name, which is the last word.
                let file = rest.split_whitespace().last().unwrap_or_default();
                Surface::Texture(texture(path, file, &place())?)
            }
            _ => continue,
        };
        let unnamed = || CityError::Format(format!("{key} without newmtl"));
        let name = name.clone();
        let name = name.ok_or_else(|| Error::input(path, place(), unnamed()))?;
        let known = materials
            .get(&name)
            .is_some_and(|s| matches!(**s, Surface::Texture(_)));
        if !known || matches!(surface, Surface::Texture(_)) {
            materials.insert(name, Arc::new(surface));
        }
    }
    Ok(())
}

fn texture(path: &Path, file: &str, place: &str) -> Result<Texture> {
    let own = Path::new(file).file_name().unwrap_or_default();
    let beside = path.with_file_name(own);
    let fault = |text: String| {
        let text = format!("texture {file:?}: {text}");
        Error::input(path, place, CityError::Format(text))
    };
    let bytes = read_bytes(&beside).map_err(|e| fault(e.to_string()))?;
    pictures::decoded(file, bytes.into()).map_err(|e| fault(e.to_string()))
}
