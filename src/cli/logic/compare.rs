//! `edifice logic compare`.

use std::path::PathBuf;

use edifice_base::{Error, Result, csv};
use edifice_io::write_atomic;
use edifice_procedural_logic::{Measure, Model};
use nalgebra::DMatrix;

use super::input::{Energy, Facades, MEASURES, model};
use crate::choice::one_of;
use crate::print;

/// Options of `logic compare`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic compare datasets/facade_grammar/layouts --query office_1 --top 5\n  edifice logic compare --model terraces.logic.json datasets/examples/facade.png --query facade\n  edifice logic compare datasets/facade_grammar/layouts -o distances.csv\n\n'=' joins facades at equal distance; what stands first of them means nothing."
)]
pub(crate) struct Args {
    #[command(flatten)]
    facades: Facades,
    /// Model whose facades to compare too, with its parameters.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    #[command(flatten)]
    energy: Energy,
    /// Distance.
    #[arg(long, value_parser = one_of(MEASURES), default_value = "powerset")]
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
pub(super) fn run(args: &Args) -> Result<()> {
    let model = model(args.model.as_deref(), &args.facades, &args.energy)?;
    let profiles = model.profiles().map_err(Error::method)?;
    if let Some(wanted) = &args.query
        && model.facades.iter().all(|known| &known.name != wanted)
    {
        let message = format!("there is no facade called {wanted}");
        return Err(Error::option("--query", message));
    }
    let distances = args.measure.matrix(&profiles);
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

/// Prints the nearest facades of one: facades at equal distance share a rank, and those that the list
/// leaves out at its last distance are counted.
fn rank(args: &Args, model: &Model, distances: &DMatrix<f64>, query: usize) -> Result<()> {
    let distance = |i: usize| distances[(query, i)];
    let mut others: Vec<usize> = (0..model.facades.len()).filter(|&i| i != query).collect();
    others.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    let ranks: Vec<usize> = others
        .iter()
        .map(|&i| {
            1 + others
                .partition_point(|&j| distance(j) < distance(i) && !equal(distance(j), distance(i)))
        })
        .collect();
    let listed = others.len().min(args.top);
    let beyond = match listed {
        0 => 0,
        listed => ranks[listed..]
            .iter()
            .filter(|&&r| r == ranks[listed - 1])
            .count(),
    };
    let name = &model.facades[query].name;
    let nearest = others.iter().zip(&ranks).take(listed);
    if args.json {
        let nearest: Vec<_> = nearest
            .map(|(&i, rank)| {
                serde_json::json!({ "name": model.facades[i].name, "distance": distance(i), "rank": rank })
            })
            .collect();
        let line =
            serde_json::json!({ "query": name, "nearest": nearest, "tied_with_last": beyond });
        return print::line(&line.to_string());
    }
    let mut text = String::new();
    for (place, (&i, rank)) in nearest.enumerate() {
        let tied = place > 0 && ranks[place - 1] == *rank;
        let joint = match (place, tied) {
            (0, _) => "",
            (_, true) => " = ",
            (_, false) => ", ",
        };
        text.push_str(&format!(
            "{joint}{} {:.3}",
            model.facades[i].name,
            distance(i)
        ));
    }
    if beyond > 0 {
        text.push_str(&format!(" (= {beyond} more at the same distance)"));
    }
    print::line(&format!("{name}: {text}"))
}

/// True if two distances are equal up to rounding.
fn equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.max(b)
}

/// The matrix with the names of the facades.
fn csv(model: &Model, distances: &DMatrix<f64>) -> String {
    let names: Vec<String> = model.facades.iter().map(|f| csv::quoted(&f.name)).collect();
    let mut text = format!("facade,{}\n", names.join(","));
    for (row, name) in names.iter().enumerate() {
        let values: Vec<String> = distances.row(row).iter().map(f64::to_string).collect();
        text.push_str(&format!("{name},{}\n", values.join(",")));
    }
    text
}
