//! Design with a learned model (Sec. 7): completing houses of which a part was observed, houses from facades with marked windows,
//! variations of a house, and edits of its boxes. Everything ends in [`draft`](super::house::draft), so that a completed or edited house is
//! measured and closed like a generated one.

mod complete;
mod edit;
mod error;
mod facades_error;
mod from_facades;
mod left_out;
mod marked;
mod observed;
mod placing;
mod possible;
mod reconcile;
mod storeys;
mod variants;

pub use complete::{around, completions};
pub use edit::{Edit, EditError, edited, suggested};
pub use error::CompleteError;
pub use facades_error::FacadesError;
pub use from_facades::{FacadeHouse, Facades, MarkedRegion, from_facades};
pub use left_out::LeftOut;
pub use marked::{MarkedFacade, eaves, in_metres};
pub use observed::{observed, wanted_rows};
pub use possible::{MOVED, Possible, possible_rows};
pub use variants::variants;
