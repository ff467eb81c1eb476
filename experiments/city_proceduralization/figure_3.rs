//! Fig. 3: buildings taken apart into their components.

use super::{data, exhibits};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Component, decompose};
use edifice_frame::Context;
use edifice_io_city::picture::side_by_side;
use edifice_report::{Align, Table};
use edifice_shape::triangles::TriangleMesh;

/// Most components of a building that is shown.
const MOST: usize = 6;
/// Gap between components, in metres.
const GAP: f64 = 4.0;

/// Draws for each number of components the largest building with that number, and counts them all.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let width = ctx.budget().choose(120, 480, 640);
    let mut table = Table::new("Buildings by their number of components")
        .column("city", Align::Left)
        .numbers(["components", "buildings"]);
    for (name, city) in data::cities(ctx)? {
        let components = decompose(&city, true, &unwatched).components;
        let buildings: Vec<&[Component]> = components
            .chunk_by(|a, b| a.building == b.building)
            .collect();
        let most = buildings.iter().map(|b| b.len()).max().unwrap_or(0);
        let mut shown = Vec::new();
        for count in 1..=most {
            let own = || buildings.iter().filter(|b| b.len() == count);
            let value = own().count() as f64;
            let instance = format!("components_{count}");
            ctx.observe(data::row(&name, "cuts", &instance, "buildings", value, ""));
            table.row([name.clone(), count.to_string(), value.to_string()]);
            let volume = |b: &[Component]| b.iter().map(|c| c.volume).sum::<f64>();
            let largest = own().max_by(|a, b| volume(a).total_cmp(&volume(b)));
            shown.extend(largest.filter(|_| count <= MOST).map(|b| apart(b)));
        }
        let picture = side_by_side(&[&exhibits::rows(&[shown])], width, width / 2);
        let what = format!("{name}: buildings of 1 to {MOST} components, taken apart");
        let file = format!("figure_3_{name}.png");
        ctx.attach(&file, &picture.map_err(Error::method)?, &what)?;
    }
    ctx.table(&table);
    Ok(())
}

/// The components of a building, each lifted off the one below.
fn apart(building: &[Component]) -> TriangleMesh {
    let mut out = TriangleMesh::default();
    for (k, c) in building.iter().enumerate() {
        let lifted = |p: &[f64; 3]| {
            let [x, y, z] = c.frame.from_unit(*p);
            [x, y, z + GAP * k as f64]
        };
        out.append(&TriangleMesh {
            positions: c.mesh.positions.iter().map(lifted).collect(),
            triangles: c.mesh.triangles.clone(),
        });
    }
    out
}
