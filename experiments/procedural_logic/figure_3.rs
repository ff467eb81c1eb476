//! Fig. 3: distance matrices of both styles in the order of the dendrogram, and their separation.

use super::data::{Source, sources};
use super::{data_table, row};
use edifice_base::{Error, Result};
use edifice_cluster::{Dendrogram, Linkage, agglomerate, purity};
use edifice_frame::Context;
use edifice_frame::picture::tiles;
use edifice_procedural_logic::{Measure, Model, Parameters};
use edifice_report as report;
use edifice_report::{Figure, HeatMap, Merge, Table};
use edifice_shape::{Facade, LabelGrid};

/// Facades shown beside the matrix.
const THUMBNAILS: usize = 12;

/// Clusters both styles together and draws tree, matrix and some layouts in the order of the tree.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let title = "Purity of the two top clusters against the data set";
    let mut table = data_table(title, &["linkage"], &["facades", "purity"]);
    for source in sources(ctx)? {
        if source.other.is_empty() {
            ctx.note(format!(
                "{}: there is no second style to separate.",
                source.dataset
            ));
            continue;
        }
        separate(ctx, &source, &mut table)?;
    }
    ctx.table(&table);
    ctx.note(
        "Distance: powersets at the parameters of Sec. 5.4, affinities over both sets together. The \
         figures use average linkage. Colours of the leaves tell the two sets.",
    );
    Ok(())
}

fn separate(ctx: &mut Context, source: &Source, table: &mut Table) -> Result<()> {
    let grids: Vec<LabelGrid> = source.grids.iter().chain(&source.other).cloned().collect();
    let sets: Vec<usize> = (0..grids.len())
        .map(|i| usize::from(i >= source.grids.len()))
        .collect();
    let both = format!("{}+{}", source.dataset, source.other_dataset);
    let model = Model::fit(&grids, Parameters::RETRIEVAL).map_err(Error::method)?;
    let profiles = model.profiles().map_err(Error::method)?;
    let distances = Measure::Powerset.matrix(&profiles);
    for (linkage, name) in [
        (Linkage::Single, "single"),
        (Linkage::Complete, "complete"),
        (Linkage::Average, "average"),
    ] {
        let tree = agglomerate(&distances, linkage).map_err(Error::method)?;
        let value = purity(&tree.cut(2), &sets);
        ctx.observe(row(
            &both,
            &format!("powerset_{name}"),
            "top_2",
            "purity",
            value,
        ));
        table.row([
            both.clone(),
            name.into(),
            grids.len().to_string(),
            format!("{value:.3}"),
        ]);
        if linkage != Linkage::Average {
            continue;
        }
        if source.is_paper() {
            let text = format!("{:.1} % in the two top clusters", 100.0 * value);
            ctx.compare("separation of Haussmannian and Gruenderzeit", "clear", text);
        }
        for (place, &facade) in tree.leaf_order().iter().enumerate() {
            let name = &grids[facade].name;
            ctx.observe(row(&both, "powerset_average", name, "leaf", place as f64));
            let group = tree.cut(2)[facade] as f64;
            ctx.observe(row(&both, "powerset_average", name, "cluster", group));
        }
        let layouts = model
            .facades
            .iter()
            .map(|known| model.layout(known))
            .collect::<std::result::Result<Vec<_>, _>>()
            .map_err(Error::method)?;
        if source.pictured {
            draw(ctx, source, &tree, &distances, &sets, &layouts)?;
        }
    }
    Ok(())
}

fn draw(
    ctx: &mut Context,
    source: &Source,
    tree: &Dendrogram,
    distances: &nalgebra::DMatrix<f64>,
    sets: &[usize],
    layouts: &[Facade],
) -> Result<()> {
    let order = tree.leaf_order();
    let log = |i: usize, j: usize| (1.0 + distances[(i, j)]).log10();
    let matrix = order
        .iter()
        .map(|&i| order.iter().map(|&j| log(i, j)).collect())
        .collect();
    let names: Vec<String> = layouts.iter().map(|layout| layout.name.clone()).collect();
    let merges = tree.merges.iter().map(|merge| Merge {
        left: merge.clusters.0,
        right: merge.clusters.1,
        height: merge.height,
    });
    let title = format!("{} and {}", source.dataset, source.other_dataset);
    let figure = Figure::new(
        format!("Distances of {title} in the order of the dendrogram"),
        2,
    )
    .cell(760.0, 700.0)
    .panel(
        report::Dendrogram::new(title, "chi-square", names.clone(), merges.collect())
            .groups(sets.to_vec()),
    )
    .panel(HeatMap::new(
        "distance matrix",
        matrix,
        "log10(1 + chi-square)",
    ));
    ctx.figure(&source.figure("figure_3"), &figure)?;
    let mut figure =
        Figure::new("Layouts, evenly spaced along the dendrogram", 6).cell(230.0, 260.0);
    for k in 0..THUMBNAILS.min(order.len()) {
        let facade = order[k * order.len() / THUMBNAILS.min(order.len())];
        figure = figure.panel(tiles(names[facade].clone(), &layouts[facade]).without_borders());
    }
    ctx.figure(&format!("{}_layouts", source.figure("figure_3")), &figure)
}
