//! Closed surfaces as Wavefront OBJ, z up, in metres, a group for each finish; and back.

use std::fmt::Write;
use std::path::Path;

use super::read_bytes;
use edifice_base::{Error, Result};
use edifice_shape::solid::{Finish, Surface};

/// The text of a file. Numbers are written so that reading gives the same bits.
pub fn to_text(surface: &Surface, name: &str) -> String {
    let mut text = format!("# metres, z up\no {name}\n");
    for [x, y, z] in &surface.positions {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    let mut finishes: Vec<Finish> = surface.triangles.iter().map(|(_, f)| *f).collect();
    finishes.sort_unstable();
    finishes.dedup();
    for finish in finishes {
        let _ = writeln!(
            text,
            "g {}\nusemtl {0}",
            format!("{finish:?}").to_lowercase()
        );
        for (t, _) in surface.triangles.iter().filter(|(_, f)| *f == finish) {
            let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
        }
    }
    text
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
