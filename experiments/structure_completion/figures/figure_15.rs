//! Fig. 15: a facade is sketched, completed, edited and completed again; every step is a command.

use super::super::picture::panel;
use super::super::row;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_io::facade_json;
use edifice_report::{Align, Figure, Table};
use edifice_shape::{AnnotatedFacade, Facade, Rect, Region};
use edifice_structure_completion::best::modes;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::model::shipped_model;
use edifice_structure_completion::partial::PartialLayout;

/// Outline of the sketch in metres.
const WIDTH: f64 = 10.7;
const HEIGHT: f64 = 13.4;

/// A step of the sequence: its letter, what the user did, and the sketched elements.
type SketchStep = (char, &'static str, Vec<Element>);

fn element(class: Class, x: f64, y: f64, width: f64, height: f64) -> Element {
    Element::new(class, Rect::new(x, y, width, height))
}

/// The sketch, and what becomes of it.
fn steps() -> [SketchStep; 4] {
    let window = |x: f64, y: f64| element(Class::Window, x, y, 1.1, 1.8);
    let sketch = |second: f64, last: Element| {
        let windows = [window(1.2, 4.2), window(second, 4.2), window(1.2, 7.4)];
        windows.into_iter().chain([last]).collect()
    };
    let door = |x: f64| element(Class::Door, x, 0.0, 1.3, 2.6);
    let shop = element(Class::Shop, 7.6, 0.0, 2.4, 2.6);
    [
        ('c', "sketch completed", sketch(3.6, door(4.7))),
        ('d', "door moved", sketch(3.6, door(8.3))),
        ('e', "door made a shop", sketch(3.6, shop)),
        ('f', "column moved", sketch(3.0, shop)),
    ]
}

/// Completes each step as `facade complete` does.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let model = shipped_model().map_err(Error::method)?;
    let mut figure = Figure::new(
        "Sketch, and completions of it and of three edits (added elements outlined)",
        5,
    )
    .cell(210.0, 240.0);
    let mut table = Table::new("Elements of each completion")
        .column("step", Align::Left)
        .column("the user", Align::Left)
        .numbers(Class::ALL.map(Class::name));
    let mut commands = Vec::new();
    for (letter, what, observed) in steps() {
        let partial = PartialLayout {
            width: WIDTH,
            height: HEIGHT,
            observed,
            unknown: None,
            forbidden: Vec::new(),
        };
        partial.check().map_err(Error::method)?;
        let mut rng = stream(ctx.seed(), "facade complete", 0);
        let answer = modes::complete(&partial, &model, 1, &mut rng);
        let added = super::first(&answer.completions);
        if letter == 'c' {
            let title = "(a) sketch".to_string();
            figure = figure.panel(panel(title, WIDTH, HEIGHT, &partial.observed, &[]));
        }
        let title = format!("({letter}) {what}");
        figure = figure.panel(panel(title, WIDTH, HEIGHT, &partial.observed, &added));
        let whole = || partial.observed.iter().chain(&added);
        let counts = Class::ALL.map(|class| whole().filter(|e| e.class == class).count());
        for (class, count) in Class::ALL.iter().zip(counts) {
            let instance = format!("{letter}/{}", class.name());
            ctx.observe(row("sketch", "best", instance, None, "count", count as f64));
        }
        let cells = [format!("({letter})"), what.to_string()].into_iter();
        table.row(cells.chain(counts.map(|c| c.to_string())));
        let name = format!("figure_15_{letter}.facade.json");
        let text = facade_json::annotated_to_string(&sketch(&partial)?);
        ctx.attach(
            &name,
            text.as_bytes(),
            &format!("what the user drew, step ({letter})"),
        )?;
        commands.push(format!(
            "edifice facade complete {name} --seed {} -o {letter}.facade.json",
            ctx.seed()
        ));
    }
    ctx.figure("figure_15", &figure)?;
    ctx.table(&table);
    ctx.note(format!("```\n{}\n```", commands.join("\n")));
    ctx.note("The commands give the same completions, by the default model. Step (b) of the paper, the choice of 3D models from a database, has no counterpart here.");
    Ok(())
}

/// The observed elements as a layout that the command reads.
fn sketch(partial: &PartialLayout) -> Result<AnnotatedFacade> {
    let regions = partial.observed.iter().map(|e| Region {
        label: e.class.name().to_string(),
        rect: e.rect,
    });
    let facade = Facade::new(
        "sketch",
        "m",
        partial.width,
        partial.height,
        regions.collect(),
    );
    Ok(AnnotatedFacade::plain(facade.map_err(Error::method)?))
}
