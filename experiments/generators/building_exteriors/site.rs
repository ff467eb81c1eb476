//! The rectangle around a house, and what is taken from it.

use edifice_shape::{BoxStyle, Rect};

/// The rectangle around the house with what garage and porches take from its main body.
pub(super) struct Site {
    pub width: f64,
    pub depth: f64,
    /// Taken from the main body.
    pub taken: Vec<Rect>,
    pub garage: Option<Rect>,
    pub front: Option<Rect>,
    pub rear: Option<Rect>,
    /// Free stretches of the walls on the outermost lines: front, back, left, right.
    pub free: [[f64; 2]; 4],
    /// Deepest cuts of the corners back left, back right, front left, front right.
    pub deepest: [f64; 4],
}

/// Styles of the parts in the order of [`Site`].
pub(super) const PARTS: [BoxStyle; 3] = [BoxStyle::Garage, BoxStyle::Porch, BoxStyle::Porch];
