//! `edifice city morphology`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_city_proceduralization::morphology::{CityPlan, Morphology, Square};

use super::data;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Cities or grammars.
    #[arg(required = true)]
    cities: Vec<PathBuf>,
    /// Side of the squares, in metres; they overlap by half, as far as they are town.
    #[arg(long, default_value_t = 700.0)]
    side: f64,
    /// A square by its lowest coordinates, in place of all.
    #[arg(
        long,
        value_name = "X,Y",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    at: Option<Vec<f64>>,
    /// One line of JSON a city.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let side = args.side;
    if !(side.is_finite() && (1.0..=100_000.0).contains(&side)) {
        return Err(Error::option(
            "--side",
            format!("{side} is not between 1 and 100,000 m"),
        ));
    }
    for path in &args.cities {
        let city = data::city(path)?;
        let plan = CityPlan::new(&city);
        let squares = match args.at.as_deref() {
            None => plan.squares(side),
            Some(&[x, y]) if x.is_finite() && y.is_finite() => vec![Square {
                low: [x - city.origin[0], y - city.origin[1]],
                side,
            }],
            Some(_) => return Err(Error::option("--at", "expected X,Y in metres")),
        };
        let Some(m) = plan.measure(&squares) else {
            let said = format!("no square of {side} m is town: try a smaller --side, or --at X,Y");
            return Err(Error::content(path, said));
        };
        print::line(&match args.json {
            true => json(&m, squares.len(), side).to_string(),
            false => text(&path.display().to_string(), &m, squares.len(), side),
        })?;
    }
    Ok(())
}

fn json(m: &Morphology, squares: usize, side: f64) -> serde_json::Value {
    serde_json::json!({
        "squares": squares, "side": side, "buildings": m.buildings, "buildings_per_block": m.buildings_per_block,
        "attached": m.attached, "parallel": m.parallel, "gap": m.gap, "covered": m.covered, "overlap": m.overlap,
        "sizes": m.sizes,
    })
}

fn text(name: &str, m: &Morphology, squares: usize, side: f64) -> String {
    let [smaller, larger, height] = m.sizes;
    format!(
        "{name}: {} buildings in {squares} squares of {side} m\n\
         buildings a block {:.2}, attached {:.3}, neighbours parallel {:.3}, gap to the next block {:.2} m\n\
         covered {:.3}, overlap {:.4}; medians: {smaller:.1} x {larger:.1} m in plan, {height:.1} m high",
        m.buildings, m.buildings_per_block, m.attached, m.parallel, m.gap, m.covered, m.overlap
    )
}
