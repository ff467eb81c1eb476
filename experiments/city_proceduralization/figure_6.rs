//! Fig. 6: type graphs and communities, level by level, up to the axiom.

use serde::{Deserialize, Serialize};

use super::data;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{Detection, Mode, Structure, proceduralize};
use edifice_frame::Context;
use edifice_report::{Align, Table};

/// Nodes, edges, communities, modularity and tolerance of a level.
#[derive(Serialize, Deserialize)]
struct Grown {
    tolerance: f64,
    nodes: usize,
    edges: usize,
    communities: usize,
    modularity: f64,
}

/// Lists the levels of the paper's parse tree over the types of level 4.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let cities = data::cities(ctx)?;
    let ways = [
        ("girvan_newman", Detection::GirvanNewman),
        ("louvain", Detection::Louvain),
    ];
    let units: Vec<(usize, usize)> = (0..cities.len()).flat_map(|c| [(c, 0), (c, 1)]).collect();
    let key = |u: &(usize, usize)| format!("{}/{}", cities[u.0].0, ways[u.1].0);
    let results: Vec<Vec<Grown>> = ctx.units(&units, key, |&(c, way)| {
        let mut settings = data::settings(Mode::Paper, 4, seed);
        settings.detection = ways[way].1;
        let made = proceduralize(&cities[c].1, &settings, &unwatched).map_err(Error::method)?;
        let Structure::Tree(tree) = made.structure else {
            return Ok(Vec::new());
        };
        let level = |l: &edifice_city_proceduralization::parse_tree::Level| Grown {
            tolerance: l.tolerance,
            nodes: l.size.0,
            edges: l.size.1,
            communities: l.communities.labels.iter().max().map_or(0, |m| m + 1),
            modularity: l.communities.modularity,
        };
        Ok(tree.levels.iter().map(level).collect())
    })?;
    let mut table = Table::new("From terminals to the axiom")
        .column("city", Align::Left)
        .column("communities by", Align::Left)
        .numbers([
            "level",
            "tolerance",
            "nodes",
            "edges",
            "communities",
            "modularity",
        ]);
    for (&(c, way), levels) in units.iter().zip(&results) {
        let (name, method) = (&cities[c].0, ways[way].0);
        for (i, l) in levels.iter().enumerate() {
            let instance = format!("level_{}", i + 1);
            for (metric, value) in [
                ("nodes", l.nodes as f64),
                ("edges", l.edges as f64),
                ("communities", l.communities as f64),
                ("modularity", l.modularity),
            ] {
                ctx.observe(data::row(name, method, &instance, metric, value, ""));
            }
            table.row([
                name.clone(),
                method.to_owned(),
                (i + 1).to_string(),
                format!("{:.0} m", l.tolerance),
                l.nodes.to_string(),
                l.edges.to_string(),
                l.communities.to_string(),
                format!("{:.3}", l.modularity),
            ]);
        }
    }
    ctx.table(&table);
    Ok(())
}
