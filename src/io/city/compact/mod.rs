//! Instance grammars in few bytes: `*.city-grammar.bin`, format `edifice/city-grammar-compact`, versions 1 to 5.
//!
//! | bytes | what |
//! | --- | --- |
//! | 4 | `EdCG` |
//! | 2 | version, like all whole numbers little-endian |
//! | 4 | CRC-32 of all that follows |
//! | 4 | bytes of the next part |
//! | | names, identifiers, attributes, steps and textures: JSON, deflated (RFC 1951) |
//! | 4 | bytes of the next part (from version 2 on) |
//! | | templates, then rules and the numbers of instances, by a range coder with learnt probabilities |
//! | to the end | residuals: where parts of instances stand, by a coder of their own; empty where there are none |
//!
//! Whoever needs no residuals leaves the last part unread. Until version 2, buildings follow Hilbert's curve; from version 3 on they go along
//! rows, each told by its place beside the one before it (`rows.rs`). In version 1, rules have no parameters, and residuals follow the
//! rules in one part. In version 4 a dictionary in another file has the first templates and rules ([`Dictionary`]), which in version 5 it may have, too.
//! In version 5 districts, blocks and rows are not written as rules, but as what each building begins, two bits by the coder before the
//! rules ([`edifice_grammar::instance::Begins`]), where the flat grammar and these make the same rules again (`tree.rs`).
//!
//! Lengths, turns and templates' corners are whole steps ([`Steps`]), chosen so that nothing is lost where a grammar lies on
//! any of the steps that are tried; otherwise it is rounded to the finest. A file holds what the text
//! ([`super::grammar_json`]) holds, but for the order of the axiom's successors where they are buildings (so that neighbours
//! follow each other), that of a template's corners and triangles, and corners without a triangle.

mod dictionary;
mod error;
mod identity;
mod integers;
mod mesh;
mod names;
mod order;
mod packing;
mod range_coder;
mod rows;
mod rules;
mod steps;
mod tree;
mod unit;

use std::path::Path;

use serde::{Deserialize, Serialize};

pub use self::dictionary::{DICTIONARY, Dictionary};
pub use self::error::{ARRANGED, CompactError, VERSION};
use self::error::{FIRST, SHARING};
use self::identity::{Attributes, Identities};
use self::mesh::{MeshModels, StepMesh};
use self::names::{Names, names, runs};
use self::packing::{checksum, deflated, inflated};
use self::range_coder::{Coder, Decoder, Encoder};
use self::rules::Rules;
use self::tree::Tree;
pub use self::unit::Steps;
use super::pictures;
use edifice_base::file::read_bytes;
use edifice_base::{Error, Result};
use edifice_grammar::instance::{InstanceGrammar, InstanceRule, Template};
use edifice_io::write_atomic;
use edifice_shape::triangles::TriangleMesh;

/// The first bytes of a file.
const MAGIC: [u8; 4] = *b"EdCG";
/// Bytes before the checked part.
const START: usize = 10;

/// Reads a grammar and checks that it derives; a dictionary that it shares is read from [`DICTIONARY`] beside it.
///
/// # Errors
/// Names the file.
pub fn read(path: &Path) -> Result<InstanceGrammar> {
    let bytes = read_bytes(path)?;
    let beside = |wanted: &str| {
        let bytes = dictionary::bytes_beside(path, wanted)?;
        dictionary(&bytes).map_err(|e| CompactError::Dictionary(e.to_string()))
    };
    decoded(&bytes, &beside).map_err(|e| Error::content(path, e))
}

/// The dictionary of a file's bytes.
///
/// # Errors
/// As [`from_bytes`].
pub fn dictionary(bytes: &[u8]) -> Result<Dictionary, CompactError> {
    Ok(Dictionary {
        sha256: dictionary::sha256(bytes),
        grammar: from_bytes(bytes)?,
    })
}

