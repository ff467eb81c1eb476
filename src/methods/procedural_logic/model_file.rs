//! A model as a plain record, for files: `edifice/logic-model`, version 1.

use serde::{Deserialize, Serialize};

use super::affinity::Affinity;
use super::alphabet::Alphabet;
use super::inference::Inference;
use super::model::{Known, Model};
use super::parameters::{ParameterError, Parameters};
use super::rules::{Call, Instance, InstanceError, ParametricRule, RuleSet};
use edifice_shape::Axis;

/// Name of the format.
pub const MODEL_FORMAT: &str = "edifice/logic-model";
/// Version of the format.
pub const MODEL_VERSION: u64 = 1;

/// Largest count that a file may state, so that counting on never overflows.
const MOST_COUNTED: u64 = 1 << 53;

/// The record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    format: String,
    version: u64,
    parameters: Parameters,
    labels: Vec<String>,
    affinity: Affinity,
    counts: Counts,
    rules: Vec<RuleRecord>,
    facades: Vec<FacadeRecord>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Counts {
    facades: u64,
    binary_splits: u64,
    nary_splits: u64,
    forced: u64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RuleRecord {
    axis: Axis,
    parts: Vec<Call>,
    uses: u64,
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FacadeRecord {
    name: String,
    unit: String,
    width: f64,
    height: f64,
    start: Call,
    parameters: Vec<f64>,
}

/// Why a record is no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelFileError {
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A label is given twice.
    #[error("labels[{index}] ({label}) is given twice")]
    LabelTwice {
        /// Index of the second one.
        index: usize,
        /// The label that is given twice.
        label: String,
    },
    /// The affinity matrices do not fit the labels, or hold a number that is negative or not finite.
    #[error("affinity does not fit {labels} labels, or holds a number that is no sum of lengths")]
    Affinity {
        /// Number of labels.
        labels: usize,
    },
    /// A rule has fewer than two parts, calls itself, a later rule or a label that does not exist,
    /// equals an earlier rule, or has statistics of another length.
    #[error("rules[{index}]: {what}")]
    Rule {
        /// Index of the rule.
        index: usize,
        /// The fault of the rule, in words.
        what: &'static str,
    },
    /// A facade's call does not fit the rules.
    #[error("facades[{index}]: {cause}")]
    Call {
        /// Index of the facade.
        index: usize,
        /// The fault of the call.
        cause: InstanceError,
    },
    /// A size of a facade is not a positive number.
    #[error("facades[{index}] has the size {value}, expected a positive number")]
    Size {
        /// Index of the facade.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A count is larger than can be counted on from.
    #[error("counts.{name} is {value}, expected at most {MOST_COUNTED}")]
    Count {
        /// Name of the count.
        name: &'static str,
        /// The value found.
        value: u64,
    },
    /// A facade starts with a label that does not exist.
    #[error("facades[{index}] starts with label {label}, which does not exist")]
    Label {
        /// Index of the facade.
        index: usize,
        /// Number of the label.
        label: u32,
    },
}

impl From<&Model> for ModelFile {
    fn from(model: &Model) -> Self {
        let inference = &model.inference;
        let rule = |rule: &ParametricRule| RuleRecord {
            axis: rule.axis,
            parts: rule.children.clone(),
            uses: rule.uses,
            mean: rule.mean.clone(),
            deviation: rule.deviation.clone(),
        };
        let facade = |known: &Known| FacadeRecord {
            name: known.name.clone(),
            unit: known.unit.clone(),
            width: known.instance.width,
            height: known.instance.height,
            start: known.instance.start,
            parameters: known.instance.parameters.clone(),
        };
        Self {
            format: MODEL_FORMAT.into(),
            version: MODEL_VERSION,
            parameters: model.parameters,
            labels: model.alphabet.names().to_vec(),
            affinity: model.affinity.clone(),
            counts: Counts {
                facades: inference.facades,
                binary_splits: inference.binary_splits,
                nary_splits: inference.nary_splits,
                forced: inference.forced,
            },
            rules: inference.rules.rules().iter().map(rule).collect(),
            facades: model.facades.iter().map(facade).collect(),
        }
    }
}

impl TryFrom<ModelFile> for Model {
    type Error = ModelFileError;

    fn try_from(file: ModelFile) -> Result<Self, ModelFileError> {
        let mut alphabet = Alphabet::default();
        for (index, label) in file.labels.iter().enumerate() {
            if alphabet.intern(label) as usize != index {
                let label = label.clone();
                return Err(ModelFileError::LabelTwice { index, label });
            }
        }
        let labels = alphabet.len();
        if !file.affinity.is_sound(labels) {
            return Err(ModelFileError::Affinity { labels });
        }
        for (name, value) in [
            ("facades", file.counts.facades),
            ("binary_splits", file.counts.binary_splits),
            ("nary_splits", file.counts.nary_splits),
            ("forced", file.counts.forced),
        ] {
            if value > MOST_COUNTED {
                return Err(ModelFileError::Count { name, value });
            }
        }
        let mut rules = RuleSet::default();
        for (index, record) in file.rules.into_iter().enumerate() {
            let wrong = |what| ModelFileError::Rule { index, what };
            check_parts(&record, index, labels).map_err(wrong)?;
            let restored = rules.restore(
                record.axis,
                record.parts,
                record.uses,
                record.mean,
                record.deviation,
            );
            if !restored {
                return Err(wrong("it equals an earlier rule"));
            }
        }
        let mut facades = Vec::with_capacity(file.facades.len());
        for (index, record) in file.facades.into_iter().enumerate() {
            facades.push(restore_facade(record, index, labels, &rules)?);
        }
        Ok(Self {
            parameters: file.parameters.checked()?,
            alphabet,
            affinity: file.affinity,
            inference: Inference {
                rules,
                facades: file.counts.facades,
                binary_splits: file.counts.binary_splits,
                nary_splits: file.counts.nary_splits,
                forced: file.counts.forced,
            },
            facades,
        })
    }
}

fn check_parts(record: &RuleRecord, index: usize, labels: usize) -> Result<(), &'static str> {
    let parts = record.parts.len();
    if parts < 2 {
        return Err("it has fewer than two parts");
    }
    if record.mean.len() != parts || record.deviation.len() != parts {
        return Err("mean and deviation need one number per part");
    }
    if record.uses > MOST_COUNTED {
        return Err("it has more uses than can be counted on from");
    }
    let known = |call: &Call| match *call {
        Call::Insert(label) => (label as usize) < labels,
        Call::Rule(rule) => (rule as usize) < index,
    };
    if record.parts.iter().all(known) {
        Ok(())
    } else {
        Err("it calls a label that does not exist, or a rule that does not come before it")
    }
}

fn restore_facade(
    record: FacadeRecord,
    index: usize,
    labels: usize,
    rules: &RuleSet,
) -> Result<Known, ModelFileError> {
    let sizes = [record.width, record.height];
    for &value in sizes.iter().chain(&record.parameters) {
        if !(value.is_finite() && value > 0.0) {
            return Err(ModelFileError::Size { index, value });
        }
    }
    if let Call::Insert(label) = record.start
        && label as usize >= labels
    {
        return Err(ModelFileError::Label { index, label });
    }
    let instance = Instance {
        width: record.width,
        height: record.height,
        start: record.start,
        parameters: record.parameters,
    };
    let fits = rules.check(&instance);
    fits.map_err(|cause| ModelFileError::Call { index, cause })?;
    Ok(Known {
        name: record.name,
        unit: record.unit,
        instance,
    })
}
