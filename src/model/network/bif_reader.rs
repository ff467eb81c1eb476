//! The reader of [`super::bif`]: words with their lines, blocks of words.

use std::collections::HashMap;

use super::super::error::ModelError;
use super::{Stated, Variable};

/// Most probabilities that the `default` lines of a file may stand for.
const MOST_DEFAULTS: usize = 1 << 22;

/// (line, word) with punctuation as words of its own.
fn tokens(text: &str) -> Vec<(usize, String)> {
    let mut tokens = Vec::new();
    let mut comment = false;
    for (line, content) in text.lines().enumerate() {
        let mut word = String::new();
        let mut quoted = false;
        let mut chars = content.chars().peekable();
        while let Some(c) = chars.next() {
            if comment {
                if c == '*' && chars.peek() == Some(&'/') {
                    chars.next();
                    comment = false;
                }
                continue;
            }
            if !quoted && c == '/' && chars.peek() == Some(&'/') {
                break;
            }
            if !quoted && c == '/' && chars.peek() == Some(&'*') {
                comment = true;
                continue;
            }
            let mark = "{}()[]|,;".contains(c);
            if c == '"' {
                quoted = !quoted;
            } else if quoted || !(mark || c.is_whitespace()) {
                word.push(c);
                continue;
            }
            if !word.is_empty() {
                tokens.push((line + 1, std::mem::take(&mut word)));
            }
            if mark {
                tokens.push((line + 1, c.to_string()));
            }
        }
        if !word.is_empty() {
            tokens.push((line + 1, word));
        }
    }
    tokens
}

/// A text that is read word by word.
pub(super) struct Reader {
    tokens: Vec<(usize, String)>,
    /// Place of the next word.
    pub(super) at: usize,
    /// Place of each variable among those read.
    pub(super) places: HashMap<String, usize>,
    /// Probabilities that `default` lines have stood for.
    defaults: usize,
}

impl Reader {
    /// At the first word; a byte order mark before it counts for nothing.
    pub(super) fn new(text: &str) -> Self {
        Self {
            tokens: tokens(text.trim_start_matches('\u{feff}')),
            at: 0,
            places: HashMap::new(),
            defaults: 0,
        }
    }

    pub(super) fn next(&mut self) -> Option<(usize, String)> {
        let token = self.tokens.get(self.at).cloned();
        self.at += 1;
        token
    }

    pub(super) fn wrong(&self, problem: &str) -> ModelError {
        let last = self.at.clamp(1, self.tokens.len().max(1)) - 1;
        let line = self.tokens.get(last).map_or(1, |t| t.0);
        ModelError::corrupt(format!("line {line}"), problem)
    }

    fn word(&mut self) -> Result<String, ModelError> {
        match self.next() {
            Some((_, word)) => Ok(word),
            None => Err(self.wrong("the text ends in the middle of a block")),
        }
    }

    fn expect(&mut self, expected: &str) -> Result<(), ModelError> {
        let word = self.word()?;
        if word == expected {
            return Ok(());
        }
        Err(self.wrong(&format!("`{expected}` is needed, not `{word}`")))
    }

    /// Words up to a closing mark, without commas.
    fn list(&mut self, close: &str) -> Result<Vec<String>, ModelError> {
        let mut words = Vec::new();
        loop {
            let word = self.word()?;
            if word == close {
                return Ok(words);
            }
            if ["{", "}", "(", ")", ";"].contains(&word.as_str()) {
                return Err(self.wrong(&format!("`{close}` is needed, not `{word}`")));
            }
            if word != "," {
                words.push(word);
            }
        }
    }

    fn numbers(&mut self) -> Result<Vec<f64>, ModelError> {
        let words = self.list(";")?;
        let parsed: Result<Vec<f64>, ModelError> = words
            .iter()
            .map(|w| {
                let value = w.parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
                value.ok_or_else(|| self.wrong(&format!("`{w}` is no probability")))
            })
            .collect();
        parsed
    }

    pub(super) fn skip_block(&mut self) -> Result<(), ModelError> {
        while self.word()? != "{" {}
        while self.word()? != "}" {}
        Ok(())
    }

    fn skip_statement(&mut self) -> Result<(), ModelError> {
        while self.word()? != ";" {}
        Ok(())
    }

    pub(super) fn variable(&mut self) -> Result<Variable, ModelError> {
        let name = self.word()?;
        self.expect("{")?;
        let mut categories = Vec::new();
        loop {
            match self.word()?.as_str() {
                "}" => break,
                "type" if !categories.is_empty() => {
                    return Err(self.wrong(&format!("`{name}` has its categories twice")));
                }
                "type" => {
                    self.expect("discrete")?;
                    self.expect("[")?;
                    let count = self.word()?;
                    self.expect("]")?;
                    self.expect("{")?;
                    categories = self.list("}")?;
                    self.expect(";")?;
                    if count.parse() != Ok(categories.len()) {
                        return Err(
                            self.wrong(&format!("`{name}` does not have {count} categories"))
                        );
                    }
                }
                "property" => self.skip_statement()?,
                other => return Err(self.wrong(&format!("`{other}` belongs to no variable"))),
            }
        }
        if categories.is_empty() {
            return Err(self.wrong(&format!("`{name}` has no categories")));
        }
        Ok(Variable {
            name,
            categories,
            dimension: 0,
            parents: Vec::new(),
            stated: Stated::Open,
        })
    }

