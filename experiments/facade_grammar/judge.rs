//! Runs methods on facades and judges the grammars by every reference.

use super::likeness::{Likeness, likeness};
use super::references::{self, Judged};
use super::runs::{Question, mean, solve};
use edifice_base::Result;
use edifice_frame::Context;
use edifice_grammar::Costs;
use edifice_report::{Align, Bars, Figure, Row, Scale, Table};

/// A row of a table: a name, and what to run.
pub(crate) type Case = (String, Question);

/// The likeness of the grammars of all cases to all references.
pub(crate) struct Scores {
    /// The facades with their references.
    pub judged: Vec<Judged>,
    /// Names of the cases.
    pub cases: Vec<String>,
    /// `found[case][facade][reference]`.
    found: Vec<Vec<Vec<Likeness>>>,
}

/// Runs every case on facade (i), on the layouts made for each kind of reference, and on each `every`-th shipped facade; the
/// observations go to the CSV, the kind of reference as data set.
pub(crate) fn run(ctx: &mut Context, cases: &[Case], every: usize) -> Result<Scores> {
    let judged = references::judged(ctx, every)?;
    let names: Vec<String> = cases.iter().map(|(name, _)| name.clone()).collect();
    ctx.setting("cases", names.clone());
    let units: Vec<(usize, usize)> = (0..cases.len())
        .flat_map(|c| (0..judged.len()).map(move |f| (c, f)))
        .collect();
    let answers = ctx.units(
        &units,
        |&(c, f)| format!("{}/{}", cases[c].0, judged[f].facade.name),
        |&(c, f)| {
            let Judged {
                facade, references, ..
            } = &judged[f];
            let (grammar, _) = solve(std::slice::from_ref(facade), &cases[c].1)?;
            let each = references.iter().map(|(_, own)| likeness(&grammar, own));
            each.collect::<Result<Vec<Likeness>>>()
        },
    )?;
    let mut found = vec![Vec::new(); cases.len()];
    for (&(c, f), each) in units.iter().zip(answers) {
        let question = &cases[c].1;
        for ((kind, _), likeness) in judged[f].references.iter().zip(&each) {
            for measure in Measure::ALL {
                ctx.observe(Row {
                    dataset: (*kind).into(),
                    method: names[c].clone(),
                    instance: judged[f].facade.name.clone(),
                    seed: question.solver.random().then_some(question.seed),
                    metric: measure.name().into(),
                    value: measure.of(likeness),
                    ..Row::default()
                });
            }
        }
        found[c].push(each);
    }
    Ok(Scores {
        judged,
        cases: names,
        found,
    })
}

/// One of the three numbers of a likeness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    /// Precision.
    Precision,
    /// Recall.
    Recall,
    /// Their harmonic mean.
    FScore,
}

impl Measure {
    const ALL: [Measure; 3] = [Measure::Precision, Measure::Recall, Measure::FScore];

    fn name(self) -> &'static str {
        match self {
            Measure::Precision => "precision",
            Measure::Recall => "recall",
            Measure::FScore => "f_score",
        }
    }

    fn of(self, likeness: &Likeness) -> f64 {
        match self {
            Measure::Precision => likeness.precision,
            Measure::Recall => likeness.recall,
            Measure::FScore => likeness.f_score,
        }
    }
}

/// The layouts that a mean is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layouts {
    /// Layouts designed for the reference's kind.
    Own,
    /// All layouts that have a reference of the kind.
    All,
}

impl Scores {
    /// Mean over the facades of a case's likeness to the references of a kind.
    pub(crate) fn mean(&self, case: usize, kind: &str, layouts: Layouts, measure: Measure) -> f64 {
        let facades = self.judged.iter().zip(&self.found[case]);
        let chosen = facades.filter(|(j, _)| layouts == Layouts::All || j.own == kind);
        let values = chosen.flat_map(|(judged, each)| {
            let mine = judged.references.iter().zip(each);
            mine.filter(|((k, _), _)| *k == kind)
                .map(|(_, likeness)| measure.of(likeness))
        });
        mean(&values.collect::<Vec<_>>())
    }

