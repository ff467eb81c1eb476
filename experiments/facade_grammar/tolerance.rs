//! Segmentation in, short grammar out: cost against the share of the area that may become wrong.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, unwatched};
use edifice_facade_grammar::{Settings, infer};
use edifice_io::{LabelMap, ReadOptions, read_label_grid};
use edifice_layout::retile::{least_wrong_path, retile};
use edifice_report::{Align, Chart, Corner, Figure, Row, Scale, Series, Table, category};
use edifice_shape::Facade;
use serde::{Deserialize, Serialize};

use super::data::{files, stem};
use super::runs::mean;
use edifice_frame::{Context, layouts};

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
    /// The least cost of all tilings within the tolerance on the path of merges that make the least area wrong.
    merge_path: f64,
}

/// The curve of every set.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let mut units: Vec<(&str, PathBuf)> = Vec::new();
    for (name, place, ending) in SETS {
        let Some(folder) = ctx.real(place)? else {
            continue;
        };
        let all = files(&folder, ending)?;
        // The largest set, of the pictures that take longest.
        let few = if name == "cmp" { 6 } else { usize::MAX };
        let count = all.len().min(ctx.budget().choose(1, few, usize::MAX));
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
            .column("way", Align::Left)
            .numbers(["facades", "0 %", "0.25 %", "0.5 %", "1 %", "2 %", "4 %"]);
    let mut chart = Chart::new(
        "cost against the area that may become wrong",
        Scale::new("per cent of the area"),
        Scale::new("mean cost"),
    );
    for (k, (name, ..)) in SETS.into_iter().enumerate() {
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
        let first = |way: &str| [name.to_owned(), way.to_owned(), mine.len().to_string()];
        table.row(first("chosen").into_iter().chain(cells));
        let path = (0..TOLERANCES.len()).map(|k| format!("{:.1}", at(k, |p| p.merge_path)));
        table.row(first("merge path").into_iter().chain(path));
        let points = |of: fn(&Point) -> f64| {
            TOLERANCES
                .iter()
                .enumerate()
                .map(|(k, &t)| (t, at(k, of)))
                .collect::<Vec<_>>()
        };
        let (cost, bound) = (points(|p| p.cost), points(|p| p.bound));
        chart = chart.series(Series::marked(name, cost).colour(category(k)));
        chart = chart.series(Series::dashed("", bound).colour(category(k)));
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
                ("merge_path_cost", point.merge_path),
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
         The bound, dashed, is proven for the picture that was chosen, not over all pictures within the tolerance. *Merge path*: the strip between two lines \
         that makes the least area wrong goes to a neighbour, again and again; every picture on the way is priced, and the cheapest within the tolerance \
         counts (`layout::retile::least_wrong_path`). All pictures of a set, \
         but at the default budget 6 of CMP, evenly spread over it.",
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
    let mut price = |facade: &Facade| -> Result<(f64, f64)> {
        if let Some((_, cost, bound)) = known.iter().find(|(f, ..)| f == facade) {
            return Ok((*cost, *bound));
        }
        let found =
            infer(std::slice::from_ref(facade), &settings, &unwatched).map_err(Error::method)?;
        let cost = settings.costs.grammar(&found.grammar);
        let bound = found.lower_bound.unwrap_or(0.0).min(cost);
        known.push((facade.clone(), cost, bound));
        Ok((cost, bound))
    };
    let most = TOLERANCES[TOLERANCES.len() - 1] / 100.0;
    let tilings = least_wrong_path(&grid, most).map_err(|e| Error::content(path, e))?;
    let mut merge_path = Vec::new();
    for (facade, wrong) in &tilings {
        merge_path.push((*wrong, price(facade)?.0));
    }
    let mut curve = Vec::new();
    for tolerance in TOLERANCES.map(|t| t / 100.0) {
        let cost = |facade: &Facade| price(facade).map(|(cost, _)| cost);
        let made = retile(&grid, None, tolerance, cost).map_err(|e| Error::content(path, e))?;
        let within = merge_path.iter().filter(|(wrong, _)| *wrong <= tolerance);
        curve.push(Point {
            cost: made.price,
            bound: price(&made.facade)?.1,
            wrong: made.wrong,
            merge_path: within.map(|p| p.1).fold(f64::INFINITY, f64::min),
        });
    }
    Ok(curve)
}
