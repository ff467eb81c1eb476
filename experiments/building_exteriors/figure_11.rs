//! Fig. 11: lateral edges, and how many training houses contribute to a sample.

use serde::{Deserialize, Serialize};

use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::agreement::edge_agreement;
use edifice_building_exteriors::attributes::{GROUPS, Level};
use edifice_building_exteriors::network;
use edifice_frame::{Budget, Context};
use edifice_generators_building_exteriors as houses;
use edifice_model::Table as Data;
use edifice_model::hierarchy::{Settings, learn};
use edifice_report::{Align, Chart, Figure, HeatMap, Row, Scale, Series, Table};

#[derive(Serialize, Deserialize)]
struct Edges {
    found: Vec<(String, String)>,
    styles: usize,
}

/// Lateral edges on the shipped houses, and on ever more houses of the same generator.
pub(crate) fn left(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let learned = data::learned(&shipped.data, &settings, ctx.seed())?;
    let found = learned.model.lateral_edges();
    let truth = &shipped.truth.dependencies;
    let (precision, recall) = edge_agreement(&found, truth);
    observe(ctx, "all", precision, recall);
    ctx.compare("lateral edges learned", "9", found.len().to_string());
    ctx.compare(
        "precision, recall against the generator's nine",
        "unknown truth",
        format!("{precision:.2}, {recall:.2}"),
    );
    ctx.figure("figure_11_left", &matrix(&found, truth))?;
    let discrete = GROUPS.iter().filter(|g| g.level == Level::Element);
    let discrete: Vec<String> = discrete.map(|g| g.name.to_owned()).collect();
    let svg = network::svg(&learned.model, &discrete);
    ctx.attach(
        "figure_11_left_network.svg",
        svg.as_bytes(),
        "the learned network",
    )?;

    // Growth: few cardinalities of S around the truth, since time is linear in houses.
    let sizes = match ctx.budget() {
        Budget::Smoke => vec![50],
        Budget::Default => vec![100, 200, 500],
        Budget::Paper => vec![100, 200, 500, 1000, 2000, 5000],
    };
    ctx.setting("sizes", sizes.clone());
    let growth = Settings {
        styles: ctx.budget().choose(2..=3, 6..=8, 6..=8),
        ..settings
    };
    let seed = ctx.seed();
    let results: Vec<Edges> = ctx.units(
        &sizes,
        |n| format!("generated/{n}"),
        |&n| {
            let made = houses::houses(seed, n);
            let buildings: Vec<_> = made.into_iter().map(|h| h.building).collect();
            let data = data::measure(&buildings)?;
            let learned = learn(&data.table, &data.groups, &growth, seed).map_err(Error::method)?;
            Ok(Edges {
                found: learned.model.lateral_edges(),
                styles: learned.model.styles(),
            })
        },
    )?;
    let mut lines = (Vec::new(), Vec::new());
    let mut report = Table::new("Growing databases of the same generator, S from 6 to 8")
        .numbers(["houses", "styles", "edges", "precision", "recall"]);
    for (&n, edges) in sizes.iter().zip(&results) {
        let (precision, recall) = edge_agreement(&edges.found, truth);
        lines.0.push((n as f64, precision));
        lines.1.push((n as f64, recall));
        observe(ctx, &n.to_string(), precision, recall);
        report.row([
            n.to_string(),
            edges.styles.to_string(),
            edges.found.len().to_string(),
            format!("{precision:.2}"),
            format!("{recall:.2}"),
        ]);
    }
    ctx.table(&report);
    let chart = Chart::new(
        "",
        Scale::new("houses").log(),
        Scale::new("share").range(0.0, 1.0),
    )
    .series(Series::marked("precision", lines.0))
    .series(Series::marked("recall", lines.1));
    ctx.figure(
        "figure_11_left_growth",
        &Figure::single("precision and recall of lateral edges", chart),
    )?;
    ctx.note(
        "Edges count without direction: an edge and its reverse can say the same of the data.",
    );
    Ok(())
}

fn observe(ctx: &mut Context, instance: &str, precision: f64, recall: f64) {
    for (metric, value) in [("edge_precision", precision), ("edge_recall", recall)] {
        ctx.observe(Row {
            dataset: if instance == "all" {
                "shipped"
            } else {
                "generated"
            }
            .into(),
            method: "ours".into(),
            instance: instance.into(),
            seed: Some(ctx.seed()),
            metric: metric.into(),
            value,
            ..Row::default()
        });
    }
}

