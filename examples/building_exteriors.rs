//! The looks of houses (Fan and Wonka 2016): a model with hidden styles of the attributes of houses, asked what goes
//! with a garage. `cargo run --example building_exteriors --no-default-features`

use edifice::methods::building_exteriors::attributes::{COLUMNS, attributes};
use edifice::model::Table;
use edifice::model::hierarchy::{Group, Settings, learn};
use edifice::rng::stream;
use edifice::shape::{BoxStyle, Building, MassBox, Ridge, Roof, RoofStyle};
use edifice_base::unwatched;

fn mass(style: BoxStyle, x: f64, width: f64, height: f64) -> MassBox {
    MassBox {
        style,
        x,
        y: 3.0,
        width,
        depth: 6.0,
        height,
        roof: Roof {
            style: RoofStyle::Gable,
            pitch: 30.0,
            ridge: Ridge::X,
        },
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Every second house is wide and has a garage; of the attributes two are enough here.
    let (mut widths, mut garages) = (Vec::new(), Vec::new());
    for i in 0..40 {
        let some = f64::from(i * 7 % 10) / 10.0;
        let mut boxes = vec![mass(BoxStyle::Main, 0.0, 7.0 + some, 5.0 + some)];
        if i % 2 == 0 {
            boxes[0].width *= 2.0;
            boxes.push(mass(BoxStyle::Garage, 9.0, 4.0, 2.5));
        }
        let house = Building::new(format!("house {i}"), "m", 3.0, boxes, vec![], vec![])?;
        for (name, value) in COLUMNS.iter().zip(attributes(&house)?) {
            match *name {
                "bbox.w" => widths.push(value),
                "garage.w" => garages.push(value.map(|w| w > 0.0)),
                _ => {}
            }
        }
    }
    let table = Table::new().real("width", widths)?;
    let table = table.binary("garage", garages)?;
    let groups = [
        Group::new("size", &["width"]),
        Group::new("parts", &["garage"]),
    ];
    let model = learn(&table, &groups, &Settings::default(), 1, &unwatched)?.model;
    println!(
        "{} styles: {:.2?}",
        model.styles(),
        model.style_probabilities()
    );

    let given = Table::new().binary("garage", [Some(true)])?;
    let draws = model.complete(&given, 3, &mut stream(1, "example", 0))?;
    for row in 0..3 {
        println!(
            "with a garage: width {:?}",
            draws.table.column("width")?.cell(row)
        );
    }
    Ok(())
}
