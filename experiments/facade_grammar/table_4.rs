//! Tables 4 and 5: likeness of the inferred grammars to known ones.

use super::likeness::{Likeness, likeness};
use super::published::Published;
use super::runs::{Question, Solver, mean, solve};
use super::{BEST, PAPER, data};
use crate::Result;
use crate::experiments::Context;
use crate::grammar::Costs;
use crate::methods::facade_grammar::{Method, Operations};
use crate::report::{Align, Row, Table};

/// Rows of a table: a name, and what to run.
type Case = (String, Question);

/// Table 4: five automatic methods against the grammars that the facades were derived from.
pub fn table_4(ctx: &mut Context) -> Result<()> {
    let (_, many) = super::iterations(ctx.budget());
    let question = |solver, operations| Question {
        operations,
        ..Question::new(solver, ctx.seed())
    };
    let plain = Operations::default();
    let cases: Vec<Case> = [
        Solver::ProceduralLogic,
        Solver::Infer(Method::Bayesian, 1),
        Solver::Infer(Method::Symmetry, 1),
        Solver::Infer(Method::Greedy, 1),
        Solver::Infer(PAPER, many),
        Solver::Infer(BEST, many),
    ]
    .into_iter()
    .map(|solver| (solver.name(), question(solver, plain)))
    .collect();
    let found = judge(ctx, &cases)?;
    let printed = Published::read(ctx)?;
    let theirs = ["procedural_logic", "bayesian", "symmetry", "", "adp", "adp"];
    for (((name, _), mean), theirs) in cases.iter().zip(&found).zip(theirs) {
        let text = |metric| printed.text(["table_4", theirs, "user_1", metric, "value"]);
        ctx.compare(
            format!("precision, recall, F of {name}"),
            match theirs {
                "" => "–".into(),
                _ => format!(
                    "{}, {}, {} (expert 1)",
                    text("precision"),
                    text("recall"),
                    text("f_score")
                ),
            },
            triple(mean),
        );
    }
    ctx.note(
        "The paper asks how like the grammars are to those of four experts and three other people. Without people, the \
         reference here is the grammar that each made facade was derived from, which no method sees: its named parts (windows, columns, \
         floors, wings) are what the designer meant. A reference with a repeat rule has no region for the elements of its period but \
         those that are themselves non-terminals.",
    );
    Ok(())
}

/// Table 5: costs of the rules, with what they do to the likeness.
pub fn table_5(ctx: &mut Context) -> Result<()> {
    let (few, _) = super::iterations(ctx.budget());
    let base = Costs::default();
    let priced = |split, repeat| Costs {
        split,
        repeat,
        ..base
    };
    let models = [
        (
            "successor_0",
            Costs {
                successor: 0.0,
                ..base
            },
        ),
        ("operation_0", priced(0.0, 0.0)),
        ("split_0.1_repeat_0.5", base),
        ("split_0.1_repeat_1", priced(0.1, 1.0)),
        ("split_1_repeat_0.1", priced(1.0, 0.1)),
        ("split_1_repeat_1", priced(1.0, 1.0)),
    ];
    let mut cases: Vec<Case> = Vec::new();
    for method in [BEST, PAPER] {
        for (name, costs) in models {
            let solver = Solver::Infer(method, few);
            let question = Question {
                costs,
                ..Question::new(solver, ctx.seed())
            };
            cases.push((format!("{} {name}", solver.name()), question));
        }
    }
    let found = judge(ctx, &cases)?;
    let printed = Published::read(ctx)?;
    for (i, ((name, _), mean)) in cases.iter().zip(&found).enumerate() {
        let model = models[i % models.len()].0;
        let text = |metric| printed.text(["table_5", model, "user_1", metric, "value"]);
        ctx.compare(
            format!("precision, recall, F of {name}"),
            format!(
                "{}, {}, {}",
                text("precision"),
                text("recall"),
                text("f_score")
            ),
            triple(mean),
        );
    }
    ctx.note("The paper compares with its first expert, this table with the known grammars of the made facades (see Table 4).");
    Ok(())
}

fn triple(mean: &Likeness) -> String {
    format!(
        "{:.2}, {:.2}, {:.2}",
        mean.precision, mean.recall, mean.f_score
    )
}

/// Runs every case on every made facade; the mean likeness of each case.
fn judge(ctx: &mut Context, cases: &[Case]) -> Result<Vec<Likeness>> {
    let known = data::known(ctx)?;
    let names: Vec<_> = cases.iter().map(|(name, _)| name.clone()).collect();
    ctx.setting("cases", names);
    let units: Vec<(usize, usize)> = (0..cases.len())
        .flat_map(|c| (0..known.len()).map(move |k| (c, k)))
        .collect();
    let answers = ctx.units(
        &units,
        |&(c, k)| format!("{}/{}", cases[c].0, known[k].0.name),
        |&(c, k)| {
            let (facade, reference) = &known[k];
            let (grammar, _) = solve(std::slice::from_ref(facade), &cases[c].1)?;
            likeness(&grammar, reference)
        },
    )?;
    let mut table = Table::new("Mean over the made facades")
        .column("method", Align::Left)
        .numbers(["precision", "recall", "F"]);
    let mut means = Vec::new();
    for (c, (name, question)) in cases.iter().enumerate() {
        let mine = || {
            units
                .iter()
                .zip(&answers)
                .filter(move |((case, _), _)| *case == c)
        };
        for ((_, k), found) in mine() {
            let values = [
                ("precision", found.precision),
                ("recall", found.recall),
                ("f_score", found.f_score),
            ];
            for (metric, value) in values {
                ctx.observe(Row {
                    dataset: "shipped".into(),
                    method: name.clone(),
                    instance: known[*k].0.name.clone(),
                    seed: question.solver.random().then_some(question.seed),
                    metric: metric.into(),
                    value,
                    ..Row::default()
                });
            }
        }
        let average =
            |of: fn(&Likeness) -> f64| mean(&mine().map(|(_, l)| of(l)).collect::<Vec<_>>());
        let found = Likeness {
            precision: average(|l| l.precision),
            recall: average(|l| l.recall),
            f_score: average(|l| l.f_score),
        };
        let cells = [found.precision, found.recall, found.f_score].map(|v| format!("{v:.2}"));
        table.row(std::iter::once(name.clone()).chain(cells));
        means.push(found);
    }
    ctx.table(&table);
    Ok(means)
}
