//! Parametric libraries and encoded facades as JSON: `*.library.json`, format `edifice/grammar-library`, and
//! `*.encoded.json`, format `edifice/encoded-facade`, both version 1.
//!
//! ```json
//! { "format": "edifice/grammar-library", "version": 1, "unit": "px", "step": 1.0, "labels": ["wall", "window"],
//!   "rules": [ { "axis": "x", "items": [ { "repeat": ["wall", "window"] }, "wall" ] },
//!              { "axis": "y", "items": [ { "repeat": ["wall", 0] }, "wall" ] } ],
//!   "facades": [ { "name": "a", "root": 1, "width": 70, "height": 90, "counts": [2, 3, 3],
//!                  "sizes": [10, 30, 10, 30, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10] } ] }
//! ```
//! - An item is a label (text), an earlier rule (its index from 0), or a repeat of such; a rule splits along its axis.
//! - `root` is a label or the index of a rule. `width`, `height` and `sizes` are in steps: `step` times so many `unit`.
//! - `counts` say how often each repeat stands, at least 2, and `sizes` how large each part is but the last one of a
//!   region: region by region in the order of the derivation, each followed by its parts from left to right, or from the
//!   bottom up.
//! - A probabilistic reading needs nothing else: all distributions follow from the facades, in their order.
//!
//! An encoded facade is `{ "format": "edifice/encoded-facade", "version": 1, "name": "a", "library": "0f...", "bits": 164.25,
//! "code": "..." }`: the arithmetic code in base64, its length before it is filled up to bytes, and a digest of the library that
//! it was written with ([`digest`]).

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use edifice_base::{Error, Result};
use edifice_grammar::parametric::{
    Item, Library, LibraryError, Member, Parse, Rule, Rules, Symbol,
};
use edifice_shape::Axis;
use serde::{Deserialize, Serialize};

use super::json::{check_header, parse_json};
use super::{json_kind, read_bytes, write_atomic};

