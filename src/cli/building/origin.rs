//! Facts that a house of a run follows from, as its report remembers them, so that the same house is not made twice.

use std::path::Path;

use clap::ValueEnum;
use edifice_base::{Error, Result};
use edifice_building_exteriors::house::{Database, Options};
use edifice_editing::building_exteriors::draws::Order;
use edifice_editing::building_exteriors::redraws::Redraws;
use edifice_io::building_json;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::output::Format;

/// Keys of a report: the digest of all that the house follows from, and the formats of its files that were made from it.
const DIGEST: &str = "made_from";
const FORMATS: &str = "formats";

/// All that the houses of a run follow from, beside their rows.
pub(super) struct Origin {
    digest: String,
    /// True if a house may have another row than its own, which depends on its number.
    redrawn: bool,
}

impl Origin {
    pub(super) fn new(
        database: &Database,
        options: &Options,
        seed: u64,
        redraws: Option<&Redraws>,
    ) -> Result<Self> {
        let mut hasher = Sha256::new();
        let version = env!("CARGO_PKG_VERSION");
        hasher.update(format!("{version} {options:?} {seed} "));
        for building in &database.buildings {
            let text = building_json::to_string(building).map_err(Error::method)?;
            hasher.update(text);
        }
        if let Some(redraws) = redraws {
            hasher.update(redraws.text()?);
        }
        Ok(Self {
            digest: hex(&hasher.finalize()),
            redrawn: redraws.is_some(),
        })
    }

    /// The digest of the `number`th house.
    pub(super) fn of(&self, number: usize, order: &Order) -> String {
        let number = self.redrawn.then_some(number);
        let text = format!("{} {number:?} {order:?}", self.digest);
        hex(&Sha256::digest(text))
    }
}

fn hex(bytes: &[u8]) -> String {
    let pairs = bytes[..16].iter().map(|byte| format!("{byte:02x}"));
    pairs.collect()
}

/// The report of a house of an earlier run, if it was made from the same.
pub(super) struct Before {
    digest: String,
    /// The report, and the formats of which it tells.
    report: Option<(String, Vec<String>)>,
}

impl Before {
    /// Looks for the report; one without a digest, as older ones are, tells nothing.
    pub(super) fn read(path: &Path, digest: String) -> Self {
        let known = || {
            let text = std::fs::read_to_string(path).ok()?;
            let value: Value = serde_json::from_str(&text).ok()?;
            let same = value[DIGEST].as_str() == Some(&digest);
            let formats = value[FORMATS].as_array()?.iter();
            let formats = formats.map(|f| f.as_str().map(str::to_owned));
            let formats = formats.collect::<Option<Vec<_>>>()?;
            same.then(|| (text.trim_end().to_owned(), formats))
        };
        let report = known();
        Self { digest, report }
    }

    /// The line of the report, if all files of the wanted formats were made with it and are there.
    pub(super) fn line(&self, folder: &Path, name: &str, wanted: &[Format]) -> Option<&str> {
        let (line, formats) = self.report.as_ref()?;
        let is_there = |format: &Format| {
            let files = format.endings().iter();
            let mut files = files.map(|ending| folder.join(format!("{name}.{ending}")));
            formats.contains(&word(*format)) && files.all(|file| file.is_file())
        };
        wanted.iter().all(is_there).then_some(line)
    }

    /// Writes into a report which files were made now, beside those that were made from the same before.
    pub(super) fn note(&self, report: &mut Value, made: &[Format]) {
        let before = self.report.iter().flat_map(|(_, formats)| formats.clone());
        let all = before.chain(made.iter().map(|f| word(*f)));
        let all: std::collections::BTreeSet<String> = all.collect();
        report[DIGEST] = json!(self.digest);
        report[FORMATS] = json!(all);
    }
}

/// The name of a format on the command line.
fn word(format: Format) -> String {
    let value = format.to_possible_value();
    value.map_or_else(String::new, |v| v.get_name().to_owned())
}
