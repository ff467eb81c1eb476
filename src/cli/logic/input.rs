//! Facades, parameters and models from the command line.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_io as io;
use edifice_io::json;
use edifice_procedural_logic::{
    MODEL_FORMAT, MODEL_VERSION, Measure, Model, ModelFile, Parameters,
};
use edifice_shape::LabelGrid;
use rayon::prelude::*;

use crate::choice::Choice;
use crate::cleaning::Cleaning;
use crate::print;
use crate::reading::{self, Reading};
use crate::walls::Walls;

/// Facades to read.
#[derive(clap::Args)]
pub(super) struct Facades {
    /// Facade files (.png, .facade.json, .xml, .txt, text also as .gz; boxes with --wall), and folders of .png and .facade.json files.
    #[arg(value_name = "IN")]
    pub inputs: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    walls: Walls,
    #[command(flatten)]
    cleaning: Cleaning,
}

impl Facades {
    /// Reads all facades as label pictures, folders in the order of their file names, and cleans them if
    /// asked.
    pub(super) fn read(&self) -> Result<Vec<LabelGrid>> {
        let options = self.reading.options()?;
        let mut grids = Vec::new();
        for input in &self.inputs {
            for path in files(input)? {
                let source = self
                    .walls
                    .tiling(reading::source(&path, &options)?, &path)?;
                grids.push(source.label_grid(&path)?);
            }
        }
        match self.cleaning.is_asked() {
            true => cleaned(&grids, &self.cleaning),
            false => Ok(grids),
        }
    }

    /// True if the facades are cleaned.
    pub(super) fn is_clean(&self) -> bool {
        self.cleaning.is_asked()
    }
}

/// The facades cleaned, with a message of what that did.
fn cleaned(grids: &[LabelGrid], cleaning: &Cleaning) -> Result<Vec<LabelGrid>> {
    let clean: Vec<LabelGrid> = grids
        .par_iter()
        .map(|grid| cleaning.picture(grid.clone()))
        .collect::<Result<_>>()?;
    let lines = |grid: &LabelGrid| {
        let merged = grid.merged();
        merged.columns() + merged.rows() - 2
    };
    let before: usize = grids.iter().map(lines).sum();
    let after: usize = clean.iter().map(lines).sum();
    print::message(&format!(
        "cleaned {} facades {}: {before} cut lines became {after}",
        grids.len(),
        cleaning.name()
    ));
    Ok(clean)
}

/// The file, or the facade files of a folder.
fn files(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(|e| Error::io(path, "read", e))? {
        let file = entry.map_err(|e| Error::io(path, "read", e))?.path();
        let name = file.to_string_lossy().to_lowercase();
        if [".png", ".facade.json", ".facade.json.gz"]
            .iter()
            .any(|ending| name.ends_with(ending))
        {
            files.push(file);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(Error::content(path, NoFacades));
    }
    Ok(files)
}

/// A folder without facades.
#[derive(Debug, thiserror::Error)]
#[error("the folder holds no .png and no .facade.json file")]
struct NoFacades;

/// Parameters of the energy of Eq. 3.
#[derive(clap::Args)]
pub(super) struct Energy {
    /// Weight of the edge term against the affinity term, 0 to 1.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha: Option<f64>,
    /// Factor on splits in the direction of the last one, above 0, at most 1.
    #[arg(long, value_name = "B", allow_negative_numbers = true)]
    parental_bias: Option<f64>,
    /// Factor on horizontal lines, above 0, at most 1.
    #[arg(long, value_name = "B", allow_negative_numbers = true)]
    horizontal_bias: Option<f64>,
}

impl Energy {
    /// The parameters given, the others from `defaults`.
    pub(super) fn parameters(&self, defaults: Parameters) -> Result<Parameters> {
        let parameters = Parameters {
            alpha: self.alpha.unwrap_or(defaults.alpha),
            parental_bias: self.parental_bias.unwrap_or(defaults.parental_bias),
            horizontal_bias: self.horizontal_bias.unwrap_or(defaults.horizontal_bias),
            ..defaults
        };
        parameters.checked().map_err(|error| {
            let option = match error.name {
                "b_p" => "--parental-bias",
                "b_h" => "--horizontal-bias",
                _ => "--alpha",
            };
            Error::option(option, error.to_string())
        })
    }

    /// True if any parameter is given.
    pub(super) fn is_given(&self) -> bool {
        self.alpha.is_some() || self.parental_bias.is_some() || self.horizontal_bias.is_some()
    }
}

/// Reads a model file.
pub(super) fn read_model(path: &Path) -> Result<Model> {
    let bytes = io::read_bytes(path)?;
    json::check_header(&bytes, path, MODEL_FORMAT, MODEL_VERSION)?;
    let file: ModelFile = json::parse_json(&bytes, path)?;
    Model::try_from(file).map_err(|error| Error::content(path, error))
}

/// Writes a model file.
pub(super) fn write_model(model: &Model, path: &Path) -> Result<()> {
    let mut bytes = serde_json::to_vec(&ModelFile::from(model)).map_err(Error::method)?;
    bytes.push(b'\n');
    io::write_atomic(path, &bytes)
}

/// The facades of a model file and of other files together, under the model's parameters; without
/// a model file, a model fitted to the facades with the parameters of Sec. 5.4.
pub(super) fn model(path: Option<&Path>, facades: &Facades, energy: &Energy) -> Result<Model> {
    let grids = facades.read()?;
    let Some(path) = path else {
        let parameters = energy.parameters(Parameters::RETRIEVAL)?;
        return Model::fit(&grids, parameters).map_err(Error::method);
    };
    if energy.is_given() {
        let message = "a model keeps the parameters that it was fitted with";
        return Err(Error::option("--model", message));
    }
    let mut model = read_model(path)?;
    model.add_all(&grids).map_err(Error::method)?;
    Ok(model)
}

/// Distances between facades.
#[rustfmt::skip]
pub(super) const MEASURES: &[Choice<Measure>] = &[
    ("powerset", "Chi-square over operations and labels of the parts of the parse trees", Measure::Powerset),
    ("common-rules", "Chi-square over the rules that two facades share", Measure::CommonRules),
    ("all-rules", "Chi-square over the rules of two facades", Measure::AllRules),
    ("rule-union", "Rules of both facades together over the sum of the rules of each", Measure::RuleUnion),
    ("lattice", "Floors, window columns, running balconies and places of doors that differ, read off the labels without rules", Measure::Lattice),
];
