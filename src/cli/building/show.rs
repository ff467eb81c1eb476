//! `edifice building show`.

use std::path::PathBuf;

use edifice_building_exteriors::network;

use super::data;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The model (`*.houses.json`).
    model: PathBuf,
    /// Draw the network into this file.
    #[arg(long)]
    svg: Option<PathBuf>,
    /// Print a line of JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> edifice_base::Result<()> {
    let file = data::model(&args.model)?;
    let model = &file.model;
    if let Some(path) = &args.svg {
        let svg = network::svg(model, &file.discrete());
        edifice_io::write_atomic(path, svg.as_bytes())?;
    }
    let kinds: Vec<(&String, usize)> = model
        .real_groups()
        .iter()
        .zip(model.cardinalities())
        .collect();
    if args.json {
        let summary = serde_json::json!({
            "styles": model.styles(),
            "style_probabilities": model.style_probabilities(),
            "cardinalities": kinds.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
            "lateral_edges": model.lateral_edges(),
        });
        return print::line(&summary.to_string());
    }
    let percent = |p: &[f64]| {
        let shares = p.iter().map(|p| format!("{:3.0}%", 100.0 * p));
        shares.collect::<Vec<_>>().join(" ")
    };
    print::line(&format!(
        "{} styles: {}",
        model.styles(),
        percent(model.style_probabilities())
    ))?;
    for (group, count) in kinds {
        print::line(&format!("{group}: {count} kinds"))?;
        if let Ok(table) = model.state_probabilities(group) {
            for (s, row) in table.iter().enumerate() {
                print::line(&format!("  style {}: {}", s + 1, percent(row)))?;
            }
        }
    }
    for group in file.groups.iter() {
        for column in &group.columns {
            if let Ok(table) = model.category_probabilities(column) {
                let last = table.iter().map(|p| p.last().copied().unwrap_or(0.0));
                let last: Vec<f64> = last.collect();
                // Of a yes/no column the last category is yes.
                print::line(&format!(
                    "{column}: last category by style {}",
                    percent(&last)
                ))?;
            }
        }
    }
    print::line(&format!("{} lateral edges", model.lateral_edges().len()))?;
    for (parent, child) in model.lateral_edges() {
        print::line(&format!("  {parent} -> {child}"))?;
    }
    Ok(())
}
