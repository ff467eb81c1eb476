//! `edifice logic cluster`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_cluster::{Dendrogram, Linkage, agglomerate};
use edifice_procedural_logic::{Measure, Model};
use edifice_report as report;
use edifice_report::{Figure, HeatMap, Merge};
use nalgebra::DMatrix;

use super::input::{Energy, Facades, MEASURES, model};
use crate::choice::{Choice, one_of};
use crate::print::{self, Json};

#[rustfmt::skip]
const LINKAGES: &[Choice<Linkage>] = &[
    ("single", "Smallest distance", Linkage::Single),
    ("complete", "Largest distance", Linkage::Complete),
    ("average", "Mean distance", Linkage::Average),
];

/// Options of `logic cluster`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  edifice logic cluster datasets/facade_grammar/layouts/terrace_*.facade.json datasets/facade_grammar/layouts/hotel_*.facade.json --clusters 2\n  edifice logic cluster datasets/facade_grammar/layouts --clusters 2 -o styles.svg"
)]
pub(crate) struct Args {
    #[command(flatten)]
    facades: Facades,
    /// Model whose facades to cluster too, with its parameters.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    #[command(flatten)]
    energy: Energy,
    /// Distance between facades.
    #[arg(long, value_parser = one_of(MEASURES), default_value = "powerset")]
    measure: Measure,
    /// Distance between clusters.
    #[arg(long, value_parser = one_of(LINKAGES), default_value = "average")]
    linkage: Linkage,
    /// Clusters to tell apart.
    #[arg(long, value_name = "K", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    clusters: u32,
    /// Draw the dendrogram and the matrix in its order, as .svg; a .png goes beside it.
    #[arg(short, long, value_name = "FIGURE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    json: Json,
}

/// Runs the command: one line per facade, in the order of the dendrogram.
pub(super) fn run(args: &Args) -> Result<()> {
    let model = model(args.model.as_deref(), &args.facades, &args.energy)?;
    let profiles = model.profiles().map_err(Error::method)?;
    let distances = args.measure.matrix(&profiles);
    let tree = agglomerate(&distances, args.linkage).map_err(Error::method)?;
    let clusters = tree.cut(args.clusters as usize);
    if let Some(path) = &args.output {
        draw(&model, &tree, &distances, &clusters, path)?;
    }
    let mut all = Vec::new();
    for facade in tree.leaf_order() {
        let (name, cluster) = (&model.facades[facade].name, clusters[facade] + 1);
        print::line(&format!("{cluster}\t{name}"))?;
        all.push(serde_json::json!({ "name": name, "cluster": cluster }));
    }
    args.json.end(&serde_json::json!({ "facades": all }))
}

fn draw(
    model: &Model,
    tree: &Dendrogram,
    distances: &DMatrix<f64>,
    clusters: &[usize],
    path: &Path,
) -> Result<()> {
    if path.extension().is_none_or(|ending| ending != "svg") {
        let message = format!("{} does not end in .svg", path.display());
        return Err(Error::option("--output", message));
    }
    let order = tree.leaf_order();
    let log = |i: usize, j: usize| (1.0 + distances[(i, j)]).log10();
    let matrix = order
        .iter()
        .map(|&i| order.iter().map(|&j| log(i, j)).collect())
        .collect();
    let names = |order: &[usize]| -> Vec<String> {
        let name = |&facade: &usize| model.facades[facade].name.clone();
        order.iter().map(name).collect()
    };
    let all: Vec<usize> = (0..model.facades.len()).collect();
    let merges = tree.merges.iter().map(|merge| Merge {
        left: merge.clusters.0,
        right: merge.clusters.1,
        height: merge.height,
    });
    let leaves = report::Dendrogram::new("clusters", "distance", names(&all), merges.collect());
    let map = HeatMap::new("distance matrix", matrix, "log10(1 + distance)");
    let figure = Figure::new("Structural distances in the order of the dendrogram", 2)
        .cell(760.0, 700.0)
        .panel(leaves.groups(clusters.to_vec()))
        .panel(map.names(names(&order), names(&order)));
    let folder = path.parent().unwrap_or(Path::new(""));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    report::write_figure(folder, &stem, &figure)
}
