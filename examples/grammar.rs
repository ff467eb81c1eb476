//! Shapes and grammars: a facade, a split grammar that derives it, and what the grammar costs.
//! `cargo run --example grammar --no-default-features`

use edifice::grammar::{Costs, Grammar, Operation, Rule, Start, Successor};
use edifice::grammar::{derive, evaluate, listing};
use edifice::shape::{Axis, Facade, Rect, Region};

fn repeat(symbol: &str, axis: Axis, successors: &[(&str, f64)]) -> Rule {
    let successors = successors.iter().map(|&(s, size)| Successor::new(s, size));
    let successors = successors.collect();
    Rule {
        symbol: symbol.into(),
        weight: None,
        operation: Operation::Repeat { axis, successors },
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

    let tiles = [("wall", 2.0), ("window", 1.0)];
    let grammar = Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: "house".into(),
            symbol: "House".into(),
            width: 9.0,
            height: 12.0,
        }],
        rules: vec![
            repeat("House", Axis::Y, &[("Floor", 3.0)]),
            repeat("Floor", Axis::X, &tiles),
        ],
    };
    for line in listing(&grammar, true) {
        println!("{line}");
    }
    let regions = derive(&grammar, 0)?.regions.len();
    let found = evaluate(&grammar, &[facade], &Costs::default())?;
    println!(
        "{regions} regions, {} rules, cost {}",
        found.rules, found.cost
    );
    Ok(())
}
