//! Why a city grammar cannot be told in CGA.

use edifice_grammar::instance::InstanceGrammarError;

/// Why a city grammar cannot be told in CGA.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CgaCityError {
    /// The grammar does not derive.
    #[error(transparent)]
    Grammar(#[from] InstanceGrammarError),
    /// A mesh has no extent along an axis.
    #[error(
        "template {template:?} is flat along {axis}: CGA fits an asset into its scope, and cannot keep it flat"
    )]
    Flat {
        /// Symbol of the template.
        template: String,
        /// The axis, `x`, `y` or `z`, z up.
        axis: char,
    },
}
