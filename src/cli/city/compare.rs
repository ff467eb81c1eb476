//! `edifice city compare`.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_shape::triangles::{
    City, Corners, SurfaceDistance, TriangleMesh, VolumeRaster, repair, surface_samples,
};
use rayon::prelude::*;

use super::data;
use crate::print;

/// Points that distances are measured from.
const SAMPLES: usize = 20_000;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A city, a grammar, or the folder of a country's grammars.
    first: PathBuf,
    /// Another of them.
    second: PathBuf,
    /// Cells of the raster, in metres.
    #[arg(long, default_value_t = 0.5)]
    resolution: f64,
    /// Seed of the points on the surfaces.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// End with a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let size = args.resolution;
    if !(size.is_finite() && (0.01..=100.0).contains(&size)) {
        return Err(Error::option(
            "--resolution",
            format!("{size} is not between 0.01 and 100 m"),
        ));
    }
    let [a, b] = [read(&args.first)?, read(&args.second)?];
    let meshes = |city: &[TriangleMesh]| -> Vec<TriangleMesh> { city.to_vec() };
    let (first, second) = (meshes(&a.meshes), meshes(&b.meshes));
    let [f, s]: [Vec<&TriangleMesh>; 2] = [first.iter().collect(), second.iter().collect()];
    let asked = size;
    let size = VolumeRaster { size }.fitted(&f, &s).size;
    if size > asked {
        print::message(&format!(
            "warning: too large for cells of {asked} m: compared in cells of {size} m"
        ));
    }
    let overlap = VolumeRaster { size }.compare(&f, &s);
    let [there, back] = [distances(&f, &s, args.seed), distances(&s, &f, args.seed)];
    if args.json {
        let summary = serde_json::json!({
            "iou": overlap.iou(), "resolution": size,
            "volumes": [overlap.first, overlap.second], "intersection": overlap.intersection,
            "buildings": [a.buildings, b.buildings], "triangles": [a.triangles, b.triangles],
            "bytes": [a.bytes, b.bytes],
            "distance_first_to_second": there, "distance_second_to_first": back,
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!("volumetric IoU {:.4} at {size} m", overlap.iou()))?;
    for (side, volume) in [(&a, overlap.first), (&b, overlap.second)] {
        print::line(&format!(
            "{}: {} buildings, {} triangles, {} bytes, {volume:.0} m3",
            side.name, side.buildings, side.triangles, side.bytes
        ))?;
    }
    for (name, d) in [("first to second", there), ("second to first", back)] {
        print::line(&format!(
            "surface distance {name}: mean {:.3} m, median {:.3} m, 95 % {:.3} m, largest {:.3} m",
            d[0], d[1], d[2], d[3]
        ))?;
    }
    Ok(())
}

struct Side {
    name: String,
    buildings: usize,
    triangles: usize,
    bytes: u64,
    meshes: Vec<TriangleMesh>,
}

fn read(path: &Path) -> Result<Side> {
    let city: City = data::city(path)?;
    Ok(Side {
        name: path.display().to_string(),
        buildings: city.buildings.len(),
        triangles: city.triangles(),
        bytes: data::bytes(path)?,
        meshes: match data::is_derived(path) {
            // What is derived is judged as it is.
            true => city.buildings.into_iter().map(|b| b.mesh).collect(),
            false => city
                .buildings
                .par_iter()
                .map(|b| repair(&b.mesh).0)
                .collect(),
        },
    })
}

/// Mean, median, 95th percentile and largest distance from points on one surface to the other.
fn distances(from: &[&TriangleMesh], to: &[&TriangleMesh], seed: u64) -> [f64; 4] {
    let corners =
        |set: &[&TriangleMesh]| -> Vec<Corners> { set.iter().flat_map(|m| m.corners()).collect() };
    let mut rng = stream(seed, "city compare", 0);
    let points = surface_samples(corners(from).into_iter(), SAMPLES, &mut rng);
    let tree = SurfaceDistance::new(corners(to).into_iter());
    let mut found: Vec<f64> = points.par_iter().map(|&p| tree.distance(p)).collect();
    found.sort_by(f64::total_cmp);
    let Some(last) = found.len().checked_sub(1) else {
        return [0.0; 4];
    };
    let at = |share: f64| found[(share * last as f64) as usize];
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    [mean, at(0.5), at(0.95), found[last]]
}
