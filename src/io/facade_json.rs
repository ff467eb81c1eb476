//! Facade layouts as JSON: `*.facade.json`, format `edifice/facade`, version 1.
//!
//! ```json
//! { "format": "edifice/facade", "version": 1, "name": "monge_42", "unit": "px",
//!   "width": 400.0, "height": 600.0,
//!   "regions": [ { "label": "window", "x": 20.0, "y": 40.0, "width": 30.0, "height": 60.0 } ] }
//! ```
//! Optional keys of a region are `id`, `observed`, `probability` and `reason`, and of a partial layout
//! `unknown`, a list of rectangles, and `photograph`, a JPEG or PNG picture that lies over the outline, as a `data:` address
//! ([`parse_annotated`]).
//! Origin at the lower left, y up. The reader is strict about what it knows (types, duplicate
//! keys, finite numbers, positive sizes, trailing text) and ignores keys that it does not know.

use std::fmt::Write;
use std::path::Path;

use serde::Deserialize;

use super::json::{check_header, number, parse_json, quoted};
use super::{photograph, read_bytes, write_atomic};
use edifice_base::{Error, Result};
use edifice_shape::{AnnotatedFacade, Facade, Note, Photograph, Rect, Region};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/facade";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;

/// Reads a facade layout (tiling or element layout) from a file.
///
/// # Errors
/// Names the file and the JSON path or the line and column of what is wrong.
pub fn read(path: &Path) -> Result<Facade> {
    parse(&read_bytes(path)?, path)
}

/// Writes a facade layout to a file, whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write(facade: &Facade, path: &Path) -> Result<()> {
    write_atomic(path, to_string(facade).as_bytes())
}

/// Parses the bytes of a facade file; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Facade> {
    Ok(parse_annotated(bytes, path)?.facade)
}

/// Parses the bytes of a facade file with the annotations of its regions and its unknown part.
///
/// # Errors
/// As [`read`].
pub fn parse_annotated(bytes: &[u8], path: &Path) -> Result<AnnotatedFacade> {
    check_header(bytes, path, FORMAT, VERSION)?;
    let file: File = parse_json(bytes, path)?;
    let (regions, notes) = file.regions.into_iter().map(FileRegion::split).unzip();
    let facade = Facade::new(file.name, file.unit, file.width, file.height, regions)
        .map_err(|e| Error::content(path, e))?;
    let photograph = file.photograph.as_deref().map(photograph::of_address);
    let annotated = AnnotatedFacade {
        facade,
        notes,
        unknown: file.unknown,
        photograph: photograph
            .transpose()
            .map_err(|e| Error::content(path, format!("photograph: {e}")))?,
    };
    annotated.check().map_err(|e| Error::content(path, e))?;
    Ok(annotated)
}

/// The text of a facade file, one region a line. Numbers read back to the same bits.
pub fn to_string(facade: &Facade) -> String {
    text(facade, &[], None, None)
}

/// As [`to_string`], with the annotations that there are.
pub fn annotated_to_string(annotated: &AnnotatedFacade) -> String {
    let unknown = annotated.unknown.as_deref();
    let photograph = annotated.photograph.as_ref();
    text(&annotated.facade, &annotated.notes, unknown, photograph)
}

fn text(
    facade: &Facade,
    notes: &[Note],
    unknown: Option<&[Rect]>,
    photograph: Option<&Photograph>,
) -> String {
    let mut out = format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": {VERSION}, \"name\": {}, \"unit\": {},\n  \"width\": {}, \"height\": {},\n  \"regions\": [",
        quoted(&facade.name),
        quoted(&facade.unit),
        number(facade.width),
        number(facade.height)
    );
    for (index, region) in facade.regions.iter().enumerate() {
        let r = region.rect;
        // Writing to a String cannot fail.
        let _ = write!(
            out,
            "{}\n    {{ \"label\": {}, {}{} }}",
            if index == 0 { "" } else { "," },
            quoted(&region.label),
            place(&r),
            notes.get(index).map(note_text).unwrap_or_default()
        );
    }
    out.push_str("\n  ]");
    if let Some(unknown) = unknown {
        let rects: Vec<String> = unknown
            .iter()
            .map(|r| format!("\n    {{ {} }}", place(r)))
            .collect();
        let _ = write!(out, ",\n  \"unknown\": [{}\n  ]", rects.join(","));
    }
    if let Some(picture) = photograph {
        let address = quoted(&photograph::address(picture));
        let _ = write!(out, ",\n  \"photograph\": {address}");
    }
    out.push_str(" }\n");
    out
}

/// The keys of a rectangle.
fn place(r: &Rect) -> String {
    let [x, y, width, height] = [r.x, r.y, r.width, r.height].map(number);
    format!("\"x\": {x}, \"y\": {y}, \"width\": {width}, \"height\": {height}")
}

