//! Lines that have become one, and sizes that have become equal.

/// Cut lines, merged into groups that share a position.
pub(super) struct Groups {
    /// Group of each line.
    pub of_line: Vec<usize>,
    /// The wanted position of the lines of each group.
    pub center: Vec<f64>,
    /// Sum of the weights of the lines.
    pub weight: Vec<f64>,
    /// Bounds of the position.
    pub lower: Vec<f64>,
    /// Bounds of the position.
    pub upper: Vec<f64>,
    /// Least distance of each group to the next.
    pub gap: Vec<f64>,
}

/// Classes of sizes that have become one.
#[derive(Debug, Clone)]
pub(super) struct Cluster {
    /// Their numbers.
    pub classes: Vec<usize>,
    /// Size that they should have.
    pub wanted: f64,
    /// Size that they have.
    pub value: f64,
}

impl Cluster {
    /// The class that it began with.
    pub(super) fn lead(&self) -> usize {
        self.classes[0]
    }
}
