//! Fig. 12: facades at other sizes: each floor by its rules, with alignment, and by whole bands.

use std::collections::BTreeSet;

use rand::SeedableRng;

use super::runs::{Question, Solver, mean, solve};
use super::{BEST, data, picture};
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_grammar::{derivation, derive_at, size_independent};
use edifice_layout::resize::{ALIGN_REACH, ALIGN_TOLERANCE, align, resized};
use edifice_report::{Align, Figure, Row, Table, Tile, Tiles};
use edifice_shape::{Facade, Region, is_background};

/// Facade of the figure.
pub(crate) const FACADE: &str = "boulevard_1";

/// Sizes of the figure, and widths of the table over all layouts.
const SIZES: [(f64, f64); 3] = [(1.4, 1.0), (0.8, 1.3), (2.0, 1.0)];
const WIDTHS: [f64; 4] = [0.8, 1.2, 1.4, 2.0];

/// Coordinates are equal up to this share of the longer side.
const NOISE: f64 = 1e-5;

/// One facade in three ways, and all shipped layouts by bands.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (few, _) = super::iterations(ctx.budget());
    ctx.setting("facade", FACADE);
    ctx.setting("reach", ALIGN_REACH);
    ctx.setting("tolerance", ALIGN_TOLERANCE);
    ctx.setting("iterations", few);
    let path = data::folder(ctx)?.join(format!("layouts/{FACADE}.facade.json"));
    let facade = edifice_io::facade_json::read(&path)?;
    let question = Question::new(Solver::Infer(BEST, few), ctx.seed());
    let (grammar, _) = solve(std::slice::from_ref(&facade), &question)?;
    let free = size_independent(&grammar);
    let own = derivation(&free, 0).map_err(Error::method)?;
    // One scale for all panels.
    let most =
        |axis: fn(&(f64, f64)) -> f64, side: f64| side * SIZES.iter().map(axis).fold(1.0, f64::max);
    let canvas = (most(|s| s.0, facade.width), most(|s| s.1, facade.height));
    let mut figure = Figure::new("one facade at other sizes, at one scale", 3)
        .cell(400.0, 470.0)
        .panel(panel("Input", &facade, canvas));
    let mut table = Table::new("Panes in line with the next floor, and sizes of elements")
        .column("size", Align::Left)
        .column("way", Align::Left)
        .numbers([
            "panes",
            "in line (%)",
            "sizes of panes",
            "sizes of elements",
            "scale x",
            "scale y",
        ]);
    let mut tell = |ctx: &mut Context, size: &str, way: &str, facade: &Facade, scale: [f64; 2]| {
        let numbers = [
            ("panes", panes(facade).len() as f64),
            ("in_line", in_line(facade)),
            ("pane_sizes", sizes(&panes(facade)) as f64),
            ("element_sizes", sizes(&elements(facade)) as f64),
            ("scale_x", scale[0]),
            ("scale_y", scale[1]),
        ];
        for (metric, value) in numbers {
            observe(ctx, way, size, metric, value);
        }
        let [panes, line, of_panes, of_elements, x, y] = numbers.map(|n| n.1);
        table.row([
            size.to_owned(),
            way.to_owned(),
            format!("{panes:.0}"),
            format!("{:.0}", 100.0 * line),
            format!("{of_panes:.0}"),
            format!("{of_elements:.0}"),
            format!("{x:.2}"),
            format!("{y:.2}"),
        ]);
    };
    tell(ctx, "input", "", &facade, [1.0; 2]);
    let mut panels = Vec::new();
    for (wide, high) in SIZES {
        let (width, height) = (
            (facade.width * wide).round(),
            (facade.height * high).round(),
        );
        // The grammar is deterministic: nothing is drawn from this stream.
        let mut stream = edifice_base::rng::Stream::seed_from_u64(ctx.seed());
        let derived = derive_at(&free, 0, width, height, &mut stream).map_err(Error::method)?;
        let aligned = align(&own, &derived).map_err(Error::method)?.facade;
        let banded = resized(&facade, width, height).map_err(Error::method)?;
        let name = format!("{wide} x {high}");
        tell(ctx, &name, "floor by floor", &derived.facade, [1.0; 2]);
        tell(ctx, &name, "floor by floor, aligned", &aligned, [1.0; 2]);
        tell(ctx, &name, "by bands", &banded.facade, banded.scale);
        panels.push(panel(&name, &aligned, canvas).caption("floor by floor, aligned"));
        panels.push(panel(&name, &banded.facade, canvas).caption("by bands"));
    }
    // Below each other: the two ways.
    for k in [0, 4, 1, 3, 5] {
        figure = figure.panel(panels[k].clone());
    }
    ctx.figure("figure_12", &figure)?;
    ctx.table(&table);
    all_layouts(ctx)?;
    ctx.note(
        "The paper shows one resized facade and prints no numbers. *Floor by floor*: sizes become relative but for thin parts, and repeats fill the space \
         (Sec. 5); *aligned*: then a quadratic program gives terminals that are equal in the input one size and merges edges into lines. *By bands* \
         (`grammar derive --bands`): columns that stand together repeat together in all floors, and the rest is scaled. A pane (glass, or a window \
         where there is none) is *in line* when one of the next floor has its left and right sides. *Scale*: what bands leave to stretching; stretching alone \
         would keep every alignment and show no columns.",
    );
    Ok(())
}