/// Pairs of attributes: 3 found and true, 2 true and missed, 1 found and not true.
fn matrix(found: &[(String, String)], truth: &[(String, String)]) -> Figure {
    let names = GROUPS.iter().filter(|g| g.level != Level::Element);
    let names: Vec<String> = names.map(|g| g.name.to_owned()).collect();
    let has = |list: &[(String, String)], a: &str, b: &str| {
        list.iter()
            .any(|(x, y)| (x == a && y == b) || (x == b && y == a))
    };
    let value = |a: &String, b: &String| match (has(found, a, b), has(truth, a, b)) {
        (true, true) => 3.0,
        (false, true) => 2.0,
        (true, false) => 1.0,
        (false, false) => 0.0,
    };
    let rows = names
        .iter()
        .map(|a| names.iter().map(|b| value(a, b)).collect());
    let label = "0 none, 1 found only, 2 missed, 3 found and true";
    let map = HeatMap::new("lateral edges", rows.collect(), label)
        .names(names.clone(), names.clone())
        .range(0.0, 3.0);
    Figure::new("lateral edges found and true", 1)
        .cell(640.0, 520.0)
        .panel(map)
}

/// Of the 1,000 most probable samples: how many different training houses are nearest in some
/// attribute.
pub(crate) fn right(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let table = &shipped.data.table;
    let learned = data::learned(&shipped.data, &settings, ctx.seed())?;
    let keep = ctx.budget().choose(20, 1000, 1000);
    let pool = ctx.budget().choose(100, 4000, 20000);
    let mut rng = stream(ctx.seed(), "building_exteriors/figure_11_right", 0);
    let draws = learned
        .model
        .most_probable(&Data::new(), keep, pool, 0.05, Some(table), &mut rng)
        .map_err(Error::method)?;
    let scales = scales(table);
    let counts: Vec<usize> = (0..draws.table.rows())
        .map(|row| contributors(&draws.table, row, table, &scales))
        .collect();
    let mean = counts.iter().sum::<usize>() as f64 / counts.len().max(1) as f64;
    let mut histogram = vec![0.0; GROUPS.len() + 1];
    for &c in &counts {
        histogram[c] += 1.0;
    }
    for (houses, count) in histogram.iter().enumerate() {
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "ours".into(),
            instance: houses.to_string(),
            seed: Some(ctx.seed()),
            metric: "samples".into(),
            value: *count,
            ..Row::default()
        });
    }
    ctx.compare(
        "training houses that contribute to a sample, mean",
        "6",
        format!("{mean:.1}"),
    );
    let categories = (0..histogram.len()).map(|c| c.to_string()).collect();
    let bars = edifice_report::Bars::new("", "training houses", Scale::new("samples"), categories)
        .group("samples", histogram.into_iter().map(Some).collect());
    ctx.figure(
        "figure_11_right",
        &Figure::single(
            "training houses that contribute to the attributes of a sample",
            bars,
        ),
    )?;
    let mut report = Table::new("Samples")
        .column("what", Align::Left)
        .column("number", Align::Right);
    report.row([
        "kept, most probable first".to_owned(),
        counts.len().to_string(),
    ]);
    report.row(["drawn".to_owned(), pool.to_string()]);
    ctx.table(&report);
    ctx.note(
        "Samples closer than 0.05 standard deviations (root mean square) to a better sample or to a training house are \
         left out. The nearest house of an attribute is the first of least distance over its columns, each in standard \
         deviations.",
    );
    Ok(())
}

/// Standard deviation of every real column, 1 where it is constant.
fn scales(table: &Data) -> Vec<f64> {
    let scale = table.columns().iter().map(|column| {
        let values: Vec<f64> = (0..table.rows())
            .map(|row| column.cell(row).number().unwrap_or(0.0))
            .collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
        if sd > 0.0 { sd } else { 1.0 }
    });
    scale.collect()
}

fn contributors(sample: &Data, row: usize, houses: &Data, scales: &[f64]) -> usize {
    let mut nearest = std::collections::BTreeSet::new();
    for group in &GROUPS {
        let range = group.first..group.first + group.len;
        let distance = |house: usize| -> f64 {
            let columns = range.clone().zip(group.columns());
            let squares = columns.map(|(c, name)| {
                let a = sample
                    .column(name)
                    .map_or(0.0, |k| k.cell(row).number().unwrap_or(0.0));
                let b = houses
                    .column(name)
                    .map_or(0.0, |k| k.cell(house).number().unwrap_or(0.0));
                ((a - b) / scales[c]).powi(2)
            });
            squares.sum()
        };
        let distances: Vec<f64> = (0..houses.rows()).map(distance).collect();
        let best = distances
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(b.1));
        nearest.extend(best.map(|(i, _)| i));
    }
    nearest.len()
}
