//! The room that real facades leave: the greatest saving below `paper` that any grammar could have.

use serde::{Deserialize, Serialize};

use super::compare::Comparison;
use super::runs::{Solver, mean};
use super::{BEST, PAPER};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_facade_grammar::{BoundLimits, Settings, lower_bound};
use edifice_frame::Context;
use edifice_report::{Align, Row, Table};

/// Saving that the table asks about, in per cent.
const ASKED: f64 = 5.0;

/// Enough for a bound; the search for proofs on small facades is an artefact of its own.
const LIMITS: BoundLimits = BoundLimits {
    items: 5_000_000,
    root_steps: 1_000,
    branch_steps: 100,
    nodes: 40,
    work: u64::MAX,
};

/// Iterations for the grammar that the bound starts from.
const ITERATIONS: u64 = 500;

/// A bound, and whether it only counts labels.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Lower {
    cost: f64,
    weak: bool,
}

/// The savings on one facade, in per cent of the cost of `paper`.
struct Room {
    /// The saving of `best`.
    saved: f64,
    /// The saving that no grammar exceeds.
    most: f64,
    /// True if `best` is proven optimal.
    optimal: bool,
}

/// Bounds every real facade of a comparison under the operations of [`Settings::default`].
pub(crate) fn table(ctx: &mut Context, found: &Comparison, many: u64) -> Result<()> {
    let column = |method| found.column(&Solver::Infer(method, many).name());
    let (Some(best), Some(paper)) = (column(BEST), column(PAPER)) else {
        return Ok(());
    };
    let real: Vec<usize> = (0..found.instances.len())
        .filter(|&i| found.instances[i].dataset != "shipped")
        .collect();
    if real.is_empty() {
        return Ok(());
    }
    let settings = Settings {
        iterations: ITERATIONS,
        seed: ctx.seed(),
        ..Settings::default()
    };
    let bounds: Vec<Lower> = ctx.units(
        &real,
        |&i| {
            let instance = &found.instances[i];
            format!("bound/{}/{}", instance.dataset, instance.facade.name)
        },
        |&i| {
            let bound = lower_bound(&found.instances[i].facade, &settings, &LIMITS, &unwatched);
            bound
                .map(|b| Lower {
                    cost: b.lower,
                    weak: b.weak.is_some(),
                })
                .map_err(Error::method)
        },
    )?;
    let mut table = Table::new(
        "Real facades: saving of `adp_best` over `adp_paper`, mean per cent of each facade's cost",
    )
    .column("data", Align::Left)
    .numbers([
        "facades",
        "saved %",
        "possible %, at most",
        "proven optimal",
        &format!("proven to leave less than {ASKED} %"),
        "weak bounds",
    ]);
    let rooms = real.iter().zip(&bounds).map(|(&i, bound)| {
        let (b, p) = (found.mean_cost(i, best), found.mean_cost(i, paper));
        let room = Room {
            saved: 100.0 * (1.0 - b / p),
            most: 100.0 * (1.0 - bound.cost / p),
            optimal: found.least_cost(i, best) <= bound.cost + 1e-6,
        };
        (found.instances[i].dataset, room, bound.weak)
    });
    let rooms: Vec<_> = rooms.collect();
    let mut names: Vec<&str> = rooms.iter().map(|(dataset, ..)| *dataset).collect();
    names.dedup();
    names.push("all");
    for name in names {
        let mine = || rooms.iter().filter(|r| r.0 == name || name == "all");
        let average = |of: fn(&Room) -> f64| mean(&mine().map(|r| of(&r.1)).collect::<Vec<_>>());
        let (saved, most) = (average(|r| r.saved), average(|r| r.most));
        table.row([
            name.to_owned(),
            mine().count().to_string(),
            format!("{saved:.1}"),
            format!("{most:.1}"),
            mine().filter(|r| r.1.optimal).count().to_string(),
            mine().filter(|r| r.1.most < ASKED).count().to_string(),
            mine().filter(|r| r.2).count().to_string(),
        ]);
        for (metric, value) in [("saving", saved), ("saving_at_most", most)] {
            ctx.observe(Row {
                dataset: name.into(),
                method: Solver::Infer(BEST, many).name(),
                instance: "average".into(),
                metric: metric.into(),
                value,
                unit: "%".into(),
                ..Row::default()
            });
        }
    }
    ctx.table(&table);
    ctx.note(format!(
        "*possible %, at most* is what `adp_best` would save if its grammars cost no more than the lower bounds: no grammar of these \
         facades saves more, whatever the method (Lagrangian bound with {} branches at most; the first page of `methods::facade_grammar` has the \
         proof, and says which grammars are bounded).",
        LIMITS.nodes
    ));
    Ok(())
}
