//! Logic models in `edifice model show`.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_procedural_logic::{MODEL_FORMAT, Model, ModelFile};

use crate::model::Shown;

/// Labels, rules and facades of a logic model.
pub(crate) const LOGIC: Shown = Shown {
    format: MODEL_FORMAT,
    show,
};

fn show(bytes: &[u8], path: &Path, json: bool) -> Result<Vec<String>> {
    let file: ModelFile = parse_json(bytes, path)?;
    let model = Model::try_from(file).map_err(|e| Error::content(path, e))?;
    let (labels, rules) = (model.alphabet.names(), &model.inference.rules);
    let facades: Vec<&str> = model.facades.iter().map(|f| f.name.as_str()).collect();
    if json {
        let summary = serde_json::json!({
            "labels": labels, "rules": rules.len(), "facades": facades,
        });
        return Ok(vec![summary.to_string()]);
    }
    Ok(vec![
        format!("{} labels: {}", labels.len(), labels.join(", ")),
        format!("{} rules", rules.len()),
        format!("{} facades: {}", facades.len(), facades.join(", ")),
    ])
}
