//! Edits of split grammars and their derivation, as the commands do them (Wu et al. 2014, Sec. 5: a change to one
//! region changes every region of its rule).

mod derivation;
mod edits;
mod error;
mod floors;
mod place;
mod reach;
mod relief;
mod rule_axis;
mod text;

pub use derivation::{DeriveError, Derived, Resizing, Wish, derived};
pub use edits::{GrammarEdit, edit};
pub use error::GrammarEditError;
pub use place::Place;
pub use relief::glb;
