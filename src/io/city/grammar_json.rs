//! Instance grammars as JSON: `*.city-grammar.json`, format `edifice/city-grammar`, versions 1 and 2.
//!
//! ```json
//! { "format": "edifice/city-grammar", "version": 1, "name": "midtown", "unit": "m", "up": "z",
//!   "reference_system": null, "origin": [0, 0, 0], "axiom": "City", "steps": 4095,
//!   "templates": [ { "symbol": "T1", "positions": [0, 0, 0, 4095, 0, 0, 0, 4095, 4095], "triangles": [0, 1, 2] } ],
//!   "rules": [
//!     { "symbol": "City", "weight": 1, "successors": [
//!       { "symbol": "B1", "at": [10.5, 3, 0], "turn": 30, "id": "b17", "attributes": { "year": 1931 } } ] },
//!     { "symbol": "B1", "weight": 1, "successors": [
//!       { "symbol": "T1", "size": [20, 12, 30] }, { "symbol": "T1", "at": [1, 0, 30], "size": [8, 8, 5] } ] } ] }
//! ```
//! A symbol with a rule is a non-terminal. Positions of templates are in steps of the unit box, of which x and
//! y are then shifted by -1/2; `size` is a template's width, depth and height in metres, or one factor for a
//! non-terminal; `turn` is in degrees, counterclockwise from above. Left out are `at` and `turn` where they are 0 and
//! `size` where it is 1. `texture`, of a template, is a picture as a data URI: its sides that look along +x, +y, -x and -y, and its
//! top, one beside the other, each a fifth of the width. `parts`, on an instance of a non-terminal, lists where its successors really stand
//! (`null`: absent).
//!
//! Version 2, written where a rule has parameters or factors: a rule's `"parameters": ["w", "d", "h1", "h2"]` say that its
//! successors' lengths are in shares of a width and a depth, and heights in levels (`InstanceRule::part`); `numbers`, on an
//! instance, are their values in metres; `scale`, on a rule, three factors of what it puts down. With several rules for a symbol a derivation takes the first one; synthesis draws
//! by weight.

mod file;

use std::path::Path;

use self::file::{File, FileTemplate, Number, levels_of, parameters, placement_file, rule_of};
use super::pictures;
use edifice_base::{Error, Result};
use edifice_grammar::instance::{InstanceGrammar, Template};
use edifice_io::json::{check_versions, parse_json};
use edifice_io::{read_bytes, write_atomic};
use edifice_shape::triangles::TriangleMesh;

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/city-grammar";
/// The newest version; it is written where a rule has parameters or factors, version 1 otherwise.
pub const VERSION: u64 = 3;
/// The version of rules with parameters and factors, but without rows.
const PARAMETRIC: u64 = 2;
/// The oldest version that is read.
const FIRST: u64 = 1;
/// Steps of the unit box: the first of these on which all positions lie, or else the last.
const STEPS: [f64; 2] = [4095.0, 65_535.0];

/// Reads a grammar and checks that it derives.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<InstanceGrammar> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a grammar; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<InstanceGrammar> {
    check_versions(bytes, path, FORMAT, FIRST..=VERSION)?;
    let file: File = parse_json(bytes, path)?;
    for (key, found, expected) in [("unit", &file.unit, "m"), ("up", &file.up, "z")] {
        if found != expected {
            let text = format!("{found:?}, expected {expected:?}");
            return Err(Error::input(path, key, text));
        }
    }
    if !(file.steps.is_finite() && file.steps > 0.0) {
        return Err(Error::input(path, "steps", format!("{} steps", file.steps)));
    }
    let mut templates = Vec::new();
    for (i, t) in file.templates.into_iter().enumerate() {
        for (key, length) in [
            ("positions", t.positions.len()),
            ("triangles", t.triangles.len()),
        ] {
            if length % 3 != 0 {
                let place = format!("templates[{i}].{key}");
                return Err(Error::input(
                    path,
                    place,
                    format!("{length} numbers, not threes"),
                ));
            }
        }
        let texture = t
            .texture
            .as_deref()
            .map(pictures::from_data_uri)
            .transpose();
        let texture = texture.map_err(|e| {
            let place = format!("templates[{i}].texture");
            Error::input(path, place, e)
        })?;
        let unit = |v: f64| v / file.steps;
        let positions = t.positions.chunks_exact(3);
        let triangles = t.triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]);
        templates.push(Template {
            symbol: t.symbol,
            mesh: TriangleMesh {
                positions: positions
                    .map(|p| [unit(p[0]) - 0.5, unit(p[1]) - 0.5, unit(p[2])])
                    .collect(),
                triangles: triangles.collect(),
            },
            texture,
        });
    }
    let mut rules = Vec::new();
    for (i, rule) in file.rules.into_iter().enumerate() {
        let levels = levels_of(&rule.parameters).ok_or_else(|| {
            let text = "expected \"w\", \"d\", \"h1\" and so on, one h for each level";
            Error::input(path, format!("rules[{i}].parameters"), text)
        })?;
        rules.push(rule_of(rule, levels));
    }
    let grammar = InstanceGrammar {
        name: file.name,
        reference_system: file.reference_system,
        origin: file.origin,
        axiom: file.axiom,
        templates,
        rules,
    };
    grammar.check().map_err(|e| Error::content(path, e))?;
    Ok(grammar)
}