    /// Mean F of a case on the layouts of a kind's own.
    pub(crate) fn f_score(&self, case: usize, kind: &str) -> f64 {
        self.mean(case, kind, Layouts::Own, Measure::FScore)
    }

    /// Place of a case among others by F, from 1, rounded as it is printed: equal numbers share the better place.
    pub(crate) fn rank(&self, case: usize, kind: &str, among: &[usize]) -> usize {
        let value = |c: usize| (100.0 * self.f_score(c, kind)).round() as i64;
        1 + among.iter().filter(|&&c| value(c) > value(case)).count()
    }

    /// `precision, recall, F` over the layouts of a kind's own.
    pub(crate) fn triple(&self, case: usize, kind: &str) -> String {
        let all = Measure::ALL.map(|m| self.mean(case, kind, Layouts::Own, m));
        all.map(|value| format!("{value:.2}")).join(", ")
    }

    /// The tables of all measures, and the picture of F.
    pub(crate) fn show(&self, ctx: &mut Context, name: &str) -> Result<()> {
        let kinds = references::kinds();
        let own = "each kind's own layouts";
        for (what, measure) in [
            ("F", Measure::FScore),
            ("Precision", Measure::Precision),
            ("Recall", Measure::Recall),
        ] {
            let title = format!("{what} by kind of reference, mean over {own}");
            ctx.table(&self.table(title, &kinds, Layouts::Own, measure));
        }
        let shared = &kinds[2..];
        let title = "F by kind of reference on the same layouts: all made for the five kinds";
        let table = self.table(title.into(), shared, Layouts::All, Measure::FScore);
        ctx.table(&table);
        let panel = |layouts, kinds: &[&str], title: &str| {
            let categories = kinds.iter().map(ToString::to_string).collect();
            let scale = Scale::new("F").range(0.0, 1.0);
            let bars = Bars::new(title, "kind of reference", scale, categories);
            (0..self.cases.len()).fold(bars, |bars, case| {
                let mean = |kind: &&str| self.mean(case, kind, layouts, Measure::FScore);
                let values = kinds.iter().map(|kind| Some(mean(kind)));
                bars.group(self.cases[case].clone(), values.collect())
            })
        };
        let figure = Figure::new("likeness to references of several kinds", 1)
            .cell(900.0, 320.0)
            .panel(panel(Layouts::Own, &kinds, "Each kind's own layouts"))
            .panel(panel(Layouts::All, shared, "The same layouts"));
        ctx.figure(name, &figure)
    }

    fn table(&self, title: String, kinds: &[&str], layouts: Layouts, measure: Measure) -> Table {
        let mut table = Table::new(title)
            .column("method", Align::Left)
            .numbers(kinds.iter().copied());
        for (case, name) in self.cases.iter().enumerate() {
            let values = kinds.iter().map(|k| self.mean(case, k, layouts, measure));
            let cells = values.map(|value| format!("{value:.2}"));
            table.row(std::iter::once(name.clone()).chain(cells));
        }
        let count = |kind: &str| {
            let all = self.judged.iter();
            let mine = all.filter(|j| match layouts {
                Layouts::Own => j.own == kind,
                Layouts::All => j.references.iter().any(|(k, _)| *k == kind),
            });
            mine.count().to_string()
        };
        let counts = kinds.iter().map(|kind| count(kind));
        table.row(std::iter::once("layouts".to_string()).chain(counts));
        table
    }

    /// The mean cost of the references of each kind on the layouts of their own, by the paper's costs.
    pub(crate) fn costs(&self, kind: &str) -> f64 {
        let own = self.judged.iter().filter(|j| j.own == kind);
        let grammars = own.flat_map(|j| j.references.iter().filter(|(k, _)| *k == kind));
        let costs = grammars.map(|(_, grammar)| Costs::default().grammar(grammar));
        mean(&costs.collect::<Vec<_>>())
    }
}
