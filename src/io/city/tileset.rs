//! Cities as 3D Tiles 1.0 and 1.1: `tileset.json` with tilesets and contents beside it, binary glTF or Batched 3D Models (`.b3dm`).
//!
//! Read is the finest level: what no tile below replaces. Each content's buildings are those that [`super::gltf`] reads; tiles that this
//! program has not written have buildings of their own, called by file and node. Where the tiles stand on the earth, coordinates become metres east, north and up of their
//! middle, without a reference system, unless this program has written at which coordinates of its reference system each content stands; else they are
//! those of the root, with the `origin` and `reference_system` of the asset's
//! `extras`, if it has them. Not read are implicit tilings, points, and contents on other machines, which are counted in a note.

use std::path::{Component, Path, PathBuf};

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::Value;

use super::CityError;
use super::earth::{earth_centred, geodetic};
use super::gltf;
use super::gltf_transform::{IDENTITY, Matrix, applied, determinant, product, shift};
use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_io::read_bytes;
use edifice_shape::triangles::{City, CityBuilding, Painted};
use edifice_shape::vec3::{cross, dot, norm, sub};

/// Tilesets below tilesets; a circle is deeper.
const DEEPEST: usize = 16;
/// Points farther from the middle of the coordinates stand on the earth, in metres.
const EARTH: f64 = 5e6;
/// Bytes of the header of a Batched 3D Model.
const HEADER: usize = 28;

#[derive(Deserialize)]
struct Tileset {
    #[serde(default)]
    asset: Value,
    root: Tile,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Tile {
    #[serde(default)]
    refine: Option<String>,
    transform: Option<Matrix>,
    content: Option<Content>,
    #[serde(default)]
    contents: Vec<Content>,
    #[serde(default)]
    children: Vec<Tile>,
    implicit_tiling: Option<Value>,
    #[serde(default)]
    extras: Value,
}

impl Tile {
    /// The coordinates of its contents' origin in the reference system, if this program has written them.
    fn at(&self) -> Option<[f64; 3]> {
        serde_json::from_value(self.extras["at"].clone()).ok()
    }

    /// True if that is known of every content.
    fn is_in_its_system(&self) -> bool {
        let is_empty = self.content.is_none() && self.contents.is_empty();
        (is_empty || self.at().is_some()) && self.children.iter().all(Self::is_in_its_system)
    }
}

#[derive(Deserialize)]
struct Content {
    /// `url` in tilesets of version 0.
    #[serde(alias = "url")]
    uri: String,
}

/// True for a file that is a tileset by its name.
pub(super) fn is_tileset(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name == "tileset.json")
}

/// Reads a tileset with all that it refers to.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<City> {
    let tileset: Tileset = parse_json(&read_bytes(path)?, path)?;
    let extras = &tileset.asset["extras"];
    let mut reader = Reader {
        city: City {
            name: match extras["name"].as_str() {
                Some(name) => name.to_owned(),
                None => edifice_io::file_stem(path.parent().unwrap_or(path)),
            },
            ..City::default()
        },
        known: FxHashMap::default(),
        names_buildings: extras["origin"].is_array(),
        is_in_its_system: extras["reference_system"].is_string() && tileset.root.is_in_its_system(),
        left: 0,
    };
    reader.tile(&tileset.root, &IDENTITY, false, path, 0)?;
    let mut city = reader.city;
    if reader.left > 0 {
        city.notes
            .push(format!("left out: {} tiles that are not read", reader.left));
    }
    let points = city.buildings.iter().flat_map(|b| &b.mesh.positions);
    match points.clone().next() {
        Some(&first) if norm(first) > EARTH => stand_upright(&mut city),
        _ => {
            let origin = serde_json::from_value(extras["origin"].clone());
            city.origin = origin.unwrap_or([0.0; 3]);
            city.reference_system = extras["reference_system"].as_str().map(str::to_owned);
        }
    }
    Ok(city)
}

/// The city as it is read.
struct Reader {
    city: City,
    /// Buildings by identifier.
    known: FxHashMap<String, usize>,
    /// True for tiles of this program, whose buildings have one identifier in all tiles.
    names_buildings: bool,
    /// True if contents are put where they are in the reference system, not on the earth.
    is_in_its_system: bool,
    /// Tiles that are not read.
    left: usize,
}

impl Reader {
    /// `replaces`: the refinement of the tile above.
    fn tile(
        &mut self,
        tile: &Tile,
        above: &Matrix,
        replaces: bool,
        path: &Path,
        depth: usize,
    ) -> Result<()> {
        let own = match &tile.transform {
            Some(transform) => product(above, transform),
            None => *above,
        };
        let replaces = tile
            .refine
            .as_deref()
            .map_or(replaces, |r| r.eq_ignore_ascii_case("replace"));
        self.left += usize::from(tile.implicit_tiling.is_some());
        // Children replace what is coarser.
        if tile.children.is_empty() || !replaces {
            let at = tile.at().filter(|_| self.is_in_its_system);
            let place = at.map_or(own, shift);
            for content in tile.content.iter().chain(&tile.contents) {
                self.content(&content.uri, &place, path, depth)?;
            }
        }
        let mut children = tile.children.iter();
        children.try_for_each(|child| self.tile(child, &own, replaces, path, depth))
    }

