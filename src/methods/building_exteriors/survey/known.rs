//! Facts on a building from the attributes of a city model.

use serde_json::{Map, Value};

/// Storeys, use and year, where the file has them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Known {
    /// Storeys above the ground, at least 1.
    pub storeys: Option<usize>,
    /// True if the file says that people live there.
    pub is_dwelling: bool,
    /// A use that is none for dwellings.
    pub other_use: Option<String>,
    /// Year of construction.
    pub year: Option<i64>,
}

/// Names of attributes, in lower case without signs: CityGML and CityJSON, 3D BAG and PLATEAU.
const STOREYS: [&str; 5] = [
    "storeysaboveground",
    "measuredstoreys",
    "b3bouwlagen",
    "storeys",
    "floors",
];
const YEARS: [&str; 5] = [
    "yearofconstruction",
    "bouwjaar",
    "oorspronkelijkbouwjaar",
    "yearbuilt",
    "year",
];
const USES: [&str; 4] = ["function", "usage", "gebruiksdoel", "use"];
/// Codes of dwellings: PLATEAU (house, flats, house with a shop); functions of buildings in CityGML's code lists (from the residential
/// building to the summer house), which the German surveys have, too.
const DWELLING_CODES: [std::ops::RangeInclusive<u32>; 2] = [411..=413, 1000..=1110];
/// Words and codes of dwellings: code lists of the German surveys (`31001_1000` to 1999, 9997 and 9998 unknown), INSPIRE.
const DWELLINGS: [&str; 7] = [
    "wohn", "woon", "resid", "dwelling", "house", "home", "31001_1",
];
const UNKNOWN: [&str; 6] = [
    "31001_9998",
    "9998",
    "unknown",
    "none",
    "null",
    "31001_9997",
];

impl Known {
    /// Reads the attributes; names that are not known count for nothing.
    pub fn new(attributes: &Map<String, Value>) -> Self {
        let mut known = Self::default();
        for (name, value) in attributes {
            let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
            let plain = plain.to_lowercase();
            let number = || match value {
                Value::Number(n) => n.as_f64(),
                Value::String(s) => s.get(..4).unwrap_or(s).trim().parse().ok(),
                _ => None,
            };
            if STOREYS.contains(&plain.as_str()) {
                let storeys = number().filter(|n| (1.0..1000.0).contains(n));
                known.storeys = known.storeys.or(storeys.map(|n| n.round() as usize));
            } else if YEARS.contains(&plain.as_str()) {
                let year = number().filter(|n| (1000.0..3000.0).contains(n));
                known.year = known.year.or(year.map(|n| n as i64));
            } else if USES.contains(&plain.as_str()) {
                known.used_as(&text(value));
            }
        }
        if known.is_dwelling {
            known.other_use = None;
        }
        known
    }

    fn used_as(&mut self, text: &str) {
        let low = text.to_lowercase();
        if low.is_empty() || UNKNOWN.contains(&low.as_str()) {
            return;
        }
        let code = low.parse().ok();
        let coded = code.is_some_and(|c| DWELLING_CODES.iter().any(|codes| codes.contains(&c)));
        match coded || DWELLINGS.iter().any(|d| low.contains(d)) {
            true => self.is_dwelling = true,
            false => self.other_use = self.other_use.take().or(Some(text.to_owned())),
        }
    }
}

/// A text, or the texts of a list.
fn text(value: &Value) -> String {
    match value {
        Value::String(s) => s.clone(),
        // Without the ".0" of a column of real numbers.
        Value::Number(n) => n.as_f64().unwrap_or_default().to_string(),
        Value::Array(list) => list.iter().map(text).collect::<Vec<_>>().join(" "),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn used_as(value: Value) -> Known {
        Known::new(&Map::from_iter([("function".to_owned(), value)]))
    }

    #[test]
    fn codes_are_read_as_numbers_and_as_texts() {
        // Files may have codes as texts or as numbers.
        for code in ["411", "412", "1000", "1010"] {
            let number: f64 = code.parse().unwrap();
            for value in [code.into(), number.into(), vec![number].into()] {
                let known = used_as(value);
                assert!(known.is_dwelling && known.other_use.is_none(), "{code}");
            }
        }
        for code in [422.0, 1120.0, 2000.0] {
            let known = used_as(code.into());
            assert_eq!(known.other_use, Some(code.to_string()));
        }
    }
}
