//! Design with a learned model (Sec. 7): completing houses of which a part was observed, variations of a house, and
//! edits of its boxes. Everything ends in [`draft`](super::house::draft), so that a completed or edited house is
//! measured and closed like a generated one.

mod complete;
mod edit;
mod error;
mod observed;
mod possible;
mod reconcile;
mod variants;

pub use complete::{around, completions};
pub use edit::{Edit, EditError, edited, suggested};
pub use error::CompleteError;
pub use observed::{observed, wanted_rows};
pub use possible::{MOVED, Possible, possible_rows};
pub use variants::variants;