    pub(super) fn probability(&mut self, variables: &mut [Variable]) -> Result<(), ModelError> {
        self.expect("(")?;
        let head = self.list(")")?;
        let child = head
            .first()
            .ok_or_else(|| self.wrong("whose probabilities?"))?;
        if head.len() > 1 && head[1] != "|" {
            return Err(self.wrong("`|` is needed before the parents"));
        }
        let parents: Vec<String> = head.iter().skip(2).cloned().collect();
        let find = |name: &String| {
            let place = self.places.get(name).copied();
            place.ok_or_else(|| ModelError::Unknown { name: name.clone() })
        };
        let own = find(child)?;
        if variables[own].stated != Stated::Open {
            return Err(self.wrong(&format!("`{child}` has probabilities already")));
        }
        let sizes: Result<Vec<&Vec<String>>, ModelError> = parents
            .iter()
            .map(|p| Ok(&variables[find(p)?].categories))
            .collect();
        let sizes = sizes?;
        let k = variables[own].categories.len();
        let rows = sizes
            .iter()
            .try_fold(1_usize, |n, c| n.checked_mul(c.len()))
            .filter(|rows| rows.checked_mul(k).is_some());
        let rows = rows.ok_or_else(|| self.wrong("more configurations than can be counted"))?;
        // By configuration: the file need not state all those that its parents have.
        let mut table: HashMap<usize, Vec<f64>> = HashMap::new();
        let mut default = None;
        self.expect("{")?;
        loop {
            match self.word()?.as_str() {
                "}" => break,
                "property" => self.skip_statement()?,
                "default" if default.is_some() => {
                    return Err(self.wrong(&format!("`{child}` has `default` twice")));
                }
                "default" => default = Some(self.row(k)?),
                "table" => {
                    // Child slowest, last parent fastest, as the format says.
                    let all = self.numbers()?;
                    if all.len() != rows * k {
                        return Err(self.wrong(&format!("{} numbers are needed", rows * k)));
                    }
                    if !table.is_empty() {
                        return Err(self.wrong(&format!("`{child}` has probabilities already")));
                    }
                    for i in 0..rows {
                        let column = (0..k).map(|v| all[v * rows + i]).collect();
                        table.insert(i, self.normal(column)?);
                    }
                }
                "(" => {
                    let words = self.list(")")?;
                    if words.len() != sizes.len() {
                        return Err(self.wrong("one category per parent is needed"));
                    }
                    let mut index = 0;
                    for (word, categories) in words.iter().zip(&sizes) {
                        let value = categories.iter().position(|c| c == word);
                        let value =
                            value.ok_or_else(|| self.wrong(&format!("no parent is `{word}`")))?;
                        index = index * categories.len() + value;
                    }
                    let row = self.row(k)?;
                    if table.insert(index, row).is_some() {
                        let words = words.join(", ");
                        return Err(self.wrong(&format!("`({words})` has probabilities already")));
                    }
                }
                other => return Err(self.wrong(&format!("`{other}` belongs to no probability"))),
            }
        }
        if default.is_none() && table.len() < rows {
            return Err(self.wrong("a configuration has no probabilities"));
        }
        self.defaults = self
            .defaults
            .saturating_add((rows - table.len()).saturating_mul(k));
        if self.defaults > MOST_DEFAULTS {
            let problem = format!("`default` stands for more than {MOST_DEFAULTS} probabilities");
            return Err(self.wrong(&problem));
        }
        let mut flat = Vec::with_capacity(rows * k);
        for i in 0..rows {
            flat.extend(table.get(&i).or(default.as_ref()).into_iter().flatten());
        }
        variables[own].parents = parents;
        variables[own].stated = Stated::Table(flat);
        Ok(())
    }

    fn row(&mut self, k: usize) -> Result<Vec<f64>, ModelError> {
        let row = self.numbers()?;
        if row.len() != k {
            return Err(self.wrong(&format!("{k} numbers are needed")));
        }
        self.normal(row)
    }

    fn normal(&self, row: Vec<f64>) -> Result<Vec<f64>, ModelError> {
        let sum: f64 = row.iter().sum();
        if (sum - 1.0).abs() > 1e-3 {
            return Err(self.wrong(&format!("probabilities sum to {sum}, not 1")));
        }
        if (sum - 1.0).abs() < 1e-9 {
            return Ok(row);
        }
        Ok(row.into_iter().map(|p| p / sum).collect())
    }
}
