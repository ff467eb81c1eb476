//! Ward's hierarchy against k-means on features of components.

use serde::{Deserialize, Serialize};

use super::data;
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{decompose, features};
use edifice_cluster::{kmeans, lloyd, means, sum_of_squares, ward};
use edifice_frame::Context;
use edifice_report::{Align, Table};

#[derive(Serialize, Deserialize)]
struct Sums {
    ward: f64,
    ward_lloyd: f64,
    kmeans: f64,
}

/// Compares at n/2 to n/64 clusters.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let (starts, levels) = ctx.budget().choose((1, 2), (5, 6), (5, 6));
    ctx.setting("starts", starts);
    let cities = data::cities(ctx)?;
    let units: Vec<usize> = (0..cities.len()).collect();
    let key = |c: &usize| cities[*c].0.clone();
    let results: Vec<Vec<Sums>> = ctx.units(&units, key, |&c| {
        let components = decompose(&cities[c].1, true, &unwatched).components;
        let points = features::paper_features(&components, &[1.0; 11]);
        let d = points.dimension;
        let n = components.len();
        let weights = vec![1.0; n];
        let tree = ward(&points.values, d, &weights).map_err(Error::method)?;
        let mut rows = Vec::new();
        for level in 1..=levels {
            let k = (n >> level).max(1);
            let labels = tree.cut(k);
            let centres = means(&points.values, d, &weights, &labels, vec![0.0; k * d]);
            let sum = sum_of_squares(&points.values, d, &weights, &labels, &centres);
            let refined = lloyd(&points.values, d, &weights, centres, 10).sse;
            let start = |s: u64| {
                let mut rng = stream(seed, "clustering", s);
                kmeans(&points.values, d, &weights, k, 10, &mut rng).sse
            };
            let best = (0..starts).map(start).fold(f64::INFINITY, f64::min);
            rows.push(Sums {
                ward: sum,
                ward_lloyd: refined,
                kmeans: best,
            });
        }
        Ok(rows)
    })?;
    let mut table = Table::new("Sums of squared errors on the paper's features")
        .column("city", Align::Left)
        .numbers([
            "level",
            "Ward",
            "Ward and 10 steps of Lloyd",
            "best k-means++",
        ]);
    for (&c, rows) in units.iter().zip(&results) {
        for (i, sums) in rows.iter().enumerate() {
            let instance = format!("level_{}", i + 1);
            let name = &cities[c].0;
            for (method, value) in [
                ("ward", sums.ward),
                ("ward_lloyd", sums.ward_lloyd),
                ("kmeans", sums.kmeans),
            ] {
                ctx.observe(data::row(name, method, &instance, "sse", value, ""));
            }
            let text = |v: f64| format!("{v:.2}");
            table.row([
                name.clone(),
                (i + 1).to_string(),
                text(sums.ward),
                text(sums.ward_lloyd),
                text(sums.kmeans),
            ]);
        }
    }
    ctx.table(&table);
    Ok(())
}