/// The value of the key `format` of a library.
pub const FORMAT: &str = "edifice/grammar-library";
/// The value of the key `format` of an encoded facade.
pub const CODE_FORMAT: &str = "edifice/encoded-facade";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
struct File {
    format: String,
    version: u64,
    unit: String,
    step: f64,
    labels: Vec<String>,
    rules: Vec<FileRule>,
    facades: Vec<FileFacade>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRule {
    axis: Axis,
    items: Vec<FileItem>,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum FileItem {
    Part(FileSymbol),
    Repeat(FileRepeat),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRepeat {
    repeat: Vec<FileSymbol>,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum FileSymbol {
    Rule(u32),
    Label(String),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileFacade {
    name: String,
    root: FileSymbol,
    width: u32,
    height: u32,
    counts: Vec<u32>,
    sizes: Vec<u32>,
}

#[derive(Serialize, Deserialize)]
struct FileCode {
    format: String,
    version: u64,
    name: String,
    library: String,
    bits: f64,
    code: String,
}

/// A facade written with a library.
#[derive(Debug, Clone, PartialEq)]
pub struct EncodedFacade {
    /// Its name.
    pub name: String,
    /// Digest of the library.
    pub library: String,
    /// Length of the code.
    pub bits: f64,
    /// The code.
    pub bytes: Vec<u8>,
}

/// True if the bytes begin as a JSON object that names the format of a library.
pub fn is_library(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(400)]);
    head.contains(&format!("\"{FORMAT}\""))
}

/// Reads a library.
///
/// # Errors
/// Names the file and the JSON path of what is wrong.
pub fn read(path: &Path) -> Result<Library> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a library; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Library> {
    check_header(bytes, path, FORMAT, VERSION)?;
    let file: File = parse_json(bytes, path)?;
    if !(file.step.is_finite() && file.step > 0.0) {
        return Err(Error::input(path, "step", "expected a positive number"));
    }
    let known = |place: &str, symbol: &FileSymbol| match symbol {
        FileSymbol::Rule(rule) => Ok(Symbol::Rule(*rule)),
        FileSymbol::Label(label) => match file.labels.iter().position(|own| own == label) {
            Some(label) => Ok(Symbol::Terminal(label as u32)),
            None => Err(Error::input(
                path,
                place,
                format!("{label:?} is none of the labels"),
            )),
        },
    };
    let mut rules = Vec::with_capacity(file.rules.len());
    for (k, rule) in file.rules.iter().enumerate() {
        let item = |(n, item): (usize, &FileItem)| {
            let place = format!("rules[{k}].items[{n}]");
            Ok(match item {
                FileItem::Part(symbol) => Item::Part(known(&place, symbol)?),
                FileItem::Repeat(repeat) => {
                    let symbols = repeat.repeat.iter().map(|symbol| known(&place, symbol));
                    Item::Repeat(symbols.collect::<Result<_>>()?)
                }
            })
        };
        let items = rule
            .items
            .iter()
            .enumerate()
            .map(item)
            .collect::<Result<_>>()?;
        rules.push(Rule {
            axis: rule.axis,
            items,
        });
    }
    let member = |(k, facade): (usize, &FileFacade)| {
        let root = known(&format!("facades[{k}].root"), &facade.root)?;
        let parse = Parse {
            root,
            extent: [facade.width, facade.height],
            counts: facade.counts.clone(),
            sizes: facade.sizes.clone(),
        };
        Ok(Member {
            name: facade.name.clone(),
            parse,
        })
    };
    let members = file
        .facades
        .iter()
        .enumerate()
        .map(member)
        .collect::<Result<_>>()?;
    let rules = Rules::from_parts(file.labels.clone(), rules).map_err(|e| placed(path, e))?;
    Library::from_members(file.unit, file.step, rules, members).map_err(|e| placed(path, e))
}

/// The error of a library with its file.
fn placed(path: &Path, error: LibraryError) -> Error {
    match error {
        LibraryError::Invalid { place, message } => Error::input(path, place, message),
        other => Error::content(path, other),
    }
}

/// Writes a library, whole or not at all.
///
/// # Errors
/// [`Error::Option`] for an ending of other files, such as `.facade.json`; [`Error::Io`] when the file cannot be written.
pub fn write(library: &Library, path: &Path) -> Result<()> {
    json_kind::check(path, "library")?;
    write_atomic(path, to_string(library)?.as_bytes())
}

/// The text of a library: one rule and one facade a line.
///
/// # Errors
/// [`Error::Method`] when a value has no JSON.
pub fn to_string(library: &Library) -> Result<String> {
    let symbol = |symbol: Symbol| match symbol {
        Symbol::Rule(rule) => FileSymbol::Rule(rule),
        Symbol::Terminal(label) => {
            FileSymbol::Label(library.rules().labels()[label as usize].clone())
        }
    };
    let item = |item: &Item| match item {
        Item::Part(part) => FileItem::Part(symbol(*part)),
        Item::Repeat(period) => FileItem::Repeat(FileRepeat {
            repeat: period.iter().map(|&part| symbol(part)).collect(),
        }),
    };
    let line = |value: serde_json::Result<String>| value.map_err(Error::method);
    let mut rules = Vec::new();
    for rule in library.rules().rules() {
        let rule = FileRule {
            axis: rule.axis,
            items: rule.items.iter().map(item).collect(),
        };
        rules.push(line(serde_json::to_string(&rule))?);
    }
    let mut facades = Vec::new();
    for member in library.members() {
        let facade = FileFacade {
            name: member.name.clone(),
            root: symbol(member.parse.root),
            width: member.parse.extent[0],
            height: member.parse.extent[1],
            counts: member.parse.counts.clone(),
            sizes: member.parse.sizes.clone(),
        };
        facades.push(line(serde_json::to_string(&facade))?);
    }
    let unit = serde_json::Value::from(library.unit());
    let step = serde_json::Value::from(library.step());
    let labels = line(serde_json::to_string(library.rules().labels()))?;
    Ok(format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": {VERSION}, \"unit\": {unit}, \"step\": {step},\n\"labels\": {labels},\n\
         \"rules\": [\n{}\n],\n\"facades\": [\n{}\n] }}\n",
        rules.join(",\n"),
        facades.join(",\n")
    ))
}

/// A digest of a library, 16 hexadecimal digits: FNV-1a (64 bits) of its text. It tells libraries apart by accident,
/// not against ill will.
///
/// # Errors
/// As [`to_string`].
pub fn digest(library: &Library) -> Result<String> {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for byte in to_string(library)?.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
    Ok(format!("{hash:016x}"))
}

/// Writes an encoded facade, whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write_code(code: &EncodedFacade, path: &Path) -> Result<()> {
    let file = FileCode {
        format: CODE_FORMAT.to_owned(),
        version: VERSION,
        name: code.name.clone(),
        library: code.library.clone(),
        bits: code.bits,
        code: STANDARD.encode(&code.bytes),
    };
    let mut bytes = serde_json::to_vec(&file).map_err(Error::method)?;
    bytes.push(b'\n');
    write_atomic(path, &bytes)
}

/// Reads an encoded facade.
///
/// # Errors
/// Names the file and the JSON path of what is wrong.
pub fn read_code(path: &Path) -> Result<EncodedFacade> {
    let bytes = read_bytes(path)?;
    check_header(&bytes, path, CODE_FORMAT, VERSION)?;
    let file: FileCode = parse_json(&bytes, path)?;
    let code = STANDARD
        .decode(&file.code)
        .map_err(|e| Error::input(path, "code", e))?;
    Ok(EncodedFacade {
        name: file.name,
        library: file.library,
        bits: file.bits,
        bytes: code,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"{ "format": "edifice/grammar-library", "version": 1, "unit": "px", "step": 1.0, "labels": ["wall", "window"],
        "rules": [ { "axis": "x", "items": [ { "repeat": ["wall", "window"] }, "wall" ] },
                   { "axis": "y", "items": [ { "repeat": ["wall", 0] }, "wall" ] } ],
        "facades": [ { "name": "a", "root": 1, "width": 70, "height": 90, "counts": [2, 3, 3],
                       "sizes": [10, 30, 10, 30, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10] } ] }"#;

    #[test]
    fn the_example_is_read_and_written_again() {
        let path = Path::new("a.library.json");
        let library = parse(TEXT.as_bytes(), path).unwrap();
        let facade = library.facade(&library.members()[0].parse, "a").unwrap();
        assert_eq!(facade.regions.len(), 17);
        let again = parse(to_string(&library).unwrap().as_bytes(), path).unwrap();
        assert_eq!(again.members(), library.members());
        assert_eq!(digest(&again).unwrap(), digest(&library).unwrap());
        let code = library.encode(&facade).unwrap();
        assert_eq!(
            again.decode(&code.bytes, "a").unwrap().regions,
            facade.regions
        );
    }

    #[test]
    fn what_is_wrong_is_placed() {
        let wrong = |from: &str, to: &str| {
            let text = TEXT.replacen(from, to, 1);
            parse(text.as_bytes(), Path::new("a.library.json"))
                .unwrap_err()
                .to_string()
        };
        assert!(wrong("[\"wall\", 0]", "[\"wall\", 1]").contains("rules[1].items[0]"));
        assert!(wrong("[\"wall\", 0]", "[\"roof\", 0]").contains("\"roof\" is none of the labels"));
        assert!(wrong("\"root\": 1", "\"root\": 7").contains("rule 7"));
        assert!(wrong("[2, 3, 3]", "[2, 3]").contains("counts[2]"));
        assert!(wrong("[10, 30, 10", "[10, 90, 10").contains("sizes[1]"));
        assert!(wrong("\"version\": 1", "\"version\": 2").contains("version"));
    }
}
