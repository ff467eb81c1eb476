//! Places in rules.

/// A place in a rule: the text of an edit behind the rule's number and a point. All are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// `K`: a part, in the order written; of a repeat A B A, A is 0 and B is 1; of a grid a cell, row by row from the bottom.
    Part(usize),
    /// `cK`: a column of a grid, from the left.
    Column(usize),
    /// `rK`: a row of a grid, from the bottom.
    Row(usize),
}

impl Place {
    /// The number in it.
    pub(super) fn index(self) -> usize {
        match self {
            Self::Part(k) | Self::Column(k) | Self::Row(k) => k,
        }
    }

    /// Another place of the same kind.
    pub(super) fn at(self, index: usize) -> Self {
        match self {
            Self::Part(_) => Self::Part(index),
            Self::Column(_) => Self::Column(index),
            Self::Row(_) => Self::Row(index),
        }
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Part(k) => write!(f, "part {k}"),
            Self::Column(k) => write!(f, "column {k}"),
            Self::Row(k) => write!(f, "row {k}"),
        }
    }
}
