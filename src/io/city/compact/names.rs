//! Names of templates and rules: mostly one text with consecutive numbers.

use serde::{Deserialize, Serialize};

use super::error::CompactError;

/// Names that are one text with consecutive numbers; without numbers one name.
#[derive(Serialize, Deserialize)]
pub(super) struct Names(String, u64, u64);

/// Names as few runs: `T1`, `T2`, `T3` are one.
pub(super) fn runs(names: &[String]) -> Vec<Names> {
    let mut out: Vec<Names> = Vec::new();
    for name in names {
        let text = name.trim_end_matches(|c: char| c.is_ascii_digit());
        // A number with zeros in front is text.
        let number = name[text.len()..].parse::<u64>().ok();
        let number = number.filter(|n| *n < 1 << 40 && name[text.len()..] == n.to_string());
        match (out.last_mut(), number) {
            (Some(run), Some(n)) if run.2 > 0 && run.0 == text && run.1 + run.2 == n => run.2 += 1,
            (_, Some(n)) => out.push(Names(text.to_owned(), n, 1)),
            (_, None) => out.push(Names(name.clone(), 0, 0)),
        }
    }
    out
}

/// Most names of a file.
const MOST_NAMES: u64 = 4_000_000;

pub(super) fn names(runs: &[Names]) -> Result<Vec<String>, CompactError> {
    let total: u64 = runs.iter().fold(0, |sum, r| sum.saturating_add(r.2.max(1)));
    if total > MOST_NAMES {
        return Err(CompactError::TooLarge("names"));
    }
    let mut out = Vec::new();
    for Names(text, first, count) in runs {
        match count {
            0 => out.push(text.clone()),
            _ => out.extend((0..*count).map(|k| format!("{text}{}", first.saturating_add(k)))),
        }
    }
    Ok(out)
}
