//! How houses look (Fan and Wonka 2016): a model with hidden styles of the attributes of houses, asked what goes with a garage.
//! `cargo run --example building_exteriors --no-default-features`

use edifice::methods::building_exteriors::attributes::{COLUMNS, attributes};
use edifice::model::Table;
use edifice::model::hierarchy::{Group, Settings, learn};
use edifice::rng::stream;
use edifice::shape::{BoxStyle, Building, MassBox, Ridge, Roof, RoofStyle};

fn mass(style: BoxStyle, x: f64, width: f64, height: f64) -> MassBox {
    let (style_of_roof, pitch, ridge) = (RoofStyle::Gable, 30.0, Ridge::X);
    let roof = Roof {
        style: style_of_roof,
        pitch,
        ridge,
    };
    MassBox {
        style,
        x,
        y: 3.0,
        width,
        depth: 6.0,
        height,
        roof,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Every second house is wide and has a garage.
    let mut rows = Vec::new();
    for i in 0..40 {
        let some = f64::from(i * 7 % 10) / 10.0;
        let boxes = match i % 2 {
            0 => vec![
                mass(BoxStyle::Main, 0.0, 14.0 + some, 5.5),
                mass(BoxStyle::Garage, 9.0, 4.0, 2.5),
            ],
            _ => vec![mass(BoxStyle::Main, 0.0, 7.0 + some, 5.0 + some)],
        };
        let house = Building::new(format!("house {i}"), "m", 3.0, boxes, vec![], vec![])?;
        rows.push(attributes(&house)?);
    }
    // Two of the paper's attributes; `data::dataset` takes all.
    let column = |name: &str| {
        COLUMNS
            .iter()
            .position(|c| *c == name)
            .ok_or("no such attribute")
    };
    let (width, garage) = (column("bbox.w")?, column("garage.w")?);
    let table = Table::new()
        .real("width", rows.iter().map(|row| row[width]))?
        .binary(
            "garage",
            rows.iter().map(|row| row[garage].map(|w| w > 0.0)),
        )?;
    let groups = [
        Group::new("size", &["width"]),
        Group::new("parts", &["garage"]),
    ];
    let settings = Settings {
        styles: 2..=4,
        ..Settings::default()
    };
    let model = learn(&table, &groups, &settings, 1)?.model;
    println!(
        "{} styles: {:.2?}",
        model.styles(),
        model.style_probabilities()
    );

    let given = Table::new().binary("garage", [Some(true)])?;
    let draws = model.complete(&given, 3, &mut stream(1, "example", 0))?;
    for row in 0..3 {
        println!(
            "a house with a garage: width {:?}",
            draws.table.column("width")?.cell(row)
        );
    }
    Ok(())
}
