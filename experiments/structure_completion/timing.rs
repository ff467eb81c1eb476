//! Seconds of a completion in five ways, and of learning a model from 100 facades.

use std::time::Instant;

use super::{data, row};
use crate::experiments::Context;
use crate::methods::structure_completion::layout::{Class, Layout};
use crate::methods::structure_completion::method::{Method, complete};
use crate::methods::structure_completion::model::Model;
use crate::methods::structure_completion::task::Task;
use crate::report::{Align, Table};
use crate::rng::stream;
use crate::{Error, Result};

/// Facades that are learnt from.
const LEARNT: usize = 100;

/// Measures on one thread after another.
pub fn run(ctx: &mut Context) -> Result<()> {
    let items = data::items(ctx)?;
    let layouts: Vec<Layout> = items.iter().map(|i| i.layout.clone()).collect();
    let start = Instant::now();
    let some = layouts.iter().take(LEARNT).cloned().collect();
    let model = Model::train(some, ctx.seed()).map_err(Error::method)?;
    let learning = start.elapsed().as_secs_f64();
    let dataset = items.first().map_or("shipped", |i| i.dataset);
    let mut all = Vec::new();
    let completed = ctx.budget().choose(3, 100, 400);
    for (k, item) in items
        .iter()
        .filter(|i| i.layout.count(Class::Window) > 0)
        .take(completed)
        .enumerate()
    {
        let mut rng = stream(ctx.seed(), "timing", k as u64);
        let task = Task::ALL[k % Task::ALL.len()];
        let (partial, _) = task.hide(&item.layout, &mut rng);
        let start = Instant::now();
        complete(Method::Best, &partial, &model, 5, &mut rng);
        all.push(start.elapsed().as_secs_f64());
    }
    all.sort_by(f64::total_cmp);
    let median = all.get(all.len() / 2).copied().unwrap_or(0.0);
    let mut table = Table::new("Seconds")
        .column("what", Align::Left)
        .numbers(["seconds"]);
    for (instance, seconds) in [("complete_5", median), ("learning", learning)] {
        ctx.observe(row(
            dataset,
            "best",
            instance.into(),
            None,
            "seconds",
            seconds,
        ));
        table.row([instance.to_string(), format!("{seconds:.4}")]);
    }
    ctx.table(&table);
    ctx.compare(
        "completion of one facade, 10,000 candidates",
        "16.7 s",
        format!("{median:.3} s (median, five ways)"),
    );
    ctx.compare(
        "learning the weights from 100 facades",
        "44.1 s",
        format!("{learning:.1} s (all that the default method learns)"),
    );
    Ok(())
}
