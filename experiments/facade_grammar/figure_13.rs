//! Fig. 13: one grammar for several facades.

use super::published::Published;
use super::runs::{Answer, Question, Solver, solve};
use super::{BEST, PAPER, data, joint_real, picture};
use edifice_base::Result;
use edifice_frame::Context;
use edifice_report::{Align, Figure, Row, Table};
use edifice_shape::Facade;

/// The four terraces.
pub(crate) const FACADES: [&str; 4] = ["terrace_a", "terrace_b", "terrace_c", "terrace_d"];

/// Joint extraction from the four terraces, beside separate extraction.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (few, many) = super::iterations(ctx.budget());
    let iterations = ctx.budget().choose(few, many, many);
    let seeds = ctx.budget().choose(1, 3, 10);
    ctx.setting("iterations", iterations);
    ctx.setting("seeds", seeds);
    let folder = data::folder(ctx)?.join("layouts");
    let facades: Result<Vec<Facade>> = FACADES
        .iter()
        .map(|name| edifice_io::facade_json::read(&folder.join(format!("{name}.facade.json"))))
        .collect();
    let facades = facades?;
    // Each facade alone, then all of them.
    let groups: Vec<&[Facade]> = facades.chunks(1).chain([facades.as_slice()]).collect();
    let names: Vec<String> = facades
        .iter()
        .map(|f| f.name.clone())
        .chain(["joint".into()])
        .collect();
    let mut units = Vec::new();
    for method in [BEST, PAPER] {
        for g in 0..groups.len() {
            units.extend(
                (0..seeds).map(|run| (Solver::Infer(method, iterations), g, ctx.seed() + run)),
            );
        }
    }
    let answers = ctx.units(
        &units,
        |(solver, g, seed)| format!("{}/{}/{seed}", solver.name(), names[*g]),
        |&(solver, g, seed)| {
            let question = Question::new(solver, seed);
            solve(groups[g], &question).map(|(_, answer)| answer)
        },
    )?;
    for ((solver, g, seed), answer) in units.iter().zip(&answers) {
        for (metric, value) in [("cost", answer.cost), ("rules", answer.rules as f64)] {
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: solver.name(),
                instance: names[*g].clone(),
                seed: Some(*seed),
                metric: metric.into(),
                value,
                ..Row::default()
            });
        }
    }
    let printed = Published::read(ctx)?;
    for method in [BEST, PAPER] {
        let name = Solver::Infer(method, iterations).name();
        let best = |g: usize| -> Option<Answer> {
            units
                .iter()
                .zip(&answers)
                .filter(|((s, group, _), _)| s.name() == name && *group == g)
                .map(|(_, answer)| *answer)
                .min_by(|a, b| a.cost.total_cmp(&b.cost))
        };
        report(ctx, &printed, &name, &names, best);
    }
    let mut figure = Figure::new("the four facades", 4).cell(300.0, 330.0);
    for facade in &facades {
        figure = figure.panel(picture::tiles(&facade.name, facade));
    }
    ctx.figure("figure_13", &figure)?;
    ctx.note("The least cost over the seeds on both sides, so that the saving is not one of luck.");
    joint_real::run(ctx)
}

/// Sum of the separate grammars beside the joint one.
fn report(
    ctx: &mut Context,
    printed: &Published,
    method: &str,
    names: &[String],
    best: impl Fn(usize) -> Option<Answer>,
) {
    let mut table = Table::new(format!("{method}: least cost over the seeds"))
        .column("facade", Align::Left)
        .numbers(["#T", "cost", "rules"]);
    let mut sum = (0, 0.0, 0);
    let count = names.len() - 1;
    for (g, name) in names.iter().enumerate() {
        let Some(a) = best(g) else { continue };
        if g == count {
            table.row([
                "sum".into(),
                sum.0.to_string(),
                format!("{:.1}", sum.1),
                sum.2.to_string(),
            ]);
            let saving = 100.0 * (1.0 - a.cost / sum.1);
            let text = |k: [&str; 3]| printed.text(["figure_13", k[0], k[1], k[2], "value"]);
            ctx.compare(
                format!("{method}: sum of the separate costs, joint cost"),
                format!(
                    "{}, {}",
                    text(["separate", "sum", "cost"]),
                    text(["joint", "all", "cost"])
                ),
                format!("{:.1}, {:.1}", sum.1, a.cost),
            );
            ctx.compare(
                format!("{method}: per cent cheaper"),
                format!("about {}", text(["joint", "all", "saving_per_cent"])),
                format!("{saving:.1}"),
            );
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: method.into(),
                instance: "joint".into(),
                metric: "saving_per_cent".into(),
                value: saving,
                unit: "%".into(),
                ..Row::default()
            });
        }
        sum = (sum.0 + a.terminals, sum.1 + a.cost, sum.2 + a.rules);
        table.row([
            name.clone(),
            a.terminals.to_string(),
            format!("{:.1}", a.cost),
            a.rules.to_string(),
        ]);
    }
    ctx.table(&table);
}
