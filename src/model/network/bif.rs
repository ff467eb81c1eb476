//! Discrete networks in the Bayesian Interchange Format (BIF 0.15), read and written.
//!
//! Read are `network`, `variable` blocks with `type discrete`, and `probability` blocks with
//! `table`, one line per configuration `(a, b) p, q;`, or `default`; properties and comments are
//! skipped. Blocks come in any order; what is stated twice is refused. A word in quotation marks may hold spaces and marks.
//! Rows that are off 1 by rounding (less than 1e-3) are normalised. `default` fills at most 4,194,304 numbers in all: a line
//! of it can stand for more than there is memory.

use super::super::error::ModelError;
use super::bif_reader::Reader;
use super::{Cpd, Network, Stated, Variable};

impl Network {
    /// Reads a discrete network.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the line, and those of [`Network::new`].
    pub fn from_bif(text: &str) -> Result<Self, ModelError> {
        let mut reader = Reader::new(text);
        let mut blocks = Vec::new();
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
                // Variables may be declared after their probabilities.
                "probability" => {
                    blocks.push(reader.at);
                    reader.skip_block()?;
                }
                other => return Err(reader.wrong(&format!("`{other}` starts no block"))),
            }
        }
        for block in blocks {
            reader.at = block;
            reader.probability(&mut variables)?;
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
