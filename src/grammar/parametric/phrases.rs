//! Strings that several rules share, as rules of their own: the cheapest choice, with a bound.
//!
//! Every rule is a string `s` over one direction ([`Bodies`]). A *phrase* is a string of 2 to
//! [`LONGEST`] letters that stands at least twice in the strings of its direction; as a rule of its own it
//! costs Wu's split plus the letters of its own string, and stands for one letter wherever it is used. A split
//! whose whole string stands elsewhere is used there at no further cost. Chosen are the phrases `y_p` and a path
//! `z` through every string, whose arcs are single letters or phrases:
//! ```text
//! min  sum_s c(s) + sum_p c_split y_p + sum_a z_a
//! s.t. z is a path from the first to the last place of every string s, and of every phrase p with flow y_p,
//!      z_a <= y_p for every arc a of phrase p (1 in a string, y_p of the other in a phrase),
//!      y_p in {0, 1}, z >= 0
//! ```
//! For fixed `y` the rest is a shortest path, so that only `y` is branched on; the start is greedy, and the bound is the
//! Lagrangian one of `program.rs`. A proof holds for the collapse of repeats that made the strings, and for phrases of
//! this length.

use super::bodies::{Bodies, Body, Letter};
use super::program::branch_and_bound;
pub use super::texts::LONGEST;
use super::texts::Texts;
use crate::Costs;
use edifice_shape::Axis;

/// One written rule: a body or a phrase, whose letters may be further phrases.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Direction.
    pub axis: Axis,
    /// True if it is a repeat.
    pub repeat: bool,
    /// The right-hand side: letters, or phrases by the index of their rule.
    pub parts: Vec<Part>,
}

/// One symbol of a written rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A label by its index.
    Label(u32),
    /// A written rule by its index.
    Rule(u32),
}

/// The rules with their shared phrases.
#[derive(Debug, Clone, PartialEq)]
pub struct Sharing {
    /// The written rules; the first are the bodies in their order, then come the phrases.
    pub rules: Vec<Written>,
    /// Number of rules that are bodies.
    pub bodies: usize,
    /// Wu's cost of the rules.
    pub cost: f64,
    /// No choice of phrases costs less.
    pub lower_bound: f64,
}

impl Sharing {
    /// True if no choice of phrases is cheaper.
    pub fn is_proven(&self) -> bool {
        self.cost <= self.lower_bound + 1e-6
    }
}

/// Chooses the phrases. `costs` are those of a split and a repeat.
pub fn share(bodies: &Bodies, costs: &Costs) -> Sharing {
    let texts = Texts::new(&bodies.bodies);
    let fixed: f64 = bodies
        .bodies
        .iter()
        .map(|body| operation_cost(body, costs))
        .sum();
    let start = texts.greedy(costs.split);
    let (open, bound) = branch_and_bound(&texts, start, costs.split);
    let cost = fixed + texts.cost(&open, costs.split);
    Sharing {
        rules: texts.written(&open, &bodies.bodies),
        bodies: texts.bodies,
        cost,
        lower_bound: (fixed + bound).min(cost),
    }
}

fn operation_cost(body: &Body, costs: &Costs) -> f64 {
    if body.repeat {
        costs.repeat
    } else {
        costs.split
    }
}

impl Texts {
    /// The rules that a choice writes.
    fn written(&self, open: &[bool], bodies: &[Body]) -> Vec<Written> {
        let mut number = vec![0; self.texts.len()];
        let chosen: Vec<usize> = (0..self.texts.len()).filter(|&k| open[k]).collect();
        for (n, &k) in chosen.iter().enumerate() {
            number[k] = n as u32;
        }
        let write = |&k: &usize| {
            let part = |(from, phrase): (usize, Option<usize>)| match phrase {
                Some(phrase) => Part::Rule(number[phrase]),
                None => match self.texts[k].letters[from] {
                    Letter::Label(label) => Part::Label(label),
                    Letter::Body(body) => Part::Rule(body),
                },
            };
            Written {
                axis: self.texts[k].axis,
                repeat: bodies.get(k).is_some_and(|body| body.repeat),
                parts: self.path(k, open).1.into_iter().map(part).collect(),
            }
        };
        chosen.iter().map(write).collect()
    }
}
