//! Made grids first: what has to come back perfectly.

use super::super::row;
use super::columns::{BASELINES, COLUMNS};
use super::measures::{added, perfect};
use super::models::Models;
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_structure_completion::made::grids::{self, Sight};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::model::Model;

/// One grid, of which a part is seen.
struct Unit {
    grid: usize,
    sight: Sight,
}

/// Completes made grids by the default model, a model of real facades, the quick baselines and the paper's method.
pub(crate) fn run(ctx: &mut Context, models: &Models) -> Result<()> {
    let mut columns: Vec<(&str, Method, &Model)> = vec![(COLUMNS[0], Method::Best, &models.all[0])];
    columns.extend(
        models
            .real
            .map(|k| (COLUMNS[1], Method::Best, &models.all[k])),
    );
    let quick = BASELINES.into_iter();
    let quick = quick.filter(|b| !b.is_slow() || *b == Method::Paper);
    columns.extend(quick.map(|b| (b.name(), b, &models.all[0])));
    let seed = ctx.seed();
    let made = grids::all(seed);
    let count = ctx.budget().choose(4, made.len(), made.len());
    let units: Vec<Unit> = Sight::ALL
        .into_iter()
        .flat_map(|sight| (0..count).map(move |grid| Unit { grid, sight }))
        .collect();
    let work = |u: &Unit| -> Result<Vec<bool>> {
        let (layout, size) = &made[u.grid];
        let rng = &mut stream(seed, u.sight.name(), u.grid as u64);
        let (partial, hidden) = u.sight.of(layout, *size, rng);
        let whole = |&(_, method, model): &(&str, Method, &Model)| {
            let rng = &mut stream(seed, "benchmark: grids", u.grid as u64);
            let done = complete(method, &partial, model, 1, rng);
            agreement(&added(done.first()), &hidden, 0.9).f1 == 1.0
        };
        Ok(columns.iter().map(whole).collect())
    };
    let key = |u: &Unit| format!("grid/{}/{}", u.sight.name(), u.grid);
    let found = ctx.units(&units, key, work)?;
    let mut table =
        Table::new("Made grids that come back perfectly, at an intersection over union of 0.9")
            .column("seen", Align::Left)
            .numbers(columns.iter().map(|c| c.0));
    for sight in Sight::ALL {
        let mut cells = vec![sight.name().to_owned()];
        for (k, (column, ..)) in columns.iter().enumerate() {
            let own = units.iter().zip(&found).filter(|(u, _)| u.sight == sight);
            let whole = own.filter(|(_, each)| each[k]).count();
            let instance = sight.name().to_owned();
            let share = whole as f64 / count.max(1) as f64;
            ctx.observe(row("grids", column, instance, Some(seed), "perfect", share));
            cells.push(perfect(whole, count));
        }
        table.row(cells);
    }
    ctx.table(&table);
    Ok(())
}
