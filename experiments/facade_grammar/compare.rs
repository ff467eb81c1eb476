//! Tables 1 and 2: methods on facades, several seeds, side by side.

use super::data::{self, Instance};
use super::runs::{Answer, Question, Solver, least, mean, solve};
use edifice_base::Result;
use edifice_facade_grammar::Operations;
use edifice_frame::{Budget, Context};
use edifice_report::{Align, Row, Table};

/// The methods, operations and metrics of a comparison.
pub(crate) struct Design {
    /// Methods in the order of the columns.
    pub solvers: Vec<Solver>,
    /// Operations allowed.
    pub operations: Operations,
    /// Metrics that go to the CSV.
    pub metrics: &'static [&'static str],
}

/// The runs of every method on every facade.
pub(crate) struct Comparison {
    /// The facades.
    pub instances: Vec<Instance>,
    /// The methods.
    pub solvers: Vec<Solver>,
    /// `answers[instance][solver]`, one for each seed.
    pub answers: Vec<Vec<Vec<Answer>>>,
}

/// Runs a plan on the shipped facades, and on the real ones that the user has.
pub(crate) fn run(ctx: &mut Context, plan: Design) -> Result<Comparison> {
    let mut instances: Vec<Instance> = data::shipped(ctx)?
        .into_iter()
        .map(|facade| Instance {
            dataset: "shipped",
            facade,
        })
        .collect();
    let limit = ctx.budget().choose(1, usize::MAX, usize::MAX);
    instances.extend(data::real(ctx, limit)?);
    let seeds = ctx.budget().choose(1, 1, 10);
    ctx.setting("seeds", seeds);
    ctx.setting("seeds_facade_i", ctx.budget().choose(1, 10, 10));
    ctx.setting("seeds_real", ctx.budget().choose(1, 1, 10));
    let names: Vec<_> = plan.solvers.iter().map(|s| s.name()).collect();
    ctx.setting("methods", names);
    ctx.setting("operations", format!("{:?}", plan.operations));

    let mut units = Vec::new();
    for (i, instance) in instances.iter().enumerate() {
        for (s, solver) in plan.solvers.iter().enumerate() {
            for run in 0..seeds_of(ctx.budget(), instance, *solver) {
                units.push((i, s, ctx.seed() + run));
            }
        }
    }
    let answers = ctx.units(
        &units,
        |&(i, s, seed)| {
            let Instance { dataset, facade } = &instances[i];
            format!(
                "{dataset}/{}/{}/{seed}",
                facade.name,
                plan.solvers[s].name()
            )
        },
        |&(i, s, seed)| {
            let question = Question {
                operations: plan.operations,
                ..Question::new(plan.solvers[s], seed)
            };
            solve(std::slice::from_ref(&instances[i].facade), &question).map(|(_, answer)| answer)
        },
    )?;
    let mut comparison = Comparison {
        answers: vec![vec![Vec::new(); plan.solvers.len()]; instances.len()],
        instances,
        solvers: plan.solvers,
    };
    for (&(i, s, seed), answer) in units.iter().zip(&answers) {
        comparison.answers[i][s].push(*answer);
        for &metric in plan.metrics {
            let (value, unit) = match metric {
                "cost" => (answer.cost, ""),
                "rules" => (answer.rules as f64, ""),
                "terminals" => (answer.terminals as f64, ""),
                "effective" => match answer.effective {
                    Some(effective) => (effective, ""),
                    None => continue,
                },
                _ => (answer.seconds, "s"),
            };
            ctx.observe(Row {
                dataset: comparison.instances[i].dataset.into(),
                method: comparison.solvers[s].name(),
                instance: comparison.instances[i].facade.name.clone(),
                seed: comparison.solvers[s].random().then_some(seed),
                metric: metric.into(),
                value,
                unit: unit.into(),
                ..Row::default()
            });
        }
    }
    Ok(comparison)
}

fn seeds_of(budget: Budget, instance: &Instance, solver: Solver) -> u64 {
    if !solver.random() {
        return 1;
    }
    match (instance.dataset, instance.facade.name.as_str()) {
        ("shipped", data::FIGURE_9) => budget.choose(1, 10, 10),
        ("shipped", _) => budget.choose(1, 1, 10),
        _ => budget.choose(1, 1, 10),
    }
}