/// Writes a grammar, whole or not at all; gzipped when the name ends in `.gz`.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write(grammar: &InstanceGrammar, path: &Path) -> Result<()> {
    let packed = path.extension().is_some_and(|e| e == "gz");
    let bytes = to_bytes(grammar, packed).map_err(|e| Error::content(path, e))?;
    write_atomic(path, &bytes)
}

/// The bytes of a grammar, gzipped or not.
///
/// # Errors
/// As [`packed_bytes`].
pub fn to_bytes(grammar: &InstanceGrammar, gzipped: bool) -> serde_json::Result<Vec<u8>> {
    let text = to_string(grammar)?;
    Ok(match gzipped {
        true => packed(text.as_bytes()),
        false => text.into_bytes(),
    })
}

/// Bytes of the gzipped text: what storing and sending a grammar takes.
///
/// # Errors
/// Those of the JSON writer, on numbers that are not finite.
pub fn packed_bytes(grammar: &InstanceGrammar) -> serde_json::Result<usize> {
    Ok(packed(to_string(grammar)?.as_bytes()).len())
}

pub(super) fn packed(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    // Writing to memory does not fail.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

/// The text of a grammar: a template, and a successor, a line.
///
/// # Errors
/// As [`packed_bytes`].
pub fn to_string(grammar: &InstanceGrammar) -> serde_json::Result<String> {
    let steps = steps_of(grammar);
    let newer = grammar
        .rules
        .iter()
        .any(|r| r.levels > 0 || !r.is_unscaled());
    let version = match grammar.rules.iter().any(|r| r.row) {
        true => VERSION,
        false if newer => PARAMETRIC,
        false => FIRST,
    };
    let mut out = format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": {version}, \"name\": {}, \"unit\": \"m\", \"up\": \"z\",\n  \
         \"reference_system\": {}, \"origin\": {}, \"axiom\": {}, \"steps\": {},\n  \"templates\": [",
        serde_json::to_string(&grammar.name)?,
        serde_json::to_string(&grammar.reference_system)?,
        serde_json::to_string(&grammar.origin.map(Number))?,
        serde_json::to_string(&grammar.axiom)?,
        serde_json::to_string(&Number(steps))?,
    );
    for (i, t) in grammar.templates.iter().enumerate() {
        let step = |v: f64| Number(v * steps);
        let positions = t.mesh.positions.iter();
        let positions = positions.flat_map(|p| [step(p[0] + 0.5), step(p[1] + 0.5), step(p[2])]);
        let template = FileTemplate {
            symbol: t.symbol.clone(),
            positions: positions.map(Number::near).collect(),
            triangles: t.mesh.triangles.concat(),
            texture: t.texture.as_deref().map(pictures::data_uri),
        };
        out.push_str(if i == 0 { "\n    " } else { ",\n    " });
        out.push_str(&serde_json::to_string(&template)?);
    }
    out.push_str("\n  ],\n  \"rules\": [");
    for (i, rule) in grammar.rules.iter().enumerate() {
        out.push_str(if i == 0 { "\n    " } else { ",\n    " });
        let (symbol, weight) = (
            serde_json::to_string(&rule.symbol)?,
            serde_json::to_string(&Number(rule.weight))?,
        );
        out.push_str(&format!("{{\"symbol\":{symbol},\"weight\":{weight},"));
        if rule.levels > 0 {
            let names = serde_json::to_string(&parameters(rule.levels))?;
            out.push_str(&format!("\"parameters\":{names},"));
        }
        if rule.row {
            out.push_str("\"row\":true,");
        }
        if !rule.is_unscaled() {
            let factors = serde_json::to_string(&rule.scale.map(Number))?;
            out.push_str(&format!("\"scale\":{factors},"));
        }
        out.push_str("\"successors\":[");
        for (k, s) in rule.successors.iter().enumerate() {
            out.push_str(if k == 0 { "\n      " } else { ",\n      " });
            out.push_str(&serde_json::to_string(&placement_file(s))?);
        }
        out.push_str("]}");
    }
    out.push_str("\n  ] }\n");
    Ok(out)
}

fn steps_of(grammar: &InstanceGrammar) -> f64 {
    let on_grid = |steps: f64| {
        let mut values = grammar.templates.iter().flat_map(|t| &t.mesh.positions);
        values.all(|p| {
            let whole = |v: f64| Number(v * steps).near().fract() == 0.0;
            whole(p[0] + 0.5) && whole(p[1] + 0.5) && whole(p[2])
        })
    };
    let [coarse, fine] = STEPS;
    if on_grid(coarse) { coarse } else { fine }
}
