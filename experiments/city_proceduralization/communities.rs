//! Girvan-Newman against Louvain on the type graph of level 4.

use serde::{Deserialize, Serialize};

use super::data;
use edifice_base::{Error, Result, Watched, unwatched};
use edifice_city_proceduralization::{
    Mode,
    emission::placed_components,
    parse_tree::{Detection, grow},
    proceduralize,
    type_graph::DistanceWeights,
};
use edifice_cluster::{girvan_newman, louvain};
use edifice_frame::Context;
use edifice_report::{Align, Table};

#[derive(Serialize, Deserialize)]
struct Found {
    nodes: usize,
    edges: usize,
    /// `None` where the graph has more than [`MOST_EDGES`] edges.
    girvan_newman: Option<f64>,
    louvain: f64,
    seconds: [f64; 2],
}

/// Most edges that Girvan-Newman is given.
const MOST_EDGES: usize = 3000;

/// Compares modularities.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let cities = data::cities(ctx)?;
    let units: Vec<usize> = (0..cities.len()).collect();
    let results: Vec<Option<Found>> = ctx.units(
        &units,
        |c| cities[*c].0.clone(),
        |&c| {
            let city = &cities[c].1;
            let made = proceduralize(city, &data::settings(Mode::Best, 4, seed), &unwatched)
                .map_err(Error::method)?;
            let components = &made.decomposition.components;
            let placed = placed_components(city, components, &made.types);
            let leaves = made.types.representatives.len();
            let tree = grow(
                leaves,
                placed,
                Detection::Louvain,
                DistanceWeights::default(),
                &Watched::new(&unwatched),
            );
            let Some(level) = tree.levels.first() else {
                return Ok(None);
            };
            let clock = std::time::Instant::now();
            let fast = louvain(&level.graph).modularity;
            let first = clock.elapsed().as_secs_f64();
            let few = level.size.1 <= MOST_EDGES;
            let slow = few.then(|| girvan_newman(&level.graph).modularity);
            Ok(Some(Found {
                nodes: level.size.0,
                edges: level.size.1,
                girvan_newman: slow,
                louvain: fast,
                seconds: [clock.elapsed().as_secs_f64() - first, first],
            }))
        },
    )?;
    let mut table = Table::new("Modularity of the type graph's communities")
        .column("city", Align::Left)
        .numbers(["types", "edges", "Girvan-Newman", "Louvain"]);
    for (&c, f) in units.iter().zip(&results) {
        let name = &cities[c].0;
        let Some(f) = f else {
            ctx.note(format!("{name}: no two types stand together twice."));
            continue;
        };
        for (method, value, seconds) in [
            ("girvan_newman", f.girvan_newman, f.seconds[0]),
            ("louvain", Some(f.louvain), f.seconds[1]),
        ] {
            if let Some(value) = value {
                ctx.observe(data::row(name, method, "level_4", "modularity", value, ""));
                ctx.observe(data::row(name, method, "level_4", "seconds", seconds, "s"));
            }
        }
        table.row([
            name.clone(),
            f.nodes.to_string(),
            f.edges.to_string(),
            f.girvan_newman
                .map_or_else(|| "-".to_owned(), |q| format!("{q:.3}")),
            format!("{:.3}", f.louvain),
        ]);
    }
    ctx.table(&table);
    Ok(())
}
