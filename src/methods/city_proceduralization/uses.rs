//! The use of a type for a component.

/// A type's use for a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Use {
    /// Index of the type.
    pub kind: usize,
    /// Quarter turns of the template, counterclockwise.
    pub quarter: u8,
}
