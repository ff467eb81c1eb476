//! Inverse procedural modeling of a facade layout (Wu et al. 2014): the smallest grammar, and a proof that it is.
//! `cargo run --example facade_grammar --no-default-features`

use edifice::grammar::{Costs, evaluate, listing};
use edifice::methods::facade_grammar::{Settings, infer};
use edifice::shape::{Facade, Rect, Region};
use edifice::unwatched;

/// Shops below five floors of windows; the top floor is lower.
fn facade() -> Result<Facade, Box<dyn std::error::Error>> {
    let mut regions = Vec::new();
    let (mut y, heights) = (0.0, [4.0, 3.0, 3.0, 3.0, 3.0, 2.0]);
    for (floor, height) in heights.into_iter().enumerate() {
        for column in 0..5 {
            let x = 3.0 * f64::from(column);
            let opening = if floor == 0 { "shop" } else { "window" };
            for (label, left, width) in [("wall", 0.0, 1.0), (opening, 1.0, 2.0)] {
                let rect = Rect::new(x + left, y, width, height);
                regions.push(Region {
                    label: label.into(),
                    rect,
                });
            }
        }
        y += height;
    }
    Ok(Facade::new("house", "m", 15.0, y, regions)?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let facades = [facade()?];
    let settings = Settings {
        iterations: 200,
        ..Settings::default()
    };
    let outcome = infer(&facades, &settings, &unwatched)?;
    // No method marks its own work: this derives the grammar and compares with the facade.
    let found = evaluate(&outcome.grammar, &facades, &Costs::default())?;
    listing(&outcome.grammar, true)
        .iter()
        .for_each(|line| println!("{line}"));
    println!(
        "{} rules for {} regions, cost {:.1}",
        found.rules, found.terminals, found.cost
    );
    match outcome.proves(found.cost) {
        true => println!("no grammar costs less"),
        false => println!("lower bound: {:?}", outcome.lower_bound),
    }
    Ok(())
}
