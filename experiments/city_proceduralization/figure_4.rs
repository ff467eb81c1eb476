//! Fig. 4: clusters of buildings, and what weights of features do to clusters of components.

use super::{data, exhibits};
use edifice_base::{Error, Result, Watched, unwatched};
use edifice_city_proceduralization::types::paper_types;
use edifice_city_proceduralization::{
    Component, Mode, PAPER_FEATURES, Representative, Structure, proceduralize,
};
use edifice_frame::Context;
use edifice_io_city::picture::side_by_side;
use edifice_report::{Align, Table};
use edifice_shape::triangles::TriangleMesh;

/// Clusters, and members of each, that are shown.
const SHOWN: (usize, usize) = (4, 6);
/// Clusters of components in the table.
const CLUSTERS: usize = 16;
/// Weights of the feature "height".
const WEIGHTS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// Draws the four types of most buildings, and measures how alike heights are within clusters as their weight grows.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let width = ctx.budget().choose(120, 480, 640);
    let mut table = Table::new("Spread of heights within 16 clusters over that of all components")
        .column("city", Align::Left)
        .numbers(WEIGHTS.map(|w| format!("weight {w}")));
    for (name, city) in data::cities(ctx)? {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        if let Structure::Patterns { buildings, .. } = &made.structure {
            let mut members: Vec<Vec<usize>> = vec![Vec::new(); buildings.count];
            for &b in &buildings.order {
                buildings.labels[b]
                    .into_iter()
                    .for_each(|l| members[l].push(b));
            }
            members.sort_by_key(|m| std::cmp::Reverse(m.len()));
            let mesh = |b: &usize| city.buildings[*b].mesh.clone();
            let row = |m: &Vec<usize>| m.iter().take(SHOWN.1).map(mesh).collect();
            let rows: Vec<Vec<TriangleMesh>> = members.iter().take(SHOWN.0).map(row).collect();
            let picture = side_by_side(&[&exhibits::rows(&rows)], width, width * 3 / 4);
            let counts: Vec<String> = members
                .iter()
                .take(SHOWN.0)
                .map(|m| m.len().to_string())
                .collect();
            let what = format!(
                "{name}: the types of most buildings ({})",
                counts.join(", ")
            );
            let file = format!("figure_4_{name}.png");
            ctx.attach(&file, &picture.map_err(Error::method)?, &what)?;
        }
        let components = &made.decomposition.components;
        let mut row = vec![name.clone()];
        for weight in WEIGHTS {
            let mut weights = [1.0; 11];
            if let Some(at) = PAPER_FEATURES.iter().position(|f| *f == "height") {
                weights[at] = weight;
            }
            let nearest = Representative::Nearest;
            let types = paper_types(
                components,
                CLUSTERS,
                &weights,
                nearest,
                seed,
                &Watched::new(&unwatched),
            );
            let labels: Vec<usize> = types.uses.iter().map(|u| u.kind).collect();
            let value = spread(components, &labels) / spread(components, &vec![0; labels.len()]);
            let instance = format!("height_weight_{weight}");
            ctx.observe(data::row(
                &name,
                "paper",
                &instance,
                "spread_of_heights",
                value,
                "",
            ));
            row.push(format!("{value:.3}"));
        }
        table.row(row);
    }
    ctx.table(&table);
    Ok(())
}

/// Root mean square distance of heights from their cluster's mean.
fn spread(components: &[Component], labels: &[usize]) -> f64 {
    let count = labels.iter().max().map_or(0, |m| m + 1);
    let mut sums = vec![(0.0, 0.0); count];
    for (c, &l) in components.iter().zip(labels) {
        sums[l].0 += 1.0;
        sums[l].1 += c.frame.size[2];
    }
    let away = |(c, &l): (&Component, &usize)| (c.frame.size[2] - sums[l].1 / sums[l].0).powi(2);
    let total: f64 = components.iter().zip(labels).map(away).sum();
    (total / labels.len().max(1) as f64).sqrt()
}
