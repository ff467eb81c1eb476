//! The rules that lead to a building.

use rustc_hash::FxHashMap;

use edifice_grammar::instance::{InstanceGrammar, Placement};

/// A rule that was applied, and which of its successors was followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub(super) struct Turn {
    /// Index of the rule.
    pub rule: usize,
    /// Index of the successor.
    pub part: usize,
}

/// The origins of the buildings and the placed templates of a derivation.
#[derive(Debug, Clone, Default)]
pub(super) struct Paths {
    /// Of each placed template, in the order of the derivation: rules applied, one inside another.
    pub depths: Vec<usize>,
    /// The symbol that stands for each building, by identifier.
    pub types: FxHashMap<String, String>,
    /// The rules that led to the building that was asked for.
    pub path: Vec<Turn>,
}

/// Walks a checked grammar as its derivation does; `building` is asked for its path.
pub(super) fn paths(grammar: &InstanceGrammar, building: Option<&str>) -> Paths {
    let mut rules: FxHashMap<&str, usize> = FxHashMap::default();
    for (k, rule) in grammar.rules.iter().enumerate() {
        rules.entry(rule.symbol.as_str()).or_insert(k);
    }
    let mut walk = Walk {
        grammar,
        rules,
        building,
        turns: Vec::new(),
        found: Paths::default(),
    };
    if let Some(&start) = walk.rules.get(grammar.axiom.as_str()) {
        walk.rule(start, &[]);
    }
    walk.found
}

struct Walk<'g> {
    grammar: &'g InstanceGrammar,
    /// The first rule of each symbol.
    rules: FxHashMap<&'g str, usize>,
    building: Option<&'g str>,
    turns: Vec<Turn>,
    found: Paths,
}

impl<'g> Walk<'g> {
    fn rule(&mut self, rule: usize, parts: &'g [Option<Placement>]) {
        let grammar = self.grammar;
        for (part, successor) in grammar.rules[rule].successors.iter().enumerate() {
            let placed = match parts.get(part) {
                None => successor,
                Some(None) => continue,
                Some(Some(own)) => own,
            };
            self.turns.push(Turn { rule, part });
            self.place(placed);
            self.turns.pop();
        }
    }

    fn place(&mut self, placed: &'g Placement) {
        if let Some(id) = &placed.id
            && !self.found.types.contains_key(id)
        {
            self.found.types.insert(id.clone(), placed.symbol.clone());
            if self.building == Some(id.as_str()) {
                self.found.path.clone_from(&self.turns);
            }
        }
        match self.rules.get(placed.symbol.as_str()) {
            Some(&rule) => self.rule(rule, &placed.parts),
            None => self.found.depths.push(self.turns.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use edifice_datasets::shipped_bytes;
    use edifice_io_city::grammar_json;

    #[test]
    fn the_walk_is_that_of_the_derivation() {
        let path = "city_proceduralization/town.city-grammar.json";
        let grammar = grammar_json::parse(shipped_bytes(path).unwrap(), Path::new(path)).unwrap();
        let derivation = grammar.derive().unwrap();
        for (id, _) in &derivation.buildings {
            let found = paths(&grammar, Some(id));
            assert_eq!(found.depths.len(), derivation.instances.len());
            assert_eq!(found.depths.iter().max(), Some(&derivation.depth));
            assert_eq!(found.types.len(), derivation.buildings.len());
            // The path leads from the axiom to the building's symbol.
            let last = found.path.last().unwrap();
            let rule = &grammar.rules[last.rule];
            assert_eq!(grammar.rules[found.path[0].rule].symbol, grammar.axiom);
            assert_eq!(rule.successors[last.part].symbol, found.types[id]);
        }
    }
}
