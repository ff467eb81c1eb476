//! The studies of this paper, for sweeps.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::data::measure;
use super::generation::{Unit, answer, rows_of};
use edifice_base::{Error, Result};
use edifice_building_exteriors::house::Database;
use edifice_frame::averages::mean_and_error;
use edifice_io::building_json;
use edifice_model::hierarchy::{Constant, Settings};
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::{Contender, held_out, split};
use edifice_sweep::{Better, Given, Outcome, Shared, Study};

/// Crates that results depend on, with those that they are built on.
const MADE_OF: &[&str] = &["edifice-building-exteriors", "edifice-io"];

/// A model of Fig. 12.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum ModelName {
    Ours,
    #[serde(rename = "model_1")]
    Model1,
    #[serde(rename = "model_2")]
    Model2,
    #[serde(rename = "model_3")]
    Model3,
    Gmm,
}

/// Settings of learning.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Learn {
    /// The model; 1 has no lateral edges, 2 no second hidden level, 3 no hidden variables.
    model: ModelName,
    /// Most styles (states of the root), or components of the mixture; at least 2.
    most_styles: usize,
    /// Most states of the hidden variables of attributes.
    most_states: usize,
    /// Random starts of each structure.
    restarts: usize,
    /// Share of the houses that is learnt from.
    share: f64,
    /// Most houses that are learnt from; 0 for all of the share.
    houses: usize,
    /// Seed of learning and of the shuffle; the sweep's seeds number the splits of it.
    seed: u64,
}

impl Default for Learn {
    fn default() -> Self {
        Self {
            model: ModelName::Ours,
            most_styles: 12,
            most_states: 25,
            restarts: 4,
            share: 0.8,
            houses: 0,
            seed: 1,
        }
    }
}

/// Models of the attributes of houses, judged on houses that they have not seen.
pub fn learn() -> Study {
    const METRICS: &[(&str, Better)] = &[("nll", Better::Lower)];
    let about = "models of the attributes of houses (Fan and Wonka 2016, Fig. 12): negative log-likelihood of unseen houses; seeds number the splits";
    Study::new(
        "building_exteriors/learn",
        about,
        "building_exteriors",
        METRICS,
        run_learn,
    )
    .made_of(MADE_OF, "building_exteriors")
}

fn run_learn(settings: &Learn, given: &Given) -> Result<Outcome> {
    static DATA: Shared<Dataset> = Shared::new();
    let data = DATA.get(key(given.path), || {
        measure(&building_json::read(given.path)?)
    })?;
    let wrong = |what: &str| Err(Error::method(what.to_owned()));
    if settings.most_styles < 2 {
        return wrong("most_styles is at least 2");
    }
    if !(settings.share > 0.0 && settings.share < 1.0) {
        return wrong("share is between 0 and 1");
    }
    let (train, test) = split(data.table.rows(), settings.share, settings.seed, given.seed);
    let most = match settings.houses {
        0 => train.len(),
        houses => houses.min(train.len()),
    };
    let (train, test) = (data.select(&train[..most]), data.select(&test));
    let learning = Settings {
        styles: 2..=settings.most_styles,
        most_states: settings.most_states,
        restarts: settings.restarts,
        constant: Constant::Keep,
        ..Settings::default()
    };
    let contender = match settings.model {
        ModelName::Ours => Contender::Ours,
        ModelName::Model1 => Contender::Model1,
        ModelName::Model2 => Contender::Model2,
        ModelName::Model3 => Contender::Model3,
        ModelName::Gmm => Contender::Gmm,
    };
    // Judged by the likelihood of rows that were not learnt from.
    let losses = held_out(contender, &train, &test, &learning, settings.seed);
    let mut found = Outcome::default();
    let mean = mean_and_error(&losses.map_err(Error::method)?).0;
    found.metrics.insert("nll".into(), mean);
    Ok(found)
}

/// The method that makes a house of its attributes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum GeneratorName {
    Best,
    Paper,
    Random,
    Nearest,
    NearestScaled,
}

/// Settings of generation.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Generate {
    /// Method: `best`, the `paper`'s annealing, search from `random` starts, the `nearest` house, or that house scaled.
    method: GeneratorName,
    /// Seed of the search; the sweep's seeds number the houses of the file, from 0.
    seed: u64,
}

impl Default for Generate {
    fn default() -> Self {
        Self {
            method: GeneratorName::Best,
            seed: 1,
        }
    }
}

/// Houses made again from their attributes, the house itself being no donor.
pub fn generate() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("max_z", Better::Lower),
        ("mean_z", Better::Lower),
        ("mass_z", Better::Lower),
        ("valid", Better::Higher),
        ("watertight", Better::Higher),
        ("evaluations", Better::Lower),
    ];
    let about = "houses from attributes (Fan and Wonka 2016, Sec. 6): distance of the house's attributes from those wanted; seeds number the houses";
    Study::new(
        "building_exteriors/generate",
        about,
        "building_exteriors",
        METRICS,
        run_generate,
    )
    .made_of(MADE_OF, "building_exteriors")
}

/// A file of houses, and the attributes of each.
struct Houses {
    database: Database,
    rows: Vec<Vec<f64>>,
}

fn run_generate(settings: &Generate, given: &Given) -> Result<Outcome> {
    static HOUSES: Shared<Houses> = Shared::new();
    let houses = HOUSES.get(key(given.path), || {
        let buildings = building_json::read(given.path)?;
        let rows = rows_of(&measure(&buildings)?.table);
        let database = Database::new(buildings).map_err(Error::method)?;
        Ok(Houses { database, rows })
    })?;
    let house = usize::try_from(given.seed).unwrap_or(usize::MAX);
    let Some(wanted) = houses.rows.get(house) else {
        let count = houses.rows.len();
        let message = format!("seeds number the houses: there is no house {house} of {count}");
        return Err(Error::content(given.path, message));
    };
    let unit = Unit {
        dataset: "shipped",
        method: match settings.method {
            GeneratorName::Best => "best",
            GeneratorName::Paper => "paper",
            GeneratorName::Random => "random",
            GeneratorName::Nearest => "nearest",
            GeneratorName::NearestScaled => "nearest_scaled",
        },
        house,
        wanted: wanted.clone(),
    };
    let answer = answer(&unit, &houses.database, settings.seed)?;
    let mut found = Outcome::default();
    let flag = |holds: bool| f64::from(u8::from(holds));
    for (name, value) in [
        ("max_z", answer.max_z),
        ("mean_z", answer.mean_z),
        ("mass_z", answer.mass_z),
        ("valid", flag(answer.valid)),
        ("watertight", flag(answer.watertight)),
        ("evaluations", answer.evaluations as f64),
    ] {
        found.metrics.insert(name.into(), value);
    }
    Ok(found)
}

fn key(path: &Path) -> String {
    path.display().to_string()
}
