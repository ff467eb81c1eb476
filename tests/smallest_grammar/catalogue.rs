//! The types that full lines can cut out of some facades.

use std::collections::HashMap;

use edifice_shape::Axis;

use super::content::Content;

/// A successor of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Symbol {
    /// A label.
    Terminal(u8),
    /// Index of a type.
    Type(usize),
}

/// All types of several tiles.
pub(super) struct Catalogue {
    /// The types, those with fewer tiles first: a part of a type comes before it.
    pub types: Vec<Content>,
    /// The symbol of each facade.
    pub roots: Vec<Symbol>,
    index: HashMap<Content, usize>,
}

impl Catalogue {
    /// The types of `facades`; `None` when there are more than `most`.
    pub(super) fn new(facades: &[Content], most: usize) -> Option<Self> {
        let mut types: Vec<Content> = Vec::new();
        let mut index: HashMap<Content, usize> = HashMap::new();
        let mut waiting: Vec<Content> = facades.to_vec();
        while let Some(content) = waiting.pop() {
            if content.label().is_some() || index.contains_key(&content) {
                continue;
            }
            for axis in Axis::BOTH {
                let lines = content.lines(axis);
                for (i, &from) in lines.iter().enumerate() {
                    for &to in &lines[i + 1..] {
                        waiting.push(content.strip(axis, from, to));
                    }
                }
                // Cut to cut along one axis after the other reaches every cell of a grid too.
            }
            index.insert(content.clone(), types.len());
            types.push(content);
            if types.len() > most {
                return None;
            }
        }
        types.sort_by_key(|content| content.tiles().len());
        for (i, content) in types.iter().enumerate() {
            index.insert(content.clone(), i);
        }
        let mut new = Self {
            types,
            roots: Vec::new(),
            index,
        };
        new.roots = facades.iter().map(|facade| new.symbol(facade)).collect();
        Some(new)
    }

    /// The symbol of a content.
    pub(super) fn symbol(&self, content: &Content) -> Symbol {
        match content.label() {
            Some(label) => Symbol::Terminal(label),
            None => Symbol::Type(self.index[content]),
        }
    }
}
