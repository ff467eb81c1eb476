//! A grammar as the file says it, and its numbers.

use serde::{Deserialize, Serialize};

use edifice_grammar::instance::{InstanceRule, Placement};

/// A number that is written as an integer where it is one.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Number(pub(super) f64);

impl Number {
    /// Rounded where it is a whole number of steps but for rounding.
    pub(super) fn near(self) -> f64 {
        let whole = self.0.round();
        if (self.0 - whole).abs() < 1e-6 {
            whole
        } else {
            self.0
        }
    }
}

impl Serialize for Number {
    fn serialize<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        match self.0.fract() == 0.0 && self.0.abs() < 1e15 {
            true => serializer.serialize_i64(self.0 as i64),
            false => serializer.serialize_f64(self.0),
        }
    }
}

fn numbers<S: serde::Serializer>(
    values: &[f64],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    serializer.collect_seq(values.iter().map(|&v| Number(v)))
}

fn triple<S: serde::Serializer>(
    v: &[f64; 3],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    numbers(v, serializer)
}

fn number<S: serde::Serializer>(v: &f64, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    Number(*v).serialize(serializer)
}

#[derive(Deserialize)]
pub(super) struct File {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) up: String,
    pub(super) reference_system: Option<String>,
    pub(super) origin: [f64; 3],
    pub(super) axiom: String,
    pub(super) steps: f64,
    pub(super) templates: Vec<FileTemplate>,
    pub(super) rules: Vec<FileRule>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct FileTemplate {
    pub(super) symbol: String,
    #[serde(serialize_with = "numbers")]
    pub(super) positions: Vec<f64>,
    pub(super) triangles: Vec<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) texture: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct FileRule {
    pub(super) symbol: String,
    #[serde(default = "one")]
    pub(super) weight: f64,
    #[serde(default)]
    pub(super) parameters: Vec<String>,
    #[serde(default)]
    pub(super) row: bool,
    #[serde(default = "ones")]
    pub(super) scale: [f64; 3],
    pub(super) successors: Vec<FilePlacement>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct FilePlacement {
    symbol: String,
    #[serde(default, skip_serializing_if = "is_zero", serialize_with = "triple")]
    at: [f64; 3],
    #[serde(default, skip_serializing_if = "is_still", serialize_with = "number")]
    turn: f64,
    #[serde(
        default = "ones",
        skip_serializing_if = "is_one",
        serialize_with = "triple"
    )]
    size: [f64; 3],
    #[serde(
        default,
        skip_serializing_if = "Vec::is_empty",
        serialize_with = "numbers"
    )]
    numbers: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    id: Option<String>,
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    attributes: serde_json::Map<String, serde_json::Value>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parts: Vec<Option<FilePlacement>>,
}

fn one() -> f64 {
    1.0
}

fn ones() -> [f64; 3] {
    [1.0; 3]
}

fn is_zero(at: &[f64; 3]) -> bool {
    *at == [0.0; 3]
}

fn is_still(turn: &f64) -> bool {
    *turn == 0.0
}

fn is_one(size: &[f64; 3]) -> bool {
    *size == [1.0; 3]
}

/// Names of the parameters of a rule of so many levels.
pub(super) fn parameters(levels: usize) -> Vec<String> {
    let fixed = ["w", "d"].map(str::to_owned).into_iter();
    fixed.chain((1..=levels).map(|k| format!("h{k}"))).collect()
}

/// The levels of a rule with these parameters.
pub(super) fn levels_of(names: &[String]) -> Option<usize> {
    if names.is_empty() {
        return Some(0);
    }
    let levels = names.len().checked_sub(2).filter(|l| *l > 0)?;
    (parameters(levels) == names).then_some(levels)
}

pub(super) fn rule_of(rule: FileRule, levels: usize) -> InstanceRule {
    InstanceRule {
        symbol: rule.symbol,
        weight: rule.weight,
        levels,
        row: rule.row,
        scale: rule.scale,
        successors: rule.successors.into_iter().map(placement_of).collect(),
    }
}

fn placement_of(p: FilePlacement) -> Placement {
    let parts = p.parts.into_iter();
    Placement {
        symbol: p.symbol,
        at: p.at,
        turn: p.turn,
        size: p.size,
        id: p.id,
        attributes: p.attributes,
        parts: parts.map(|part| part.map(placement_of)).collect(),
        numbers: p.numbers,
    }
}

pub(super) fn placement_file(p: &Placement) -> FilePlacement {
    let parts = p.parts.iter();
    FilePlacement {
        symbol: p.symbol.clone(),
        at: p.at,
        turn: p.turn,
        size: p.size,
        id: p.id.clone(),
        attributes: p.attributes.clone(),
        numbers: p.numbers.clone(),
        parts: parts
            .map(|part| part.as_ref().map(placement_file))
            .collect(),
    }
}
