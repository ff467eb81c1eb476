//! A facade as a scene in three dimensions.

use std::collections::BTreeMap;

use edifice_base::{Error, Result};
use edifice_io::gltf;
use edifice_scene::relief::{material, relief};
use edifice_scene::{Group, Instance, Material, Scene};
use edifice_shape::{Facade, Rect, Region};

/// Height given to facades whose unit is no metric one (m).
const HEIGHT: f64 = 14.0;

/// A facade in relief as binary glTF, y up, in metres: each region before or behind the wall by its label.
///
/// # Errors
/// When the scene is too large for the format.
pub fn glb(facade: &Facade) -> Result<Vec<u8>> {
    gltf::to_bytes(&scene(facade)).map_err(Error::method)
}

/// The scene; a facade in other units is scaled to a height of 14 m.
pub(super) fn scene(facade: &Facade) -> Scene {
    let factor = match facade.unit.as_str() {
        "m" => 1.0,
        "dm" => 0.1,
        "cm" => 0.01,
        "mm" => 0.001,
        _ => HEIGHT / facade.height,
    };
    let scaled = |r: &Region| Region {
        label: r.label.clone(),
        rect: Rect::new(
            r.rect.x * factor,
            r.rect.y * factor,
            r.rect.width * factor,
            r.rect.height * factor,
        ),
    };
    let metric = Facade {
        regions: facade.regions.iter().map(scaled).collect(),
        ..facade.clone()
    };
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut materials: Vec<Material> = Vec::new();
    for region in &metric.regions {
        numbers.entry(region.label.as_str()).or_insert_with(|| {
            materials.push(material(&region.label, 0));
            materials.len() - 1
        });
    }
    let mesh = relief("facade".to_owned(), &metric, |label| numbers[label]);
    Scene {
        materials,
        meshes: vec![mesh],
        groups: vec![Group {
            name: "facade".to_owned(),
            yaw: 0.0,
            translation: [0.0; 3],
            instances: vec![Instance::at(0, [0.0; 3])],
        }],
    }
}
