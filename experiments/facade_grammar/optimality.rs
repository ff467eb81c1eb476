//! The distance from the optimum: lower bounds and proofs for small facades.

use cpu_time::ThreadTime;

use serde::{Deserialize, Serialize};

use super::data::{self, FIGURE_9, Instance};
use super::runs::{Question, Solver, solve};
use super::{BEST, iterations};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_facade_grammar::{BoundLimits, Operations, Settings, lower_bound};
use edifice_frame::{Budget, Context};
use edifice_report::{Align, Chart, Corner, Figure, Row, Scale, Series, Table};

/// The two sets of operations of Tables 1 and 2.
pub(super) const OPERATIONS: [&str; 2] = ["split", "split_repeat"];

/// Branches for facades of more than 100 terminals, where each costs much and proofs are rare.
const FEW_NODES: u64 = 100;

/// Facades of each real set, evenly spread, among which the smallest are taken.
const LOOKED_AT: usize = 40;

/// The bounds known for one facade under one set of operations.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Answer {
    terminals: usize,
    /// Cost of the grammar that the best configuration finds.
    cost: f64,
    /// Lower bound: no grammar costs less.
    lower: f64,
    /// Cost of the best grammar known after branch and bound.
    upper: f64,
    proven: bool,
    nodes: u64,
    types: usize,
    weak: bool,
    /// Processor seconds of branch and bound.
    seconds: f64,
}

impl Answer {
    /// The most that a grammar may still cost less than `cost`, in per cent of the bound.
    fn gap(&self) -> f64 {
        100.0 * (self.cost - self.lower).max(0.0) / self.lower
    }
}

/// Bounds the cost of facade (i), of small shipped layouts, and of small real facades.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (_, many) = iterations(ctx.budget());
    let (terminals, real) = ctx.budget().choose((60, 1), (400, 8), (1_200, 40));
    let limits = match ctx.budget() {
        Budget::Smoke => BoundLimits {
            root_steps: 50,
            nodes: 5,
            ..BoundLimits::default()
        },
        _ => BoundLimits::default(),
    };
    ctx.setting("iterations", many);
    ctx.setting("most_terminals", terminals);
    ctx.setting("most_items", limits.items);
    ctx.setting("most_nodes", limits.nodes);
    ctx.setting("most_nodes_above_100_terminals", FEW_NODES);
    ctx.setting("root_steps", limits.root_steps);
    ctx.setting("branch_steps", limits.branch_steps);
    let instances = instances(ctx, terminals, real)?;
    let mut units: Vec<(&Instance, usize)> = Vec::new();
    for operations in 0..OPERATIONS.len() {
        units.extend(instances.iter().map(|instance| (instance, operations)));
    }
    let seed = ctx.seed();
    let found = ctx.units(
        &units,
        |(instance, operations)| {
            let (dataset, name) = (instance.dataset, &instance.facade.name);
            format!("{dataset}/{name}/{}", OPERATIONS[*operations])
        },
        |&(instance, operations)| {
            let nodes = match instance.facade.regions.len() {
                0..=100 => limits.nodes,
                _ => limits.nodes.min(FEW_NODES),
            };
            let limits = BoundLimits { nodes, ..limits };
            bound(instance, operations, many, seed, &limits)
        },
    )?;
    let rows: Vec<(&Instance, usize, Answer)> = units
        .iter()
        .zip(found)
        .map(|(&(instance, operations), answer)| (instance, operations, answer))
        .collect();
    for (operations, name) in OPERATIONS.iter().enumerate() {
        let mine = rows.iter().filter(|row| row.1 == operations);
        tabulate(ctx, name, mine);
    }
    for row in &rows {
        observe(ctx, row);
    }
    draw(ctx, &rows)?;
    ctx.note(NOTE);
    Ok(())
}

const NOTE: &str = "Not in the paper, which proves nothing. *cost* is that of the grammar that `adp_best` finds with the \
    iterations of `run.json`, *bound* is below every grammar whose symbols each derive one region type (the grammars that are searched; \
    the first page of `methods::facade_grammar` says how it is found), *known* is the least cost of any grammar met in the branch \
    and bound, *gap* is how much of the bound *cost* lies above it. A proof says that *known* is the optimum. \
    The search stops after a number of branches (fewer above 100 terminals), never by the clock. A *weak* bound only counts labels: \
    there the facade has more rules and places than are taken on.";

/// Facade (i) and the shipped and real facades of at most `terminals` terminals, the smallest first;
/// `real` of each real set, out of [`LOOKED_AT`].
fn instances(ctx: &mut Context, terminals: usize, real: usize) -> Result<Vec<Instance>> {
    let small = |instance: &Instance| instance.facade.regions.len() <= terminals;
    let dataset = "shipped";
    let mut instances: Vec<Instance> = data::shipped(ctx)?
        .into_iter()
        .map(|facade| Instance { dataset, facade })
        .filter(small)
        .collect();
    instances.sort_by_key(|instance| instance.facade.regions.len());
    let mut others: Vec<Instance> = data::real(ctx, LOOKED_AT)?
        .into_iter()
        .filter(small)
        .collect();
    others.sort_by_key(|instance| (instance.dataset, instance.facade.regions.len()));
    for set in others.chunk_by(|a, b| a.dataset == b.dataset) {
        instances.extend(set.iter().take(real).cloned());
    }
    Ok(instances)
}

