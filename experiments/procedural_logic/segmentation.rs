//! Labels of a second labelling, inexact ones of the same facades: rules and retrieval, as given and cleaned.

use edifice_base::{Error, Result};
use edifice_procedural_logic::{Model, Parameters};
use edifice_report::{Align, Row, Table};
use edifice_shape::{LabelGrid, Lattice, clean, on_lattice};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::data::{Source, label_images, sources};
use super::noise::{outcome, rates};
use edifice_frame::{Budget, Context};

/// The numbers of one set of labels.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Numbers {
    rules: f64,
    axioms: f64,
    powerset: [f64; 2],
    lattice: [f64; 2],
    counts: [f64; 2],
}

/// A way to clean.
type Clean = fn(&LabelGrid) -> Result<LabelGrid>;

const WAYS: [(&str, Clean); 3] = [
    ("as_given", |grid| Ok(grid.clone())),
    ("specks_and_edges_3px", |grid| {
        clean(grid, 3.0).map_err(Error::method)
    }),
    ("rows_and_columns", |grid| Ok(on_lattice(grid))),
];

/// Exact labels and the second labelling under every way to clean.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let Some(exact) = sources(ctx)?.into_iter().find(Source::is_paper) else {
        ctx.skip("ECP2011 and its annotation are in the data folder (`--data`)");
        return Ok(());
    };
    let Some(folder) = ctx.real("facades/ecp2011_second_labels")? else {
        return Ok(());
    };
    let mut second = label_images(&folder)?;
    if ctx.budget() == Budget::Smoke {
        second.truncate(12);
    }
    // The gold standard is that of the exact labels of the same facade.
    let named = |grid: &LabelGrid| {
        let name = grid.name.trim_end_matches("_mask");
        exact.grids.iter().position(|other| other.name == name)
    };
    let known: Vec<(LabelGrid, usize)> = second
        .into_iter()
        .filter_map(|grid| named(&grid).map(|at| (grid, at)))
        .collect();
    let second = Source {
        grids: known.iter().map(|(grid, _)| grid.clone()).collect(),
        architecture: known
            .iter()
            .map(|(_, at)| exact.architecture[*at].clone())
            .collect(),
        by_hand: Vec::new(),
        other: Vec::new(),
        dataset: exact.dataset,
        other_dataset: exact.other_dataset,
        pictured: exact.pictured,
    };
    let sets = [("exact", exact), ("second", second)];
    let units: Vec<(usize, usize)> = (0..2)
        .flat_map(|s| (0..WAYS.len()).map(move |w| (s, w)))
        .collect();
    let key = |&(s, w): &(usize, usize)| format!("{}/{}", sets[s].0, WAYS[w].0);
    let found = ctx.units(&units, key, |&(s, w)| numbers(&sets[s].1, WAYS[w].1))?;
    let mut table = Table::new("Rules and retrieval (per cent at ranks 1 and 2)")
        .column("labels", Align::Left)
        .column("cleaned", Align::Left)
        .numbers([
            "facades",
            "rules",
            "rules of the axiom",
            "powersets",
            "lattices",
            "component counts",
        ]);
    for (&(s, w), numbers) in units.iter().zip(&found) {
        let pair = |rates: [f64; 2]| format!("{:.1} / {:.1}", 100.0 * rates[0], 100.0 * rates[1]);
        table.row([
            sets[s].0.to_owned(),
            WAYS[w].0.to_owned(),
            sets[s].1.grids.len().to_string(),
            format!("{}", numbers.rules),
            format!("{}", numbers.axioms),
            pair(numbers.powerset),
            pair(numbers.lattice),
            pair(numbers.counts),
        ]);
        for (metric, value) in [
            ("rules", numbers.rules),
            ("axiom_rules", numbers.axioms),
            ("rank_1", numbers.powerset[0]),
            ("rank_2", numbers.powerset[1]),
            ("lattice_rank_1", numbers.lattice[0]),
            ("lattice_rank_2", numbers.lattice[1]),
            ("counts_rank_1", numbers.counts[0]),
            ("counts_rank_2", numbers.counts[1]),
        ] {
            ctx.observe(Row {
                dataset: sets[s].0.into(),
                method: WAYS[w].0.into(),
                instance: "all".into(),
                metric: metric.into(),
                value,
                ..Row::default()
            });
        }
    }
    ctx.table(&table);
    ctx.note(
        "The second labelling is another group's, of half of the same facades: windows are boxes moved by themselves. The gold standard is that of the exact \
         labels of the same facade. *rows_and_columns* is `--clean`; *specks_and_edges_3px* is `--clean=3`. *Lattices* is `logic compare --measure lattice`: floors, window columns, doors and \
         running balconies are read off the labels and counted where they differ, as the gold standard does, without a rule. *Component counts* is the trivial baseline of Fig. 4 on \
         the same labels. Rules at the parameters of Sec. 5.3, retrieval at those of Sec. 5.4.",
    );
    Ok(())
}

fn numbers(source: &Source, way: Clean) -> Result<Numbers> {
    let grids = source.grids.iter().map(way).collect::<Result<Vec<_>>>()?;
    let found = outcome(source, &grids, &[])?;
    let model = Model::fit(&grids, Parameters::COMPRESSION).map_err(Error::method)?;
    let mut axioms: Vec<_> = model
        .facades
        .iter()
        .map(|known| known.instance.start)
        .collect();
    axioms.sort_unstable();
    axioms.dedup();
    Ok(Numbers {
        rules: found.rules,
        axioms: axioms.len() as f64,
        powerset: found.powerset,
        lattice: rates(source, &changes(&grids)),
        counts: found.counts,
    })
}

/// Architectural changes between the lattices of all pairs.
fn changes(grids: &[LabelGrid]) -> DMatrix<f64> {
    let lattices: Vec<Lattice> = grids.iter().map(Lattice::read).collect();
    let n = lattices.len();
    DMatrix::from_fn(n, n, |i, j| lattices[i].changes(&lattices[j]) as f64)
}
