//! The benchmark: parts of whole facades are hidden and completed by all methods, five-fold cross-validated by building.

use std::collections::BTreeMap;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::data::{self, Item};
use super::plausibility::{auc, statistics};
use super::{folds, row};
use crate::experiments::{Budget, Context};
use crate::methods::structure_completion::best::modes;
use crate::methods::structure_completion::completion::Completion;
use crate::methods::structure_completion::layout::{Class, Element};
use crate::methods::structure_completion::measure::{agreement, area_iou};
use crate::methods::structure_completion::method::{self, Method};
use crate::methods::structure_completion::model::Model;
use crate::methods::structure_completion::task::Task;
use crate::report::{Align, Table};
use crate::rng::stream;
use crate::{Error, Result};

/// Folds of the cross-validation.
const FOLDS: usize = 5;
/// The default method, learnt from the other data sets only.
const OTHER_SETS: &str = "best_other_sets";

/// What one facade, task and seed gives.
#[derive(Serialize, Deserialize)]
struct Answer {
    /// Method, metric, value.
    values: Vec<(String, String, f64)>,
    /// Method, statistics of the completed layout.
    statistics: Vec<(String, Vec<f64>)>,
    /// Statistics of the true layout.
    truth: Vec<f64>,
}

/// One facade, one task, one seed; the models that have not seen it.
struct Unit<'a> {
    item: &'a Item,
    task: Task,
    seed: u64,
    models: Vec<(&'static str, Method, &'a Model)>,
}

/// Runs the benchmark.
pub fn run(ctx: &mut Context) -> Result<()> {
    let seeds = ctx.budget().choose(1, 2, 5);
    ctx.setting("mask_seeds", seeds);
    ctx.setting("folds", FOLDS);
    let all = data::items(ctx)?;
    let shipped = all.iter().all(|i| i.dataset == "shipped");
    // The few shipped layouts are too few to leave any out.
    let usable = |i: &&Item| i.layout.count(Class::Window) > 0;
    let used: Vec<&Item> = all
        .iter()
        .filter(usable)
        .filter(|i| i.in_scope || shipped)
        .collect();
    let apart: Vec<&Item> = all
        .iter()
        .filter(usable)
        .filter(|i| !(i.in_scope || shipped))
        .collect();
    let fold = folds::folds(&used, FOLDS, ctx.seed());
    let models: Vec<Model> = (0..FOLDS)
        .map(|f| folds::model(&used, ctx.seed(), |i| fold[i] != f))
        .collect::<Result<_>>()?;
    let mut others: BTreeMap<&str, Model> = BTreeMap::new();
    if !shipped && ctx.budget() != Budget::Smoke {
        for set in ["ecp2011", "graz50", "cmp"] {
            if used.iter().any(|i| i.dataset == set) && used.iter().any(|i| i.dataset != set) {
                let model = folds::model(&used, ctx.seed(), |i| used[i].dataset != set)?;
                others.insert(set, model);
            }
        }
    }
    let mut units = Vec::new();
    for seed in 0..seeds {
        for task in Task::ALL {
            for (k, item) in used.iter().copied().enumerate() {
                let own = Method::ALL.map(|m| (m.name(), m, &models[fold[k]]));
                let mut all = own.to_vec();
                let other = others.get(item.dataset);
                all.extend(other.map(|model| (OTHER_SETS, Method::Best, model)));
                units.push(Unit {
                    item,
                    task,
                    seed,
                    models: all,
                });
            }
            for item in &apart {
                // No model has seen it.
                let best = vec![(Method::Best.name(), Method::Best, &models[0])];
                units.push(Unit {
                    item,
                    task,
                    seed,
                    models: best,
                });
            }
        }
    }
    let dataset = |item: &Item| match item.in_scope || shipped {
        true => item.dataset.to_string(),
        false => format!("{}_out_of_scope", item.dataset),
    };
    let run_seed = ctx.seed();
    let key = |u: &Unit| {
        format!(
            "{}/{}/{}/{}",
            dataset(u.item),
            u.item.layout.name,
            u.task.name(),
            u.seed
        )
    };
    let answers: Vec<Option<Answer>> = ctx.units(&units, key, |u| answer(u, run_seed))?;
    let mut result = Results::default();
    for (unit, answer) in units.iter().zip(&answers) {
        let Some(answer) = answer else { continue };
        let instance = format!("{}/{}", unit.task.name(), unit.item.layout.name);
        for (method, metric, value) in &answer.values {
            let set = dataset(unit.item);
            ctx.observe(row(
                &set,
                method,
                instance.clone(),
                Some(unit.seed),
                metric,
                *value,
            ));
        }
        result.add(unit, answer, &dataset(unit.item));
    }
    result.tables(ctx)?;
    if shipped {
        ctx.note("On the shipped layouts, of which few have a regular lattice; with `--data` on ECP, Graz and CMP.");
    }
    ctx.note("F1 of the hidden elements at an intersection over union of 0.5 with equal labels, mean over facades and mask seeds, with the standard error over facades. Facades that hide nothing in a task are left out of it.");
    Ok(())
}

