//! A learnt model as JSON text: `*.completion.json`.

use super::best::candidates::{FEATURES, FEATURES_BEFORE};
use super::best::{doors, masses};
use super::model::{Example, Model, Stored};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/completion_model";
/// The only version.
pub const VERSION: u64 = 1;

/// Why the text of a model cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelFileError {
    /// Not JSON of this form; the message has line and column.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
    /// Another format or version.
    #[error("{key} is {found}, expected {expected}")]
    Header {
        /// The key: `format` or `version`.
        key: &'static str,
        /// The value in the file.
        found: String,
        /// The value that is expected.
        expected: String,
    },
    /// A number of a layout that cannot be.
    #[error("layouts[{layout}].elements[{element}] is not inside its layout")]
    Element {
        /// Index of the layout.
        layout: usize,
        /// Index of the element.
        element: usize,
    },
    /// The outline of a layout.
    #[error("layouts[{layout}] has no positive width and height")]
    Outline {
        /// Index of the layout.
        layout: usize,
    },
    /// A table of spacings of another length, or with numbers that are no densities.
    #[error("{0} is not a table of spacings")]
    Spacing(&'static str),
    /// Trees that do not fit the features.
    #[error("elements: {0}")]
    Elements(#[from] edifice_model::boosting::BoostingError),
    /// Scoring functions or policies out of range.
    #[error("paper: {0}")]
    Paper(#[from] edifice_model::ModelError),
    /// No layout with windows.
    #[error("no layout has a window")]
    Empty,
}

impl Model {
    /// The text of the file.
    pub fn to_json(&self) -> String {
        let stored = Stored {
            format: FORMAT.into(),
            version: VERSION,
            layouts: self.layouts(),
            columns: self.columns.clone(),
            rows: self.rows.clone(),
            elements: self.elements.clone(),
            tight: self.tight.clone(),
            doors: self.doors.clone(),
            masses: self.masses.clone(),
            paper: self.paper.clone(),
        };
        // All numbers are finite and all keys are text.
        serde_json::to_string(&stored).unwrap_or_default() + "\n"
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`ModelFileError`] with the place.
    pub fn from_json(text: &str) -> Result<Self, ModelFileError> {
        let stored: Stored = serde_json::from_str(text)?;
        let headers = [
            ("format", stored.format.clone(), FORMAT.to_string()),
            ("version", stored.version.to_string(), VERSION.to_string()),
        ];
        for (key, found, expected) in headers {
            if found != expected {
                return Err(ModelFileError::Header {
                    key,
                    found,
                    expected,
                });
            }
        }
        for (layout, l) in stored.layouts.iter().enumerate() {
            let positive = |v: f64| v.is_finite() && v > 0.0;
            if !positive(l.width) || !positive(l.height) {
                return Err(ModelFileError::Outline { layout });
            }
            let slack = 1e-6 * l.width.max(l.height);
            let outside = l.elements.iter().position(|e| {
                let r = e.rect;
                let inside = r.x >= -slack && r.y >= -slack && r.right() <= l.width + slack;
                !(inside && r.top() <= l.height + slack && positive(r.width) && positive(r.height))
            });
            if let Some(element) = outside {
                return Err(ModelFileError::Element { layout, element });
            }
        }
        for (name, spacing) in [("columns", &stored.columns), ("rows", &stored.rows)] {
            if !spacing.is_valid() {
                return Err(ModelFileError::Spacing(name));
            }
        }
        for elements in [&stored.elements, &stored.tight].into_iter().flatten() {
            let before = elements.features() == FEATURES_BEFORE;
            elements.check(if before { FEATURES_BEFORE } else { FEATURES })?;
        }
        if let Some(trees) = &stored.doors {
            trees.check(doors::FEATURES)?;
        }
        if let Some(trees) = &stored.masses {
            trees.check(masses::FEATURES)?;
        }
        if let Some(paper) = &stored.paper {
            paper.check()?;
        }
        let examples: Vec<Example> = stored
            .layouts
            .into_iter()
            .filter_map(Example::new)
            .collect();
        if examples.is_empty() {
            return Err(ModelFileError::Empty);
        }
        Ok(Self {
            examples,
            columns: stored.columns,
            rows: stored.rows,
            elements: stored.elements,
            tight: stored.tight,
            doors: stored.doors,
            masses: stored.masses,
            paper: stored.paper,
        })
    }
}
