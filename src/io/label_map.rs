//! The labels that colours or numbers of an image stand for.

use std::fmt;
use std::path::Path;

use serde::Deserialize;
use serde::de::{self, MapAccess, Visitor};

use super::json::parse_json;
use super::read_bytes;
use edifice_base::{Error, Result};

/// Colours of the ECP and Graz facade databases.
pub const ECP: [(&str, [u8; 3]); 9] = [
    ("window", [255, 0, 0]),
    ("wall", [255, 255, 0]),
    ("balcony", [128, 0, 255]),
    ("door", [255, 128, 0]),
    ("roof", [0, 0, 255]),
    ("sky", [128, 255, 255]),
    ("shop", [0, 255, 0]),
    ("chimney", [128, 128, 128]),
    ("void", [0, 0, 0]),
];

/// Labels of the CMP facade database; the first is number 1.
pub const CMP: [&str; 12] = [
    "background",
    "facade",
    "window",
    "door",
    "cornice",
    "sill",
    "balcony",
    "blind",
    "deco",
    "molding",
    "pillar",
    "shop",
];

/// Colours of ours for the labels that only CMP has: its images carry numbers.
pub const CMP_COLORS: [(&str, [u8; 3]); 8] = [
    ("background", [200, 200, 200]),
    ("facade", [240, 230, 140]),
    ("cornice", [0, 128, 128]),
    ("sill", [139, 69, 19]),
    ("blind", [0, 100, 0]),
    ("deco", [255, 105, 180]),
    ("molding", [188, 143, 143]),
    ("pillar", [72, 61, 139]),
];

/// The value of a pixel: a colour, or a number (palette index, grey value, number in a matrix).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// Red, green, blue.
    Color([u8; 3]),
    /// A number; negative ones stand in text matrices only.
    Id(i64),
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Key::Color([r, g, b]) => write!(f, "colour [{r}, {g}, {b}]"),
            Key::Id(id) => write!(f, "number {id}"),
        }
    }
}

/// Names of colours or numbers. As a file, a JSON object: `{"window": [255, 0, 0], "wall": 2}`.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelMap {
    entries: Vec<(String, Key)>,
}

impl LabelMap {
    /// The colours that are known without a map: [`ECP`] and [`CMP_COLORS`].
    pub fn colors() -> Self {
        let entry = |&(name, color): &(&str, [u8; 3])| (name.to_string(), Key::Color(color));
        Self {
            entries: ECP.iter().chain(&CMP_COLORS).map(entry).collect(),
        }
    }

    /// The numbers of CMP: [`CMP`].
    pub fn cmp() -> Self {
        let numbered = (1..).zip(CMP);
        Self {
            entries: numbered
                .map(|(id, name)| (name.to_string(), Key::Id(id)))
                .collect(),
        }
    }

    /// Reads a label map from a JSON file.
    ///
    /// # Errors
    /// Names the file and the place: not an object of colours and numbers, a name or a colour
    /// given twice, an empty name, no entry at all.
    pub fn read(path: &Path) -> Result<Self> {
        Self::parse(&read_bytes(path)?, path)
    }

    /// Parses a label map; `path` only names the file in errors.
    ///
    /// # Errors
    /// As [`LabelMap::read`].
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self> {
        let map: LabelMap = parse_json(bytes, path)?;
        if map.entries.is_empty() {
            return Err(Error::content(path, "the label map is empty"));
        }
        for (index, (name, key)) in map.entries.iter().enumerate() {
            if name.is_empty() {
                return Err(Error::content(path, "a label has an empty name"));
            }
            for (other, other_key) in &map.entries[..index] {
                if name == other {
                    return Err(Error::input(
                        path,
                        name.clone(),
                        "this label is given twice",
                    ));
                }
                if key == other_key {
                    let message = format!("{key} already stands for {other:?}");
                    return Err(Error::input(path, name.clone(), message));
                }
            }
        }
        Ok(map)
    }

    /// The names, in order; positions are the indices that [`LabelMap::find`] returns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(name, _)| name.as_str())
    }

    /// Position of what `key` stands for.
    pub fn find(&self, key: Key) -> Option<u16> {
        let position = self.entries.iter().position(|&(_, k)| k == key)?;
        u16::try_from(position).ok()
    }

    /// The colours of the map with their positions, in order.
    pub fn colours(&self) -> Vec<([u8; 3], u16)> {
        let colour = |(position, (_, key)): (u16, &(String, Key))| match key {
            Key::Color(color) => Some((*color, position)),
            Key::Id(_) => None,
        };
        (0..=u16::MAX)
            .zip(&self.entries)
            .filter_map(colour)
            .collect()
    }

    /// True if the map names colours (rather than only numbers).
    pub fn has_colors(&self) -> bool {
        self.entries
            .iter()
            .any(|(_, key)| matches!(key, Key::Color(_)))
    }
}

impl<'de> Deserialize<'de> for LabelMap {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "expected a colour [r, g, b] of 0..255 or a whole number"
        )]
        enum Value {
            Color([u8; 3]),
            Id(i64),
        }
        // A visitor, because a map type would silently keep the last of two equal keys.
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = LabelMap;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object like {\"window\": [255, 0, 0], \"wall\": 2}")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<LabelMap, A::Error> {
                let mut entries = Vec::new();
                while let Some((name, value)) = map.next_entry()? {
                    let key = match value {
                        Value::Color(color) => Key::Color(color),
                        Value::Id(id) => Key::Id(id),
                    };
                    entries.push((name, key));
                }
                Ok(LabelMap { entries })
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_checked() {
        let parse = |text: &str| LabelMap::parse(text.as_bytes(), "m.json".as_ref());
        let map = parse(r#"{"window": [255, 0, 0], "wall": 2}"#).unwrap();
        assert_eq!(map.find(Key::Id(2)), Some(1));
        assert_eq!(map.find(Key::Color([0, 0, 0])), None);
        let map = parse(r#"{"unlabelled": -1, "wall": 0}"#).unwrap();
        assert_eq!(map.find(Key::Id(-1)), Some(0));
        let cases = [
            (r#"{"a": 1, "a": 2}"#, "a: this label is given twice"),
            (
                r#"{"a": 1, "b": 1}"#,
                "b: number 1 already stands for \"a\"",
            ),
            (r#"{"a": [1, 2, 300]}"#, "a: expected a colour"),
            (r#"{"a": [1, 2]}"#, "expected a colour"),
            (r#"{"a": -1.5}"#, "or a whole number"),
            (r#"{"a": -1, "b": -1}"#, "b: number -1 already stands"),
            (r#"{"": 1}"#, "empty name"),
            (r#"{}"#, "empty"),
            (r#"[1]"#, "expected an object like"),
            (r#"{"a": 1} x"#, "line 1, column 10"),
        ];
        for (text, expected) in cases {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
