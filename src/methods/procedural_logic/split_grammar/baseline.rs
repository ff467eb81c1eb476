//! The split-only baseline of Wu et al. 2014, Table 2: procedural logic for one facade.

use crate::affinity::Affinity;
use crate::alphabet::Alphabet;
use crate::canvas::Canvas;
use crate::joining::Joining;
use crate::parameters::{ParameterError, Parameters};
use crate::parse::{NoSplit, parse};
use crate::split_grammar::split_grammar;
use edifice_grammar::Grammar;
use edifice_shape::{Facade, LabelGrid, LayoutError};

/// Why a facade has no baseline grammar.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// The layout is not a tiling.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The tiling cannot be split by straight lines.
    #[error(transparent)]
    NoSplit(#[from] NoSplit),
    /// A parameter is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

/// The split grammar of one tiling: parsed with the affinities of this facade alone, binary splits
/// made n-ary, and one symbol for all regions of identical content (label, offset and size).
///
/// The grammar derives back the tiling, region by region.
///
/// # Errors
/// [`BaselineError`] for a parameter out of range, a layout that is not a tiling, or a tiling that
/// no sequence of straight cuts makes.
pub fn baseline_grammar(
    facade: &Facade,
    parameters: &Parameters,
) -> Result<Grammar, BaselineError> {
    baseline_grammar_joining(facade, parameters, Joining::All)
}

/// The split grammar of a label picture, whose areas lines may cut as they do in the paper's own pipeline: an area of one
/// label is an asset only once it is alone in its scope. The grammar derives the picture, not the tiling it came from.
///
/// # Errors
/// [`BaselineError`] for a parameter out of range, or a picture that no sequence of straight cuts makes.
pub fn picture_grammar(
    grid: &LabelGrid,
    parameters: &Parameters,
) -> Result<Grammar, BaselineError> {
    let parameters = parameters.checked()?;
    let mut alphabet = Alphabet::default();
    let labels = alphabet.intern_all(&grid.labels);
    let canvas = Canvas::from_grid(grid, labels);
    let mut affinity = Affinity::new(parameters.facing);
    affinity.add(&canvas, alphabet.len());
    let binary = parse(&canvas, &affinity.normalized(), &parameters)?;
    let tree = Joining::All.apply(&binary);
    Ok(split_grammar(&tree, &alphabet, &grid.name, &grid.unit))
}

/// As [`baseline_grammar`], with another reading of which binary splits are made n-ary.
///
/// # Errors
/// As [`baseline_grammar`].
pub fn baseline_grammar_joining(
    facade: &Facade,
    parameters: &Parameters,
    joining: Joining,
) -> Result<Grammar, BaselineError> {
    let parameters = parameters.checked()?;
    let mut alphabet = Alphabet::default();
    let canvas = Canvas::from_tiling(facade, &mut alphabet)?;
    let mut affinity = Affinity::new(parameters.facing);
    affinity.add(&canvas, alphabet.len());
    let binary = parse(&canvas, &affinity.normalized(), &parameters)?;
    let tree = joining.apply(&binary);
    Ok(split_grammar(&tree, &alphabet, &facade.name, &facade.unit))
}
