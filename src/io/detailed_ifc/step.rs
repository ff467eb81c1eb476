//! The clear text of an exchange file: numbered instances, strings, numbers and global identifiers.

use std::collections::HashMap;
use std::fmt::{self, Display, Write};

/// The number of an instance, written as `#n`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Id(usize);

impl Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// The instances of a file in the order in which they are added, numbered from 1.
#[derive(Debug, Default)]
pub(super) struct Step {
    text: String,
    count: usize,
    shared: HashMap<String, Id>,
}

impl Step {
    /// Adds an instance, such as `IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)`.
    pub(super) fn add(&mut self, instance: impl Display) -> Id {
        self.count += 1;
        let id = Id(self.count);
        let _ = writeln!(self.text, "{id}={instance};");
        id
    }

    /// The earlier instance of the same text, or a new one. For values without an identity, such as points.
    pub(super) fn share(&mut self, instance: impl Display) -> Id {
        let text = instance.to_string();
        if let Some(id) = self.shared.get(&text) {
            return *id;
        }
        let id = self.add(&text);
        self.shared.insert(text, id);
        id
    }

    /// The lines of all instances.
    pub(super) fn into_text(self) -> String {
        self.text
    }
}

/// A list or a set in parentheses.
pub(super) fn list<T: Display>(items: impl IntoIterator<Item = T>) -> String {
    let mut text = String::from("(");
    for (k, item) in items.into_iter().enumerate() {
        let _ = write!(text, "{}{item}", if k > 0 { "," } else { "" });
    }
    text + ")"
}

/// A string in quotes: apostrophes and backslashes are doubled, all but printable ASCII is written by code points, in four
/// hexadecimal digits or in eight (ISO 10303-21:2016, Sec. 6.4.3).
pub(super) fn quoted(words: &str) -> String {
    let mut text = String::from("'");
    // Digits of the code points in the run that is open; 0 outside of one.
    let mut open = 0;
    for sign in words.chars() {
        let digits = match sign {
            ' '..='~' => 0,
            '\0'..='\u{ffff}' => 4,
            _ => 8,
        };
        if digits != open {
            if open != 0 {
                text.push_str("\\X0\\");
            }
            text.push_str(match digits {
                0 => "",
                4 => "\\X2\\",
                _ => "\\X4\\",
            });
            open = digits;
        }
        match sign {
            '\'' | '\\' => text.extend([sign, sign]),
            ' '..='~' => text.push(sign),
            _ => {
                let _ = write!(text, "{:01$X}", u32::from(sign), digits);
            }
        }
    }
    if open != 0 {
        text.push_str("\\X0\\");
    }
    text.push('\'');
    text
}

/// A number of metres or of no unit, rounded to six decimals.
pub(super) fn real(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0');
    match text {
        "-0." => "0.".into(),
        _ => text.into(),
    }
}

/// A number that reads back to the same bits; zero has no sign.
pub(super) fn exact(value: f64) -> String {
    let text = format!("{:?}", value + 0.0);
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.E{exponent}"),
        None => text,
    }
}

/// A `GlobalId` in quotes, derived from the words that name its owner: FNV-1a of 128 bits in the 64 digits of IFC, the
/// first of which holds two bits.
pub(super) fn global_id(words: &[&str]) -> String {
    const DIGITS: &[u8; 64] = b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
    let mut hash: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    for word in words {
        // No text has the byte 255: it keeps `ab`, `c` apart from `a`, `bc`.
        for byte in word.bytes().chain([255]) {
            hash =
                (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
    let digits = (0..22)
        .rev()
        .map(|k| DIGITS[(hash >> (6 * k)) as usize & 63]);
    let mut text = String::from("'");
    text.extend(digits.map(char::from));
    text.push('\'');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_escaped() {
        assert_eq!(quoted("it's a \\"), r"'it''s a \\'");
        assert_eq!(quoted("Köln"), r"'K\X2\00F6\X0\ln'");
        assert_eq!(quoted("äö\n"), r"'\X2\00E400F6000A\X0\'");
        assert_eq!(quoted("é🏠"), r"'\X2\00E9\X0\\X4\0001F3E0\X0\'");
    }

    #[test]
    fn numbers_have_a_point() {
        assert_eq!(
            [0.0, -1e-9, 3.0, -2.5, 0.1 + 0.2].map(real),
            ["0.", "0.", "3.", "-2.5", "0.3"]
        );
        assert_eq!(
            [1.0, 0.1, 1e-7, 2.5e300].map(exact),
            ["1.0", "0.1", "1.E-7", "2.5E300"]
        );
    }

    #[test]
    fn identifiers_differ_by_all_words() {
        let one = global_id(&["ab", "c"]);
        assert_eq!(one.len(), 24);
        assert!(one.as_bytes()[1] <= b'3');
        assert_ne!(one, global_id(&["a", "bc"]));
        assert_ne!(one, global_id(&["ab", "d"]));
        assert_eq!(one, global_id(&["ab", "c"]));
    }
}
