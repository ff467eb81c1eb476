//! Names of rules for people: `Facade`, `Row` (split along x), `Stack` (along y), `Rows` and `Stacks` for repeats.

use std::collections::BTreeSet;

use super::library::Library;
use super::rules::Symbol;
use edifice_shape::Axis;

/// Gives names that no label has, numbered by kind in the order in which they are asked for.
pub(super) struct Namer<'l> {
    labels: BTreeSet<&'l str>,
    given: [usize; 6],
}

/// The kind of rule that a name is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A whole facade.
    Facade,
    /// A split of a direction.
    Split(Axis),
    /// A repeat of a direction.
    Repeat(Axis),
    /// A string that several rules share.
    Phrase,
}

impl<'l> Namer<'l> {
    /// Names that differ from the labels.
    pub(super) fn new(labels: &'l [String]) -> Self {
        Self {
            labels: labels.iter().map(String::as_str).collect(),
            given: [0; 6],
        }
    }

    /// The next name of a kind.
    pub(super) fn next(&mut self, kind: Kind) -> String {
        let (at, stem) = match kind {
            Kind::Facade => (0, "Facade"),
            Kind::Split(Axis::X) => (1, "Row"),
            Kind::Split(Axis::Y) => (2, "Stack"),
            Kind::Repeat(Axis::X) => (3, "Columns"),
            Kind::Repeat(Axis::Y) => (4, "Floors"),
            Kind::Phrase => (5, "Part"),
        };
        self.given[at] += 1;
        let mut name = format!("{stem}{}", self.given[at]);
        while self.labels.contains(name.as_str()) {
            name.push('_');
        }
        name
    }
}

impl Library {
    /// The names of all rules, outer ones numbered first.
    pub(super) fn rule_names(&self) -> Vec<String> {
        let rules = self.rules();
        let roots = self.tables().structure.roots();
        let mut namer = Namer::new(rules.labels());
        let mut names = vec![String::new(); rules.rules().len()];
        for (k, rule) in rules.rules().iter().enumerate().rev() {
            names[k] = namer.next(match roots.contains_key(&Symbol::Rule(k as u32)) {
                true => Kind::Facade,
                false => Kind::Split(rule.axis),
            });
        }
        names
    }
}
