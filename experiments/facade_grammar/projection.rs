//! Sec. 3.3: what regularization leaves as it was, on every set.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::data;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_facade_grammar::{Settings, infer};
use edifice_frame::{Budget, Context};
use edifice_grammar::{Costs, evaluate};
use edifice_io::read_label_grid;
use edifice_layout::regularize::{regularize_facade, regularize_grid};
use edifice_report::{Align, Table};
use edifice_shape::{Facade, decompose, splittable};

/// A layout to regularize.
enum Source {
    Tiling(Facade),
    Picture(PathBuf),
}

/// The effect of one tolerance on one layout.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Effect {
    /// Distinct sizes of the regions, summed over labels.
    sizes: (usize, usize),
    /// Cost of `best`; none where full lines cannot split the layout.
    cost: Option<(f64, f64)>,
    idempotent: bool,
}

/// Distinct sizes and costs before and after, and whether a second pass changes anything, by set and
/// tolerance.
pub(crate) fn table(ctx: &mut Context) -> Result<()> {
    let mut sources: Vec<(&str, String, Source)> = Vec::new();
    for facade in data::shipped(ctx)? {
        sources.push(("shipped", facade.name.clone(), Source::Tiling(facade)));
    }
    let limit = ctx.budget().choose(1, usize::MAX, usize::MAX);
    for (set, place, ending) in [
        ("ecp2011", "facades/ecp2011/labels", ".png"),
        ("graz50", "facades/graz50/labels", ".png"),
        ("cmp", "facades/cmp", ".xml"),
    ] {
        if let Some(folder) = ctx.real(place)? {
            for path in data::files(&folder, ending)?.into_iter().take(limit) {
                sources.push((set, data::stem(&path, ending), Source::Picture(path)));
            }
        }
    }
    let tolerances = match ctx.budget() {
        Budget::Smoke => vec![2.0],
        Budget::Default => vec![2.0],
        Budget::Paper => vec![0.5, 1.0, 2.0, 3.0, 5.0, 10.0],
    };
    let mut units = Vec::new();
    for &tolerance in &tolerances {
        units.extend(sources.iter().map(|source| (tolerance, source)));
    }
    let found = ctx.units(
        &units,
        |(tolerance, (set, name, _))| format!("projection/{tolerance}/{set}/{name}"),
        |(tolerance, (_, _, source))| effect(source, *tolerance),
    )?;
    let mut table = Table::new("A projection: sums over each set, costs by `best`")
        .column("set", Align::Left)
        .column("tolerance", Align::Right)
        .numbers([
            "layouts",
            "distinct sizes",
            "after",
            "with more",
            "cost",
            "after",
            "dearer",
            "idempotent",
        ]);
    let mut dearer = Vec::new();
    for &tolerance in &tolerances {
        for set in ["shipped", "ecp2011", "graz50", "cmp"] {
            let mine: Vec<_> = (units.iter().zip(&found))
                .filter(|((t, (of, ..)), _)| *t == tolerance && *of == set)
                .map(|((_, (_, name, _)), effect)| (name, effect))
                .collect();
            if mine.is_empty() {
                continue;
            }
            let sum = |of: &dyn Fn(&Effect) -> f64| mine.iter().map(|(_, e)| of(e)).sum::<f64>();
            let rises = |e: &Effect| e.cost.is_some_and(|(before, after)| after > before + 1e-9);
            let worse = mine.iter().filter(|(_, e)| rises(e));
            dearer.extend(worse.map(|(name, _)| format!("{set} {name} at {tolerance}")));
            table.row([
                set.to_string(),
                format!("{tolerance}"),
                format!("{}", mine.len()),
                format!("{}", sum(&|e| e.sizes.0 as f64)),
                format!("{}", sum(&|e| e.sizes.1 as f64)),
                format!("{}", sum(&|e| f64::from(e.sizes.1 > e.sizes.0))),
                format!("{:.1}", sum(&|e| e.cost.map_or(0.0, |c| c.0))),
                format!("{:.1}", sum(&|e| e.cost.map_or(0.0, |c| c.1))),
                format!("{}", sum(&|e| f64::from(rises(e)))),
                format!("{}", sum(&|e| f64::from(e.idempotent))),
            ]);
        }
    }
    ctx.table(&table);
    if !dearer.is_empty() {
        ctx.note(format!(
            "Dearer after regularization: {}.",
            dearer.join(", ")
        ));
    }
    Ok(())
}

fn effect(source: &Source, tolerance: f64) -> Result<Effect> {
    let (before, after, idempotent) = match source {
        Source::Tiling(facade) => {
            let (once, _) = regularize_facade(facade, tolerance).map_err(Error::method)?;
            let (twice, _) = regularize_facade(&once, tolerance).map_err(Error::method)?;
            let same = twice == once;
            (facade.clone(), once, same)
        }
        Source::Picture(path) => {
            let grid = read_label_grid(path, &Default::default())?;
            let (once, _) = regularize_grid(&grid, tolerance).map_err(Error::method)?;
            let (twice, _) = regularize_grid(&once, tolerance).map_err(Error::method)?;
            let tiling = |grid| decompose(grid).map_err(|e| Error::content(path, e));
            let same = twice == once;
            (tiling(&grid)?.facade, tiling(&once)?.facade, same)
        }
    };
    let cost = match (splittable(&before), splittable(&after)) {
        (Ok(()), Ok(())) => Some((cost(&before)?, cost(&after)?)),
        _ => None,
    };
    // The report counts regions of a tiling exactly as the method does.
    let sizes = |facade: &Facade| -> Result<usize> {
        let (_, report) = regularize_facade(facade, 0.0).map_err(Error::method)?;
        Ok(report.sizes.values().map(|(count, _)| count).sum())
    };
    Ok(Effect {
        sizes: (sizes(&before)?, sizes(&after)?),
        cost,
        idempotent,
    })
}

fn cost(facade: &Facade) -> Result<f64> {
    let one = std::slice::from_ref(facade);
    let found = infer(one, &Settings::default(), &unwatched).map_err(Error::method)?;
    let evaluation = evaluate(&found.grammar, one, &Costs::default()).map_err(Error::method)?;
    Ok(evaluation.cost)
}
