//! A fitted model: affinities, rules, and each facade as a call of a starting rule.

use rustc_hash::FxHashSet;

use super::affinity::Affinity;
use super::alphabet::Alphabet;
use super::canvas::Canvas;
use super::features::Profile;
use super::inference::{Inference, learn_affinity};
use super::nary::NaryTree;
use super::parameters::{ParameterError, Parameters};
use super::parse::{BinaryTree, NoSplit, parse};
use super::rules::{Instance, InstanceError};
use edifice_shape::{Facade, GridError, LabelGrid, Lattice};

/// Most labels that a model is fitted to: affinities take the square of their number.
const MOST_LABELS: usize = 4096;

/// A facade that the model knows.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// Name of the facade.
    pub name: String,
    /// Unit of its lengths.
    pub unit: String,
    /// Its starting rule and parameter vector.
    pub instance: Instance,
}

/// The procedural logic of a set of facades.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Parameters of the energy.
    pub parameters: Parameters,
    /// The asset labels.
    pub alphabet: Alphabet,
    /// Co-occurrence sums over the facades that the model was fitted to.
    pub affinity: Affinity,
    /// Rules and counts.
    pub inference: Inference,
    /// The facades, in the order in which they were added.
    pub facades: Vec<Known>,
}

/// Why there is no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There are no facades to learn from.
    #[error("no facades to learn from")]
    Empty,
    /// More labels than affinities are learned for.
    #[error("the facades have {0} labels, expected at most {MOST_LABELS}")]
    Labels(usize),
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A facade cannot be split.
    #[error(transparent)]
    NoSplit(#[from] NoSplit),
}

impl Model {
    /// Learns affinities from all facades, then adds them one by one.
    ///
    /// # Errors
    /// [`FitError`] for no facades, too many labels or parameters out of range.
    pub fn fit(grids: &[LabelGrid], parameters: Parameters) -> Result<Self, FitError> {
        let parameters = parameters.checked()?;
        if grids.is_empty() {
            return Err(FitError::Empty);
        }
        let labels: FxHashSet<&String> = grids.iter().flat_map(|g| &g.labels).collect();
        if labels.len() > MOST_LABELS {
            return Err(FitError::Labels(labels.len()));
        }
        let mut alphabet = Alphabet::default();
        let affinity = learn_affinity(grids, &mut alphabet, &parameters);
        let mut model = Self {
            parameters,
            alphabet,
            affinity,
            inference: Inference::default(),
            facades: Vec::with_capacity(grids.len()),
        };
        model.add_all(grids)?;
        Ok(model)
    }

    /// Adds facades online, with the affinities that the model was fitted with: what was added
    /// before stays as it is, and labels never seen get a number but no affinity.
    ///
    /// # Errors
    /// [`FitError::NoSplit`], which label images never meet.
    pub fn add_all(&mut self, grids: &[LabelGrid]) -> Result<(), FitError> {
        let coefficients = self.affinity.normalized();
        let facades = &mut self.facades;
        let mut names = grids.iter();
        self.inference.add_all(
            grids,
            &mut self.alphabet,
            &coefficients,
            &self.parameters,
            |instance| {
                facades.extend(names.next().map(|grid| Known {
                    name: grid.name.clone(),
                    unit: grid.unit.clone(),
                    instance,
                }));
            },
        )?;
        Ok(())
    }

    /// The binary split tree of a facade under this model; its labels join the alphabet.
    ///
    /// # Errors
    /// [`NoSplit`], which label images never meet.
    pub fn parse(&mut self, grid: &LabelGrid) -> Result<BinaryTree, NoSplit> {
        let labels = self.alphabet.intern_all(&grid.labels);
        let canvas = Canvas::from_grid(grid, labels);
        parse(&canvas, &self.affinity.normalized(), &self.parameters)
    }

    /// The layout of an instance: one region per insert.
    ///
    /// # Errors
    /// [`InstanceError`] for an instance of another model.
    pub fn layout(&self, known: &Known) -> Result<Facade, InstanceError> {
        let tree = self.inference.rules.expand(&known.instance)?;
        Ok(tree.layout(&self.alphabet, &known.name, &known.unit))
    }

    /// The profile of every facade that the model knows, for the distances between facades.
    ///
    /// The label image of each is painted from its parameters and parsed again, which is exact.
    ///
    /// # Errors
    /// [`ProfileError`], for a damaged model.
    pub fn profiles(&self) -> Result<Vec<Profile>, ProfileError> {
        let coefficients = self.affinity.normalized();
        let profile = |known: &Known| {
            let grid = LabelGrid::from_facade(&self.layout(known)?, None)?;
            let mut alphabet = self.alphabet.clone();
            let labels = alphabet.intern_all(&grid.labels);
            let canvas = Canvas::from_grid(&grid, labels);
            let tree = parse(&canvas, &coefficients, &self.parameters)?;
            Ok(Profile::new(
                &tree,
                &self.inference.rules,
                known.instance.start,
                Lattice::read(&grid),
            ))
        };
        self.facades.iter().map(profile).collect()
    }
}

/// Why a facade of a model has no profile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// Its call does not fit the rules.
    #[error(transparent)]
    Instance(#[from] InstanceError),
    /// Its parameters make no tiling.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// It cannot be split.
    #[error(transparent)]
    NoSplit(#[from] NoSplit),
}

impl NaryTree {
    /// The regions that the tree inserts, in order of derivation.
    pub fn layout(&self, alphabet: &Alphabet, name: &str, unit: &str) -> Facade {
        Facade {
            name: name.to_owned(),
            unit: unit.to_owned(),
            width: self.width,
            height: self.height,
            regions: self.regions(alphabet),
        }
    }
}