/// Writes a grammar, whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written; [`CompactError`] on a grammar that is not sound.
pub fn write(grammar: &InstanceGrammar, path: &Path) -> Result<()> {
    write_atomic(
        path,
        &to_bytes(grammar).map_err(|e| Error::content(path, e))?,
    )
}

/// The texts of a file, and the few numbers that stand among them.
#[derive(Serialize, Deserialize)]
struct Texts {
    name: String,
    reference_system: Option<String>,
    origin: [f64; 3],
    axiom: usize,
    steps: Steps,
    /// Names of the templates, then of the non-terminals.
    templates: Vec<Names>,
    non_terminals: Vec<Names>,
    ids: Vec<String>,
    attributes: Vec<Attributes>,
    /// Templates' textures as data URIs, with their templates.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    textures: Vec<(usize, String)>,
    /// SHA-256 of the dictionary that has the first templates and rules.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dictionary: Option<String>,
    /// The grid of the flat grammar of districts, blocks and rows: steps of a metre and of a degree.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    arranged: Option<[f64; 2]>,
}

/// The bytes of a grammar.
///
/// # Errors
/// [`CompactError`] on a grammar that is not sound, and on numbers too large to be lengths.
pub fn to_bytes(grammar: &InstanceGrammar) -> Result<Vec<u8>, CompactError> {
    encoded(grammar, None)
}

/// The bytes of a grammar without those templates and rules that it shares with others.
///
/// # Errors
/// As [`to_bytes`]; [`CompactError::Dictionary`] on a grammar that does not begin with the dictionary.
pub fn to_bytes_over(
    grammar: &InstanceGrammar,
    dictionary: &Dictionary,
) -> Result<Vec<u8>, CompactError> {
    dictionary.check(grammar)?;
    encoded(grammar, Some(dictionary))
}

fn encoded(
    grammar: &InstanceGrammar,
    dictionary: Option<&Dictionary>,
) -> Result<Vec<u8>, CompactError> {
    grammar.check()?;
    let tree = Tree::of(grammar);
    let rows = grammar.rules.iter().any(|r| r.row);
    let version = match dictionary {
        _ if tree.is_some() || rows => ARRANGED,
        Some(_) => SHARING,
        None => VERSION,
    };
    let grammar = tree.as_ref().map_or(grammar, |t| &t.flat);
    let shared = dictionary.map_or(0, |d| d.grammar.templates.len());
    let known = dictionary.map_or_else(Vec::new, Dictionary::rules);
    let steps = Steps::of(grammar);
    let mut symbols: Vec<String> = grammar.templates.iter().map(|t| t.symbol.clone()).collect();
    let templates = symbols.len();
    let mut seen = rustc_hash::FxHashSet::default();
    let new = grammar.rules.iter().filter(|r| seen.insert(&r.symbol));
    symbols.extend(new.map(|r| r.symbol.clone()));
    let axiom = symbols.iter().position(|s| *s == grammar.axiom);
    let axiom = axiom.ok_or(CompactError::Index("symbol"))?;
    let mut coder = Encoder::new();
    let mut models = MeshModels::new(steps.shape);
    for template in &grammar.templates[shared..] {
        models.code(&mut coder, &in_steps(&template.mesh, steps.shape)?)?;
    }
    let mut sorted = grammar.rules.clone();
    let loose = sorted.iter_mut().filter(|_| tree.is_none());
    for rule in loose.filter(|r| r.symbol == grammar.axiom) {
        order::along_rows(&mut rule.successors, &steps);
    }
    let mut rules = Rules::new(
        coder,
        steps,
        &symbols,
        templates,
        Identities::default(),
        version,
    );
    if let Some(tree) = &tree {
        rules.begins(&tree.begins)?;
    }
    let mut made = rules.rules(&sorted, &known, axiom)?;
    let mut residuals = Vec::new();
    let mut coder = None;
    if sorted
        .iter()
        .flat_map(|r| &r.successors)
        .any(|p| !p.parts.is_empty())
    {
        coder = Some(rules.switch(Encoder::new()));
        rules.residuals(&sorted, &mut made)?;
    }
    let (last, identities) = rules.finish();
    let coder = match coder {
        Some(first) => {
            residuals = last.finish();
            first
        }
        None => last,
    };
    let textures = grammar.templates.iter().enumerate();
    let textures =
        textures.filter_map(|(i, t)| Some((i, pictures::data_uri(t.texture.as_deref()?))));
    let texts = Texts {
        name: grammar.name.clone(),
        reference_system: grammar.reference_system.clone(),
        origin: grammar.origin,
        axiom,
        steps,
        templates: runs(&symbols[shared..templates]),
        non_terminals: runs(&symbols[templates + symbols_of(&known)..]),
        ids: identities.texts,
        attributes: identities.attributes,
        textures: textures.collect(),
        dictionary: dictionary.map(|d| d.sha256.clone()),
        arranged: tree.map(|t| [t.grid.length, t.grid.turn]),
    };
    let texts = serde_json::to_vec(&texts).map_err(|e| CompactError::Text(e.to_string()))?;
    let texts = deflated(&texts);
    let size = u32::try_from(texts.len()).map_err(|_| CompactError::TooLarge("bytes of text"))?;
    let mut body = size.to_le_bytes().to_vec();
    body.extend(texts);
    let coded = coder.finish();
    let size = u32::try_from(coded.len()).map_err(|_| CompactError::TooLarge("bytes of rules"))?;
    body.extend(size.to_le_bytes());
    body.extend(coded);
    body.extend(residuals);
    let mut bytes = MAGIC.to_vec();
    bytes.extend(version.to_le_bytes());
    bytes.extend(checksum(&body).to_le_bytes());
    bytes.extend(body);
    Ok(bytes)
}

