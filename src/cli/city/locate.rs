//! `edifice city locate`.

use std::path::PathBuf;

use edifice::Result;
use edifice::io::city::view_json;
use edifice::methods::city_proceduralization::localization::{Seen, landmarks, locate};

use super::data;
use crate::cli::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// The grammar, or a city.
    grammar: PathBuf,
    /// The view: buildings that one sees (`edifice/city-view`).
    #[arg(long)]
    view: PathBuf,
    /// How many places to list.
    #[arg(long, default_value_t = 5)]
    top: usize,
    /// Print a line of JSON for each place instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let city = data::city(&args.grammar)?;
    let (landmarks, building) = landmarks(&city);
    let view: Vec<Seen> = view_json::read(&args.view)?
        .into_iter()
        .map(|b| Seen {
            width: b.width,
            depth: b.depth,
            height: b.height,
            solid: b.solid,
        })
        .collect();
    for (rank, found) in locate(&landmarks, &view, args.top).iter().enumerate() {
        let id = |l: usize| city.buildings[building[l]].id.as_str();
        let near = id(found.landmark);
        let at = landmarks[found.landmark].at;
        let [x, y] = [0, 1].map(|k| at[k] + city.origin[k]);
        let matched: Vec<&str> = found.matched.iter().map(|&l| id(l)).collect();
        let text = match args.json {
            true => serde_json::json!({ "rank": rank + 1, "building": near, "at": [x, y],
                "cost": found.cost, "matched": matched })
            .to_string(),
            false => format!(
                "{}: near {near} at ({x:.1}, {y:.1}), cost {:.4}, sees {}",
                rank + 1,
                found.cost,
                matched.join(", ")
            ),
        };
        print::line(&text)?;
    }
    Ok(())
}