/// All shipped layouts at four widths and at 1.3 times the height.
fn all_layouts(ctx: &mut Context) -> Result<()> {
    let layouts = data::shipped(ctx)?;
    let mut table =
        Table::new("All shipped layouts by bands: panes in line, as a share of the input's")
            .column("size", Align::Left)
            .numbers([
                "layouts",
                "mean",
                "least",
                "below 0.9",
                "mean |ln scale|",
                "scaled by more than 1.15",
                "bands added",
            ])
            .column("least of", Align::Left);
    let sizes = WIDTHS.map(|w| (w, 1.0)).into_iter().chain([(1.0, 1.3)]);
    for (wide, high) in sizes {
        let name = format!("{wide} x {high}");
        let (mut shares, mut scales, mut bands) = (Vec::new(), Vec::new(), Vec::new());
        let mut least = (f64::INFINITY, String::new());
        for layout in &layouts {
            let (width, height) = (layout.width * wide, layout.height * high);
            let found = resized(layout, width, height).map_err(Error::method)?;
            found.facade.check_tiling().map_err(Error::method)?;
            let before = in_line(layout);
            let share = if before > 0.0 {
                in_line(&found.facade) / before
            } else {
                1.0
            };
            let k = usize::from(high != 1.0);
            for (metric, value) in [
                ("in_line_kept", share),
                ("scale", found.scale[k]),
                ("bands", found.bands[k] as f64),
            ] {
                observe(ctx, &name, &layout.name, metric, value);
            }
            if share < least.0 {
                least = (share, layout.name.clone());
            }
            shares.push(share);
            scales.push(found.scale[k].ln().abs());
            bands.push(found.bands[k] as f64);
        }
        let below = shares.iter().filter(|&&share| share < 0.9).count();
        let stretched = scales.iter().filter(|&&scale| scale > 1.15f64.ln()).count();
        table.row([
            name,
            layouts.len().to_string(),
            format!("{:.3}", mean(&shares)),
            format!("{:.2}", least.0),
            below.to_string(),
            format!("{:.3}", mean(&scales)),
            stretched.to_string(),
            format!("{:.1}", mean(&bands)),
            least.1,
        ]);
    }
    ctx.table(&table);
    Ok(())
}

fn observe(ctx: &mut Context, method: &str, instance: &str, metric: &str, value: f64) {
    ctx.observe(Row {
        dataset: "shipped".into(),
        method: method.into(),
        instance: instance.into(),
        metric: metric.into(),
        value,
        ..Row::default()
    });
}

/// A facade on a canvas that all panels share.
fn panel(title: &str, facade: &Facade, (width, height): (f64, f64)) -> Tiles {
    let tiles = facade.regions.iter().map(|region| Tile {
        x: region.rect.x,
        y: region.rect.y,
        width: region.rect.width,
        height: region.rect.height,
        colour: picture::material(&region.label),
    });
    Tiles::new(title, width, height, tiles.collect())
}

fn elements(facade: &Facade) -> Vec<&Region> {
    facade
        .regions
        .iter()
        .filter(|r| !is_background(&r.label))
        .collect()
}

fn panes(facade: &Facade) -> Vec<&Region> {
    let of = |label: &str| facade.regions.iter().filter(|r| r.label == label).collect();
    let glass: Vec<&Region> = of("glass");
    if glass.is_empty() {
        of("window")
    } else {
        glass
    }
}

/// The share of the panes below a next floor that have their like in line there.
fn in_line(facade: &Facade) -> f64 {
    let noise = NOISE * facade.width.max(facade.height);
    let mut own = panes(facade);
    own.sort_by(|a, b| a.rect.y.total_cmp(&b.rect.y));
    let mut floors: Vec<Vec<&Region>> = Vec::new();
    for pane in own {
        match floors.last_mut() {
            Some(floor) if pane.rect.y < floor[0].rect.top() - noise => floor.push(pane),
            _ => floors.push(vec![pane]),
        }
    }
    let (mut all, mut kept) = (0, 0);
    for pair in floors.windows(2) {
        for pane in &pair[0] {
            let same = |other: &&Region| {
                (other.rect.x - pane.rect.x).abs() <= noise
                    && (other.rect.right() - pane.rect.right()).abs() <= noise
            };
            all += 1;
            kept += usize::from(pair[1].iter().any(same));
        }
    }
    kept as f64 / f64::from(all.max(1))
}

/// Distinct sizes, label by label.
fn sizes(regions: &[&Region]) -> usize {
    let size = |r: &&Region| {
        let size = [r.rect.width, r.rect.height].map(|v| (v * 1e3).round() as i64);
        (r.label.clone(), size)
    };
    regions.iter().map(size).collect::<BTreeSet<_>>().len()
}
