//! The readings of the points that the text of the algorithm leaves open: facade (i), and the saving of `best`, under
//! each reading.

use super::data::{self, FIGURE_9, Instance};
use super::published::Published;
use super::runs::{Answer, Question, Solver, least, mean, solve};
use super::{BEST, PAPER, iterations};
use edifice_base::Result;
use edifice_facade_grammar::{Exploit, Method, Protect, Readings};
use edifice_frame::Context;
use edifice_report::{Align, Bars, Figure, Row, Scale, Table};

/// Facades of each real set, evenly spread.
const LOOKED_AT: usize = 40;

/// The readings by name, that of all other artefacts first.
fn readings() -> Vec<(&'static str, Readings)> {
    let ours = Readings::default();
    let protecting = |protection| Readings { protection, ..ours };
    let drawing = |draws| protecting(Protect::Walk { draws });
    let never = protecting(Protect::Never);
    let remembering = |most, readings| Readings {
        exploitation: Exploit::Remembered(most),
        ..readings
    };
    let ending = |last_epsilon| Readings {
        last_epsilon,
        ..ours
    };
    vec![
        ("as_run", ours),
        ("epsilon_0.01", ending(0.01)),
        ("epsilon_0.5", ending(0.5)),
        ("2_draws", drawing(2)),
        ("30_draws", drawing(30)),
        ("64_rules", remembering(64, ours)),
        ("1_rule", remembering(1, ours)),
        ("once_for_a_run", protecting(Protect::Run)),
        ("no_protection", never),
        ("no_protection_1_rule", remembering(1, never)),
    ]
}

/// A run: of a method under a reading, on a facade.
type Unit = (usize, Solver, usize, u64);

/// Runs the text's algorithm under each reading, many times on facade (i) and once on all others.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let readings = readings();
    let (few, many) = iterations(ctx.budget());
    let seeds = ctx.budget().choose(2, 8, 100);
    ctx.setting("iterations", vec![few, many]);
    ctx.setting("seeds_facade_i", seeds);
    let described = readings.iter().map(|(name, r)| format!("{name}: {r:?}"));
    ctx.setting("readings", described.collect::<Vec<_>>());
    let instances = instances(ctx)?;
    let solvers = [
        Solver::Infer(PAPER, few),
        Solver::Infer(PAPER, many),
        Solver::Infer(Method::Importance, few),
        Solver::Infer(Method::Importance, many),
    ];
    let seed = ctx.seed();
    let mut units: Vec<Unit> = Vec::new();
    for (i, instance) in instances.iter().enumerate() {
        let is_example = instance.facade.name == FIGURE_9;
        for r in 0..readings.len() {
            if is_example {
                let all = solvers.iter();
                units.extend(all.flat_map(|&s| (seed..seed + seeds).map(move |k| (i, s, r, k))));
            } else {
                units.push((i, solvers[1], r, seed));
            }
        }
        if !is_example {
            units.push((i, Solver::Infer(BEST, many), 0, seed));
        }
    }
    let answers = ctx.units(
        &units,
        |&(i, solver, r, seed)| {
            let Instance { dataset, facade } = &instances[i];
            let (solver, reading) = (solver.name(), readings[r].0);
            format!("{dataset}/{}/{solver}/{reading}/{seed}", facade.name)
        },
        |&(i, solver, r, seed)| {
            let question = Question {
                readings: readings[r].1,
                ..Question::new(solver, seed)
            };
            solve(std::slice::from_ref(&instances[i].facade), &question).map(|(_, answer)| answer)
        },
    )?;
    for (&(i, solver, r, seed), answer) in units.iter().zip(&answers) {
        ctx.observe(Row {
            dataset: instances[i].dataset.into(),
            method: format!("{}/{}", solver.name(), readings[r].0),
            instance: instances[i].facade.name.clone(),
            seed: Some(seed),
            metric: "cost".into(),
            value: answer.cost,
            ..Row::default()
        });
    }
    let found = Found {
        instances: &instances,
        units: &units,
        answers: &answers,
    };
    let names: Vec<&str> = readings.iter().map(|(name, _)| *name).collect();
    let figure = Figure::new("readings of the text", 1)
        .cell(900.0, 330.0)
        .panel(example(ctx, &found, &names, &solvers)?)
        .panel(savings(ctx, &found, &names, many));
    ctx.figure("readings", &figure)?;
    ctx.note(NOTE);
    Ok(())
}

const NOTE: &str = "*as_run* is what all other artefacts run, the text word by word: other regions are protected in each \
    iteration (up to 8 draws), exploitation takes the best of all reasonable rules that cut none, and epsilon falls from 0.9 to 0.1. \
    It costs less than the paper prints, with every seed. Every other row changes what its name says: *64_rules* and *1_rule* exploit \
    only by the cheapest rules tried before (\"we also store the best action\"); *once_for_a_run* draws protected regions once, until \
    no other fits, against the text (\"for the current iteration\"). These come nearer to the printed numbers, and more is left to \
    `adp_best` beside them. Importance sampling learns nothing and draws anew for each walk unless there is no protection.";

