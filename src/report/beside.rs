//! A printed number beside ours: how far they are from each other, and what that says of a paper as a whole.

/// A quantity as the paper printed it and as a run found it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Beside {
    /// Name of the quantity.
    pub quantity: String,
    /// The paper's words.
    pub printed: String,
    /// The run's words.
    pub ours: String,
}

/// True for a relative difference that counts as none: up to 5 %.
pub(crate) fn is_near(difference: f64) -> bool {
    difference.abs() <= 0.05 + 1e-9
}

/// Numbers of a text outside parentheses, in order; digits within a word are none.
fn numbers(text: &str) -> Vec<f64> {
    let mut depth = 0_i32;
    let mut found = Vec::new();
    let mut word = String::new();
    for sign in text.chars().chain([' ']) {
        match sign {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
        let part =
            sign.is_alphanumeric() || "._-".contains(sign) || (sign == ',' && !word.is_empty());
        if part && depth == 0 {
            word.push(sign);
            continue;
        }
        // A comma between digits parts thousands, one at the end parts numbers.
        let plain = word.trim_end_matches([',', '.']).replace(',', "");
        found.extend(plain.parse::<f64>().ok().filter(|v| v.is_finite()));
        word.clear();
    }
    found
}

impl Beside {
    /// Our number over the paper's, minus one; of several the one that differs most. `None` where the texts do not hold equally
    /// many numbers, or the paper's is zero.
    pub fn difference(&self) -> Option<f64> {
        let [printed, ours] = [&self.printed, &self.ours].map(|t| numbers(t));
        if printed.is_empty() || printed.len() != ours.len() || printed.contains(&0.0) {
            return None;
        }
        let each = printed.iter().zip(&ours).map(|(p, o)| o / p - 1.0);
        each.max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }
}

/// Counts of the quantities of a paper by their differences.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Within 5 % of the printed number.
    pub near: usize,
    /// Farther from it.
    pub far: usize,
    /// No number stands against a number.
    pub none: usize,
}

impl Counts {
    /// Of some quantities.
    pub fn of<'b>(all: impl IntoIterator<Item = &'b Beside>) -> Self {
        let mut counts = Self::default();
        for beside in all {
            match beside.difference() {
                None => counts.none += 1,
                Some(d) if is_near(d) => counts.near += 1,
                Some(_) => counts.far += 1,
            }
        }
        counts
    }

    /// All of them.
    pub fn all(&self) -> usize {
        self.near + self.far + self.none
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn difference(printed: &str, ours: &str) -> Option<f64> {
        let beside = Beside {
            quantity: String::new(),
            printed: printed.into(),
            ours: ours.into(),
        };
        beside.difference().map(|d| (d * 1e3).round() / 1e3)
    }

    #[test]
    fn numbers_are_set_against_numbers() {
        assert_eq!(numbers("41.2/43.1 (ADP 10k)"), [41.2, 43.1]);
        assert_eq!(numbers("1,121 terminals, 0.5, 3"), [1121.0, 0.5, 3.0]);
        assert_eq!(numbers("falls for ADP"), []);
        assert_eq!(difference("40", "38.6, proven optimal"), Some(-0.035));
        assert_eq!(difference("41.2/43.1", "38.1/38.1"), Some(-0.116));
        assert_eq!(difference("falls", "0.087, 0.024"), None);
        assert_eq!(difference("0", "1"), None);
        assert_eq!(difference("0.21, 0.18", "0.18"), None);
    }

    #[test]
    fn a_paper_is_counted() {
        let all = [("40", "41"), ("40", "60"), ("pictures", "2")];
        let all = all.map(|(printed, ours)| Beside {
            quantity: String::new(),
            printed: printed.into(),
            ours: ours.into(),
        });
        let counts = Counts::of(&all);
        assert_eq!(
            (counts.near, counts.far, counts.none, counts.all()),
            (1, 1, 1, 3)
        );
    }
}
