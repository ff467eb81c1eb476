//! The studies of this paper, for sweeps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::figure_4::retrieve;
use super::gold::{Architecture, Doors};
use super::{outline, shipped};
use crate::sweep::{Better, Given, Outcome, Shared, Study};
use edifice_base::{Error, Result};
use edifice_cluster::MatchCurve;
use edifice_io::{ReadOptions, read_facade, read_label_grid};
use edifice_procedural_logic as logic;
use edifice_procedural_logic::{Model, Parameters};
use edifice_shape::LabelGrid;

/// Distance between facades.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Measure {
    Powerset,
    CommonRules,
    AllRules,
    RuleUnion,
}

/// Reading of `W` in Eq. 3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Extent {
    Line,
    Facade,
    Scope,
}

/// Reading of Eq. 6.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Facing {
    Across,
    Adjacent,
}

/// Settings of retrieval.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Retrieval {
    /// Distance between facades.
    measure: Measure,
    /// Weight of the edge term against the affinity term, 0 to 1.
    alpha: f64,
    /// `b_p`: factor on proposals in the direction of the last split, above 0 to 1.
    parental_bias: f64,
    /// `b_h`: factor on horizontal lines, above 0 to 1.
    horizontal_bias: f64,
    /// Reading of `W` in Eq. 3.
    extent: Extent,
    /// Reading of Eq. 6.
    facing: Facing,
    /// Sizes at which each facade stands, its own included; 1 where the facades have like ones among them.
    sizes: u64,
}

impl Default for Retrieval {
    fn default() -> Self {
        let printed = Parameters::RETRIEVAL;
        Self {
            measure: Measure::Powerset,
            alpha: printed.alpha,
            parental_bias: printed.parental_bias,
            horizontal_bias: printed.horizontal_bias,
            extent: Extent::Line,
            facing: Facing::Across,
            sizes: 5,
        }
    }
}

/// Retrieval of facades without architectural change among all facades of the sweep.
pub fn retrieval() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("rank_1", Better::Higher),
        ("rank_2", Better::Higher),
        ("rank_5", Better::Higher),
        ("rank_20", Better::Higher),
        ("queries", Better::Higher),
        ("rules", Better::Lower),
    ];
    let about = "retrieval of facades of equal architecture (Weissenberg et al. 2013, Fig. 4): the facade is the query";
    Study::new(
        "procedural_logic/retrieval",
        about,
        "facade_grammar",
        METRICS,
        run,
    )
    .learning()
}

/// All facades of a sweep, ranked.
struct Ranked {
    curve: MatchCurve,
    rules: usize,
    facades: usize,
}

fn run(settings: &Retrieval, given: &Given) -> Result<Outcome> {
    static RANKED: Shared<Ranked> = Shared::new();
    let mut paths: Vec<_> = given.database.iter().map(|p| p.as_path()).collect();
    paths.push(given.path);
    // By name, so that the order is the same wherever the files are.
    paths.sort_by_key(|path| (path.file_name(), *path));
    let own = paths.iter().position(|p| *p == given.path).unwrap_or(0);
    let key = format!("{settings:?} {paths:?}");
    let ranked = RANKED.get(key, || {
        let grids: Result<Vec<LabelGrid>> = paths.iter().map(|path| picture(path)).collect();
        rank(settings, grids?)
    })?;
    let queries: Vec<&Vec<f64>> = (ranked.curve.queries.iter())
        .filter(|(query, _)| query % ranked.facades == own)
        .map(|(_, rates)| rates)
        .collect();
    let mut found = Outcome::default();
    let mut put = |name: &str, value: f64| found.metrics.insert(name.into(), value);
    put("queries", queries.len() as f64);
    put("rules", ranked.rules as f64);
    // A facade that no other equals is no query.
    if !queries.is_empty() {
        for rank in [1, 2, 5, 20] {
            let sum: f64 = queries.iter().map(|rates| rates[rank - 1]).sum();
            put(&format!("rank_{rank}"), sum / queries.len() as f64);
        }
    }
    Ok(found)
}

/// A facade in the classes of the real sets.
fn picture(path: &std::path::Path) -> Result<LabelGrid> {
    let options = ReadOptions::default();
    if path.to_string_lossy().ends_with(".json") {
        let facade = read_facade(path, &options)?;
        return shipped::picture(&facade).map_err(|e| Error::content(path, e));
    }
    read_label_grid(path, &options)
}

fn rank(settings: &Retrieval, facades: Vec<LabelGrid>) -> Result<Ranked> {
    let count = facades.len();
    let mut grids = facades;
    let mut architecture: Vec<Architecture> = grids.iter().map(outline::architecture).collect();
    for copy in 2..=settings.sizes {
        for index in 0..count {
            let grid = shipped::resized(&grids[index], copy);
            // Only where along the facade a door stands depends on sizes.
            let doors = outline::architecture(&grid).doors;
            let original = architecture[index].clone();
            architecture.push(Architecture { doors, ..original });
            grids.push(grid);
        }
    }
    let checked = Parameters::new(
        settings.alpha,
        settings.parental_bias,
        settings.horizontal_bias,
    );
    let parameters = Parameters {
        extent: match settings.extent {
            Extent::Line => logic::Extent::Line,
            Extent::Facade => logic::Extent::Facade,
            Extent::Scope => logic::Extent::Scope,
        },
        facing: match settings.facing {
            Facing::Across => logic::Facing::Across,
            Facing::Adjacent => logic::Facing::Adjacent,
        },
        ..checked.map_err(Error::method)?
    };
    let measure = match settings.measure {
        Measure::Powerset => logic::Measure::Powerset,
        Measure::CommonRules => logic::Measure::CommonRules,
        Measure::AllRules => logic::Measure::AllRules,
        Measure::RuleUnion => logic::Measure::RuleUnion,
    };
    let model = Model::fit(&grids, parameters).map_err(Error::method)?;
    let profiles = model.profiles().map_err(Error::method)?;
    // Judged by the architecture, which the method does not see.
    let curve = retrieve(&measure.matrix(&profiles), &architecture, Doors::Layout);
    Ok(Ranked {
        curve,
        rules: model.inference.rules.len(),
        facades: count,
    })
}
