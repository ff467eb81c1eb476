//! A city becomes a grammar (Demir, Aliaga and Benes 2014): boxes without structure in, templates and rules out.
//! `cargo run --example city_proceduralization --no-default-features`

use edifice::methods::city_proceduralization::{Budget, Settings, proceduralize};
use edifice::shape::triangles::{City, CityBuilding, TriangleMesh};
use edifice::unwatched;

/// Appends the walls and the roof of a box to a mesh.
fn push_box(mesh: &mut TriangleMesh, low: [f64; 3], size: [f64; 3]) {
    let corner = |c: [usize; 3]| [0, 1, 2].map(|k| low[k] + c[k] as f64 * size[k]);
    let faces = [
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
        [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    ];
    for [a, b, c, d] in faces.map(|face| face.map(corner)) {
        mesh.push([a, b, c]);
        mesh.push([a, c, d]);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Thirty towers on podiums, of two kinds, along a street.
    let buildings = (0..30).map(|i| {
        let (x, wide) = (40.0 * f64::from(i), if i % 2 == 0 { 20.0 } else { 28.0 });
        let mut mesh = TriangleMesh::default();
        push_box(&mut mesh, [x, 0.0, 0.0], [wide, 20.0, 6.0]);
        push_box(&mut mesh, [x + 4.0, 4.0, 6.0], [wide - 10.0, 10.0, 24.0]);
        CityBuilding {
            id: format!("building {i}"),
            attributes: serde_json::Map::new(),
            mesh,
            ..CityBuilding::default()
        }
    });
    let city = City {
        name: "street".into(),
        reference_system: None,
        origin: [0.0; 3],
        buildings: buildings.collect(),
        ..City::default()
    };
    let settings = Settings {
        budget: Budget::Templates(4),
        ..Settings::default()
    };
    let made = proceduralize(&city, &settings, &unwatched)?;
    println!(
        "{} buildings, {} components, {} templates, {} rules",
        city.buildings.len(),
        made.decomposition.components.len(),
        made.grammar.templates.len(),
        made.grammar.rules.len()
    );
    Ok(())
}
