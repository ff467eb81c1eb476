//! Files of Bayesian networks, read, shown, drawn and written.

use std::path::Path;

use edifice_base::file::{read_bytes, write_atomic};
use edifice_base::{Error, Result};
use edifice_model::ModelError;
use edifice_model::network::{Evidence, Network};

use super::{Any, NotANetwork, at, drawing, read};

/// Formats by extension.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Bif,
    XmlBif,
    Json,
    Dot,
    Svg,
}

fn format(path: &Path) -> Option<Format> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    match extension.as_str() {
        "bif" => Some(Format::Bif),
        "xmlbif" | "xml" => Some(Format::XmlBif),
        "json" => Some(Format::Json),
        "dot" | "gv" => Some(Format::Dot),
        "svg" => Some(Format::Svg),
        _ => None,
    }
}

/// A network in a format of its own extension; `None` for JSON, which may be any model.
pub(super) fn by_extension(path: &Path) -> Result<Option<Network>> {
    let parse = match format(path) {
        Some(Format::Bif) => Network::from_bif,
        Some(Format::XmlBif) => Network::from_xmlbif,
        _ => return Ok(None),
    };
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|e| Error::content(path, e))?;
    parse(text).map(Some).map_err(at(path))
}

/// Reads a Bayesian network.
pub(super) fn network(path: &Path) -> Result<Network> {
    match read(path)? {
        Any::Network(network) => Ok(network),
        Any::Other(..) => Err(Error::content(path, NotANetwork)),
    }
}

/// Writes a network in the format of the extension; a drawing shows the posteriors without evidence.
pub(super) fn write(network: &Network, path: &Path) -> Result<()> {
    write_given(network, path, &Evidence::new(), &[])
}

/// Converts a file; `given` are the variables of `evidence`, which a drawing shows posteriors of.
pub(super) fn convert(
    network: &Network,
    to: &Path,
    evidence: &Evidence,
    given: &[String],
) -> Result<()> {
    if !given.is_empty() && format(to) != Some(Format::Svg) {
        return Err(Error::option(
            "--given",
            "only a drawing (.svg) shows posteriors",
        ));
    }
    write_given(network, to, evidence, given)
}

fn write_given(
    network: &Network,
    path: &Path,
    evidence: &Evidence,
    given: &[String],
) -> Result<()> {
    let text = match format(path) {
        Some(Format::Bif) => network.to_bif(),
        Some(Format::XmlBif) => network.to_xmlbif(),
        Some(Format::Json) => network.to_json().map(|text| text + "\n"),
        Some(Format::Dot) => Ok(network.to_dot()),
        Some(Format::Svg) => drawing::svg(network, evidence, given),
        None => {
            let expected = "expected .bif, .xmlbif, .json, .dot or .svg";
            let message = format!("unknown format {:?}, {expected}", path.display());
            return Err(Error::option("--output", message));
        }
    };
    write_atomic(path, text.map_err(at(path))?.as_bytes())
}

/// The variables of a network, a line each, or as JSON.
pub(super) fn show(network: &Network, json: bool) -> Result<Vec<String>, ModelError> {
    let mut lines = Vec::new();
    let mut variables = Vec::new();
    for name in network.names() {
        let (categories, parents) = (network.categories(name)?, network.parents(name)?);
        let kind = match categories {
            [] => "real".to_string(),
            _ => categories.join(", "),
        };
        let given = match &parents[..] {
            [] => String::new(),
            _ => format!(", given {}", parents.join(", ")),
        };
        lines.push(format!("{name}: {kind}{given}"));
        variables.push(serde_json::json!({
            "name": name, "categories": categories, "parents": parents,
        }));
    }
    match json {
        true => Ok(vec![
            serde_json::json!({"variables": variables}).to_string(),
        ]),
        false => Ok(lines),
    }
}
