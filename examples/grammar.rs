//! Shapes and grammars: a facade, a split grammar that derives it, and what the grammar costs.
//! `cargo run --example grammar --no-default-features`

use edifice::grammar::{
    Costs, Grammar, Operation, Rule, Start, Successor, derive, evaluate, listing,
};
use edifice::shape::{Axis, Facade, Rect, Region};

fn rule(symbol: &str, operation: Operation) -> Rule {
    Rule {
        symbol: symbol.into(),
        weight: None,
        operation,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Four floors of three windows, each window in a strip of wall.
    let mut regions = Vec::new();
    for floor in 0..4 {
        for column in 0..3 {
            let (x, y) = (3.0 * f64::from(column), 3.0 * f64::from(floor));
            for (label, left, width) in [("wall", 0.0, 2.0), ("window", 2.0, 1.0)] {
                let (label, rect) = (label.into(), Rect::new(x + left, y, width, 3.0));
                regions.push(Region { label, rect });
            }
        }
    }
    let facade = Facade::new("house", "m", 9.0, 12.0, regions)?;

    let floors = Operation::Repeat {
        axis: Axis::Y,
        successors: vec![Successor::new("Floor", 3.0)],
    };
    let tiles = vec![Successor::new("wall", 2.0), Successor::new("window", 1.0)];
    let grammar = Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: "house".into(),
            symbol: "House".into(),
            width: 9.0,
            height: 12.0,
        }],
        rules: vec![
            rule("House", floors),
            rule(
                "Floor",
                Operation::Repeat {
                    axis: Axis::X,
                    successors: tiles,
                },
            ),
        ],
    };
    listing(&grammar, true)
        .iter()
        .for_each(|line| println!("{line}"));
    let derived = derive(&grammar, 0)?;
    let found = evaluate(&grammar, &[facade], &Costs::default())?;
    println!(
        "{} regions from {} rules, cost {:.1}",
        derived.regions.len(),
        found.rules,
        found.cost
    );
    Ok(())
}
