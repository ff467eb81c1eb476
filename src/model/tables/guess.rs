//! A schema guessed from the texts of a table.

use std::collections::BTreeMap;

use edifice_base::csv::MISSING;
use rustc_hash::FxHashSet;

use super::schema::{Kind, Schema, SchemaError, SchemaGroup};

/// Different texts up to which a column may be a category, whatever the number of rows.
const FEW_CATEGORIES: usize = 10;
/// Different texts beyond which it is free text, whatever the number of rows.
const MOST_CATEGORIES: usize = 100;
/// Least mean number of rows of a category.
const ROWS_PER_CATEGORY: usize = 5;

impl Schema {
    /// Guesses a schema, one attribute a column: columns of two texts that say yes and no are binary, other numbers
    /// are continuous, texts that repeat are categories, and so are numbers of few different values (a density over such
    /// values has no upper bound). Usual signs for "not known" are missing.
    ///
    /// # Errors
    /// [`SchemaError::FreeText`] for a column of many different texts, [`SchemaError::NoValues`] for one without any: a
    /// schema written by hand can leave them out, and [`Schema::guess_some`] does.
    pub fn guess(header: &[String], rows: &[Vec<String>]) -> Result<Self, SchemaError> {
        let (schema, left_out) = Self::guess_some(header, rows);
        match left_out.into_iter().next() {
            Some(error) => Err(error),
            None => Ok(schema),
        }
    }

    /// As [`Schema::guess`] for every table: columns of free text and columns without a value are left out, and returned with the reason.
    pub fn guess_some(header: &[String], rows: &[Vec<String>]) -> (Self, Vec<SchemaError>) {
        let mut groups = Vec::with_capacity(header.len());
        let mut left_out = Vec::new();
        for (c, column) in header.iter().enumerate() {
            let texts = rows.iter().filter_map(|row| row.get(c)).map(|t| t.trim());
            let texts: Vec<&str> = texts.filter(|t| !MISSING.contains(t)).collect();
            match kind(column, &texts) {
                Ok(kind) => groups.push(SchemaGroup {
                    name: column.clone(),
                    kind,
                    columns: vec![column.clone()],
                }),
                Err(error) => left_out.push(error),
            }
        }
        let schema = Self {
            keep: BTreeMap::new(),
            missing: MISSING.map(str::to_owned).to_vec(),
            groups,
            relations: None,
        };
        (schema, left_out)
    }
}

fn kind(column: &str, texts: &[&str]) -> Result<Kind, SchemaError> {
    let few = (texts.len() / ROWS_PER_CATEGORY).min(FEW_CATEGORIES);
    let most = (texts.len() / ROWS_PER_CATEGORY).clamp(FEW_CATEGORIES, MOST_CATEGORIES);
    // Columns of many different numbers are not counted to the end.
    let different = different(texts, most);
    if different.is_empty() {
        return Err(SchemaError::NoValues {
            column: column.to_owned(),
        });
    }
    let pair = |no: &str, yes: &str| different.iter().all(|t| t == no || t == yes);
    if pair("0", "1") || pair("no", "yes") || pair("false", "true") {
        return Ok(Kind::Binary);
    }
    let number = |text: &&str| text.parse().is_ok_and(f64::is_finite);
    if different.len() > few && texts.iter().all(number) {
        return Ok(Kind::Continuous);
    }
    match different.len() <= most {
        true => Ok(Kind::Category),
        false => Err(SchemaError::FreeText {
            column: column.to_owned(),
            different: self::different(texts, texts.len()).len(),
            cells: texts.len(),
        }),
    }
}

/// The different texts, by letters without regard to their case; no more than one beyond `most`.
fn different(texts: &[&str], most: usize) -> FxHashSet<String> {
    let mut found = FxHashSet::default();
    let mut lower = String::new();
    for text in texts {
        lower.clear();
        lower.push_str(text);
        lower.make_ascii_lowercase();
        if !found.contains(&lower) {
            found.insert(lower.clone());
            if found.len() > most {
                break;
            }
        }
    }
    found
}
