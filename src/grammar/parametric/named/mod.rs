//! A library, or one facade of it, as rules whose sizes and counts have names.
//!
//! Languages of rules such as CGA have attributes, parameters and choices by chance, and no distributions of whole facades. Here a
//! library is written with these alone:
//!
//! | in the library | here |
//! | --- | --- |
//! | sizes of a slot | mean over the facades, as [`Attribute`]; slots that agree in [`AGREED`] of the facades that have both (two at least, one for the same symbol) share one |
//! | counts of a repeat | a parameter of the rule; repeats that no facade tells apart share one |
//! | roots with counts | a [`Choice`] of the start for each pair of root and counts, as often as facades have it |
//!
//! One facade has an attribute for each size of a symbol and for each count, and no choices: it comes back region for region.
//!
//! What is lost of a library: that sizes vary and depend on one another, and counts of a repeat that differ
//! within one facade (the commonest stands for all).

mod facade;
mod library;
mod ties;

use std::collections::BTreeSet;

use crate::Start;
use edifice_shape::Axis;

pub use ties::AGREED;

/// Rules with named sizes and counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// The unit of all lengths.
    pub unit: String,
    /// Name, symbol and size of the whole.
    pub start: Start,
    /// The ways in which the start's symbol may be replaced; none where it is a rule or a label itself.
    pub choices: Vec<Choice>,
    /// Sizes, and counts of a single facade.
    pub attributes: Vec<Attribute>,
    /// The rules, outer ones first.
    pub rules: Vec<NamedRule>,
    /// The labels that the rules end in.
    pub labels: Vec<String>,
}

/// One replacement of the start's symbol.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Number of facades that chose it.
    pub facades: usize,
    /// A rule or a label.
    pub symbol: String,
    /// The counts that the rule takes.
    pub counts: Vec<u32>,
}

/// A number with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// Its value: a length in the unit, or a count.
    pub value: f64,
    /// Its distribution over a library's facades; none where one facade alone is written.
    pub spread: Option<Spread>,
}

/// The distribution of a number over the facades that have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Number of facades.
    pub facades: usize,
    /// Standard deviation.
    pub deviation: f64,
    /// Least and greatest value.
    pub range: (f64, f64),
}

/// A rule with the counts that it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedRule {
    /// Its left-hand side.
    pub symbol: String,
    /// Names of the counts that it and the rules below it take.
    pub parameters: Vec<String>,
    /// Direction of the split.
    pub axis: Axis,
    /// The parts in order.
    pub items: Vec<NamedItem>,
}

/// One item of a rule.
#[derive(Debug, Clone, PartialEq)]
pub enum NamedItem {
    /// One part.
    Part(NamedPart),
    /// A period of parts, as often as a count says.
    Repeat {
        /// Name of the count.
        count: String,
        /// The parts of one period.
        period: Vec<NamedPart>,
    },
}

/// A part: a symbol, its size along the split, and the counts that the symbol's rule takes.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPart {
    /// Name of the size.
    pub size: String,
    /// A rule or a label.
    pub symbol: String,
    /// Names of counts.
    pub arguments: Vec<String>,
}

/// The word for extents along an axis.
fn extent(axis: Axis) -> &'static str {
    match axis {
        Axis::X => "width",
        Axis::Y => "height",
    }
}

/// The word for counts along an axis.
fn count(axis: Axis) -> &'static str {
    match axis {
        Axis::X => "columns",
        Axis::Y => "floors",
    }
}

/// Names that are all different.
struct Names(BTreeSet<String>);

impl Names {
    /// A name that is free, and taken from then on: `stem`, `stem_2`, `stem_3`, ...
    fn free(&mut self, stem: &str) -> String {
        let mut name = stem.to_owned();
        let mut number = 1;
        while !self.0.insert(name.clone()) {
            number += 1;
            name = format!("{stem}_{number}");
        }
        name
    }
}
