//! The plan of a country: its tiles and settings, by their content.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::split::{Seen, split};
use super::tile::Tile;
use edifice_base::{Error, Result, file};
use edifice_city_proceduralization::country::{CountrySettings, Shares};
use edifice_city_proceduralization::{Precision, Representative};
use edifice_frame::provenance;
use edifice_io::json::{check_header, parse_json};
use edifice_io_city as city;

/// Name of the plan in its folder.
pub const PLAN: &str = "plan.json";
/// Format of a plan.
const FORMAT: &str = "edifice/city-plan";
/// Its version.
const VERSION: u64 = 1;
/// Most types that all tiles together propose: what the merge holds.
const MOST_PROPOSED: usize = 150_000;
/// Types that a tile may always propose.
const LEAST_PROPOSED: usize = 64;
/// Bytes that a building of a tile takes in a worker: 693 MB were measured on a tile of Delft with 16,033 buildings.
const BUILDING_BYTES: u64 = 40_000;
/// Bytes that a type takes: triangles, height map, features. Assumed, not measured.
const TYPE_BYTES: u64 = 8_000;
/// Components of a building, more than the 1.55 of Delft.
const COMPONENTS: f64 = 2.0;

/// The settings of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Halvings of the number of components that give the number of types.
    pub level: u32,
    /// True to represent types by members of few polygons.
    pub poly: bool,
    /// Step of the numbers written: `mm`, `cm` or `dm`.
    pub precision: String,
    /// Share of the types that are local, 0 to 1.
    pub local: f64,
    /// Most templates, and most rules, of the dictionary.
    pub most: usize,
    /// False to leave out the attributes of buildings.
    pub attributes: bool,
    /// True to write 3D Tiles.
    pub scenes: bool,
}

impl Default for Options {
    fn default() -> Self {
        let Shares { local, most } = Shares::default();
        Self {
            level: 4,
            poly: false,
            precision: "dm".to_owned(),
            local,
            most,
            attributes: true,
            scenes: false,
        }
    }
}

/// A plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    format: String,
    version: u64,
    /// Hash of settings and tiles.
    pub key: String,
    /// Settings.
    pub settings: Options,
    /// Tiles.
    pub tiles: Vec<Tile>,
}

/// Bytes of memory that a plan needs by its own arithmetic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// A worker on the largest tile.
    pub tile: u64,
    /// The worker that merges.
    pub merge: u64,
}

/// The faults of a plan.
#[derive(Debug, thiserror::Error)]
enum PlanError {
    #[error("two tiles are called {0}: rename one of the files")]
    Twice(String),
    #[error("the plan's key {found} does not fit its tiles and settings: {wanted}")]
    Key { found: String, wanted: String },
    #[error("{0:?} is not mm, cm or dm")]
    Precision(String),
    #[error("{0} is not between 0 and 1")]
    Share(f64),
}

