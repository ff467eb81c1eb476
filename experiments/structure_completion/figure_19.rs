//! Fig. 19: low-rank completion has only the rows and columns that are seen.

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

/// Completes a facade with half of its elements, and with a known half, by low rank and by the default method.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let all = data::items(ctx)?;
    let items: Vec<&data::Item> = all
        .iter()
        .filter(|i| i.layout.count(Class::Window) > 7)
        .collect();
    let shown = items.len() / 2;
    let model = folds::fast_model(&items, ctx.seed(), |i| i != shown)?;
    let layout = &items[shown].layout;
    let mut figure =
        Figure::new("Observed, low-rank completion, default method, truth", 4).cell(240.0, 240.0);
    for task in [Task::R50, Task::Side50] {
        let mut rng = stream(ctx.seed(), "figure 19", task as u64);
        let (partial, hidden) = task.hide(layout, &mut rng);
        let (w, h) = (layout.width, layout.height);
        figure = figure.panel(panel(task.name().into(), w, h, &partial.observed, &[]));
        for method in [Method::LowRank, Method::Best] {
            let completions = complete(method, &partial, &model, 1, &mut rng);
            let added: Vec<Element> = completions
                .iter()
                .flat_map(|c| c.added.iter().map(|a| a.element))
                .collect();
            let f1 = agreement(&added, &hidden, 0.5).f1;
            let title = format!("{}: F1 {f1:.2}", method.option());
            figure = figure.panel(panel(title, w, h, &partial.observed, &added));
            let instance = format!("{}/{}", task.name(), layout.name);
            ctx.observe(row(
                items[shown].dataset,
                method.name(),
                instance,
                None,
                "f1",
                f1,
            ));
        }
        figure = figure.panel(panel("truth".into(), w, h, &layout.elements, &[]));
    }
    ctx.figure("figure_19", &figure)
}
