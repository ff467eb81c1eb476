//! Discrete networks in the Bayesian Interchange Format (BIF 0.15), read and written.
//!
//! Read are `network`, `variable` blocks with `type discrete`, and `probability` blocks with
//! `table`, one line per configuration `(a, b) p, q;`, or `default`; properties and comments are
//! skipped. A word in quotation marks may hold spaces and marks. Rows that are off 1 by rounding (less than 1e-3) are normalised. `default` fills at most
//! [`MOST_DEFAULTS`] numbers in all: a line of it can stand for more than there is memory.

use std::collections::HashMap;

use super::super::error::ModelError;
use super::{Cpd, Network, Stated, Variable};

/// Most probabilities that the `default` lines of a file may stand for.
pub(super) const MOST_DEFAULTS: usize = 1 << 22;

impl Network {
    /// Reads a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the line, and those of [`Network::new`].
    pub fn from_bif(text: &str) -> Result<Self, ModelError> {
        let mut reader = Reader {
            tokens: tokens(text),
            at: 0,
            places: HashMap::new(),
            defaults: 0,
        };
        let mut variables: Vec<Variable> = Vec::new();
        while let Some((_, word)) = reader.next() {
            match word.as_str() {
                "network" => reader.skip_block()?,
                "variable" => {
                    let variable = reader.variable()?;
                    let place = variables.len();
                    if reader.places.insert(variable.name.clone(), place).is_some() {
                        return Err(reader.wrong(&format!("`{}` is declared twice", variable.name)));
                    }
                    variables.push(variable);
                }
                "probability" => reader.probability(&mut variables)?,
                other => return Err(reader.wrong(&format!("`{other}` starts no block"))),
            }
        }
        if let Some(v) = variables.iter().find(|v| v.stated == Stated::Open) {
            return Err(ModelError::corrupt(
                "end",
                format!("`{}` has no probabilities", v.name),
            ));
        }
        Self::new(variables)
    }

    /// Writes a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Kind`] for a variable without a table; [`ModelError::Parameter`] for a name
    /// that the format cannot hold.
    pub fn to_bif(&self) -> Result<String, ModelError> {
        let mut out = String::from("network unknown {\n}\n");
        let mut names = Vec::with_capacity(self.nodes.len());
        let mut categories: Vec<Vec<String>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let name = written(&node.name)?;
            let own: Result<Vec<String>, ModelError> =
                node.categories.iter().map(|c| written(c)).collect();
            let own = own?;
            out += &format!(
                "variable {name} {{\n  type discrete [ {} ] {{ {} }};\n}}\n",
                own.len(),
                own.join(", ")
            );
            names.push(name);
            categories.push(own);
        }
        for (node, name) in self.nodes.iter().zip(&names) {
            let Cpd::Table(table) = &node.cpd else {
                return Err(ModelError::Kind {
                    column: node.name.clone(),
                    got: "without a table",
                    expected: "discrete with a table",
                });
            };
            let row = |p: &[f64]| p.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            if node.discrete.is_empty() {
                out += &format!("probability ( {name} ) {{\n  table {};\n}}\n", row(table));
                continue;
            }
            let given: Vec<&str> = node.discrete.iter().map(|&p| names[p].as_str()).collect();
            out += &format!("probability ( {name} | {} ) {{\n", given.join(", "));
            for (i, p) in table.chunks(node.categories.len()).enumerate() {
                let mut rest = i;
                let mut words: Vec<&str> = Vec::new();
                for &parent in node.discrete.iter().rev() {
                    let k = self.sizes[parent];
                    words.push(&categories[parent][rest % k]);
                    rest /= k;
                }
                words.reverse();
                out += &format!("  ({}) {};\n", words.join(", "), row(p));
            }
            out += "}\n";
        }
        Ok(out)
    }
}

/// A word as it is written: in quotation marks where it would not be read as one word otherwise.
fn written(word: &str) -> Result<String, ModelError> {
    const MARKS: &str = "{}()[]|,;";
    if word.is_empty()
        || MARKS.chars().any(|m| word.chars().eq([m]))
        || word.contains(['"', '\n', '\r'])
    {
        return Err(ModelError::parameter(word, "cannot be written as a word"));
    }
    let plain = !word.contains(|c: char| c.is_whitespace() || c == '/' || MARKS.contains(c));
    Ok(if plain {
        word.to_owned()
    } else {
        format!("\"{word}\"")
    })
}

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

struct Reader {
    tokens: Vec<(usize, String)>,
    at: usize,
    /// Place of each variable among those read.
    places: HashMap<String, usize>,
    /// Probabilities that `default` lines have stood for.
    defaults: usize,
}

impl Reader {
    fn next(&mut self) -> Option<(usize, String)> {
        let token = self.tokens.get(self.at).cloned();
        self.at += 1;
        token
    }

    fn wrong(&self, problem: &str) -> ModelError {
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

    fn skip_block(&mut self) -> Result<(), ModelError> {
        while self.word()? != "{" {}
        while self.word()? != "}" {}
        Ok(())
    }

    fn skip_statement(&mut self) -> Result<(), ModelError> {
        while self.word()? != ";" {}
        Ok(())
    }

    fn variable(&mut self) -> Result<Variable, ModelError> {
        let name = self.word()?;
        self.expect("{")?;
        let mut categories = Vec::new();
        loop {
            match self.word()?.as_str() {
                "}" => break,
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

    fn probability(&mut self, variables: &mut [Variable]) -> Result<(), ModelError> {
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
                "default" => default = Some(self.row(k)?),
                "table" => {
                    // Child slowest, last parent fastest, as the format says.
                    let all = self.numbers()?;
                    if all.len() != rows * k {
                        return Err(self.wrong(&format!("{} numbers are needed", rows * k)));
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
                    table.insert(index, row);
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
