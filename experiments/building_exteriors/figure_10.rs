//! Fig. 10: the styles found.

use super::views::{FRONT, Panel, sheet};
use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::design::wanted_rows;
use edifice_building_exteriors::house::{Database, Generated, Options, generate};
use edifice_cluster::adjusted_rand_index;
use edifice_frame::Context;
use edifice_model::hierarchy::Hierarchy;
use edifice_model::{Cell, Table as Data};
use edifice_report::{Align, Colour, Figure, HeatMap, Row, Table, Tile, Tiles};
use edifice_shape::{BoxStyle, Building, PlanUnion, Rect};

/// Learns from the shipped houses and shows the styles, their most typical houses and means.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let table = &shipped.data.table;
    let learned = data::learned(&shipped.data, &settings, ctx.seed())?;
    let model = &learned.model;
    let posterior = model.style_posterior(table).map_err(Error::method)?;
    let labels: Vec<usize> = posterior.iter().map(|p| data::argmax(p)).collect();
    let agreement = adjusted_rand_index(&labels, &shipped.truth.styles);
    for (metric, value) in [
        ("styles", model.styles() as f64),
        ("adjusted_rand_index", agreement),
    ] {
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "ours".into(),
            instance: "all".into(),
            seed: Some(ctx.seed()),
            metric: metric.into(),
            value,
            ..Row::default()
        });
    }
    ctx.compare("styles learned", "7", model.styles().to_string());
    ctx.compare(
        "agreement with the generator's styles (adjusted Rand index)",
        "unknown truth",
        format!("{agreement:.3}"),
    );

    let densities = model.log_likelihood(table).map_err(Error::method)?;
    let mut figure = Figure::new(
        "the two most probable houses of each style, ground floor from above: main, garage, porch",
        4,
    )
    .cell(240.0, 230.0);
    for style in 0..model.styles() {
        let mut members: Vec<usize> = (0..labels.len()).filter(|&i| labels[i] == style).collect();
        members.sort_by(|&a, &b| densities[b].total_cmp(&densities[a]));
        for &i in members.iter().take(2) {
            let name = format!("style {}: {}", style + 1, shipped.buildings[i].name);
            figure = figure.panel(plan(&name, &shipped.buildings[i]));
        }
    }
    ctx.figure("figure_10", &figure)?;
    ctx.figure("figure_10_means", &means(table, &labels, model.styles()))?;

    let mut kinds = Table::new("Hidden variables of the attributes")
        .column("attribute", Align::Left)
        .column("kinds", Align::Right);
    for (group, count) in model.real_groups().iter().zip(model.cardinalities()) {
        kinds.row([group.clone(), count.to_string()]);
    }
    ctx.table(&kinds);
    let mut apart = Table::new("What sets the styles apart")
        .column("style", Align::Left)
        .column("houses", Align::Right)
        .column(
            "stands out by (standard deviations from the mean of all houses)",
            Align::Left,
        );
    for style in 0..model.styles() {
        let houses = labels.iter().filter(|&&l| l == style).count();
        let mut scores = deviations(table, &labels, style);
        scores.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let words = scores.iter().take(5).map(|(c, z)| format!("{c} {z:+.1}"));
        let words = words.collect::<Vec<_>>().join(", ");
        apart.row([(style + 1).to_string(), houses.to_string(), words]);
    }
    ctx.table(&apart);
    ctx.note(
        "The plans are those of the two training houses of highest density of each style; the picture of houses shows two \
         samples of each style, as in the paper: the most probable of 40 draws, and the most probable of 40 others.",
    );
    sampled_houses(ctx, model, shipped.buildings)
}

