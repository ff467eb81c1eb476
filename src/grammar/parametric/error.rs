//! Ways for facades, libraries and codes to be wrong.

use edifice_shape::LayoutError;

/// Why facades make no library, or a facade has no code in it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LibraryError {
    /// There is no facade to learn from.
    #[error("a library needs at least one facade")]
    NoFacades,
    /// A layout is not a tiling that full lines can split.
    #[error("facade {name}: {source}")]
    Layout {
        /// Name of the facade.
        name: String,
        /// The fault of the layout.
        source: LayoutError,
    },
    /// Two facades have lengths in different units.
    #[error("facade {name} is in {unit}, the library in {expected}")]
    Unit {
        /// Name of the facade.
        name: String,
        /// Its unit.
        unit: String,
        /// The unit of the library.
        expected: String,
    },
    /// Parts are nested deeper than is allowed.
    #[error("facade {name}: parts are nested more than {limit} deep")]
    TooDeep {
        /// Name of the facade.
        name: String,
        /// Greatest depth.
        limit: usize,
    },
    /// A coordinate is not a multiple of the library's step.
    #[error("facade {name}: {axis} = {value} is not a multiple of the step {step}")]
    OffStep {
        /// Name of the facade.
        name: String,
        /// `x` or `y`.
        axis: &'static str,
        /// The coordinate.
        value: f64,
        /// The step that all lengths of the library are multiples of.
        step: f64,
    },
    /// A facade is more steps wide or high than a code can write.
    #[error("facade {name}: {extent} steps of {step} along {axis}, at most {limit} are possible")]
    TooLarge {
        /// Name of the facade.
        name: String,
        /// `x` or `y`.
        axis: &'static str,
        /// Number of steps.
        extent: f64,
        /// The step.
        step: f64,
        /// Most steps.
        limit: u32,
    },
    /// A code, or a part of a file, that no facade has.
    #[error("{place}: {message}")]
    Invalid {
        /// The place, for example `rules[3].items[2]`.
        place: String,
        /// The fault.
        message: String,
    },
}
