//! Table 2: the automatic methods, split rule only.

use super::compare::{self, Plan};
use super::data::FIGURE_9;
use super::published::Published;
use super::runs::Solver;
use super::{BEST, PAPER, ratios};
use crate::Result;
use crate::experiments::Context;
use crate::methods::facade_grammar::{Method, Operations};
use crate::report::{Align, Table};

/// Costs of five methods with splits alone.
pub fn run(ctx: &mut Context) -> Result<()> {
    let (_, many) = super::iterations(ctx.budget());
    let plan = Plan {
        solvers: vec![
            Solver::ProceduralLogic,
            Solver::Infer(Method::Bayesian, 1),
            Solver::Infer(Method::Symmetry, 1),
            Solver::Infer(PAPER, many),
            Solver::Infer(BEST, many),
        ],
        operations: Operations::split_only(),
        metrics: &["cost"],
    };
    let found = compare::run(ctx, plan)?;
    let printed = Published::read(ctx)?;
    for dataset in found.datasets() {
        let title = format!("{dataset}: cost with splits only, least/mean over the seeds");
        ctx.table(&found.table(title, dataset, |a| a.cost, 1, true));
    }
    ctx.table(&published(&printed));
    if let Some(i) = found
        .instances
        .iter()
        .position(|i| i.facade.name == FIGURE_9)
    {
        let names = ["procedural_logic", "bayesian", "symmetry", "adp", "adp"];
        for (s, name) in names.into_iter().enumerate() {
            ctx.compare(
                format!("facade (i), cost, {}", found.solvers[s].name()),
                printed.text(["table_2", name, "i", "cost", "value"]),
                format!("{:.1}", found.least_cost(i, s)),
            );
        }
    }
    let methods = [
        ("procedural_logic", false),
        ("bayesian", false),
        ("symmetry", false),
    ];
    ratios::compare(ctx, &found, &printed, many, &methods);
    ratios::wins(ctx, &found, many);
    ctx.note(
        "The columns U1 to U7 of the paper are grammars that people made; they need people, and are in `published.csv` only. \
         Every grammar here was derived back to its facade and costed by the same evaluator.",
    );
    Ok(())
}

fn published(printed: &Published) -> Table {
    let methods = ["procedural_logic", "bayesian", "symmetry", "adp"];
    let users: Vec<String> = (1..=7).map(|u| format!("user_{u}")).collect();
    let columns: Vec<&str> = methods
        .into_iter()
        .chain(users.iter().map(String::as_str))
        .collect();
    let mut table = Table::new("Printed in the paper: cost with splits only")
        .column("facade", Align::Left)
        .numbers(columns.iter().copied());
    for facade in ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "avg"] {
        let costs = columns
            .iter()
            .map(|method| printed.text(["table_2", method, facade, "cost", "value"]));
        table.row(std::iter::once(format!("({facade})")).chain(costs));
    }
    table
}