/// Finds a grammar, and bounds what any grammar can cost.
fn bound(
    instance: &Instance,
    operations: usize,
    iterations: u64,
    seed: u64,
    limits: &BoundLimits,
) -> Result<Answer> {
    let question = Question {
        operations: match operations {
            0 => Operations::split_only(),
            _ => Operations::default(),
        },
        ..Question::new(Solver::Infer(BEST, iterations), seed)
    };
    let (_, found) = solve(std::slice::from_ref(&instance.facade), &question)?;
    let settings = Settings {
        iterations,
        seed,
        operations: question.operations,
        ..Settings::default()
    };
    let start = ThreadTime::now();
    let bound =
        lower_bound(&instance.facade, &settings, limits, &unwatched).map_err(Error::method)?;
    Ok(Answer {
        terminals: found.terminals,
        cost: found.cost,
        lower: bound.lower,
        upper: bound.upper,
        proven: bound.proven,
        nodes: bound.nodes,
        types: bound.types,
        weak: bound.weak.is_some(),
        seconds: start.elapsed().as_secs_f64(),
    })
}

fn tabulate<'a>(
    ctx: &mut Context,
    operations: &str,
    rows: impl Iterator<Item = &'a (&'a Instance, usize, Answer)>,
) {
    let mut table = Table::new(format!("Cost and bound, operations {operations}"))
        .column("data", Align::Left)
        .column("facade", Align::Left)
        .numbers(["terminals", "types", "cost", "known", "bound", "gap %"])
        .column("optimal?", Align::Left)
        .numbers(["branches"])
        .times(["seconds"]);
    let (mut count, mut proven) = (0, 0);
    for (instance, _, answer) in rows {
        count += 1;
        proven += usize::from(answer.proven);
        table.row([
            instance.dataset.to_owned(),
            instance.facade.name.clone(),
            answer.terminals.to_string(),
            answer.types.to_string(),
            format!("{:.1}", answer.cost),
            format!("{:.1}", answer.upper),
            format!("{:.1}", answer.lower),
            format!("{:.1}", answer.gap()),
            verdict(answer).to_owned(),
            answer.nodes.to_string(),
            format!("{:.2}", answer.seconds),
        ]);
        if instance.facade.name == FIGURE_9 {
            let text = match answer.proven {
                true => format!("{:.1}, proven optimal", answer.upper),
                false => format!("between {:.1} and {:.1}", answer.lower, answer.upper),
            };
            let printed = if operations == "split" { "40" } else { "40.3" };
            ctx.compare(
                format!("facade (i), least cost, {operations}"),
                printed,
                text,
            );
        }
    }
    ctx.table(&table);
    ctx.compare(
        format!("facades with a proof, {operations}"),
        "",
        format!("{proven} of {count}"),
    );
}

fn verdict(answer: &Answer) -> &'static str {
    match (answer.proven, answer.weak) {
        (true, _) if answer.cost > answer.upper + 1e-9 => "no, a better one is optimal",
        (true, _) => "proven",
        (false, true) => "open, weak bound",
        (false, false) => "open",
    }
}

fn observe(ctx: &mut Context, (instance, operations, answer): &(&Instance, usize, Answer)) {
    for (metric, value, unit) in [
        ("terminals", answer.terminals as f64, ""),
        ("types", answer.types as f64, ""),
        ("cost", answer.cost, ""),
        ("known_cost", answer.upper, ""),
        ("lower_bound", answer.lower, ""),
        ("gap", answer.gap(), "%"),
        ("proven", f64::from(u8::from(answer.proven)), ""),
        ("branches", answer.nodes as f64, ""),
        ("seconds", answer.seconds, "s"),
    ] {
        let row = Row {
            dataset: instance.dataset.into(),
            method: format!("adp_best/{}", OPERATIONS[*operations]),
            instance: instance.facade.name.clone(),
            metric: metric.into(),
            value,
            unit: unit.into(),
            ..Row::default()
        };
        ctx.observe(row);
    }
}

/// Gap against terminals, one panel for each set of operations.
fn draw(ctx: &mut Context, rows: &[(&Instance, usize, Answer)]) -> Result<()> {
    let mut figure =
        Figure::new("gap between cost and lower bound against terminals", 2).cell(560.0, 400.0);
    for (operations, name) in OPERATIONS.iter().enumerate() {
        let mut chart = Chart::new(
            format!("Operations {name}"),
            Scale::new("terminals"),
            Scale::new("gap in %").from_zero(),
        )
        .legend(Corner::Above);
        let mine: Vec<_> = rows.iter().filter(|row| row.1 == operations).collect();
        for set in mine.chunk_by(|a, b| a.0.dataset == b.0.dataset) {
            let points = set.iter().map(|row| (row.2.terminals as f64, row.2.gap()));
            chart = chart.series(Series::points(set[0].0.dataset, points.collect()));
        }
        figure = figure.panel(chart);
    }
    ctx.figure("optimality", &figure)
}
