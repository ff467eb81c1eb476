//! Table 5: costs of the rules, and what they do to the likeness to references of several kinds.

use super::judge::{self, Case, Scores};
use super::published::Published;
use super::references::{self, NOTE};
use super::runs::{Question, Solver};
use super::{BEST, PAPER};
use edifice_base::Result;
use edifice_frame::Context;
use edifice_grammar::Costs;
use edifice_report::{Align, Table};

/// The models by name, as in `published.csv`; the paper's choice is the third.
fn models() -> [(&'static str, Costs); 6] {
    let base = Costs::default();
    let priced = |split, repeat| Costs {
        split,
        repeat,
        ..base
    };
    [
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
    ]
}

/// Place of the paper's choice among the models.
const CHOSEN: usize = 2;

/// Both configurations of ADP with six cost models against references of every kind.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (few, _) = super::iterations(ctx.budget());
    let mut cases: Vec<Case> = Vec::new();
    for method in [BEST, PAPER] {
        for (name, costs) in models() {
            let solver = Solver::Infer(method, few);
            let question = Question {
                costs,
                ..Question::new(solver, ctx.seed())
            };
            cases.push((format!("{} {name}", solver.name()), question));
        }
    }
    // Twelve cases by the clock of the slowest: every second shipped facade shows the same.
    let every = ctx.budget().choose(1, 2, 1);
    ctx.setting("every_shipped_facade", every);
    let scores = judge::run(ctx, &cases, every)?;
    let printed = Published::read(ctx)?;
    for (case, name) in scores.cases.iter().enumerate() {
        let model = models()[case % models().len()].0;
        let text = |metric| printed.text(["table_5", model, "user_1", metric, "value"]);
        let theirs = ["precision", "recall", "f_score"].map(text).join(", ");
        for kind in references::kinds() {
            let what = format!("precision, recall, F of {name}, {kind}");
            ctx.compare(what, theirs.clone(), scores.triple(case, kind));
        }
    }
    follows(ctx, &scores);
    scores.show(ctx, "table_5")?;
    ctx.note(NOTE);
    Ok(())
}

/// Notes the paper's statements that hold, for references of each kind.
fn follows(ctx: &mut Context, scores: &Scores) {
    let kinds = references::kinds();
    let count = models().len();
    let (mut first, mut omitted, mut cheap) = (0, 0, 0);
    for (start, method) in [(0, "adp_best"), (count, "adp_paper")] {
        let title = format!("What the paper states of its costs, {method}, by kind of reference");
        let mut table = Table::new(title)
            .column("kind of reference", Align::Left)
            .column("most alike", Align::Left)
            .numbers(["F", "F of 0.1 and 0.5", "its rank of 6"])
            .column("worse without either term", Align::Left)
            .column("cheap repeats better", Align::Left);
        let all: Vec<usize> = (start..start + count).collect();
        for &kind in &kinds {
            let f = |model: usize| scores.f_score(start + model, kind);
            let chosen = f(CHOSEN);
            let nearest: Vec<&str> = all
                .iter()
                .filter(|&&c| scores.rank(c, kind, &all) == 1)
                .map(|&c| models()[c - start].0)
                .collect();
            let rank = scores.rank(start + CHOSEN, kind, &all);
            let needs_both = chosen > f(0) && chosen > f(1);
            let cheaper_repeats = f(4) > f(3);
            first += usize::from(rank == 1);
            omitted += usize::from(needs_both);
            cheap += usize::from(cheaper_repeats);
            let best = (0..count).map(f).fold(0.0, f64::max);
            let yes = |holds| if holds { "yes" } else { "no" }.to_string();
            table.row([
                kind.to_string(),
                nearest.join(", "),
                format!("{best:.2}"),
                format!("{chosen:.2}"),
                rank.to_string(),
                yes(needs_both),
                yes(cheaper_repeats),
            ]);
        }
        ctx.table(&table);
    }
    let cases = 2 * kinds.len();
    ctx.note(format!(
        "**What follows.** The paper finds its costs, 0.1 for a split and 0.5 for a repeat, most like its first expert's grammars (F 0.71, \
         all others at most 0.64), worse without the cost of rules or that of symbols, and better when repeats are cheaper than \
         splits. Over {cases} cases here (two configurations, {} kinds of reference), its costs rank first, alone or level, in {first}; leaving out \
         either term makes it worse in {omitted}; split 1 with repeat 0.1 is above split 0.1 with repeat 1 in {cheap}. Ranks are by F with two digits. \
         Without the cost of symbols, long rules cost nothing, and the cheapest grammar takes all floors and then all elements of a floor, as BGL does: \
         it does well on references that do the same. One expert's grammars, or one kind of reference, do not decide which costs are best.",
        kinds.len(),
    ));
}
