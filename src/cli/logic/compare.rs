//! `edifice logic compare`.

use std::path::PathBuf;

use edifice::io::write_atomic;
use edifice::methods::procedural_logic::{self, Model};
use edifice::{Error, Result};
use nalgebra::DMatrix;

use super::input::{Energy, Facades, Measure, model};
use crate::cli::print;

/// Options of `logic compare`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic compare labels/ --query monge_42 --top 5\n  edifice logic compare --model paris.logic.json new.png --query new\n  edifice logic compare labels/ -o distances.csv"
)]
pub struct Args {
    #[command(flatten)]
    facades: Facades,
    /// Model whose facades to compare too, with its parameters.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    #[command(flatten)]
    energy: Energy,
    /// Distance.
    #[arg(long, value_enum, default_value_t = Measure::Powerset)]
    measure: Measure,
    /// Rank the facades by distance from the one of this name only.
    #[arg(long, value_name = "NAME")]
    query: Option<String>,
    /// Facades to list for each.
    #[arg(long, value_name = "K", default_value_t = 5)]
    top: usize,
    /// Write the matrix of all distances to a CSV file.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print one JSON object per facade.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let model = model(args.model.as_deref(), &args.facades, &args.energy)?;
    let profiles = model.profiles().map_err(Error::method)?;
    if let Some(wanted) = &args.query
        && model.facades.iter().all(|known| &known.name != wanted)
    {
        let message = format!("there is no facade called {wanted}");
        return Err(Error::option("--query", message));
    }
    let distances = procedural_logic::Measure::from(args.measure).matrix(&profiles);
    if let Some(path) = &args.output {
        write_atomic(path, csv(&model, &distances).as_bytes())?;
    }
    for query in 0..model.facades.len() {
        let name = &model.facades[query].name;
        if args.query.as_ref().is_none_or(|wanted| wanted == name) {
            rank(args, &model, &distances, query)?;
        }
    }
    Ok(())
}

/// Prints the nearest facades of one.
fn rank(args: &Args, model: &Model, distances: &DMatrix<f64>, query: usize) -> Result<()> {
    let mut others: Vec<usize> = (0..model.facades.len()).filter(|&i| i != query).collect();
    others.sort_by(|&a, &b| distances[(query, a)].total_cmp(&distances[(query, b)]));
    others.truncate(args.top);
    let name = &model.facades[query].name;
    if args.json {
        let nearest: Vec<_> = others
            .iter()
            .map(|&i| {
                let distance = distances[(query, i)];
                serde_json::json!({ "name": model.facades[i].name, "distance": distance })
            })
            .collect();
        return print::line(&serde_json::json!({ "query": name, "nearest": nearest }).to_string());
    }
    let nearest: Vec<String> = others
        .iter()
        .map(|&i| format!("{} {:.3}", model.facades[i].name, distances[(query, i)]))
        .collect();
    print::line(&format!("{name}: {}", nearest.join(", ")))
}

/// The matrix with the names of the facades.
fn csv(model: &Model, distances: &DMatrix<f64>) -> String {
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    let names: Vec<String> = model.facades.iter().map(|f| quoted(&f.name)).collect();
    let mut text = format!("facade,{}\n", names.join(","));
    for (row, name) in names.iter().enumerate() {
        let values: Vec<String> = distances.row(row).iter().map(f64::to_string).collect();
        text.push_str(&format!("{name},{}\n", values.join(",")));
    }
    text
}
