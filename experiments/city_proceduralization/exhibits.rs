//! Bodies set up side by side, for pictures.

use edifice_shape::triangles::{City, CityBuilding, TriangleMesh};

/// A city of bodies in rows, the first row behind; each body stands on the ground in the middle of its place.
pub(crate) fn rows(rows: &[Vec<TriangleMesh>]) -> City {
    let width = |m: &TriangleMesh| {
        let (low, high) = m.bounds().unwrap_or_default();
        (high[0] - low[0]).max(high[1] - low[1])
    };
    let place = rows.iter().flatten().map(width).fold(1.0, f64::max) * 1.3;
    let mut city = City::default();
    for (r, row) in rows.iter().enumerate() {
        for (k, body) in row.iter().enumerate() {
            let (low, high) = body.bounds().unwrap_or_default();
            let shift = [
                (k as f64 + 0.5) * place - (low[0] + high[0]) / 2.0,
                -(r as f64 + 0.5) * place - (low[1] + high[1]) / 2.0,
                -low[2],
            ];
            let mut mesh = body.clone();
            for p in &mut mesh.positions {
                *p = [0, 1, 2].map(|k| p[k] + shift[k]);
            }
            city.buildings.push(CityBuilding {
                id: format!("{r}/{k}"),
                mesh,
                ..CityBuilding::default()
            });
        }
    }
    city
}
