//! Discrete networks in the Bayesian Interchange Format (BIF 0.15), read and written.
//!
//! Read are `network`, `variable` blocks with `type discrete`, and `probability` blocks with
//! `table`, one line per configuration `(a, b) p, q;`, or `default`; properties and comments are
//! skipped. Rows that are off 1 by rounding (less than 1e-3) are normalised.

use super::super::error::ModelError;
use super::{Cpd, Network, Stated, Variable};

impl Network {
    /// Reads a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the line, and those of [`Network::new`].
    pub fn from_bif(text: &str) -> Result<Self, ModelError> {
        let mut reader = Reader {
            tokens: tokens(text),
            at: 0,
        };
        let mut variables: Vec<Variable> = Vec::new();
        while let Some((_, word)) = reader.next() {
            match word.as_str() {
                "network" => reader.skip_block()?,
                "variable" => variables.push(reader.variable()?),
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
        for node in &self.nodes {
            for word in node.categories.iter().chain([&node.name]) {
                if word.is_empty()
                    || word.contains(|c: char| c.is_whitespace() || "{}()[]|,;\"/".contains(c))
                {
                    return Err(ModelError::parameter(word, "cannot be written as a word"));
                }
            }
            let list = node.categories.join(", ");
            out += &format!(
                "variable {} {{\n  type discrete [ {} ] {{ {list} }};\n}}\n",
                node.name,
                node.categories.len()
            );
        }
        for node in &self.nodes {
            let Cpd::Table(table) = &node.cpd else {
                return Err(ModelError::Kind {
                    column: node.name.clone(),
                    got: "without a table",
                    expected: "discrete with a table",
                });
            };
            let row = |p: &[f64]| p.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            if node.discrete.is_empty() {
                out += &format!(
                    "probability ( {} ) {{\n  table {};\n}}\n",
                    node.name,
                    row(table)
                );
                continue;
            }
            let names: Vec<&str> = node
                .discrete
                .iter()
                .map(|&p| self.nodes[p].name.as_str())
                .collect();
            out += &format!("probability ( {} | {} ) {{\n", node.name, names.join(", "));
            for (i, p) in table.chunks(node.categories.len()).enumerate() {
                let mut rest = i;
                let mut words: Vec<&str> = Vec::new();
                for &parent in node.discrete.iter().rev() {
                    let k = self.sizes[parent];
                    words.push(&self.nodes[parent].categories[rest % k]);
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
            if "{}();".contains(&word) {
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
        let find = |name: &String| variables.iter().position(|v| v.name == *name);
        let unknown = |name: &String| ModelError::Unknown { name: name.clone() };
        let own = find(child).ok_or_else(|| unknown(child))?;
        let mut sizes = Vec::new();
        for p in &parents {
            sizes.push(
                variables[find(p).ok_or_else(|| unknown(p))?]
                    .categories
                    .clone(),
            );
        }
        let k = variables[own].categories.len();
        let rows: usize = sizes.iter().map(Vec::len).product();
        let mut table: Vec<Option<Vec<f64>>> = vec![None; rows];
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
                    for (i, row) in table.iter_mut().enumerate() {
                        let column = (0..k).map(|v| all[v * rows + i]).collect();
                        *row = Some(self.normal(column)?);
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
                    table[index] = Some(self.row(k)?);
                }
                other => return Err(self.wrong(&format!("`{other}` belongs to no probability"))),
            }
        }
        let mut flat = Vec::with_capacity(rows * k);
        for row in table {
            let row = row.or_else(|| default.clone());
            flat.extend(row.ok_or_else(|| self.wrong("a configuration has no probabilities"))?);
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
