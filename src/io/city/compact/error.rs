//! Why bytes are no grammar.

use super::unit::Steps;
use edifice_grammar::instance::InstanceGrammarError;

/// The version written of a grammar that is flat.
pub const VERSION: u16 = 3;

/// The version of flat grammars that share a dictionary.
pub(super) const SHARING: u16 = 4;

/// The version of grammars with rows, and the newest that is read.
pub const ARRANGED: u16 = 5;

/// The oldest version that is read.
pub(super) const FIRST: u16 = 1;

/// Why bytes are no grammar, or a grammar cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompactError {
    /// The file is of another kind.
    #[error("not a compact grammar: it does not begin with \"EdCG\"")]
    Magic,
    /// A version that is not known.
    #[error("version {0}, expected {FIRST} to {ARRANGED}")]
    Version(u16),
    /// The bytes are not those that were written.
    #[error("damaged: the checksum does not fit")]
    Checksum,
    /// The file ends too early.
    #[error("truncated")]
    Truncated,
    /// The number of things is larger than is read or written.
    #[error("too many {0}")]
    TooLarge(&'static str),
    /// A number leads nowhere.
    #[error("a number of a {0} leads nowhere")]
    Index(&'static str),
    /// A number has too many digits for whole steps.
    #[error("{0} is too large to be written in steps")]
    Number(f64),
    /// The numbers of steps are not from 1 to 65,535.
    #[error("steps {0:?} are not whole numbers from 1 to 65,535")]
    Steps(Steps),
    /// The dictionary that the grammar shares.
    #[error("dictionary: {0}")]
    Dictionary(String),
    /// The text part.
    #[error("text part: {0}")]
    Text(String),
    /// The grammar is not sound.
    #[error(transparent)]
    Grammar(#[from] InstanceGrammarError),
}
