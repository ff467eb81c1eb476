//! Fig. 9: pairs of truth and completion. The paper asked people which looks more plausible; here the classifier of the
//! benchmark stands in for them.

use rand::seq::SliceRandom;

use super::picture::panel;
use super::{data, folds, row};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::Figure;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::task::Task;

/// Pairs in a row of the picture.
const PAIRS: usize = 5;

/// Draws up to 50 pairs of truth and completion.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let count = ctx.budget().choose(4, 50, 50);
    let all = data::items(ctx)?;
    let mut items: Vec<&data::Item> = all
        .iter()
        .filter(|i| i.layout.count(Class::Window) > 0)
        .collect();
    items.shuffle(&mut stream(ctx.seed(), "figure 9", 0));
    let (shown, rest) = items.split_at(count.min(items.len() / 2));
    let model = folds::fast_model(rest, ctx.seed(), |_| true)?;
    let mut figure =
        Figure::new("Truth and completion (added elements outlined)", 2 * PAIRS).cell(150.0, 170.0);
    for (k, item) in shown.iter().enumerate() {
        let task = Task::ALL[k % Task::ALL.len()];
        let mut rng = stream(ctx.seed(), "figure 9: task", k as u64);
        let (partial, hidden) = task.hide(&item.layout, &mut rng);
        let completions = complete(Method::Best, &partial, &model, 1, &mut rng);
        let added: Vec<Element> = completions
            .iter()
            .flat_map(|c| c.added.iter().map(|a| a.element))
            .collect();
        let f1 = agreement(&added, &hidden, 0.5).f1;
        let (w, h) = (item.layout.width, item.layout.height);
        figure = figure
            .panel(panel(
                item.layout.name.clone(),
                w,
                h,
                &item.layout.elements,
                &[],
            ))
            .panel(panel(
                format!("{} F1 {f1:.2}", task.name()),
                w,
                h,
                &partial.observed,
                &added,
            ));
        let instance = format!("{}/{}", task.name(), item.layout.name);
        ctx.observe(row(item.dataset, "best", instance, None, "f1", f1));
    }
    ctx.compare(
        "votes: truth / completion / both (134 people)",
        "31.5 % / 40.2 % / 28.3 %",
        "needs people",
    );
    ctx.figure("figure_9", &figure)
}