impl Plan {
    /// The plan of tiles, each a city's file; or, with `side` in metres, of the square tiles that each of the files is split into,
    /// which are written below `out`.
    ///
    /// # Errors
    /// Those of reading cities; [`Error::Content`] where a building is in two tiles, or two tiles have one name.
    pub fn make(
        inputs: &[PathBuf],
        side: Option<f64>,
        out: &Path,
        options: Options,
    ) -> Result<Self> {
        settings(&options, 1)?;
        std::fs::create_dir_all(out).map_err(|e| Error::io(out, "create", e))?;
        let (mut seen, mut tiles) = (Seen::default(), Vec::new());
        for input in inputs {
            let city = city::read(input)?;
            seen.add(&city, input)?;
            match side {
                Some(side) => tiles.extend(split(city, side, out)?),
                None => tiles.push(Tile {
                    name: name(input),
                    path: std::path::absolute(input).map_err(|e| Error::io(input, "find", e))?,
                    sha256: provenance::digest(input)?,
                    buildings: city.buildings.len(),
                }),
            }
        }
        let mut names = std::collections::BTreeSet::new();
        if let Some(twice) = tiles.iter().find(|t| !names.insert(&t.name)) {
            return Err(Error::content(
                &twice.path,
                PlanError::Twice(twice.name.clone()),
            ));
        }
        let plan = Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            key: key(&options, &tiles)?,
            settings: options,
            tiles,
        };
        let mut bytes = serde_json::to_vec_pretty(&plan).map_err(Error::method)?;
        bytes.push(b'\n');
        file::write_atomic(&out.join(PLAN), &bytes)?;
        Ok(plan)
    }

    /// Reads the plan of a folder.
    ///
    /// # Errors
    /// [`Error::Io`], or what is wrong and where.
    pub fn read(out: &Path) -> Result<Self> {
        let path = out.join(PLAN);
        Self::parse(&file::read_bytes(&path)?, &path)
    }

    /// Parses a plan; `path` only names the file in errors.
    ///
    /// # Errors
    /// [`Error::Input`]; [`Error::Content`] where the key is not that of tiles and settings.
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self> {
        check_header(bytes, path, FORMAT, VERSION)?;
        let plan: Self = parse_json(bytes, path)?;
        settings(&plan.settings, 1)?;
        let (found, wanted) = (plan.key.clone(), key(&plan.settings, &plan.tiles)?);
        match found == wanted {
            true => Ok(plan),
            false => Err(Error::content(path, PlanError::Key { found, wanted })),
        }
    }

    /// The settings of the method.
    ///
    /// # Errors
    /// [`Error::Option`] on a setting that there is not.
    pub fn settings(&self) -> Result<CountrySettings> {
        settings(&self.settings, self.tiles.len())
    }

    /// Number of buildings.
    pub fn buildings(&self) -> usize {
        self.tiles.iter().map(|t| t.buildings).sum()
    }

    /// The memory that workers need: 40,000 bytes for a building of a tile, 8,000 bytes for each template and each rule of the
    /// dictionary and of the proposals, two components for a building.
    ///
    /// # Errors
    /// As [`Plan::settings`].
    pub fn memory(&self) -> Result<Memory> {
        let proposed = self.settings()?.proposed;
        let types = |buildings: usize| -> u64 {
            let components = COMPONENTS * buildings as f64;
            (components / 2f64.powi(self.settings.level as i32)).ceil() as u64
        };
        let proposals = |t: &Tile| types(t.buildings).min(proposed as u64);
        let dictionary = types(self.buildings()).min(self.settings.most as u64);
        let tile = |t: &Tile| {
            BUILDING_BYTES * t.buildings as u64 + 2 * TYPE_BYTES * (dictionary + proposals(t))
        };
        Ok(Memory {
            tile: self.tiles.iter().map(tile).max().unwrap_or(0),
            merge: 2 * TYPE_BYTES * self.tiles.iter().map(proposals).sum::<u64>(),
        })
    }
}

fn settings(options: &Options, tiles: usize) -> Result<CountrySettings> {
    let bad = |option, fault: PlanError| Error::option(option, fault.to_string());
    if !(0.0..=1.0).contains(&options.local) {
        return Err(bad("--local", PlanError::Share(options.local)));
    }
    Ok(CountrySettings {
        level: options.level,
        representative: match options.poly {
            true => Representative::FewestPolygons,
            false => Representative::Nearest,
        },
        precision: match options.precision.as_str() {
            "mm" => Precision::Millimetre,
            "cm" => Precision::Centimetre,
            "dm" => Precision::Decimetre,
            other => return Err(bad("--precision", PlanError::Precision(other.to_owned()))),
        },
        shares: Shares {
            local: options.local,
            most: options.most,
        },
        proposed: (MOST_PROPOSED / tiles.max(1)).max(LEAST_PROPOSED),
    })
}

/// A hash of what the results follow from.
fn key(options: &Options, tiles: &[Tile]) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(serde_json::to_vec(options).map_err(Error::method)?);
    for tile in tiles {
        hash.update(format!("{}\n{}\n", tile.name, tile.sha256));
    }
    Ok(provenance::hex(&hash.finalize()[..6]))
}

/// The name of a tile: that of its file up to the first dot.
fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_million_buildings_in_two_hundred_tiles_fit_into_four_gigabytes() {
        let tile = |t: usize| Tile {
            name: format!("t{t}"),
            path: PathBuf::from("t.city.json"),
            sha256: String::new(),
            buildings: 50_000,
        };
        let plan = Plan {
            format: FORMAT.to_owned(),
            version: VERSION,
            key: String::new(),
            settings: Options::default(),
            tiles: (0..200).map(tile).collect(),
        };
        assert_eq!(plan.buildings(), 10_000_000);
        let memory = plan.memory().unwrap();
        assert!(memory.tile.max(memory.merge) < 4_000_000_000, "{memory:?}");
    }
}
