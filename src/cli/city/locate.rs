//! `edifice city locate`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_city_proceduralization::facades::{Facade, facades, photographed};
use edifice_city_proceduralization::localization::{Seen, landmarks, locate, locate_facades};
use edifice_io::{pixels, read_bytes};
use edifice_io_city::view_json;
use rayon::prelude::*;

use super::data;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar, or a city.
    grammar: PathBuf,
    /// The view: buildings that one sees (`edifice/city-view`), or rectified photographs of the facades of neighbours, each
    /// from edge to edge (PNG, JPEG, WebP); the city must then have textures.
    #[arg(long, required = true, num_args = 1..)]
    view: Vec<PathBuf>,
    /// Number of places to list.
    #[arg(long, default_value_t = 5)]
    top: usize,
    /// Print a line of JSON for each place instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let city = data::city(&args.grammar)?;
    let (landmarks, building) = landmarks(&city);
    let places = match &args.view[..] {
        [view] if !is_picture(view) => {
            let seen = view_json::read(view)?.into_iter().map(|b| Seen {
                width: b.width,
                depth: b.depth,
                height: b.height,
                solid: b.solid,
            });
            locate(&landmarks, &seen.collect::<Vec<_>>(), args.top)
        }
        views => {
            let facades: Vec<Vec<Facade>> = building
                .par_iter()
                .map(|&b| facades(&city.buildings[b]))
                .collect();
            if facades.iter().all(Vec::is_empty) {
                let text = "no facade shows a texture that photographs could be compared with";
                return Err(Error::content(&args.grammar, text));
            }
            let view: Vec<Facade> = views.iter().map(|v| photograph(v)).collect::<Result<_>>()?;
            locate_facades(&landmarks, &facades, &view, args.top)
        }
    };
    if places.is_empty() {
        print::message("no place matches: too few buildings stand around any");
    }
    for (rank, found) in places.iter().enumerate() {
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

fn is_picture(path: &Path) -> bool {
    let ending = path.extension().and_then(|e| e.to_str());
    ending.is_some_and(|e| ["png", "jpg", "jpeg", "webp"].contains(&e.to_lowercase().as_str()))
}

fn photograph(path: &Path) -> Result<Facade> {
    let (width, colours) =
        pixels::colours(&read_bytes(path)?).map_err(|e| Error::content(path, e))?;
    photographed(width, &colours)
        .ok_or_else(|| Error::content(path, "all of one grey: it shows no facade"))
}
