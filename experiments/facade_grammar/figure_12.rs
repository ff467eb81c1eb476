//! Fig. 12: a facade resized by its grammar, elements aligned by quadratic programming.

use rand::SeedableRng;

use super::runs::{Question, Solver, solve};
use super::{BEST, data, picture};
use crate::Context;
use edifice_base::{Error, Result};
use edifice_grammar::{derivation, derive_at, size_independent};
use edifice_layout::resize::{ALIGN_REACH, ALIGN_TOLERANCE, Aligned, align};
use edifice_report::{Align, Figure, Row, Table};
use edifice_shape::{Facade, is_background};

/// Facade to resize.
const FACADE: &str = "boulevard_1";
/// Resizes to other widths and heights, with and without alignment.
pub fn run(ctx: &mut Context) -> Result<()> {
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
    let mut figure = Figure::new("resized facades, before and after alignment", 5)
        .cell(270.0, 340.0)
        .panel(picture::tiles("Input", &facade));
    let mut table = Table::new("Cut lines and sizes of elements before and after alignment")
        .column("size", Align::Left)
        .numbers([
            "lines",
            "aligned",
            "sizes of elements in the input",
            "derived",
            "aligned",
            "sizes of panes in the input",
            "derived",
            "aligned",
            "largest move (cm)",
        ]);
    for (wide, high) in [(1.4, 1.0), (0.8, 1.3)] {
        let (width, height) = (
            (facade.width * wide).round(),
            (facade.height * high).round(),
        );
        // The grammar is deterministic: nothing is drawn from this stream.
        let mut stream = edifice_base::rng::Stream::seed_from_u64(ctx.seed());
        let derived = derive_at(&free, 0, width, height, &mut stream).map_err(Error::method)?;
        let Aligned {
            facade: aligned,
            largest_move,
            ..
        } = align(&own, &derived).map_err(Error::method)?;
        let resized = derived.facade;
        let name = format!("{wide} x {high}");
        figure = figure
            .panel(picture::tiles(&name, &resized).caption("derived"))
            .panel(picture::tiles(&name, &aligned).caption("aligned"));
        let numbers = [
            lines(&resized) as f64,
            lines(&aligned) as f64,
            sizes(&facade, is_element) as f64,
            sizes(&resized, is_element) as f64,
            sizes(&aligned, is_element) as f64,
            sizes(&facade, is_pane) as f64,
            sizes(&resized, is_pane) as f64,
            sizes(&aligned, is_pane) as f64,
            largest_move,
        ];
        let metrics = [
            "lines",
            "lines_aligned",
            "sizes_input",
            "sizes",
            "sizes_aligned",
            "pane_sizes_input",
            "pane_sizes",
            "pane_sizes_aligned",
            "largest_move",
        ];
        for (metric, value) in metrics.into_iter().zip(numbers) {
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: "resize".into(),
                instance: name.clone(),
                metric: metric.into(),
                value,
                unit: if metric == "largest_move" { "cm" } else { "" }.into(),
                ..Row::default()
            });
        }
        let cells = numbers.map(|n| format!("{n:.0}"));
        table.row(std::iter::once(name).chain(cells));
    }
    ctx.figure("figure_12", &figure)?;
    ctx.table(&table);
    ctx.note(
        "The paper shows one resized facade and prints no numbers. Sizes become relative but for thin parts, repeats fill the space \
         (Sec. 5); then a quadratic program with linear constraints gives all terminals that are equal in the input one size, and \
         merges edges within the tolerance into one line as far as the sizes allow. *Sizes* count pairs of a label with a width and a \
         height, of everything but wall and roof: no more than in the input when all equal terminals are equal.",
    );
    Ok(())
}

/// Distinct coordinates of edges, both axes together.
fn lines(facade: &Facade) -> usize {
    let rounded = |v: f64| (v * 1e3).round() as i64;
    let count = |edges: Vec<i64>| {
        edges
            .into_iter()
            .collect::<std::collections::BTreeSet<_>>()
            .len()
    };
    let of = |edge: fn(&edifice_shape::Rect) -> [f64; 2]| {
        let edges = facade.regions.iter().flat_map(|r| edge(&r.rect));
        count(edges.map(rounded).collect())
    };
    of(|r| [r.x, r.right()]) + of(|r| [r.y, r.top()])
}

/// Distinct sizes of the regions of some labels, label by label.
fn sizes(facade: &Facade, counts: fn(&str) -> bool) -> usize {
    let regions = facade.regions.iter().filter(|r| counts(&r.label));
    regions
        .map(|r| {
            let size = [r.rect.width, r.rect.height].map(|v| (v * 1e3).round() as i64);
            (&r.label, size)
        })
        .collect::<std::collections::BTreeSet<_>>()
        .len()
}

fn is_pane(label: &str) -> bool {
    label == "glass"
}

fn is_element(label: &str) -> bool {
    !is_background(label)
}