/// Facade (i), the other shipped facades, and some of each real set.
fn instances(ctx: &mut Context) -> Result<Vec<Instance>> {
    let dataset = "shipped";
    let shipped = data::shipped(ctx)?;
    let mut instances: Vec<Instance> = shipped
        .into_iter()
        .map(|facade| Instance { dataset, facade })
        .collect();
    instances.truncate(ctx.budget().choose(2, 8, usize::MAX));
    let limit = ctx.budget().choose(1, LOOKED_AT, usize::MAX);
    instances.extend(data::real(ctx, limit)?);
    Ok(instances)
}

/// All runs.
struct Found<'a> {
    instances: &'a [Instance],
    units: &'a [Unit],
    answers: &'a [Answer],
}

impl Found<'_> {
    /// Costs on the facades that `wanted` picks, of a method under a reading.
    fn costs(
        &self,
        solver: Solver,
        reading: usize,
        wanted: impl Fn(&Instance) -> bool,
    ) -> Vec<f64> {
        let runs = self.units.iter().zip(self.answers);
        let mine = runs.filter(|((i, s, r, _), _)| {
            *s == solver && *r == reading && wanted(&self.instances[*i])
        });
        mine.map(|(_, answer)| answer.cost).collect()
    }
}

/// Facade (i): least of ten runs on average, mean of all, and how many reach what the paper printed.
fn example(ctx: &mut Context, found: &Found, names: &[&str], solvers: &[Solver]) -> Result<Bars> {
    let printed = Published::read(ctx)?;
    let mut table = Table::new("Facade (i): least of ten runs on average / mean of all")
        .column("reading", Align::Left)
        .numbers(solvers.iter().map(|s| s.name()))
        .numbers(["runs that reach 40.3"]);
    let theirs = ["adp_2k", "adp_10k", "importance_2k", "importance_10k"].map(|method| {
        let text = |k: &str| printed.text(["table_1", method, "i", "cost", k]);
        format!("{}/{}", text("min"), text("mean"))
    });
    let (first, last) = (["printed".to_owned()], ["–".to_owned()]);
    table.row(first.into_iter().chain(theirs).chain(last));
    let mut means = vec![Vec::new(); solvers.len()];
    for (r, name) in names.iter().enumerate() {
        let of = |solver: &Solver| found.costs(*solver, r, |i| i.facade.name == FIGURE_9);
        let cells = solvers.iter().map(|solver| {
            let costs = of(solver);
            let tens: Vec<f64> = costs.chunks(10).map(least).collect();
            format!("{:.1}/{:.1}", mean(&tens), mean(&costs))
        });
        let costs = of(&solvers[1]);
        let reach = costs.iter().filter(|cost| **cost < 40.3 + 1e-6).count();
        let reach = format!("{reach} of {}", costs.len());
        let name = [name.to_string()].into_iter();
        table.row(name.chain(cells).chain([reach]));
        for (means, solver) in means.iter_mut().zip(solvers) {
            means.push(Some(mean(&of(solver))));
        }
    }
    ctx.table(&table);
    let title = "Facade (i), mean cost of all runs";
    let bars = Bars::new(title, "reading", Scale::new("cost"), categories(names));
    let groups = solvers.iter().zip(means);
    Ok(groups.fold(bars, |bars, (solver, means)| {
        bars.group(solver.name(), means)
    }))
}

fn categories(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| name.to_string()).collect()
}

/// The saving of `best`, facade by facade, on each set of the others.
fn savings(ctx: &mut Context, found: &Found, names: &[&str], many: u64) -> Bars {
    let mut sets: Vec<&str> = found.instances.iter().map(|i| i.dataset).collect();
    sets.dedup();
    let mut table = Table::new("Saving of adp_best over adp_paper in %, mean over the facades")
        .column("reading of adp_paper", Align::Left)
        .numbers(sets.iter().copied());
    let mut means = vec![Vec::new(); sets.len()];
    for (r, name) in names.iter().enumerate() {
        let mut row = vec![name.to_string()];
        for (set, means) in sets.iter().zip(&mut means) {
            let others = |i: &Instance| i.dataset == *set && i.facade.name != FIGURE_9;
            let best = found.costs(Solver::Infer(BEST, many), 0, others);
            let paper = found.costs(Solver::Infer(PAPER, many), r, others);
            let each = best.iter().zip(&paper).map(|(a, b)| 100.0 * (1.0 - a / b));
            let saving = mean(&each.collect::<Vec<_>>());
            row.push(format!("{saving:.1}"));
            means.push(Some(saving));
            ctx.observe(Row {
                dataset: (*set).into(),
                method: format!("adp_paper/{name}"),
                instance: "average".into(),
                metric: "saving_of_best".into(),
                value: saving,
                unit: "%".into(),
                ..Row::default()
            });
        }
        table.row(row);
    }
    ctx.table(&table);
    let title = "Mean saving of adp_best over adp_paper";
    let bars = Bars::new(
        title,
        "reading of adp_paper",
        Scale::new("%"),
        categories(names),
    );
    let groups = sets.into_iter().zip(means);
    groups.fold(bars, |bars, (set, means)| bars.group(set, means))
}
