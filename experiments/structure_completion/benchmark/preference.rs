//! The layouts that the score of the paper prefers: a whole facade, or the same with a hole.

use super::super::row;
use super::models::Models;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_structure_completion::layout::Layout;
use edifice_structure_completion::made::grids;
use edifice_structure_completion::policy::paper_model;
use edifice_structure_completion::score::ScoreModel;

/// Share of the elements of a layout without which its score is less.
fn worse_without(score: &ScoreModel, layout: &Layout) -> f64 {
    let of = |elements: &[_]| {
        let facade = [layout.width, layout.height];
        score.score(&score.evaluate(facade, elements).features)
    };
    let whole = of(&layout.elements);
    let without = |at: usize| {
        let mut elements = layout.elements.clone();
        elements.remove(at);
        of(&elements)
    };
    let count = layout.elements.len();
    let less = (0..count).filter(|&at| without(at) < whole).count();
    less as f64 / count.max(1) as f64
}

/// Takes single elements away from made grids and from facades, and scores both by the default model.
pub(crate) fn run(ctx: &mut Context, models: &Models) -> Result<()> {
    let paper = paper_model(&models.all[0]);
    let paper = paper.ok_or_else(|| Error::option("--data", "no layout with elements"))?;
    let mut sets: Vec<(&str, Vec<Layout>)> = vec![(
        "made grids",
        grids::all(ctx.seed()).into_iter().map(|g| g.0).collect(),
    )];
    for tested in &models.tested {
        match sets.iter_mut().find(|s| s.0 == tested.set) {
            Some(known) => known.1.push(tested.layout.clone()),
            None => sets.push((tested.set, vec![tested.layout.clone()])),
        }
    }
    let mut table = Table::new(
        "The score of the paper by the default model: layouts that score above the same without any one element",
    )
    .column("layouts", Align::Left)
    .numbers(["number", "above all", "elements without which the score is less"]);
    for (set, layouts) in sets {
        let shares: Vec<f64> = layouts
            .iter()
            .map(|layout| worse_without(&paper.score, layout))
            .collect();
        let count = shares.len().max(1) as f64;
        let all = shares.iter().filter(|s| **s == 1.0).count() as f64 / count;
        let mean = shares.iter().sum::<f64>() / count;
        for (metric, value) in [("above_all", all), ("worse_without", mean)] {
            let instance = "deletions".to_owned();
            ctx.observe(row(set, "paper", instance, Some(ctx.seed()), metric, value));
        }
        table.row([
            set.to_owned(),
            layouts.len().to_string(),
            format!("{:.0} %", 100.0 * all),
            format!("{:.1} %", 100.0 * mean),
        ]);
    }
    ctx.table(&table);
    Ok(())
}