/// Completes one facade by all methods; `None` where nothing is hidden.
fn answer(unit: &Unit, run_seed: u64) -> Result<Option<Answer>> {
    let layout = &unit.item.layout;
    let name = format!("{}/{}", unit.task.name(), layout.name);
    let mut rng = stream(run_seed, &format!("mask/{name}"), unit.seed);
    let (partial, hidden) = unit.task.hide(layout, &mut rng);
    if hidden.is_empty() {
        return Ok(None);
    }
    let mut values = Vec::new();
    let mut made = Vec::new();
    for &(label, method, model) in &unit.models {
        let mut rng = stream(run_seed, &format!("completion/{name}"), unit.seed);
        let start = Instant::now();
        let (completions, windows) = match method {
            Method::Best => {
                let answer = modes::complete(&partial, model, 5, &mut rng);
                (answer.completions, answer.windows)
            }
            method => (
                method::complete(method, &partial, model, 5, &mut rng),
                Vec::new(),
            ),
        };
        let seconds = start.elapsed().as_secs_f64();
        let first = added(completions.first());
        let mut put = |metric: &str, value: f64| {
            values.push((label.to_string(), metric.to_string(), value));
        };
        put("f1", agreement(&first, &hidden, 0.5).f1);
        put("f1_25", agreement(&first, &hidden, 0.25).f1);
        put("iou", area_iou(&first, &hidden));
        put(
            "count_error",
            (first.len() as f64 - hidden.len() as f64).abs(),
        );
        put("seconds", seconds);
        for class in Class::ALL {
            let of = |e: &[Element]| -> Vec<Element> {
                e.iter().filter(|e| e.class == class).copied().collect()
            };
            let truth = of(&hidden);
            if !truth.is_empty() {
                let metric = format!("{}_recall", class.name());
                put(&metric, agreement(&of(&first), &truth, 0.5).recall);
            }
        }
        if method == Method::Best {
            let each = completions
                .iter()
                .map(|c| agreement(&added(Some(c)), &hidden, 0.5).f1);
            put("f1_best_of_5", each.fold(0.0, f64::max));
            put("distinct_of_5", completions.len() as f64);
            put("calibration", inside(&windows, &hidden));
        }
        let whole: Vec<Element> = partial.observed.iter().copied().chain(first).collect();
        made.push((
            label.to_string(),
            statistics(layout.width, layout.height, &whole),
        ));
    }
    Ok(Some(Answer {
        values,
        statistics: made,
        truth: statistics(layout.width, layout.height, &layout.elements),
    }))
}

fn added(completion: Option<&Completion>) -> Vec<Element> {
    completion
        .into_iter()
        .flat_map(|c| c.added.iter().map(|a| a.element))
        .collect()
}

/// Whether the true number of windows lies between the 10 % and the 90 % quantile of the pool.
fn inside(windows: &[(usize, f64)], hidden: &[Element]) -> f64 {
    let truth = hidden.iter().filter(|e| e.class == Class::Window).count();
    let share = |test: &dyn Fn(usize) -> bool| {
        windows
            .iter()
            .filter(|w| test(w.0))
            .map(|w| w.1)
            .sum::<f64>()
    };
    let inside = share(&|n| n < truth) <= 0.9 && share(&|n| n > truth) <= 0.9;
    f64::from(u8::from(inside))
}

