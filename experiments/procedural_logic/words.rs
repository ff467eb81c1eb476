//! Starting rules in words: floors, columns, running balconies, shops.

use edifice_procedural_logic::{Alphabet, Call, RuleSet};
use edifice_shape::Axis;

/// The structure of a facade, read from the parts of a starting rule from the bottom up.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Structure {
    /// Floors, the ground floor and a roof floor included.
    pub floors: usize,
    /// Most window columns of any floor.
    pub columns: usize,
    /// Floors with a running balcony, the ground floor being 0.
    pub balconies: Vec<usize>,
    /// True if there are shops on the ground floor.
    pub shops: bool,
    /// Number of doors on the ground floor.
    pub doors: usize,
    /// True if the top floor is in the roof.
    pub roof: bool,
}

impl Structure {
    /// Reads a starting rule that splits the facade into floors; `None` when it does not.
    pub fn new(rules: &RuleSet, alphabet: &Alphabet, start: Call) -> Option<Self> {
        let Call::Rule(rule) = start else { return None };
        let rule = &rules.rules()[rule as usize];
        if rule.axis != Axis::Y {
            return None;
        }
        let mut structure = Self::default();
        for &part in &rule.children {
            let labels = inserted(rules, alphabet, part);
            let count = |name: &str| labels.iter().filter(|label| **label == name).count();
            let (windows, shops, doors) = (count("window"), count("shop"), count("door"));
            if matches!(part, Call::Insert(_)) && count("balcony") == 1 {
                structure.balconies.push(structure.floors);
            }
            if windows > 0 || shops > 0 || doors > 0 {
                structure.floors += 1;
                structure.columns = structure.columns.max(windows);
                structure.shops |= shops > 0;
                structure.doors += doors;
            }
            structure.roof |= count("roof") > 0;
        }
        Some(structure)
    }

    /// One sentence.
    pub fn sentence(&self) -> String {
        let balconies = match self.balconies.as_slice() {
            [] => "no running balcony".into(),
            floors => {
                let names: Vec<String> = floors.iter().map(|&f| ordinal(f)).collect();
                let s = if names.len() == 1 { "" } else { "s" };
                format!("running balconies on the {} floor{s}", names.join(" and "))
            }
        };
        let ground = match (self.shops, self.doors) {
            (true, 0) => "shops on the ground floor",
            (true, _) => "shops and a door on the ground floor",
            (false, 0) => "neither shops nor a door",
            (false, _) => "a door on the ground floor",
        };
        let roof = if self.roof { " and roof" } else { "" };
        format!(
            "{} floors (including the ground{roof} floor), {} window columns, {balconies}, {ground}",
            self.floors, self.columns
        )
    }
}

fn ordinal(floor: usize) -> String {
    match floor {
        0 => "ground".into(),
        1 => "1st".into(),
        2 => "2nd".into(),
        3 => "3rd".into(),
        n => format!("{n}th"),
    }
}

/// The labels that a call inserts.
fn inserted<'a>(rules: &RuleSet, alphabet: &'a Alphabet, call: Call) -> Vec<&'a str> {
    let mut labels = Vec::new();
    let mut todo = vec![call];
    while let Some(call) = todo.pop() {
        match call {
            Call::Insert(label) => labels.push(alphabet.name(label)),
            Call::Rule(rule) => todo.extend(&rules.rules()[rule as usize].children),
        }
    }
    labels
}

/// A rule as text: direction and parts, runs of equal pairs shortened.
pub fn rule_text(rules: &RuleSet, alphabet: &Alphabet, rule: u32) -> String {
    let parts: Vec<String> = rules.rules()[rule as usize]
        .children
        .iter()
        .map(|call| match call {
            Call::Insert(label) => alphabet.name(*label).to_owned(),
            Call::Rule(rule) => format!("R{rule}"),
        })
        .collect();
    let pairs = parts
        .chunks_exact(2)
        .take_while(|pair| *pair == &parts[..2])
        .count();
    let body = if pairs > 1 {
        let rest = parts[2 * pairs..].join(" | ");
        let rest = if rest.is_empty() {
            rest
        } else {
            format!(" | {rest}")
        };
        format!("{{ {} }} x {pairs}{rest}", parts[..2].join(" | "))
    } else {
        parts.join(" | ")
    };
    let axis = rules.rules()[rule as usize].axis.name();
    format!("split({axis}) {{ {body} }}")
}
