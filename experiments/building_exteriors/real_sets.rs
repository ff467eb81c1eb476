//! Fig. 10 and Fig. 11 left on the real houses that ship: the styles found, and the learnt network.

use super::{data, settings};
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::{AttributeRow, COLUMNS, GROUPS, Level};
use edifice_building_exteriors::data::{dataset, known};
use edifice_building_exteriors::network;
use edifice_frame::Context;
use edifice_io::building_csv;
use edifice_model::hierarchy::{Hierarchy, learn};
use edifice_model::tables::Dataset;
use edifice_model::{Cell, Table as Data};
use edifice_report::{Align, Figure, HeatMap, Row, Table};

/// Attributes of real houses, their source in the first column.
const REAL: &str = "building_exteriors/real.houses.csv";
/// The source of it with more than one continuous attribute.
pub(super) const DELFT: &str = "delft";
const H2K: &str = "h2k";
/// Columns that a style is described by.
const WORDS: usize = 5;

/// The houses of each source with the attributes that it knows, and the model learnt from them.
fn learnt(
    ctx: &mut Context,
    sources: &[&'static str],
) -> Result<Vec<(&'static str, Dataset, Hierarchy)>> {
    let settings = settings(ctx);
    let mut sets = Vec::new();
    for &source in sources {
        let rows = rows_of(ctx, source)?;
        let data = dataset(&rows).and_then(known).map_err(Error::method)?;
        let learned =
            learn(&data.table, &data.groups, &settings, ctx.seed()).map_err(Error::method)?;
        sets.push((source, data, learned.model));
    }
    Ok(sets)
}

/// The attributes of the houses of a source, each known or not. A kind that all of them have, or none, counts as not known: a model of
/// this source alone cannot tell anything by it.
pub(super) fn rows_of(ctx: &mut Context, source: &str) -> Result<Vec<AttributeRow>> {
    let path = ctx.shipped(REAL)?;
    let text = building_csv::read(&path)?;
    let places = COLUMNS.map(|name| text.header.iter().position(|h| h == name));
    let own = text.rows.iter().filter(|row| row[0] == source);
    let rows = own.map(|row| {
        let cells = places.iter().map(|place| match place.map(|k| &*row[k]) {
            None | Some("") => Ok(None),
            Some("yes") => Ok(Some(1.0)),
            Some("no") => Ok(Some(0.0)),
            Some(number) => number.parse().map(Some),
        });
        cells.collect::<std::result::Result<AttributeRow, _>>()
    });
    let rows = rows.collect::<std::result::Result<Vec<_>, _>>();
    let mut rows = rows.map_err(|e| Error::content(&path, e))?;
    let kinds = GROUPS.iter().filter(|g| g.level == Level::Element);
    for column in kinds.flat_map(|g| g.first..g.first + g.len) {
        let all = |value: f64| rows.iter().all(|r| r[column].is_none_or(|v| v == value));
        if all(0.0) || all(1.0) {
            rows.iter_mut().for_each(|r| r[column] = None);
        }
    }
    Ok(rows)
}

fn observe(ctx: &mut Context, source: &str, metric: &str, value: usize) {
    ctx.observe(Row {
        dataset: source.into(),
        method: "ours".into(),
        instance: "all".into(),
        seed: Some(ctx.seed()),
        metric: metric.into(),
        value: value as f64,
        ..Row::default()
    });
}

/// Fig. 10 on real houses: what sets the styles of each source apart.
pub(crate) fn styles(ctx: &mut Context) -> Result<()> {
    let mut figure = Figure::new("means of the attributes by style, real houses", 1);
    for (source, data, model) in learnt(ctx, &[DELFT, H2K])? {
        let posterior = model.style_posterior(&data.table).map_err(Error::method)?;
        let labels: Vec<usize> = posterior.iter().map(|p| data::argmax(p)).collect();
        observe(ctx, source, "styles", model.styles());
        ctx.compare(
            format!("styles learned, {source}"),
            "7 (200 houses)",
            format!("{} ({} houses)", model.styles(), labels.len()),
        );
        let mut table = Table::new(format!("What sets the styles of `{source}` apart"))
            .column("style", Align::Left)
            .column("houses", Align::Right)
            .column("mean", Align::Left)
            .column("stands out by (standard deviations)", Align::Left);
        let mut maps: Vec<Vec<f64>> = Vec::new();
        for style in 0..model.styles() {
            let means = means(&data.table, &labels, style);
            let houses = labels.iter().filter(|&&l| l == style).count();
            let mut most: Vec<&Mean> = means.iter().collect();
            most.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
            let most = || most.iter().take(WORDS);
            let words = |each: Vec<String>| each.join(", ");
            table.row([
                (style + 1).to_string(),
                houses.to_string(),
                words(
                    most()
                        .map(|m| format!("{} {:.2}", m.column, m.own))
                        .collect(),
                ),
                words(
                    most()
                        .map(|m| format!("{} {:+.1}", m.column, m.z))
                        .collect(),
                ),
            ]);
            maps.push(means.iter().map(|m| m.z).collect());
        }
        ctx.table(&table);
        let names: Vec<String> =
            (data.table.columns().iter().map(|c| c.name().to_owned())).collect();
        let by_column: Vec<Vec<f64>> = (0..names.len())
            .map(|c| maps.iter().map(|row| row[c]).collect())
            .collect();
        let styles = (1..=model.styles()).map(|s| format!("style {s}"));
        let map = HeatMap::new(source, by_column, "standard deviations")
            .names(names, styles.collect())
            .range(-2.0, 2.0);
        figure = figure.panel(map);
    }
    ctx.note(
        "The attributes that a source does not know are left out. Of no real house a style is known, so that nothing says \
         which styles are right.",
    );
    ctx.figure("figure_10_real", &figure.cell(620.0, 480.0))
}

/// A column among the houses of a style.
struct Mean {
    column: String,
    own: f64,
    /// Distance from the mean of all houses in standard deviations of all.
    z: f64,
}

fn means(table: &Data, labels: &[usize], style: usize) -> Vec<Mean> {
    let each = table.columns().iter().map(|column| {
        let known = |row: usize| Cell::number(column.cell(row));
        let all: Vec<f64> = (0..labels.len()).filter_map(known).collect();
        let of_style = (0..labels.len()).filter(|&row| labels[row] == style);
        let own: Vec<f64> = of_style.filter_map(known).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        let (total, own) = (mean(&all), mean(&own));
        let squares: Vec<f64> = all.iter().map(|v| (v - total).powi(2)).collect();
        let deviation = mean(&squares).sqrt();
        let z = match deviation > 0.0 {
            true => (own - total) / deviation,
            false => 0.0,
        };
        Mean {
            column: column.name().to_owned(),
            own,
            z,
        }
    });
    each.collect()
}

/// Fig. 11 left on real houses: the lateral edges of each source, beside those of the made houses.
pub(crate) fn edges(ctx: &mut Context) -> Result<()> {
    let made = data::shipped(ctx)?.truth.dependencies;
    let mut table = Table::new("Lateral edges found on real houses")
        .column("source", Align::Left)
        .column("edge", Align::Left)
        .column("also one of the nine of the made houses", Align::Left);
    let mut figure = Figure::new("lateral edges of real houses", 1);
    let discrete = GROUPS.iter().filter(|g| g.level == Level::Element);
    let discrete: Vec<String> = discrete.map(|g| g.name.to_owned()).collect();
    for (source, data, model) in learnt(ctx, &[DELFT])? {
        let found = model.lateral_edges();
        observe(ctx, source, "lateral_edges", found.len());
        ctx.compare(
            format!("lateral edges learned, {source}"),
            "9",
            found.len().to_string(),
        );
        let joined = |list: &[(String, String)], a: &str, b: &str| {
            let same = |(x, y): &(String, String)| (x == a && y == b) || (x == b && y == a);
            list.iter().any(same)
        };
        for (a, b) in &found {
            let also = if joined(&made, a, b) { "yes" } else { "no" };
            table.row([source.to_owned(), format!("{a}, {b}"), also.to_owned()]);
        }
        let names = model.real_groups().to_vec();
        let value = |a: &String, b: &String| f64::from(u8::from(joined(&found, a, b)));
        let rows = names
            .iter()
            .map(|a| names.iter().map(|b| value(a, b)).collect());
        let map = HeatMap::new(source, rows.collect(), "1 where an edge is found")
            .names(names.clone(), names.clone())
            .range(0.0, 1.0);
        figure = figure.panel(map);
        let has = |name: &String| data.groups.iter().any(|g| g.name == *name);
        let own: Vec<String> = discrete.iter().filter(|name| has(name)).cloned().collect();
        ctx.attach(
            &format!("figure_11_real_{source}.svg"),
            network::svg(&model, &own).as_bytes(),
            &format!("the network learnt from {source}"),
        )?;
    }
    ctx.table(&table);
    ctx.note(
        "Edges count without direction. Three attributes follow from one another (floor area ratio = coverage over the share \
         of the ground floor), on real houses as on made ones. The audited houses know window-to-wall ratios alone as numbers, \
         so that no lateral edge is possible there.",
    );
    ctx.figure("figure_11_real", &figure.cell(520.0, 440.0))
}