/// Values by method, metric, task and facade.
#[derive(Default)]
struct Results {
    values: BTreeMap<(String, String, &'static str), BTreeMap<String, Vec<f64>>>,
    pairs: BTreeMap<(String, &'static str), Vec<(Vec<f64>, Vec<f64>)>>,
    by_set: BTreeMap<(String, &'static str), Vec<f64>>,
}

/// Mean and its standard error.
fn summary(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    (mean, (variance / n).sqrt())
}

fn mean(values: &[f64]) -> f64 {
    summary(values).0
}

impl Results {
    fn add(&mut self, unit: &Unit, answer: &Answer, dataset: &str) {
        let task = unit.task.name();
        for (method, metric, value) in &answer.values {
            if method == "best" && metric == "f1" {
                self.by_set
                    .entry((dataset.to_string(), task))
                    .or_default()
                    .push(*value);
            }
            if dataset.ends_with("out_of_scope") {
                continue;
            }
            let key = (method.clone(), metric.clone(), task);
            let facade = format!("{dataset}/{}", unit.item.layout.name);
            self.values
                .entry(key)
                .or_default()
                .entry(facade)
                .or_default()
                .push(*value);
        }
        if unit.seed == 0 && !dataset.ends_with("out_of_scope") {
            for (method, made) in &answer.statistics {
                let pairs = self.pairs.entry((method.clone(), task)).or_default();
                pairs.push((answer.truth.clone(), made.clone()));
            }
        }
    }

    /// Means over the seeds of each facade.
    fn facades(&self, method: &str, metric: &str, task: &'static str) -> BTreeMap<&str, f64> {
        let key = (method.to_string(), metric.to_string(), task);
        let facades = self.values.get(&key).into_iter().flatten();
        facades
            .map(|(facade, values)| (facade.as_str(), mean(values)))
            .collect()
    }

    fn cell(&self, method: &str, metric: &str, task: &'static str) -> String {
        let values: Vec<f64> = self.facades(method, metric, task).into_values().collect();
        let (mean, error) = summary(&values);
        match values.len() {
            0 => "–".into(),
            _ => format!("{mean:.3} ± {error:.3}"),
        }
    }

    fn tables(&self, ctx: &mut Context) -> Result<()> {
        let tasks = Task::ALL.map(Task::name);
        let table =
            |title: &str, first: &str| Table::new(title).column(first, Align::Left).numbers(tasks);
        let mut methods: Vec<&str> = Method::ALL.map(Method::name).to_vec();
        methods.push(OTHER_SETS);
        let mut f1 = table("F1 of hidden elements", "method");
        for method in &methods {
            f1.row(
                std::iter::once(method.to_string())
                    .chain(tasks.map(|t| self.cell(method, "f1", t))),
            );
        }
        f1.row(
            std::iter::once("best above the strongest other, in standard errors".to_string())
                .chain(tasks.map(|t| self.margin(t))),
        );
        ctx.table(&f1);
        let mut more = table("The default method in further measures", "measure");
        for metric in [
            "f1_25",
            "iou",
            "count_error",
            "f1_best_of_5",
            "distinct_of_5",
            "calibration",
            "window_recall",
            "door_recall",
            "balcony_recall",
            "shop_recall",
        ] {
            let cells = tasks.map(|t| self.cell("best", metric, t));
            more.row(std::iter::once(metric.to_string()).chain(cells));
        }
        ctx.table(&more);
        let mut sets = table("F1 of the default method by data set", "data");
        let names: std::collections::BTreeSet<&String> = self.by_set.keys().map(|k| &k.0).collect();
        for name in names {
            let cell = |task| match self.by_set.get(&(name.clone(), task)) {
                Some(values) => format!("{:.3}", mean(values)),
                None => "–".into(),
            };
            sets.row(std::iter::once(name.clone()).chain(tasks.map(cell)));
        }
        ctx.table(&sets);
        let mut plausible = table(
            "AUC of a classifier of truth against completion (0.5 is ideal)",
            "method",
        );
        for method in Method::ALL.map(Method::name) {
            let mut cells = vec![method.to_string()];
            for task in tasks {
                let pairs = self.pairs.get(&(method.to_string(), task));
                let Some(pairs) = pairs.filter(|p| p.len() >= 10) else {
                    cells.push("–".into());
                    continue;
                };
                let value = auc(pairs, ctx.seed()).map_err(Error::method)?;
                ctx.observe(row(
                    "all",
                    method,
                    format!("{task}/all"),
                    None,
                    "auc",
                    value,
                ));
                cells.push(format!("{value:.2}"));
            }
            plausible.row(cells);
        }
        ctx.table(&plausible);
        Ok(())
    }

    /// Difference to the strongest other method in standard errors of the paired difference.
    fn margin(&self, task: &'static str) -> String {
        let best = self.facades("best", "f1", task);
        let others = Method::ALL
            .map(Method::name)
            .into_iter()
            .filter(|m| *m != "best");
        let strongest = others
            .map(|m| (m, self.facades(m, "f1", task)))
            .max_by(|a, b| {
                let value =
                    |x: &BTreeMap<&str, f64>| mean(&x.values().copied().collect::<Vec<_>>());
                value(&a.1).total_cmp(&value(&b.1))
            });
        let Some((name, strongest)) = strongest else {
            return "–".into();
        };
        let differences: Vec<f64> = best
            .iter()
            .filter_map(|(f, v)| Some(v - strongest.get(f)?))
            .collect();
        let (mean, error) = summary(&differences);
        format!("{:.1} ({name})", mean / error.max(1e-9))
    }
}
