//! The costs of the other methods, relative to approximate dynamic programming.

use super::compare::Comparison;
use super::published::Published;
use super::runs::Solver;
use super::{BEST, PAPER};
use edifice_facade_grammar::Method;
use edifice_frame::Context;
use edifice_report::{Align, Row, Table};

/// Sets the ratio of average costs of each method to both configurations of ADP beside the ratio
/// of the paper's printed averages. `(name, random)`; random methods have `many` iterations.
pub(crate) fn compare(
    ctx: &mut Context,
    found: &Comparison,
    printed: &Published,
    many: u64,
    methods: &[(&str, bool)],
) {
    for (name, random) in methods {
        let method = match random {
            true => Solver::Infer(Method::Importance, many).name(),
            false => name.to_string(),
        };
        let theirs = printed.text(["ratios", name, "avg", "cost_over_adp", "value"]);
        for dataset in found.datasets() {
            let mut parts = Vec::new();
            for adp in [BEST, PAPER] {
                let adp = Solver::Infer(adp, many).name();
                let (Some(a), Some(m)) = (found.column(&adp), found.column(&method)) else {
                    continue;
                };
                // As the paper's averages: least over the runs, averaged over the facades.
                let ratio = found.average_least(dataset, m) / found.average_least(dataset, a);
                ctx.observe(Row {
                    dataset: dataset.into(),
                    method: method.clone(),
                    instance: "average".into(),
                    metric: format!("cost_over_{adp}"),
                    value: ratio,
                    ..Row::default()
                });
                parts.push(format!("{ratio:.2} ({adp})"));
            }
            let what = format!("cost of {name} over ADP, {dataset}");
            ctx.compare(what, theirs.clone(), parts.join(", "));
        }
    }
}

/// Counts the facades on which the best configuration is lowest, for each data set.
pub(crate) fn wins(ctx: &mut Context, found: &Comparison, many: u64) {
    let name = Solver::Infer(BEST, many).name();
    let Some(best) = found.column(&name) else {
        return;
    };
    for dataset in found.datasets() {
        let title = format!("{dataset}: facades on which {name} costs less, the same, more than");
        let mut table = Table::new(title).column("method", Align::Left).numbers([
            "less",
            "same",
            "more",
            "average lower by %",
        ]);
        for s in (0..found.solvers.len()).filter(|&s| s != best) {
            let [less, same, more] = found.wins(dataset, best, s);
            let saving =
                100.0 * (1.0 - found.average_mean(dataset, best) / found.average_mean(dataset, s));
            table.row([
                found.solvers[s].name(),
                less.to_string(),
                same.to_string(),
                more.to_string(),
                format!("{saving:.1}"),
            ]);
        }
        ctx.table(&table);
    }
}
