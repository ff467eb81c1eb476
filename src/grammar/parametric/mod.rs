//! Parametric grammars: one library of rules for many facades.

mod bodies;
mod codec;
mod coder;
mod collapse;
mod counts;
mod draw;
mod error;
mod extents;
mod library;
mod names;
mod phrases;
mod rules;
mod sizes;
mod structure;
mod tree;
mod written;

pub use bodies::{Bodies, Body, Letter};
pub use coder::{Coder, Counter, Decoder, Drawer, Encoder};
pub use error::LibraryError;
pub use library::{Code, Library, Member};
pub use phrases::{LONGEST, Part, Sharing, Written, share};
pub use rules::{Item, Rule, Rules, Symbol};
pub use tree::{Parse, STEP_LIMIT, Slot, slots};
pub use written::FACADE;
