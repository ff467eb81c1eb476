//! Completions, and the table of the methods that make them.

use serde::{Deserialize, Serialize};

use super::layout::Element;

/// Why an element was added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// It continues the grid lines of observed elements.
    Lattice,
    /// It mirrors an observed element.
    Symmetry,
    /// It is taken over from a similar facade of the database.
    Database,
    /// An action of the policy added it (Sec. 5.1).
    Policy,
    /// A move of simulated annealing added it (Fig. 14).
    Annealing,
    /// Low-rank completion of the matrix of cells (Fig. 19).
    LowRank,
}

impl Reason {
    /// The reason in words, for files.
    pub fn text(self) -> &'static str {
        match self {
            Reason::Lattice => "continues the grid lines",
            Reason::Symmetry => "mirrors an observed element",
            Reason::Database => "as in a similar facade of the database",
            Reason::Policy => "added by the completion policy",
            Reason::Annealing => "added by simulated annealing",
            Reason::LowRank => "low-rank completion of the cells",
        }
    }
}

/// An added element.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Completed {
    /// The element.
    pub element: Element,
    /// Probability that the facade has it there, 0 to 1; 1 where the method knows none.
    pub probability: f64,
    /// Why it was added.
    pub reason: Reason,
}

/// One completion: the elements that are added to the observed ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Completion {
    /// Added elements.
    pub added: Vec<Completed>,
    /// The method's own score, higher is better; only comparable within one method and input.
    pub score: f64,
    /// Share of the probability that this completion stands for; the shares of all completions of an
    /// answer sum to at most 1.
    pub mass: f64,
}
