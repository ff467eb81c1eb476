//! A tile of a plan.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tile {
    /// Name of its grammar.
    pub name: String,
    /// Its file; a relative path is relative to the plan's folder.
    pub path: PathBuf,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Number of buildings.
    pub buildings: usize,
}