/// Two houses built from samples of each style, a style a column.
fn sampled_houses(ctx: &mut Context, model: &Hierarchy, buildings: Vec<Building>) -> Result<()> {
    let database = Database::new(buildings).map_err(Error::method)?;
    let mut rows: [Vec<Generated>; 2] = Default::default();
    for style in 0..model.styles() {
        for (k, row) in rows.iter_mut().enumerate() {
            let name = format!("building_exteriors/figure_10/{style}");
            let mut rng = stream(ctx.seed(), &name, k as u64);
            let draws = model
                .sample_style(style, DRAWS, &mut rng)
                .map_err(Error::method)?;
            let wanted = wanted_rows(&draws.table);
            let most = data::argmax(&draws.log_density);
            let (free, options) = ([false; 49], Options::default());
            let made = generate(
                "sample",
                &wanted[most],
                &free,
                &database,
                &options,
                &mut rng,
            );
            row.push(made.map_err(Error::method)?);
        }
    }
    let panels: Vec<Vec<Panel>> = rows
        .iter()
        .map(|row| {
            let each = row.iter().enumerate();
            each.map(|(s, house)| Panel::House(&house.model, s, FRONT))
                .collect()
        })
        .collect();
    let cell = ctx.budget().choose([60, 44], [240, 180], [240, 180]);
    ctx.attach(
        "figure_10_houses.png",
        &sheet(&panels, cell)?,
        "two houses sampled from each style, a style a column",
    )
}

/// Draws of a style, the most probable of which is built.
const DRAWS: usize = 40;

/// Mean of each column among the houses of a style, in standard deviations of all houses.
fn deviations(table: &Data, labels: &[usize], style: usize) -> Vec<(&'static str, f64)> {
    let value = |column: &str, row: usize| {
        let cell = table.column(column).map(|c| c.cell(row));
        cell.ok().and_then(Cell::number).unwrap_or(0.0)
    };
    let scores = COLUMNS.iter().map(|column| {
        let values: Vec<f64> = (0..table.rows()).map(|row| value(column, row)).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
        let of_style = values.iter().zip(labels).filter(|(_, l)| **l == style);
        let (sum, count) = of_style.fold((0.0, 0.0), |(s, c), (v, _)| (s + v, c + 1.0));
        let z = if sd > 0.0 && count > 0.0 {
            (sum / count - mean) / sd
        } else {
            0.0
        };
        (*column, z)
    });
    scores.collect()
}

fn means(table: &Data, labels: &[usize], styles: usize) -> Figure {
    let rows: Vec<Vec<f64>> = (0..styles)
        .map(|s| {
            deviations(table, labels, s)
                .iter()
                .map(|(_, z)| *z)
                .collect()
        })
        .collect();
    let columns: Vec<&str> = COLUMNS.to_vec();
    let by_column: Vec<Vec<f64>> = (0..columns.len())
        .map(|c| rows.iter().map(|row| row[c]).collect())
        .collect();
    let names = (1..=styles).map(|s| format!("style {s}")).collect();
    let map = HeatMap::new("means of the styles", by_column, "standard deviations")
        .names(columns.iter().map(|c| (*c).to_owned()).collect(), names)
        .range(-2.0, 2.0);
    Figure::new("means of the attributes by style", 1)
        .cell(620.0, 900.0)
        .panel(map)
}

const MAIN: Colour = Colour::new(200, 204, 210);
const GARAGE: Colour = Colour::new(88, 160, 96);
const PORCH: Colour = Colour::new(76, 120, 200);

/// The boxes of a house from above.
fn plan(name: &str, building: &Building) -> Tiles {
    let all: Vec<Rect> = building.boxes.iter().map(|b| b.plan()).collect();
    let bounds = PlanUnion::new(&all)
        .bounding_box()
        .unwrap_or(Rect::new(0.0, 0.0, 1.0, 1.0));
    let tiles = building.boxes.iter().map(|b| {
        let r = b.plan();
        Tile {
            x: r.x - bounds.x,
            y: r.y - bounds.y,
            width: r.width,
            height: r.height,
            colour: match b.style {
                BoxStyle::Main => MAIN,
                BoxStyle::Garage => GARAGE,
                BoxStyle::Porch => PORCH,
            },
        }
    });
    let caption = format!(
        "{:.0} m x {:.0} m, {} floors",
        bounds.width,
        bounds.height,
        building.floors()
    );
    Tiles::new(name, bounds.width, bounds.height, tiles.collect()).caption(caption)
}
