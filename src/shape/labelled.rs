//! A labelled facade in either of its two forms.

use crate::{Facade, LabelGrid};

/// A labelled facade of any source: rectangles in their own unit, or a label picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Labelled {
    /// A facade layout: rectangles, which may overlap.
    Layout(Facade),
    /// A label picture.
    Picture(LabelGrid),
}
