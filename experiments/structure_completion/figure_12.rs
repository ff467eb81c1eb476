//! Fig. 12: several completions of one facade, with the share of the probability that each stands for.

use super::picture::panel;
use super::{data, folds, row};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::Figure;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::task::Task;

/// Completes a few facades in five ways.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let all = data::items(ctx)?;
    let items: Vec<&data::Item> = all
        .iter()
        .filter(|i| i.layout.count(Class::Window) > 7)
        .collect();
    let shown: Vec<usize> = [5, 3, 2].map(|part| items.len() / part).to_vec();
    let model = folds::fast_model(&items, ctx.seed(), |i| !shown.contains(&i))?;
    let mut figure = Figure::new("Truth, and five completions of the known half or corner", 6)
        .cell(200.0, 210.0);
    for (k, &index) in shown.iter().enumerate() {
        let layout = &items[index].layout;
        let task = [Task::Side50, Task::Corner36, Task::Side50][k];
        let mut rng = stream(ctx.seed(), "figure 12", k as u64);
        let (partial, _) = task.hide(layout, &mut rng);
        let (w, h) = (layout.width, layout.height);
        figure = figure.panel(panel(layout.name.clone(), w, h, &layout.elements, &[]));
        let completions = complete(Method::Best, &partial, &model, 5, &mut rng);
        for place in 0..5 {
            let found = completions.get(place);
            let added: Vec<Element> = found
                .into_iter()
                .flat_map(|c| c.added.iter().map(|a| a.element))
                .collect();
            let mass = found.map_or(0.0, |c| c.mass);
            let title = format!("{}: mass {mass:.2}", place + 1);
            figure = figure.panel(panel(title, w, h, &partial.observed, &added));
            let instance = format!("{}/{}/{}", task.name(), layout.name, place + 1);
            ctx.observe(row(
                items[index].dataset,
                "best",
                instance,
                None,
                "mass",
                mass,
            ));
        }
    }
    ctx.figure("figure_12", &figure)
}
