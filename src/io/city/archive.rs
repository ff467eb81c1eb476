//! Archives of OBJ files with their materials and textures: `.tar` and `.tar.xz`.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use lzma_rust2::XzReader;

use super::obj;
use edifice_base::{Error, Result};
use edifice_shape::triangles::City;

/// Most bytes that an archive may unpack to: 1 GB.
const MOST_BYTES: u64 = 1 << 30;

/// The buildings of all OBJ files of an archive, in the order of the files' names.
///
/// # Errors
/// Names the archive, or the file in it, and what is wrong.
pub(super) fn read(path: &Path) -> Result<City> {
    let folder = tempfile::tempdir().map_err(|e| Error::io(path, "unpack", e))?;
    let file = File::open(path).map_err(|e| Error::io(path, "unpack", e))?;
    let packed = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("xz"));
    let reader: Box<dyn Read> = match packed {
        true => Box::new(XzReader::new(file, true)),
        false => Box::new(file),
    };
    // What is cut off at the limit is a damaged archive.
    tar::Archive::new(reader.take(MOST_BYTES))
        .unpack(folder.path())
        .map_err(|e| Error::content(path, format!("a damaged archive: {e}")))?;
    let mut found = Vec::new();
    list(folder.path(), &mut found).map_err(|e| Error::io(path, "unpack", e))?;
    found.sort();
    let mut city: Option<City> = None;
    for file in &found {
        let next = obj::read(file)?;
        match &mut city {
            Some(city) => city.merge(next),
            None => city = Some(next),
        }
    }
    let mut city =
        city.ok_or_else(|| Error::content(path, "no .obj file in the archive".to_owned()))?;
    let name = edifice_io::file_stem(path);
    city.name = name.strip_suffix(".tar").unwrap_or(&name).to_owned();
    Ok(city)
}

/// The OBJ files below a folder.
fn list(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            list(&path, found)?;
        } else if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("obj"))
        {
            found.push(path);
        }
    }
    Ok(())
}
