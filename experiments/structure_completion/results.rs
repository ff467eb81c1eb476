//! Means, margins and plausibility of the benchmark, as tables.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::plausibility::auc;
use super::row;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_structure_completion::method::Method;
use edifice_structure_completion::task::Task;

/// The default method, learnt from the other data sets only.
pub(crate) const OTHER_SETS: &str = "best_other_sets";

/// The values of one facade, task and seed.
#[derive(Serialize, Deserialize)]
pub(crate) struct Answer {
    /// Method, metric, value.
    pub values: Vec<(String, String, f64)>,
    /// Method, statistics of the completed layout.
    pub statistics: Vec<(String, Vec<f64>)>,
    /// Statistics of the true layout.
    pub truth: Vec<f64>,
}

/// Pairs of statistics: of the true layout and of the completed one.
type Pairs = Vec<(Vec<f64>, Vec<f64>)>;

/// Values by method, metric, task and facade.
#[derive(Default)]
pub(crate) struct Results {
    values: BTreeMap<(String, String, &'static str), BTreeMap<String, Vec<f64>>>,
    pairs: BTreeMap<(String, &'static str), Pairs>,
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
    /// Adds the values and the statistics of one facade, task and seed.
    pub(crate) fn add(
        &mut self,
        (dataset, facade): (&str, &str),
        task: &'static str,
        seed: u64,
        answer: &Answer,
    ) {
        let apart = dataset.ends_with("out_of_scope");
        for (method, metric, value) in &answer.values {
            if method == "best" && metric == "f1" {
                let of_set = self.by_set.entry((dataset.to_string(), task)).or_default();
                of_set.push(*value);
            }
            if !apart {
                let key = (method.clone(), metric.clone(), task);
                let facades = self.values.entry(key).or_default();
                facades
                    .entry(format!("{dataset}/{facade}"))
                    .or_default()
                    .push(*value);
            }
        }
        if seed == 0 && !apart {
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

    /// Writes the tables.
    pub(crate) fn tables(&self, ctx: &mut Context) -> Result<()> {
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
        let names: BTreeSet<&String> = self.by_set.keys().map(|k| &k.0).collect();
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
        // Slow methods are run on some of the facades only.
        let others = Method::ALL.into_iter().filter(|m| !m.is_slow());
        let others = others.map(Method::name).filter(|m| *m != "best");
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