/// The grammar of a file's bytes.
///
/// # Errors
/// [`CompactError`].
pub fn from_bytes(bytes: &[u8]) -> Result<InstanceGrammar, CompactError> {
    decoded(bytes, &|wanted| {
        let message =
            format!("it has the SHA-256 {wanted}, and bytes alone have no file beside them");
        Err(CompactError::Dictionary(message))
    })
}

/// The number of symbols of rules.
fn symbols_of(rules: &[InstanceRule]) -> usize {
    let symbols: rustc_hash::FxHashSet<&str> = rules.iter().map(|r| r.symbol.as_str()).collect();
    symbols.len()
}

fn decoded(
    bytes: &[u8],
    shared: &dyn Fn(&str) -> Result<Dictionary, CompactError>,
) -> Result<InstanceGrammar, CompactError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(CompactError::Magic);
    }
    let Some((start, body)) = bytes.split_at_checked(START) else {
        return Err(CompactError::Truncated);
    };
    let version = u16::from_le_bytes([start[4], start[5]]);
    if !(FIRST..=ARRANGED).contains(&version) {
        return Err(CompactError::Version(version));
    }
    if u32::from_le_bytes([start[6], start[7], start[8], start[9]]) != checksum(body) {
        return Err(CompactError::Checksum);
    }
    let (texts, rest) = sized(body)?;
    let (coded, residuals) = match version {
        FIRST => (rest, &[][..]),
        _ => sized(rest)?,
    };
    let texts: Texts =
        serde_json::from_slice(&inflated(texts)?).map_err(|e| CompactError::Text(e.to_string()))?;
    let steps = texts.steps.checked()?;
    let shared = match (version, texts.dictionary.as_deref()) {
        (SHARING | ARRANGED, Some(wanted)) => Some(shared(wanted)?),
        _ => None,
    };
    let known = shared.as_ref().map_or_else(Vec::new, Dictionary::rules);
    let mut templates = shared.map_or_else(Vec::new, |d| d.grammar.templates);
    let first = templates.len();
    let mut symbols: Vec<String> = templates.iter().map(|t| t.symbol.clone()).collect();
    symbols.extend(names(&texts.templates)?);
    let count = symbols.len();
    let mut seen = rustc_hash::FxHashSet::default();
    let new = known.iter().filter(|r| seen.insert(&r.symbol));
    symbols.extend(new.map(|r| r.symbol.clone()));
    symbols.extend(names(&texts.non_terminals)?);
    let mut coder = Decoder::new(coded);
    let mut models = MeshModels::new(steps.shape);
    for symbol in &symbols[first..count] {
        if coder.exhausted() {
            return Err(CompactError::Truncated);
        }
        let mesh = models.code(&mut coder, &StepMesh::default())?;
        templates.push(Template {
            symbol: symbol.clone(),
            mesh: in_box(&mesh, steps.shape),
            texture: None,
        });
    }
    for (i, uri) in &texts.textures {
        let template = templates
            .get_mut(*i)
            .ok_or(CompactError::Index("texture"))?;
        let texture = pictures::from_data_uri(uri);
        template.texture = Some(texture.map_err(|e| CompactError::Text(e.to_string()))?);
    }
    let axiom = symbols.get(texts.axiom).cloned();
    let identities = Identities::new(texts.ids, texts.attributes);
    let mut rules = Rules::new(coder, steps, &symbols, count, identities, version);
    let grid = texts.arranged.filter(|_| version >= ARRANGED);
    let grid = grid.map(tree::grid).transpose()?;
    if grid.is_some() {
        rules.begins(&[])?;
    }
    let mut made = rules.rules(&[], &known, texts.axiom)?;
    let begins = rules.told();
    if version > FIRST && !residuals.is_empty() {
        if rules.switch(Decoder::new(residuals)).exhausted() {
            return Err(CompactError::Truncated);
        }
        rules.residuals(&[], &mut made)?;
    } else if version == FIRST {
        rules.residuals(&[], &mut made)?;
    }
    let grammar = InstanceGrammar {
        name: texts.name,
        reference_system: texts.reference_system,
        origin: texts.origin,
        axiom: axiom.ok_or(CompactError::Index("symbol"))?,
        templates,
        rules: made,
    };
    match rules.finish().0.exhausted() {
        true => Err(CompactError::Truncated),
        false => {
            grammar.check()?;
            steps::writable(&grammar)?;
            let Some(grid) = grid else {
                return Ok(grammar);
            };
            // Without this, buildings of which nothing is told would be left out.
            if grammar.top().map_or(0, |r| r.successors.len()) != begins.len() {
                return Err(CompactError::Index("building"));
            }
            let grammar = grammar.arranged(&begins, &grid);
            grammar.check()?;
            Ok(grammar)
        }
    }
}

/// A part after its number of bytes, and the rest.
fn sized(bytes: &[u8]) -> Result<(&[u8], &[u8]), CompactError> {
    let (size, rest) = bytes
        .split_first_chunk::<4>()
        .ok_or(CompactError::Truncated)?;
    let size = u32::from_le_bytes(*size) as usize;
    rest.split_at_checked(size).ok_or(CompactError::Truncated)
}

fn in_steps(mesh: &TriangleMesh, shape: i64) -> Result<StepMesh, CompactError> {
    let step = |v: f64| steps::in_steps(v, shape);
    let mut out = StepMesh::default();
    for p in &mesh.positions {
        let corner = [step(p[0] + 0.5)?, step(p[1] + 0.5)?, step(p[2])?];
        out.corners.push(corner);
    }
    out.triangles.clone_from(&mesh.triangles);
    Ok(out)
}

fn in_box(mesh: &StepMesh, steps: i64) -> TriangleMesh {
    let unit = |v: i64| v as f64 / steps as f64;
    let corners = mesh.corners.iter();
    TriangleMesh {
        positions: corners
            .map(|c| [unit(c[0]) - 0.5, unit(c[1]) - 0.5, unit(c[2])])
            .collect(),
        triangles: mesh.triangles.clone(),
    }
}