/// The keys of a region's annotations, each after a comma.
fn note_text(note: &Note) -> String {
    let keys = [
        ("id", note.id.as_deref().map(quoted)),
        ("observed", note.observed.map(|o| o.to_string())),
        ("probability", note.probability.map(number)),
        ("reason", note.reason.as_deref().map(quoted)),
    ];
    let written = keys
        .into_iter()
        .filter_map(|(key, value)| Some(format!(", \"{key}\": {}", value?)));
    written.collect()
}

#[derive(Deserialize)]
struct File {
    name: String,
    unit: String,
    width: f64,
    height: f64,
    regions: Vec<FileRegion>,
    #[serde(default)]
    unknown: Option<Vec<Rect>>,
    #[serde(default)]
    photograph: Option<String>,
}

#[derive(Deserialize)]
struct FileRegion {
    label: String,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    #[serde(default)]
    id: Option<String>,
    #[serde(default)]
    observed: Option<bool>,
    #[serde(default)]
    probability: Option<f64>,
    #[serde(default)]
    reason: Option<String>,
}

impl FileRegion {
    fn split(self) -> (Region, Note) {
        let region = Region {
            label: self.label,
            rect: Rect::new(self.x, self.y, self.width, self.height),
        };
        let note = Note {
            id: self.id,
            observed: self.observed,
            probability: self.probability,
            reason: self.reason,
        };
        (region, note)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{ "format": "edifice/facade", "version": 1, "name": "a", "unit": "px",
        "width": 4.0, "height": 6, "note": "ignored",
        "regions": [ { "label": "window", "x": 1, "y": 2.5, "width": 3, "height": 1e-1 } ] }"#;

    fn fail(text: &str) -> String {
        let error = parse(text.as_bytes(), "f.facade.json".as_ref()).unwrap_err();
        let message = error.to_string();
        assert!(message.starts_with("f.facade.json: "), "{message}");
        message
    }

    #[test]
    fn round_trip_keeps_every_bit() {
        let facade = parse(GOOD.as_bytes(), "f".as_ref()).unwrap();
        assert_eq!(facade.regions[0].rect, Rect::new(1.0, 2.5, 3.0, 0.1));
        let again = parse(to_string(&facade).as_bytes(), "f".as_ref()).unwrap();
        assert_eq!(facade, again);
    }

    #[test]
    fn annotations_round_trip_and_stay_out_of_plain_layouts() {
        let text = GOOD
            .replace("1e-1 }", "1e-1, \"id\": \"w1\", \"observed\": false, \"probability\": 0.25, \"reason\": \"symmetry\" }")
            .replace("] }", "], \"unknown\": [ { \"x\": 0, \"y\": 0, \"width\": 4, \"height\": 2 } ] }");
        let annotated = parse_annotated(text.as_bytes(), "f".as_ref()).unwrap();
        assert_eq!(annotated.notes[0].probability, Some(0.25));
        assert_eq!(annotated.unknown.as_deref().unwrap().len(), 1);
        let again = annotated_to_string(&annotated);
        assert_eq!(
            parse_annotated(again.as_bytes(), "f".as_ref()).unwrap(),
            annotated
        );
        let plain = to_string(&annotated.facade);
        assert_eq!(
            plain,
            annotated_to_string(&AnnotatedFacade::plain(annotated.facade))
        );
        assert!(!plain.contains("observed"));
        for (from, to, expected) in [
            ("0.25", "1.25", "regions[0].probability is 1.25"),
            ("\"height\": 2 }", "\"height\": -2 }", "unknown[0]"),
            ("false", "\"no\"", "regions[0].observed"),
        ] {
            let message = fail(&text.replacen(from, to, 1));
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn bad_files_name_their_place() {
        let cases = [
            ("\"width\": 3", "\"width\": -3", "regions[0].width"),
            ("\"width\": 3", "\"width\": NaN", "line 3"),
            ("\"width\": 3", "\"width\": 1e999", "regions[0].width"),
            ("\"width\": 3", "\"width\": \"3\"", "regions[0].width"),
            (
                "\"width\": 3",
                "\"width\": 3, \"width\": 3",
                "duplicate field",
            ),
            (
                "\"width\": 3",
                "\"w\": 3",
                "regions[0]: missing field `width`",
            ),
            (
                "\"width\": 3",
                "\"width\": 30",
                "regions[0] (window) reaches outside",
            ),
            ("\"window\"", "\"\"", "regions[0].label is empty"),
            ("\"width\": 4.0", "\"width\": 0", "facade width is 0"),
            (
                "edifice/facade",
                "edifice/grammar",
                "format: unknown format",
            ),
            (
                "\"version\": 1",
                "\"version\": 2",
                "version: unknown version 2",
            ),
            ("1e-1 } ] }", "1e-1 } ] } x", "line 3"),
            ("1e-1 } ] }", "1e-1 }", "line 3"),
        ];
        for (from, to, expected) in cases {
            let text = GOOD.replacen(from, to, 1);
            assert_ne!(text, GOOD, "{from}");
            let message = fail(&text);
            assert!(message.contains(expected), "{to}: {message}");
        }
    }
}
