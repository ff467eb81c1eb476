//! Whole facades from a few elements (Fan et al. 2014): a model learnt from made facades completes a half of another one.
//! `cargo run --example structure_completion --no-default-features`

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::measure::agreement;
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::Model;
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::Rect;
use edifice::unwatched;

/// Floors of windows above a ground floor with a door in the middle.
fn facade(floors: usize, columns: usize, axis: f64) -> Layout {
    let window = |x, y| Element::new(Class::Window, Rect::new(x, y, 1.2, 1.8));
    let mut elements = Vec::new();
    for floor in 0..floors {
        for column in 0..columns {
            let (x, y) = (0.8 + axis * column as f64, 1.0 + 3.2 * floor as f64);
            if (floor, column) == (0, columns / 2) {
                elements.push(Element::new(Class::Door, Rect::new(x, 0.0, 1.2, 2.4)));
            } else {
                elements.push(window(x, y));
            }
        }
    }
    Layout {
        name: format!("{floors} x {columns}"),
        width: 1.2 + 1.6 + axis * (columns - 1) as f64,
        height: 3.2 * floors as f64 + 0.5,
        elements,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let database = (0..12).map(|i| facade(3 + i % 3, 3 + i % 4, 2.2 + 0.1 * (i % 5) as f64));
    let model = Model::train(database.collect(), 1, &unwatched)?.model;

    let truth = facade(4, 7, 2.5);
    let mut rng = stream(1, "example", 0);
    let (partial, hidden) = Task::Side50.hide(&truth, &mut rng);
    println!(
        "{} elements seen, {} hidden",
        partial.observed.len(),
        hidden.len()
    );
    for completion in complete(Method::Best, &partial, &model, 3, &mut rng) {
        let added: Vec<Element> = completion.added.iter().map(|c| c.element).collect();
        let found = agreement(&added, &hidden, 0.5).matched;
        println!(
            "{:.0} %: {} added, {found} right",
            100.0 * completion.mass,
            added.len()
        );
    }
    Ok(())
}
