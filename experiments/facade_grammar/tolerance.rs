//! Segmentation in, short grammar out: cost against the share of the area that may become wrong.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, unwatched};
use edifice_facade_grammar::{Settings, infer};
use edifice_io::{LabelMap, ReadOptions, read_label_grid};
use edifice_layout::retile::retile;
use edifice_report::{Align, Chart, Corner, Figure, Row, Scale, Series, Table};
use edifice_shape::Facade;
use serde::{Deserialize, Serialize};

use super::data::{files, stem};
use super::runs::mean;
use crate::{Context, layouts};

/// The tolerances, in per cent of the area.
const TOLERANCES: [f64; 6] = [0.0, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Sets of label pictures: name, place, ending.
const SETS: [(&str, &str, &str); 5] = [
    ("ecp2011", "facades/ecp2011/labels", ".png"),
    ("ecp2011_second", "facades/ecp2011_second_labels", ".png"),
    ("graz50", "facades/graz50/labels", ".png"),
    ("paris_art_deco", "facades/paris_art_deco", ".txt.gz"),
    ("cmp", "facades/cmp", ".png"),
];

/// Cost, lower bound and wrong share at one tolerance.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Point {
    cost: f64,
    bound: f64,
    wrong: f64,
}

/// The curve of every set.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let most = ctx.budget().choose(1, 6, usize::MAX);
    let mut units: Vec<(&str, PathBuf)> = Vec::new();
    for (name, place, ending) in SETS {
        let Some(folder) = ctx.real(place)? else {
            continue;
        };
        let all = files(&folder, ending)?;
        let count = all.len().min(most);
        units.extend((0..count).map(|k| (name, all[k * all.len() / count].clone())));
    }
    if units.is_empty() {
        ctx.skip("the label pictures of real facades are in the data folder (`--data`)");
        return Ok(());
    }
    let key = |(name, path): &(&str, PathBuf)| format!("{name}/{}", stem(path, ".png"));
    let curves = ctx.units(&units, key, |(name, path)| curve(name, path))?;
    let mut table =
        Table::new("Mean cost (mean lower bound) over the facades of a set, by tolerance")
            .column("set", Align::Left)
            .numbers(["facades", "0 %", "0.25 %", "0.5 %", "1 %", "2 %", "4 %"]);
    let mut chart = Chart::new(
        "cost against the area that may become wrong",
        Scale::new("per cent of the area"),
        Scale::new("mean cost"),
    );
    for (name, ..) in SETS {
        let mine = units.iter().zip(&curves).filter(|(unit, _)| unit.0 == name);
        let mine: Vec<&Vec<Point>> = mine.map(|(_, curve)| curve).collect();
        if mine.is_empty() {
            continue;
        }
        let at = |k: usize, of: fn(&Point) -> f64| {
            mean(&mine.iter().map(|c| of(&c[k])).collect::<Vec<_>>())
        };
        let cells = (0..TOLERANCES.len())
            .map(|k| format!("{:.1} ({:.1})", at(k, |p| p.cost), at(k, |p| p.bound)));
        table.row(
            [name.to_owned(), mine.len().to_string()]
                .into_iter()
                .chain(cells),
        );
        let points = |of: fn(&Point) -> f64| {
            TOLERANCES
                .iter()
                .enumerate()
                .map(|(k, &t)| (t, at(k, of)))
                .collect::<Vec<_>>()
        };
        chart = chart.series(Series::marked(name, points(|p| p.cost)));
        chart = chart.series(Series::dashed(
            format!("{name}, bound"),
            points(|p| p.bound),
        ));
    }
    let rising = curves.iter().filter(|curve| {
        curve
            .windows(2)
            .any(|pair| pair[1].cost > pair[0].cost + 1e-9)
    });
    ctx.compare(
        "facades whose cost rises with the tolerance",
        "–",
        format!("{} of {}", rising.count(), curves.len()),
    );
    ctx.table(&table);
    let figure = Figure::new("cost against the area that may become wrong", 1).cell(720.0, 480.0);
    let figure = figure.panel(chart.legend(Corner::Above));
    ctx.figure("tolerance", &figure)?;
    for ((name, path), curve) in units.iter().zip(&curves) {
        for (point, tolerance) in curve.iter().zip(TOLERANCES) {
            for (metric, value) in [
                ("cost", point.cost),
                ("lower_bound", point.bound),
                ("wrong", point.wrong),
            ] {
                ctx.observe(Row {
                    dataset: (*name).into(),
                    method: format!("tolerance_{tolerance}"),
                    instance: stem(path, ".png"),
                    metric: metric.into(),
                    value,
                    ..Row::default()
                });
            }
        }
    }
    ctx.note(
        "Each label picture is retiled by merges (`layout::retile`, `grammar infer --tolerance`), and the cheapest picture within the tolerance is kept. \
         The bound is proven for the picture that was chosen, not over all pictures within the tolerance. Facades are evenly spread over each set: 6 of it \
         at the default budget, all at the paper's.",
    );
    Ok(())
}

/// Cost and bound of one picture at every tolerance.
fn curve(name: &str, path: &Path) -> Result<Vec<Point>> {
    let label_map = match name {
        "paris_art_deco" => Some(layouts::art_deco()?),
        "cmp" => Some(LabelMap::cmp()),
        _ => None,
    };
    let options = ReadOptions {
        label_map,
        ..ReadOptions::default()
    };
    let grid = read_label_grid(path, &options)?;
    let settings = Settings {
        iterations: 200,
        ..Settings::default()
    };
    // Tolerances share their pictures: each is priced once.
    let mut known: Vec<(Facade, f64, f64)> = Vec::new();
    let mut curve = Vec::new();
    for tolerance in TOLERANCES {
        let price = |facade: &Facade| -> Result<f64> {
            if let Some((_, cost, _)) = known.iter().find(|(f, ..)| f == facade) {
                return Ok(*cost);
            }
            let found = infer(std::slice::from_ref(facade), &settings, &unwatched)
                .map_err(Error::method)?;
            let cost = settings.costs.grammar(&found.grammar);
            known.push((
                facade.clone(),
                cost,
                found.lower_bound.unwrap_or(0.0).min(cost),
            ));
            Ok(cost)
        };
        let made =
            retile(&grid, None, tolerance / 100.0, price).map_err(|e| Error::content(path, e))?;
        let bound = known
            .iter()
            .find(|(f, ..)| *f == made.facade)
            .map_or(0.0, |k| k.2);
        curve.push(Point {
            cost: made.price,
            bound,
            wrong: made.wrong,
        });
    }
    Ok(curve)
}
