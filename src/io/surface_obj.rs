//! Closed surfaces as Wavefront OBJ, z up, in metres, a group for each finish or each part, with their colours; and back.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use super::read_bytes;
use edifice_base::{Error, Result};
use edifice_scene::palette::Palette;
use edifice_shape::DetailedBuilding;
use edifice_shape::solid::{Finish, Surface};

/// The text of a file, a group for each finish. Numbers are written so that reading gives the same bits.
pub fn to_text(surface: &Surface, name: &str) -> String {
    let mut text = head(name, None, &surface.positions);
    let finishes: BTreeSet<Finish> = surface.triangles.iter().map(|(_, f)| *f).collect();
    for finish in finishes {
        let own = surface.triangles.iter().filter(|(_, f)| *f == finish);
        let _ = writeln!(text, "g {}", material(finish));
        faces(&mut text, finish, own.map(|(t, _)| t));
    }
    text
}

/// The text of a file of a building in parts, a group for each part and a material for each finish. `materials` is the name
/// of the file with the materials, as [`mtl`] writes it, in the same folder.
pub fn parts_text(building: &DetailedBuilding, materials: Option<&str>) -> String {
    let mut text = head(&building.name, materials, &building.positions);
    for part in &building.parts {
        let _ = writeln!(text, "g {}", part.name);
        let finishes: BTreeSet<Finish> = part.triangles.iter().map(|(_, f)| *f).collect();
        for finish in finishes {
            let own = part.triangles.iter().filter(|(_, f)| *f == finish);
            faces(&mut text, finish, own.map(|(t, _)| t));
        }
    }
    text
}

/// The text of a file of materials: for each finish of a building its colour (`Kd`, sRGB from 0 to 1) and opacity (`d`).
pub fn mtl(building: &DetailedBuilding, palette: &Palette) -> String {
    let mut text = String::new();
    let finishes: BTreeSet<Finish> = building.triangles().map(|(_, _, f)| f).collect();
    for finish in finishes {
        let (_, look) = palette.look(finish, false);
        let [r, g, b] = look.colour.map(|c| f64::from(c) / 255.0);
        let opacity = 1.0 - look.transmission;
        let name = material(finish);
        let _ = writeln!(
            text,
            "newmtl {name}\nKd {r:.4} {g:.4} {b:.4}\nd {opacity:.2}\n"
        );
    }
    text
}

fn head(name: &str, materials: Option<&str>, positions: &[[f64; 3]]) -> String {
    let mut text = "# metres, z up\n".to_owned();
    if let Some(file) = materials {
        let _ = writeln!(text, "mtllib {file}");
    }
    let _ = writeln!(text, "o {name}");
    for [x, y, z] in positions {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    text
}

fn faces<'a>(text: &mut String, finish: Finish, triangles: impl Iterator<Item = &'a [u32; 3]>) {
    let _ = writeln!(text, "usemtl {}", material(finish));
    for t in triangles {
        let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
}

/// The name of a finish's material.
fn material(finish: Finish) -> String {
    format!("{finish:?}").to_lowercase()
}

/// The defects of a line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// Not a finite number.
    #[error("{0:?} is not a finite number")]
    Number(String),
    /// Not the number of a corner that came before.
    #[error("{0:?} is not the number of an earlier corner")]
    Corner(String),
    /// A face with less than three corners.
    #[error("a face with {0} corners")]
    Face(usize),
}

/// Reads the vertices and faces of a file; faces of more than three corners become fans, all else is skipped.
///
/// # Errors
/// Names the file and the line.
pub fn read(path: &Path) -> Result<Surface> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Surface> {
    let text = std::str::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    let mut surface = Surface::default();
    for (k, line) in text.lines().enumerate() {
        let at = |e: ObjError| Error::input(path, format!("line {}", k + 1), e);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut p = [0.0; 3];
                for value in &mut p {
                    let word = words.next().unwrap_or("");
                    let number = word.parse().ok().filter(|v: &f64| v.is_finite());
                    *value = number.ok_or_else(|| at(ObjError::Number(word.into())))?;
                }
                surface.positions.push(p);
            }
            Some("f") => {
                let mut corners = Vec::new();
                for word in words {
                    let number = word.split('/').next().unwrap_or("");
                    let index = number.parse::<usize>().ok();
                    let index = index.filter(|i| (1..=surface.positions.len()).contains(i));
                    let index = index.ok_or_else(|| at(ObjError::Corner(word.into())))?;
                    corners.push((index - 1) as u32);
                }
                if corners.len() < 3 {
                    return Err(at(ObjError::Face(corners.len())));
                }
                for i in 2..corners.len() {
                    let t = [corners[0], corners[i - 1], corners[i]];
                    surface.triangles.push((t, Finish::Wall));
                }
            }
            _ => {}
        }
    }
    Ok(surface)
}