    fn content(&mut self, uri: &str, place: &Matrix, path: &Path, depth: usize) -> Result<()> {
        let uri = uri.split(['?', '#']).next().unwrap_or_default();
        let kind = Path::new(uri)
            .extension()
            .and_then(|e| e.to_str())
            .unwrap_or_default();
        if uri.contains("://") || !matches!(kind, "json" | "glb" | "gltf" | "b3dm") {
            self.left += 1;
            return Ok(());
        }
        let file = beside(path, uri)?;
        if kind == "json" {
            if depth >= DEEPEST {
                let text = format!("more than {DEEPEST} tilesets deep: a circle?");
                return Err(Error::content(&file, CityError::Format(text)));
            }
            let inner: Tileset = parse_json(&read_bytes(&file)?, &file)?;
            return self.tile(&inner.root, place, true, &file, depth + 1);
        }
        let bytes = read_bytes(&file)?;
        let (model, centre) = match kind {
            "b3dm" => batched(&bytes).ok_or_else(|| {
                let text = "no Batched 3D Model".to_owned();
                Error::content(&file, CityError::Format(text))
            })?,
            _ => (&bytes[..], [0.0; 3]),
        };
        let read = gltf::parse(model, &file)?;
        self.city.notes.extend(read.notes);
        let shift = [0, 1, 2].map(|k| read.origin[k] + centre[k]);
        for mut building in read.buildings {
            let painted = building.paint.iter_mut().flat_map(|p| &mut p.corners);
            for p in building.mesh.positions.iter_mut().chain(painted) {
                *p = applied(place, [0, 1, 2].map(|k| p[k] + shift[k]));
            }
            if determinant(place) < 0.0 {
                building.mesh.flip();
                building.paint.iter_mut().for_each(Painted::flip);
            }
            // Parts are known in the coordinates of their tile alone.
            building.parts.clear();
            if !self.names_buildings {
                building.id = format!("{}/{}", edifice_io::file_stem(&file), building.id);
            }
            self.add(building);
        }
        Ok(())
    }

    fn add(&mut self, mut building: CityBuilding) {
        match self.known.get(&building.id) {
            Some(&at) => {
                let whole = &mut self.city.buildings[at];
                whole.mesh.append(&building.mesh);
                whole.paint.append(&mut building.paint);
            }
            None => {
                self.known
                    .insert(building.id.clone(), self.city.buildings.len());
                self.city.buildings.push(building);
            }
        }
    }
}

/// A file beside another, by a relative address.
fn beside(path: &Path, uri: &str) -> Result<PathBuf> {
    let inner = Path::new(uri);
    let plain = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
    if !inner.components().all(plain) {
        let text = format!("{uri:?} lies outside the folder of the file");
        return Err(Error::input(path, "content", CityError::Format(text)));
    }
    Ok(path.parent().unwrap_or(Path::new("")).join(inner))
}

/// The glTF in a Batched 3D Model, and the point that its coordinates are relative to (`RTC_CENTER`), z up.
fn batched(bytes: &[u8]) -> Option<(&[u8], [f64; 3])> {
    let word = |at: usize| -> Option<usize> {
        let four = bytes.get(at..at + 4)?.try_into().ok()?;
        usize::try_from(u32::from_le_bytes(four)).ok()
    };
    if !bytes.starts_with(b"b3dm") {
        return None;
    }
    let table = word(12)?;
    let start = (12..HEADER)
        .step_by(4)
        .try_fold(HEADER, |sum, at| sum.checked_add(word(at)?))?;
    let text = bytes.get(HEADER..HEADER.checked_add(table)?)?;
    let table: Value = serde_json::from_slice(text).unwrap_or_default();
    let centre = serde_json::from_value(table["RTC_CENTER"].clone());
    Some((bytes.get(start..)?, centre.unwrap_or([0.0; 3])))
}

/// Makes earth-centred coordinates metres east, north and up of the middle of the city, as in a local map: heights are those above the
/// ellipsoid, less that of the middle, so that the city does not bend with the earth.
fn stand_upright(city: &mut City) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in city.buildings.iter().flat_map(|b| &b.mesh.positions) {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    let [longitude, latitude, height] = geodetic([0, 1, 2].map(|k| (low[k] + high[k]) / 2.0));
    let middle = earth_centred(longitude, latitude, height);
    let (sin, cos) = latitude.sin_cos();
    let (s, c) = longitude.sin_cos();
    let up = [cos * c, cos * s, sin];
    let east = [-s, c, 0.0];
    let north = cross(up, east);
    for building in &mut city.buildings {
        let painted = building.paint.iter_mut().flat_map(|p| &mut p.corners);
        for p in building.mesh.positions.iter_mut().chain(painted) {
            let [x, y, z] = geodetic(*p);
            let from = sub(earth_centred(x, y, height), middle);
            *p = [dot(from, east), dot(from, north), z - height];
        }
    }
    let note = "earth-centred coordinates were made metres east, north and up of the middle";
    city.notes.push(note.to_owned());
}
