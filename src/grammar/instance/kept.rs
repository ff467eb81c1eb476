//! Grammars without what is not needed.

use rustc_hash::{FxHashMap, FxHashSet};

use super::{InstanceGrammar, InstanceRule, Placement};

/// The part of a grammar that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// Everything.
    All,
    /// Everything but the attributes of buildings.
    Identifiers,
    /// The buildings that the axiom derives to, with identifiers; no attributes, textures, or rules that the axiom does
    /// not lead to.
    Buildings,
    /// The instances that the axiom derives to, without identifiers, attributes and textures: an instance of a type of
    /// buildings is one, and so is each template that stands in none.
    Shape,
}

impl InstanceGrammar {
    /// The grammar with what is kept.
    pub fn keeping(&self, kept: Kept) -> Self {
        let mut out = self.clone();
        if matches!(kept, Kept::Buildings | Kept::Shape) {
            let used = self.reached();
            out.rules.retain(|r| used.contains(r.symbol.as_str()));
            out.templates.iter_mut().for_each(|t| t.texture = None);
        }
        if kept != Kept::All {
            let successors = out.rules.iter_mut().flat_map(|r| &mut r.successors);
            successors.for_each(|p| strip(p, kept));
        }
        out
    }

    /// The grammar by its rules alone: no instance says where its parts stand, and templates that no rule names are left
    /// out. With mean transforms (Eq. 7), or the numbers that instances state, parts stand where the rules put them.
    pub fn rules_only(&self) -> Self {
        let mut out = self.clone();
        let successors = out.rules.iter_mut().flat_map(|r| &mut r.successors);
        successors.for_each(|p| p.parts.clear());
        out.without_unused_templates()
    }

    /// The grammar without templates that neither a rule nor a part names.
    pub fn without_unused_templates(mut self) -> Self {
        let mut used: FxHashSet<String> = FxHashSet::default();
        let mut open: Vec<&Placement> = self.rules.iter().flat_map(|r| &r.successors).collect();
        while let Some(p) = open.pop() {
            if !used.contains(&p.symbol) {
                used.insert(p.symbol.clone());
            }
            open.extend(p.parts.iter().flatten());
        }
        self.templates.retain(|t| used.contains(&t.symbol));
        self
    }

    /// Number of instances that say where their parts stand.
    pub fn residuals(&self) -> usize {
        let successors = self.rules.iter().flat_map(|r| &r.successors);
        successors.filter(|p| !p.parts.is_empty()).count()
    }

    /// Number of rules with parameters that have a single instance: buildings whose shape no type explains.
    pub fn escapes(&self) -> usize {
        let mut uses: FxHashMap<&str, usize> = FxHashMap::default();
        for placed in self.rules.iter().flat_map(|r| &r.successors) {
            *uses.entry(placed.symbol.as_str()).or_default() += 1;
        }
        let single = |r: &&InstanceRule| r.levels > 0 && uses.get(r.symbol.as_str()) == Some(&1);
        self.rules.iter().filter(single).count()
    }

    /// The symbols that the axiom leads to.
    fn reached(&self) -> FxHashSet<&str> {
        let mut rules: FxHashMap<&str, Vec<&Placement>> = FxHashMap::default();
        for rule in &self.rules {
            rules
                .entry(&rule.symbol)
                .or_default()
                .extend(&rule.successors);
        }
        let mut seen = FxHashSet::from_iter([self.axiom.as_str()]);
        let mut open = vec![self.axiom.as_str()];
        while let Some(symbol) = open.pop() {
            for placed in rules.get(symbol).into_iter().flatten() {
                if seen.insert(&placed.symbol) {
                    open.push(&placed.symbol);
                }
            }
        }
        seen
    }
}

fn strip(placed: &mut Placement, kept: Kept) {
    placed.attributes.clear();
    if kept == Kept::Shape {
        placed.id = None;
    }
    placed
        .parts
        .iter_mut()
        .flatten()
        .for_each(|p| strip(p, kept));
}
