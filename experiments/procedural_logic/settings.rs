//! Settings of the studies of this paper.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use edifice_base::{Error, Result};
use edifice_procedural_logic as logic;
use edifice_procedural_logic::Parameters;

/// Distance between facades.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Measure {
    Powerset,
    CommonRules,
    AllRules,
    RuleUnion,
    Lattice,
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
pub(super) struct Retrieval {
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
    pub sizes: u64,
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

/// The parameters of the method.
pub(super) fn parameters(settings: &Retrieval) -> Result<Parameters> {
    let checked = Parameters::new(
        settings.alpha,
        settings.parental_bias,
        settings.horizontal_bias,
    );
    Ok(Parameters {
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
    })
}

/// The distance between facades.
pub(super) fn measure(settings: &Retrieval) -> logic::Measure {
    match settings.measure {
        Measure::Powerset => logic::Measure::Powerset,
        Measure::CommonRules => logic::Measure::CommonRules,
        Measure::AllRules => logic::Measure::AllRules,
        Measure::RuleUnion => logic::Measure::RuleUnion,
        Measure::Lattice => logic::Measure::Lattice,
    }
}
