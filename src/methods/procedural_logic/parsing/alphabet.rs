//! The asset labels, by number.

use rustc_hash::FxHashMap;

/// The set of asset labels `L`, in order of first sight.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Alphabet {
    names: Vec<String>,
    index: FxHashMap<String, u32>,
}

impl Alphabet {
    /// The numbers of several labels.
    pub fn intern_all(&mut self, names: &[String]) -> Vec<u32> {
        names.iter().map(|name| self.intern(name)).collect()
    }

    /// The number of a label, new if it was not seen before.
    pub fn intern(&mut self, name: &str) -> u32 {
        if let Some(&id) = self.index.get(name) {
            return id;
        }
        let id = self.names.len() as u32;
        self.names.push(name.to_owned());
        self.index.insert(name.to_owned(), id);
        id
    }

    /// The name of label `id`.
    pub fn name(&self, id: u32) -> &str {
        &self.names[id as usize]
    }

    /// All names, by number.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of labels.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// True if no label was seen.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }
}
