//! A city split into square tiles, and the check that no building is in two.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use super::tile::Tile;
use edifice_base::{Error, Result, file};
use edifice_frame::provenance;
use edifice_io_city::cityjson;
use edifice_shape::triangles::{City, CityBuilding};

/// Folder of the tiles that a city was split into.
const TILES: &str = "tiles";

/// A building that is in two tiles.
#[derive(Debug, thiserror::Error)]
#[error("building {id:?} is in {}, too: a building belongs to one tile", .other.display())]
struct InTwo {
    id: String,
    other: PathBuf,
}

/// A side that is no length.
#[derive(Debug, thiserror::Error)]
#[error("{0} is no length of at least 1 m")]
struct NoSide(f64);

/// Splits a city into squares with sides of `side` metres, by the middle of each building's bounds, and writes each that has buildings
/// as CityJSON below `out`.
pub(super) fn split(city: City, side: f64, out: &Path) -> Result<Vec<Tile>> {
    if !(side.is_finite() && side >= 1.0) {
        return Err(Error::option("--tile", NoSide(side).to_string()));
    }
    let mut squares: BTreeMap<[i64; 2], Vec<CityBuilding>> = BTreeMap::new();
    for building in city.buildings {
        let (low, high) = building.mesh.bounds().unwrap_or_default();
        let square = [0, 1].map(|k| {
            let middle = (low[k] + high[k]) / 2.0 + city.origin[k];
            (middle / side).floor() as i64
        });
        squares.entry(square).or_default().push(building);
    }
    let folder = out.join(TILES);
    std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
    let mut tiles = Vec::new();
    for ([x, y], buildings) in squares {
        let name = format!("x{x}_y{y}");
        let tile = City {
            name: name.clone(),
            reference_system: city.reference_system.clone(),
            origin: city.origin,
            buildings,
            ..City::default()
        };
        let path = Path::new(TILES).join(format!("{name}.city.json"));
        file::write_atomic(&out.join(&path), cityjson::to_string(&tile).as_bytes())?;
        tiles.push(Tile {
            sha256: provenance::digest(&out.join(&path))?,
            name,
            path,
            buildings: tile.buildings.len(),
        });
    }
    Ok(tiles)
}

/// The buildings of the tiles so far, by identifier and bounds in centimetres, with the number of their tile.
#[derive(Default)]
pub(super) struct Seen {
    known: HashMap<(String, [i64; 6]), usize>,
    tiles: Vec<PathBuf>,
}

impl Seen {
    /// Adds a tile.
    ///
    /// # Errors
    /// [`Error::Input`] naming a building that is in another tile.
    pub(super) fn add(&mut self, city: &City, path: &Path) -> Result<()> {
        let tile = self.tiles.len();
        self.tiles.push(path.to_path_buf());
        for building in &city.buildings {
            let (low, high) = building.mesh.bounds().unwrap_or_default();
            let at =
                |p: [f64; 3]| [0, 1, 2].map(|k| ((p[k] + city.origin[k]) * 100.0).round() as i64);
            let ([a, b, c], [d, e, f]) = (at(low), at(high));
            let key = (building.id.clone(), [a, b, c, d, e, f]);
            let first = *self.known.entry(key).or_insert(tile);
            if first != tile {
                let (id, other) = (building.id.clone(), self.tiles[first].clone());
                let place = format!("building {id:?}");
                return Err(Error::input(path, place, InTwo { id, other }));
            }
        }
        Ok(())
    }
}
