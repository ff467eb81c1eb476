//! The steps in which numbers of a file are whole.

use serde::{Deserialize, Serialize};

/// Numbers of steps in a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Steps {
    /// Steps of a metre.
    pub length: i64,
    /// Steps of a degree.
    pub turn: i64,
    /// Steps of a side of a template's box.
    pub shape: i64,
}
