//! Identities of placements: identifiers and attributes.
//!
//! Identifiers that end in digits, like those before them, are told by the difference of their numbers; others, and
//! attributes, stand in lists, in the order in which they are met.

use rustc_hash::FxHashMap;

use super::error::CompactError;
use super::integers::{Natural, Whole};
use super::range_coder::{Bit, Coder};

/// Properties of a building.
pub(super) type Attributes = serde_json::Map<String, serde_json::Value>;

/// Identifiers and attributes, while they are written or read.
#[derive(Default)]
pub(super) struct Identities {
    /// Identifiers that are not told by a difference, and how many of them were met.
    pub(super) texts: Vec<String>,
    next_text: usize,
    /// Attributes, and how many of them were met.
    pub(super) attributes: Vec<Attributes>,
    next_attributes: usize,
    /// Identifiers met, by their numbers, and the reverse.
    met: Vec<String>,
    known: FxHashMap<String, usize>,
    /// Text, digits and number of the identifier before.
    last: (String, usize, i64),
    onward: Whole,
    back: Natural,
    flags: [Bit; 4],
}

/// The meanings of [`Identities::flags`].
#[derive(Clone, Copy)]
enum Flag {
    HasId,
    NewId,
    HasAttributes,
    Numbered,
}

impl Identities {
    /// The lists of a file.
    pub(super) fn new(texts: Vec<String>, attributes: Vec<Attributes>) -> Self {
        Self {
            texts,
            attributes,
            ..Self::default()
        }
    }

    fn flag<C: Coder>(&mut self, coder: &mut C, flag: Flag, given: bool) -> bool {
        coder.bit(&mut self.flags[flag as usize], given)
    }

    pub(super) fn id<C: Coder>(
        &mut self,
        coder: &mut C,
        given: Option<&String>,
    ) -> Result<Option<String>, CompactError> {
        if !self.flag(coder, Flag::HasId, given.is_some()) {
            return Ok(None);
        }
        let known = given.and_then(|id| self.known.get(id)).copied();
        let next = self.met.len();
        let missing = CompactError::Index("identifier");
        if !self.flag(coder, Flag::NewId, known.is_none()) {
            let back = known.map_or(0, |k| next - 1 - k) as u64;
            let back = self.back.code(coder, back);
            let index = (next as u64)
                .checked_sub(1)
                .and_then(|l| l.checked_sub(back));
            return Ok(Some(self.met[index.ok_or(missing)? as usize].clone()));
        }
        let own = given.and_then(|id| numbered(id));
        let (text, digits, number) = self.last.clone();
        let like = own.filter(|o| o.0 == text && o.1 == digits);
        let id = if self.flag(coder, Flag::Numbered, like.is_some()) {
            let onward = like.map_or(0, |o| o.2 - number);
            let number = number.checked_add(self.onward.code(coder, onward));
            let number = number.filter(|n| *n >= 0).ok_or(missing)?;
            format!("{text}{number:0digits$}")
        } else {
            if let Some(id) = given {
                self.texts.push(id.clone());
            }
            self.next_text += 1;
            self.texts.get(self.next_text - 1).cloned().ok_or(missing)?
        };
        if let Some((text, digits, number)) = numbered(&id) {
            self.last = (text.to_owned(), digits, number);
        }
        self.known.insert(id.clone(), next);
        self.met.push(id.clone());
        Ok(Some(id))
    }

    pub(super) fn attributes<C: Coder>(
        &mut self,
        coder: &mut C,
        given: Option<&Attributes>,
    ) -> Result<Attributes, CompactError> {
        let own = given.filter(|a| !a.is_empty());
        if !self.flag(coder, Flag::HasAttributes, own.is_some()) {
            return Ok(Attributes::new());
        }
        if let Some(attributes) = own {
            self.attributes.push(attributes.clone());
        }
        let found = self.attributes.get(self.next_attributes).cloned();
        self.next_attributes += 1;
        found.ok_or(CompactError::Index("attributes"))
    }
}

/// An identifier that ends in up to 18 digits: the text before them, how many they are, and their number.
fn numbered(id: &str) -> Option<(&str, usize, i64)> {
    let text = id.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = id.len() - text.len();
    let number = id[text.len()..].parse().ok().filter(|_| digits <= 18)?;
    Some((text, digits, number))
}
