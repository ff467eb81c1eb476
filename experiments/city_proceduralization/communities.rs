//! Girvan-Newman against Louvain on the type graph of level 4.

use serde::{Deserialize, Serialize};

use super::data;
use crate::cluster::{girvan_newman, louvain};
use crate::experiments::Context;
use crate::methods::city_proceduralization::{Mode, proceduralize};
use crate::report::{Align, Table};
use crate::{Error, Result};

#[derive(Serialize, Deserialize)]
struct Found {
    nodes: usize,
    edges: usize,
    girvan_newman: f64,
    louvain: f64,
    seconds: [f64; 2],
}

/// Most edges that Girvan-Newman is given.
const MOST_EDGES: usize = 3000;

/// Compares modularities.
pub fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let cities = data::cities(ctx)?;
    let units: Vec<usize> = (0..cities.len()).collect();
    let results: Vec<Found> = ctx.units(
        &units,
        |c| cities[*c].0.clone(),
        |&c| {
            let made = proceduralize(&cities[c].1, &data::settings(Mode::Best, 4, seed))
                .map_err(Error::method)?;
            let Some(level) = made.tree.levels.first() else {
                return Err(Error::method("no two types stand together"));
            };
            let clock = std::time::Instant::now();
            let fast = louvain(&level.graph).modularity;
            let first = clock.elapsed().as_secs_f64();
            let slow = match level.size.1 <= MOST_EDGES {
                true => girvan_newman(&level.graph).modularity,
                false => return Err(Error::method("the type graph has too many edges")),
            };
            Ok(Found {
                nodes: level.size.0,
                edges: level.size.1,
                girvan_newman: slow,
                louvain: fast,
                seconds: [clock.elapsed().as_secs_f64() - first, first],
            })
        },
    )?;
    let mut table = Table::new("Modularity of the type graph's communities")
        .column("city", Align::Left)
        .numbers(["types", "edges", "Girvan-Newman", "Louvain"]);
    for (&c, f) in units.iter().zip(&results) {
        let name = &cities[c].0;
        for (method, value, seconds) in [
            ("girvan_newman", f.girvan_newman, f.seconds[0]),
            ("louvain", f.louvain, f.seconds[1]),
        ] {
            ctx.observe(data::row(name, method, "level_4", "modularity", value, ""));
            ctx.observe(data::row(name, method, "level_4", "seconds", seconds, "s"));
        }
        table.row([
            name.clone(),
            f.nodes.to_string(),
            f.edges.to_string(),
            format!("{:.3}", f.girvan_newman),
            format!("{:.3}", f.louvain),
        ]);
    }
    ctx.table(&table);
    Ok(())
}
