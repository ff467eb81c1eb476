//! Facade layouts with what is known of their regions: which were observed, and which part of the
//! facade is unknown (Fan et al. 2014, Sec. 3.2, with a third state beside element and unknown).

use super::{Facade, Photograph, Rect};

/// The notes of a file on one region, beside its label and place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Note {
    /// Name of the region within its layout.
    pub id: Option<String>,
    /// True if the region was observed, false if a completion added it; `None` if the file does not say.
    pub observed: Option<bool>,
    /// Probability of an added region, 0 to 1.
    pub probability: Option<f64>,
    /// Why a region was added.
    pub reason: Option<String>,
}

/// A layout, a note for each of its regions, and its unknown part.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnotatedFacade {
    /// The layout.
    pub facade: Facade,
    /// One for each region, in the same order.
    pub notes: Vec<Note>,
    /// Rectangles whose content is not known; without them all that is not observed is unknown.
    pub unknown: Option<Vec<Rect>>,
    /// A photograph that lies over the outline, to draw over.
    pub photograph: Option<Photograph>,
}

/// Why annotations do not fit their layout.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnnotationError {
    /// A probability is not a number from 0 to 1.
    #[error("regions[{index}].probability is {value}, expected a number from 0 to 1")]
    Probability {
        /// Index of the region.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// Two regions have one name.
    #[error("regions[{first}] and regions[{second}] both have the id {id:?}")]
    DuplicateId {
        /// Index of one region.
        first: usize,
        /// Index of the other.
        second: usize,
        /// The name.
        id: String,
    },
    /// A number of an unknown rectangle is not finite, or a size is not positive.
    #[error("unknown[{index}] has x {}, y {}, width {}, height {}; expected finite numbers and sizes above zero", rect.x, rect.y, rect.width, rect.height)]
    Unknown {
        /// Index of the rectangle.
        index: usize,
        /// The rectangle.
        rect: Rect,
    },
}

impl AnnotatedFacade {
    /// A layout without annotations.
    pub fn plain(facade: Facade) -> Self {
        let notes = vec![Note::default(); facade.regions.len()];
        Self {
            facade,
            notes,
            unknown: None,
            photograph: None,
        }
    }

    /// Checks probabilities, names and unknown rectangles.
    ///
    /// # Errors
    /// The first that is wrong.
    pub fn check(&self) -> Result<(), AnnotationError> {
        let mut names = std::collections::HashMap::new();
        for (index, note) in self.notes.iter().enumerate() {
            if let Some(value) = note.probability
                && !(0.0..=1.0).contains(&value)
            {
                return Err(AnnotationError::Probability { index, value });
            }
            if let Some(id) = &note.id
                && let Some(first) = names.insert(id.as_str(), index)
            {
                let id = id.clone();
                return Err(AnnotationError::DuplicateId {
                    first,
                    second: index,
                    id,
                });
            }
        }
        for (index, rect) in self.unknown.iter().flatten().enumerate() {
            let finite = [rect.x, rect.y, rect.width, rect.height]
                .iter()
                .all(|v| v.is_finite());
            if !finite || rect.width <= 0.0 || rect.height <= 0.0 {
                let rect = *rect;
                return Err(AnnotationError::Unknown { index, rect });
            }
        }
        Ok(())
    }
}
