//! The model that is learnt from a database of whole layouts.

use serde::{Deserialize, Serialize};

use super::best::density::Spacing;
use super::best::learn::learn;
use super::layout::lines::{LatticeLine, lines, median};
use super::layout::{Class, Layout};
use super::model_file::ModelFileError;
use super::policy::PaperModel;
use edifice_base::{Ended, Progress, Watch, Watched};
use edifice_model::ModelError;
use edifice_model::boosting::{Boosting, BoostingError};
use edifice_shape::{Axis, Rect};

/// A whole layout of the database, with its lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// The layout.
    pub layout: Layout,
    /// Columns of its windows.
    pub columns: Vec<LatticeLine>,
    /// Rows of its windows, from the bottom.
    pub rows: Vec<LatticeLine>,
    /// Median width and height of its windows.
    pub size: (f64, f64),
}

impl Example {
    /// A layout with its lattice; `None` without windows.
    pub fn new(layout: Layout) -> Option<Self> {
        let windows: Vec<Rect> = layout.of(Class::Window).map(|e| e.rect).collect();
        let size = (
            median(windows.iter().map(|r| r.width))?,
            median(windows.iter().map(|r| r.height))?,
        );
        Some(Self {
            columns: lines(&windows, Axis::X).0,
            rows: lines(&windows, Axis::Y).0,
            size,
            layout,
        })
    }
}

/// A learnt model.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The layouts of the database.
    pub examples: Vec<Example>,
    /// Columns from left to right.
    pub columns: Spacing,
    /// Rows from the top down.
    pub rows: Spacing,
    /// Probability that a candidate element is true at an intersection over union of 0.5, given its features; `None` before it
    /// is learnt.
    pub elements: Option<Boosting>,
    /// The same at an intersection over union of 0.75; `None` before it is learnt, and in files of before.
    pub tight: Option<Boosting>,
    /// Probability that a place holds the door, given its features; `None` before it is learnt, and in files of before.
    pub doors: Option<Boosting>,
    /// Probability that a facade has so many columns and rows, given its features; `None` before it is learnt, and in files of
    /// before.
    pub masses: Option<Boosting>,
    /// The model of the paper's own method; `None` before it is learnt.
    pub paper: Option<PaperModel>,
}

/// Result of [`Model::train`].
#[derive(Debug, Clone, PartialEq)]
pub struct Trained {
    /// The model.
    pub model: Model,
    /// The way in which the training ended.
    pub ended: Ended,
}

/// Why nothing can be learnt.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrainError {
    /// No layout has a window.
    #[error("none of the layouts has a window: nothing to learn from")]
    Empty,
    /// The element probabilities cannot be learnt.
    #[error("element probabilities: {0}")]
    Elements(#[from] BoostingError),
    /// The scoring functions, their weights or the policies cannot be learnt.
    #[error("scoring functions: {0}")]
    Score(#[from] ModelError),
}

/// The parts of a model that a file holds.
#[derive(Serialize, Deserialize)]
pub(super) struct Stored {
    pub format: String,
    pub version: u64,
    pub layouts: Vec<Layout>,
    pub columns: Spacing,
    pub rows: Spacing,
    pub elements: Option<Boosting>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tight: Option<Boosting>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doors: Option<Boosting>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub masses: Option<Boosting>,
    #[serde(default)]
    pub paper: Option<PaperModel>,
}

impl Model {
    /// Learns everything from a database of whole layouts; those without windows are left out. A training that `watch` stops
    /// returns the parts of the model that were learnt until then; spacings always are.
    ///
    /// # Errors
    /// [`TrainError`] without any window.
    pub fn train(layouts: Vec<Layout>, seed: u64, watch: &Watch) -> Result<Trained, TrainError> {
        let watched = Watched::new(watch);
        let mut model = Self::of_best(layouts, seed, &watched)?;
        if watched.goes_on(Progress::stage("densities of the scoring functions")) {
            let paper = PaperModel::train(&model.layouts(), seed, &watched.inner())?;
            model.paper = Some(paper);
        }
        Ok(Trained {
            model,
            ended: watched.ended(),
        })
    }

    /// Learns all but the paper's method, as [`Model::train`] does.
    ///
    /// # Errors
    /// [`TrainError`] without any window.
    pub fn of_best(layouts: Vec<Layout>, seed: u64, watched: &Watched) -> Result<Self, TrainError> {
        let mut model = Self::of_spacing(layouts);
        match model.examples.len() {
            0 => return Err(TrainError::Empty),
            // Nothing to learn from what the rest of the database says of one facade.
            1 => return Ok(model),
            _ => {}
        }
        let learnt = match learn(&model, seed, watched) {
            Ok(learnt) => learnt,
            // No part was hidden yet.
            Err(BoostingError::Empty) if watched.is_stopped() => return Ok(model),
            Err(error) => return Err(error.into()),
        };
        model.elements = Some(learnt.loose);
        model.tight = Some(learnt.tight);
        model.doors = learnt.doors;
        model.masses = Some(learnt.masses);
        Ok(model)
    }

    /// Learns the spacing of lines; element probabilities are not learnt yet.
    pub fn of_spacing(layouts: Vec<Layout>) -> Self {
        let examples: Vec<Example> = layouts.into_iter().filter_map(Example::new).collect();
        let (mut columns, mut rows) = (Vec::new(), Vec::new());
        for e in &examples {
            let (width, height) = (e.layout.width, e.layout.height);
            let at: Vec<f64> = e.columns.iter().map(|l| l.at).collect();
            // A facade and its mirror image are equally probable.
            let mirrored: Vec<f64> = at.iter().rev().map(|x| width - x).collect();
            columns.push((at, e.size.0, width));
            columns.push((mirrored, e.size.0, width));
            let down = e.rows.iter().rev().map(|l| height - l.at).collect();
            rows.push((down, e.size.1, height));
        }
        Self {
            columns: Spacing::learn(&columns),
            rows: Spacing::learn(&rows),
            elements: None,
            tight: None,
            doors: None,
            masses: None,
            paper: None,
            examples,
        }
    }

    /// The layouts of the database.
    pub fn layouts(&self) -> Vec<Layout> {
        self.examples.iter().map(|e| e.layout.clone()).collect()
    }

    /// Typical width and height of a window on a facade of this size.
    pub fn window_size(&self, width: f64, height: f64) -> (f64, f64) {
        let wide = self.examples.iter().map(|e| e.size.0 / e.layout.width);
        let high = self.examples.iter().map(|e| e.size.1 / e.layout.height);
        (
            median(wide).unwrap_or(0.1) * width,
            median(high).unwrap_or(0.1) * height,
        )
    }
}

/// The model that ships with the project, learnt from the shipped layouts by `edifice facade train`.
///
/// # Errors
/// [`ModelFileError`]; a test keeps it readable.
pub fn shipped_model() -> Result<Model, ModelFileError> {
    let file = "structure_completion/default.completion.json";
    // An empty text is refused below.
    Model::from_json(edifice_datasets::shipped_text(file).unwrap_or_default())
}
