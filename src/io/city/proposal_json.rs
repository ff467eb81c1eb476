//! The types that a tile of a country proposes: `*.city-proposal.json.gz`, format `edifice/city-proposal`, version 1.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::grammar_json;
use edifice_base::{Error, Result};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io::json::{check_header, parse_json};
use edifice_io::read_bytes;

/// Format of a proposal.
pub const FORMAT: &str = "edifice/city-proposal";
/// Its version.
pub const VERSION: u64 = 1;

/// Types with what they stand for.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// Components of the tile.
    pub components: usize,
    /// The number of components that each template stands for, and their volume in cubic metres.
    pub stands: Vec<[f64; 2]>,
    /// Templates, rules, and an example of each rule.
    pub grammar: InstanceGrammar,
}

#[derive(Serialize, Deserialize)]
struct File {
    format: String,
    version: u64,
    components: usize,
    stands: Vec<[f64; 2]>,
    grammar: Value,
}

/// Reads a proposal.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<Proposal> {
    parse(&read_bytes(path)?, path)
}

/// Parses the text of a proposal; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Proposal> {
    check_header(bytes, path, FORMAT, VERSION)?;
    let file: File = parse_json(bytes, path)?;
    let grammar = grammar_json::parse(file.grammar.to_string().as_bytes(), path)?;
    let (found, wanted) = (file.stands.len(), grammar.templates.len());
    if found != wanted {
        let message = format!("{found} entries for {wanted} templates");
        return Err(Error::input(path, "stands", message));
    }
    let sound = |v: &f64| v.is_finite() && *v >= 0.0;
    if let Some(at) = file.stands.iter().position(|s| !s.iter().all(sound)) {
        let place = format!("stands[{at}]");
        return Err(Error::input(path, place, "a number below 0"));
    }
    Ok(Proposal {
        components: file.components,
        stands: file.stands,
        grammar,
    })
}

/// The bytes of a proposal's file, gzipped.
///
/// # Errors
/// Those of the JSON writer, on numbers that are not finite.
pub fn to_bytes(proposal: &Proposal) -> serde_json::Result<Vec<u8>> {
    let file = File {
        format: FORMAT.to_owned(),
        version: VERSION,
        components: proposal.components,
        stands: proposal.stands.clone(),
        grammar: serde_json::from_str(&grammar_json::to_string(&proposal.grammar)?)?,
    };
    Ok(grammar_json::packed(&serde_json::to_vec(&file)?))
}
