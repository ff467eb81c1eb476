//! The dictionary that grammars of tiles share: templates and rules that stand in a file of their own.
//!
//! A grammar over a dictionary begins with the dictionary's templates and with its rules but the axiom's. Its file (version 4) leaves
//! them out and names the dictionary's file by the SHA-256 of its bytes, so that no other can take its place.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::CompactError;
use edifice_base::file::read_bytes;
use edifice_grammar::instance::{InstanceGrammar, InstanceRule};

/// Name of a dictionary's file, beside the grammars that share it.
pub const DICTIONARY: &str = "dictionary.city-grammar.bin";

/// A dictionary, as it was read from its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Dictionary {
    /// SHA-256 of the file's bytes, in hexadecimal digits.
    pub sha256: String,
    /// Its grammar.
    pub grammar: InstanceGrammar,
}

impl Dictionary {
    /// The rules but the axiom's.
    pub(super) fn rules(&self) -> Vec<InstanceRule> {
        let rules = self.grammar.rules.iter();
        let shared = rules.filter(|r| r.symbol != self.grammar.axiom);
        shared.cloned().collect()
    }

    /// Checks that a grammar begins with this dictionary.
    pub(super) fn check(&self, grammar: &InstanceGrammar) -> Result<(), CompactError> {
        let templates = grammar.templates.starts_with(&self.grammar.templates);
        match templates && grammar.rules.starts_with(&self.rules()) {
            true => Ok(()),
            false => Err(CompactError::Dictionary(
                "the grammar does not begin with the dictionary's templates and rules".to_owned(),
            )),
        }
    }
}

pub(super) fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The bytes of the dictionary beside the grammar at `path`; their digest has to be `wanted`.
pub(super) fn bytes_beside(path: &Path, wanted: &str) -> Result<Vec<u8>, CompactError> {
    let path = path.with_file_name(DICTIONARY);
    let bytes = read_bytes(&path).map_err(|e| CompactError::Dictionary(e.to_string()))?;
    match sha256(&bytes) {
        found if found == wanted => Ok(bytes),
        found => Err(CompactError::Dictionary(format!(
            "{} has the SHA-256 {found}, expected {wanted}",
            path.display()
        ))),
    }
}
