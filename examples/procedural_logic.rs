//! Rules common to facades, and new facades of the same style (Weissenberg et al. 2013).
//! `cargo run --example procedural_logic --no-default-features`

use edifice::methods::procedural_logic::{Measure, Model, Parameters, Style, starting_rules};
use edifice::rng::stream;
use edifice::shape::{Facade, LabelGrid, Rect, Region};

/// Windows in a wall: `floors` rows of `columns`, with windows of some width.
fn facade(
    name: &str,
    floors: i32,
    columns: i32,
    width: f64,
) -> Result<LabelGrid, Box<dyn std::error::Error>> {
    let mut windows = Vec::new();
    for floor in 0..floors {
        for column in 0..columns {
            let (x, y) = (4.0 * f64::from(column), 3.0 * f64::from(floor));
            let rect = Rect::new(x + 2.0 - width / 2.0, y + 1.0, width, 1.5);
            windows.push(Region {
                label: "window".into(),
                rect,
            });
        }
    }
    let size = (4.0 * f64::from(columns), 3.0 * f64::from(floors));
    let facade = Facade::new(name, "m", size.0, size.1, windows)?;
    Ok(LabelGrid::from_facade(&facade, Some("wall"))?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let grids = [
        facade("narrow", 4, 3, 1.0)?,
        facade("wide", 4, 3, 1.8)?,
        facade("medium", 4, 3, 1.4)?,
        facade("long", 3, 6, 1.2)?,
    ];
    let model = Model::fit(&grids, Parameters::COMPRESSION)?;
    println!(
        "{} binary splits became {} rules",
        model.inference.binary_splits,
        model.inference.rules.len()
    );
    let profiles = model.profiles()?;
    println!("distances:{:.2}", Measure::Powerset.matrix(&profiles));

    let (start, count) = starting_rules(&model)[0];
    println!("{count} facades have one structure; a new one of it:");
    let instance = Style::learn(&model, start)?.sample(1.0, &mut stream(3, "example", 0))?;
    let tree = model.inference.rules.expand(&instance)?;
    let new = tree.layout(&model.alphabet, "new", "m");
    println!(
        "{:.2} x {:.2} m, {} regions",
        new.width,
        new.height,
        new.regions.len()
    );
    new.check_tiling()?;
    Ok(())
}