impl Comparison {
    /// The data sets, in order.
    pub(crate) fn datasets(&self) -> Vec<&'static str> {
        let mut names: Vec<_> = self.instances.iter().map(|i| i.dataset).collect();
        names.dedup();
        names
    }

    /// Indices of a data set's facades.
    pub(crate) fn of(&self, dataset: &str) -> Vec<usize> {
        (0..self.instances.len())
            .filter(|&i| self.instances[i].dataset == dataset)
            .collect()
    }

    /// Least cost over the seeds.
    pub(crate) fn least_cost(&self, instance: usize, solver: usize) -> f64 {
        least(&self.costs(instance, solver))
    }

    /// Mean cost over the seeds.
    pub(crate) fn mean_cost(&self, instance: usize, solver: usize) -> f64 {
        mean(&self.costs(instance, solver))
    }

    fn costs(&self, instance: usize, solver: usize) -> Vec<f64> {
        let answers = &self.answers[instance][solver];
        answers.iter().map(|a| a.cost).collect()
    }

    /// Column of a method; `None` when it was not run.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.solvers.iter().position(|s| s.name() == name)
    }

    /// `least/mean` of a quantity over the seeds; one number where there is one run.
    fn cell(
        &self,
        instance: usize,
        solver: usize,
        of: impl Fn(&Answer) -> f64,
        digits: usize,
    ) -> String {
        let values: Vec<f64> = self.answers[instance][solver].iter().map(of).collect();
        match values.len() {
            1 => format!("{:.digits$}", values[0]),
            _ => format!("{:.digits$}/{:.digits$}", least(&values), mean(&values)),
        }
    }

    /// A table of one quantity on one data set, `least/mean` over the seeds, with the averages and
    /// the lowest of each row in bold.
    pub(crate) fn table(
        &self,
        title: String,
        dataset: &str,
        of: impl Fn(&Answer) -> f64 + Copy,
        digits: usize,
        bold: bool,
    ) -> Table {
        let names = self.solvers.iter().map(|s| s.name());
        let mut table = Table::new(title)
            .column("facade", Align::Left)
            .numbers(["#T"])
            .numbers(names);
        let rows = self.of(dataset);
        let columns = 0..self.solvers.len();
        for &i in &rows {
            let terminals = self.instances[i].facade.regions.len();
            let mut row = vec![self.instances[i].facade.name.clone(), terminals.to_string()];
            let lowest = columns
                .clone()
                .map(|s| self.least(i, s, of))
                .fold(f64::INFINITY, f64::min);
            for s in columns.clone() {
                let text = self.cell(i, s, of, digits);
                row.push(match bold && self.least(i, s, of) <= lowest + 1e-9 {
                    true => format!("**{text}**"),
                    false => text,
                });
            }
            table.row(row);
        }
        let count = rows.len().max(1) as f64;
        let terminals: usize = rows
            .iter()
            .map(|&i| self.instances[i].facade.regions.len())
            .sum();
        let mut row = vec![
            "average".to_string(),
            format!("{:.0}", terminals as f64 / count),
        ];
        for s in columns {
            let average = |pick: &dyn Fn(&[f64]) -> f64| {
                let each = rows
                    .iter()
                    .map(|&i| pick(&self.answers[i][s].iter().map(of).collect::<Vec<_>>()));
                each.sum::<f64>() / count
            };
            row.push(match self.solvers[s].random() {
                true => format!("{:.digits$}/{:.digits$}", average(&least), average(&mean)),
                false => format!("{:.digits$}", average(&mean)),
            });
        }
        table.row(row);
        table
    }

    fn least(&self, instance: usize, solver: usize, of: impl Fn(&Answer) -> f64) -> f64 {
        least(
            &self.answers[instance][solver]
                .iter()
                .map(of)
                .collect::<Vec<_>>(),
        )
    }

    /// Average of the methods' least costs over a data set.
    pub(crate) fn average_least(&self, dataset: &str, solver: usize) -> f64 {
        mean(
            &self
                .of(dataset)
                .iter()
                .map(|&i| self.least_cost(i, solver))
                .collect::<Vec<_>>(),
        )
    }

    /// Average over a data set of the mean cost over the seeds.
    pub(crate) fn average_mean(&self, dataset: &str, solver: usize) -> f64 {
        mean(
            &self
                .of(dataset)
                .iter()
                .map(|&i| self.mean_cost(i, solver))
                .collect::<Vec<_>>(),
        )
    }

    /// On how many facades of a data set a method's least cost is lower than, equal to, higher than
    /// another's.
    pub(crate) fn wins(&self, dataset: &str, first: usize, second: usize) -> [usize; 3] {
        let mut wins = [0; 3];
        for i in self.of(dataset) {
            let (a, b) = (self.least_cost(i, first), self.least_cost(i, second));
            wins[if a < b - 1e-9 {
                0
            } else if a <= b + 1e-9 {
                1
            } else {
                2
            }] += 1;
        }
        wins
    }
}
