//! Reasons for which a scene or a building cannot be written as glTF.

/// Why a scene or a building cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GltfError {
    /// A mesh has no positions or no triangles, which glTF does not allow.
    #[error("mesh {index} ({name}) is empty")]
    EmptyMesh {
        /// Index of the mesh.
        index: usize,
        /// Its name.
        name: String,
    },
    /// An index leads nowhere.
    #[error("{what} {index} does not exist, there are {count}")]
    Dangling {
        /// `mesh`, `material`, `corner` or `wall`.
        what: &'static str,
        /// The index.
        index: usize,
        /// Number of them in the scene.
        count: usize,
    },
    /// A position is not finite.
    #[error("mesh {index} ({name}) has a corner that is not finite")]
    NotFinite {
        /// Index of the mesh.
        index: usize,
        /// Its name.
        name: String,
    },
    /// The file would be larger than the format can say (4 GiB).
    #[error("the scene takes {bytes} bytes, more than a binary glTF can hold")]
    TooLarge {
        /// Its size.
        bytes: u64,
    },
    /// An image of a texture could not be encoded.
    #[error("an image cannot be encoded: {0}")]
    Image(String),
    /// The document could not be written as JSON.
    #[error("the document cannot be written: {0}")]
    Json(String),
}
