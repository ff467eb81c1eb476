//! The likeness of two grammars of one facade: the regions that both keep whole (Sec. 6.1, Table 4).

use std::collections::HashSet;

use serde::{Deserialize, Serialize};

use edifice_base::{Error, Result};
use edifice_grammar::{Grammar, derivation};

/// Precision, recall and F-score.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Likeness {
    /// Common regions over regions of the grammar judged.
    pub precision: f64,
    /// Common regions over regions of the reference.
    pub recall: f64,
    /// Harmonic mean of both.
    pub f_score: f64,
}

/// Left, bottom, width, height in thousandths of a unit.
type Key = [i64; 4];

/// The rectangles of the non-terminals of a grammar. The whole facade, which every grammar has, counts as in the paper:
/// "all non-terminal regions".
fn regions(grammar: &Grammar) -> Result<HashSet<Key>> {
    let derived = derivation(grammar, 0).map_err(Error::method)?;
    let key = |v: f64| (v * 1000.0).round() as i64;
    let places = derived.non_terminals.iter().map(|n| n.rect);
    Ok(places
        .map(|r| [key(r.x), key(r.y), key(r.width), key(r.height)])
        .collect())
}

/// Judges a grammar against a reference for the same facade.
///
/// # Errors
/// [`Error::Method`] when one of them does not derive.
pub(crate) fn likeness(grammar: &Grammar, reference: &Grammar) -> Result<Likeness> {
    let (ours, theirs) = (regions(grammar)?, regions(reference)?);
    let common = ours.intersection(&theirs).count() as f64;
    let share = |count: usize| {
        if count == 0 {
            0.0
        } else {
            common / count as f64
        }
    };
    let (precision, recall) = (share(ours.len()), share(theirs.len()));
    let f_score = match precision + recall {
        s if s > 0.0 => 2.0 * precision * recall / s,
        _ => 0.0,
    };
    Ok(Likeness {
        precision,
        recall,
        f_score,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_io::grammar_cga::from_str;

    #[test]
    fn shares_of_common_regions() {
        let grammar = |text: &str| from_str(text).unwrap();
        let head = "//@ unit \"m\"\n//@ facade F 6 x 1 \"f\"\n";
        let known = grammar(&format!(
            "{head}F --> split(x) {{ 2 : A | 2 : A | 2 : B }}\nA --> split(x) {{ 1 : w | 1 : v }}\nB --> split(x) {{ 1 : v | 1 : u }}\n"
        ));
        let flat = grammar(&format!(
            "{head}F --> split(x) {{ 2 : A | 1 : w | 1 : v | 1 : v | 1 : u }}\nA --> split(x) {{ 1 : w | 1 : v }}\n"
        ));
        let found = likeness(&flat, &known).unwrap();
        assert_eq!((found.precision, found.recall), (1.0, 0.5));
        assert!((found.f_score - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(likeness(&known, &known).unwrap().f_score, 1.0);
    }
}
