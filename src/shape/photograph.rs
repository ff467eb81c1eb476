//! A photograph that lies over the outline of a facade: the bytes of its file, as they are.

use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

/// Most bytes of a photograph.
const MOST: usize = 4 << 20;
/// Most pixels along a side.
const LONGEST: u32 = 8000;

/// Formats of photographs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhotographFormat {
    /// `image/jpeg`.
    Jpeg,
    /// `image/png`.
    Png,
}

/// A photograph, shared by all states of a drawing that have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Photograph {
    format: PhotographFormat,
    size: [u32; 2],
    bytes: Arc<[u8]>,
    id: u64,
}

/// Why a picture is not taken.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PhotographError {
    /// Its file is too large.
    #[error("the picture has {bytes} bytes, at most {MOST} are kept with a drawing")]
    Bytes {
        /// Bytes of the file.
        bytes: usize,
    },
    /// It has too many pixels, or none.
    #[error("the picture has {width} x {height} pixels, expected 1 to {LONGEST} on each side")]
    Pixels {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
}

impl Photograph {
    /// A picture of this format and size in pixels.
    ///
    /// # Errors
    /// When it is too large.
    pub fn new(
        format: PhotographFormat,
        size: [u32; 2],
        bytes: Vec<u8>,
    ) -> Result<Self, PhotographError> {
        let [width, height] = size;
        if bytes.len() > MOST {
            let bytes = bytes.len();
            return Err(PhotographError::Bytes { bytes });
        }
        if !size.iter().all(|side| (1..=LONGEST).contains(side)) {
            return Err(PhotographError::Pixels { width, height });
        }
        let mut hasher = DefaultHasher::new();
        hasher.write(&bytes);
        Ok(Self {
            format,
            size,
            id: hasher.finish(),
            bytes: bytes.into(),
        })
    }

    /// Its format.
    pub fn format(&self) -> PhotographFormat {
        self.format
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Its file.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// A number by which another picture is told from it while a program runs.
    pub fn id(&self) -> u64 {
        self.id
    }
}
