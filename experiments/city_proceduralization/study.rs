//! The studies of this paper, for sweeps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::data::{self, Measures};
use edifice_base::{Error, Result};
use edifice_city_proceduralization as proceduralization;
use edifice_city_proceduralization::Budget;
use edifice_generators_city_proceduralization as synthetic;
use edifice_io::{json, read_bytes};
use edifice_io_city as city;
use edifice_shape::triangles::City;
use edifice_sweep::{Better, Given, Outcome, Shared, Study};

/// The method that finds types.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Mode {
    Best,
    Paper,
}

/// The representative of a type, of `paper`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Representative {
    Nearest,
    FewestPolygons,
}

/// Settings of proceduralization.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Proceduralize {
    /// Method that finds types.
    mode: Mode,
    /// Representative of a type, of `paper`.
    representative: Representative,
    /// The number of templates is that of the components, halved so many times; 0 for one of each distinct component.
    level: u32,
}

impl Default for Proceduralize {
    fn default() -> Self {
        Self {
            mode: Mode::Best,
            representative: Representative::Nearest,
            level: 4,
        }
    }
}

/// A city made by rule, as its file tells it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Recipe {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: u64,
    /// Motif instances of six buildings.
    motifs: usize,
    /// Share by which buildings are moved and resized.
    noise: f64,
    /// Seed.
    seed: u64,
}

/// Format of [`Recipe`].
const FORMAT: &str = "edifice/made-city";

/// A city as a grammar.
pub fn proceduralize() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("iou", Better::Higher),
        ("polygons", Better::Lower),
        ("bytes", Better::Lower),
        ("terminals", Better::Lower),
        ("non_terminals", Better::Lower),
        ("components", Better::Lower),
    ];
    let about = "cities as grammars (Demir et al. 2014, Fig. 7): quality against compression, on a file of a city or on one made by rule (`edifice/made-city`)";
    Study::new(
        "city_proceduralization/proceduralize",
        about,
        "city_proceduralization",
        METRICS,
        run,
    )
    .made_of(
        &["edifice-city-proceduralization", "edifice-io"],
        "city_proceduralization",
    )
}

fn run(settings: &Proceduralize, given: &Given) -> Result<Outcome> {
    static CITIES: Shared<City> = Shared::new();
    let city = CITIES.get(given.path.display().to_string(), || read(given.path))?;
    let mode = match settings.mode {
        Mode::Best => proceduralization::Mode::Best,
        Mode::Paper => proceduralization::Mode::Paper,
    };
    let asked = proceduralization::Settings {
        mode,
        budget: match settings.level {
            0 => Budget::All,
            level => Budget::Level(level),
        },
        representative: match settings.representative {
            Representative::Nearest => proceduralization::Representative::Nearest,
            Representative::FewestPolygons => proceduralization::Representative::FewestPolygons,
        },
        seed: given.seed,
        ..proceduralization::Settings::default()
    };
    // Measured on the derived triangles.
    let Measures {
        polygons,
        components,
        terminals,
        non_terminals,
        iou,
        bytes,
        ..
    } = data::measure(&city, &asked, &given.watched.inner())?;
    let mut found = Outcome::default();
    for (name, value) in [
        ("iou", iou),
        ("polygons", polygons),
        ("bytes", bytes),
        ("terminals", terminals),
        ("non_terminals", non_terminals),
        ("components", components),
    ] {
        found.metrics.insert(name.into(), value);
    }
    Ok(found)
}

fn read(path: &std::path::Path) -> Result<City> {
    if !path.to_string_lossy().ends_with(".made-city.json") {
        return city::read(path);
    }
    let bytes = read_bytes(path)?;
    json::check_header(&bytes, path, FORMAT, 1)?;
    let recipe: Recipe = json::parse_json(&bytes, path)?;
    if recipe.motifs == 0 || !(0.0..1.0).contains(&recipe.noise) {
        let message = "motifs are at least 1, noise is 0 to 1";
        return Err(Error::content(path, message));
    }
    Ok(synthetic::city(recipe.motifs, recipe.noise, recipe.seed).0)
}
