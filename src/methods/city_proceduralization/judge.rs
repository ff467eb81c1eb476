//! The judge of a city's grammar: the solid that the grammar derives beside the solid of its input. It knows the grammar alone,
//! not how it was found.

use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError};
use edifice_shape::triangles::{City, TriangleMesh, VolumeRaster, repair};

/// Side of the cells in which volumes are compared, in metres.
pub const RESOLUTION: f64 = 1.0;

/// Volumetric intersection over union, 0 to 1, of what the grammar derives and the input's meshes, repaired as
/// [`proceduralize`](crate::proceduralize()) repairs them, in cells of [`RESOLUTION`].
///
/// # Errors
/// A grammar that cannot be derived.
pub fn iou(input: &City, grammar: &InstanceGrammar) -> Result<f64, InstanceGrammarError> {
    let derived = grammar.derive()?.city(grammar);
    let repaired: Vec<TriangleMesh> = input.buildings.iter().map(|b| repair(&b.mesh).0).collect();
    let first: Vec<&TriangleMesh> = repaired.iter().collect();
    let second: Vec<&TriangleMesh> = derived.buildings.iter().map(|b| &b.mesh).collect();
    let size = RESOLUTION;
    Ok(VolumeRaster { size }.compare(&first, &second).iou())
}
