//! The benchmark: parts of whole facades are hidden and completed by all methods, five-fold cross-validated by building.

use std::collections::BTreeMap;
use std::time::Instant;

use super::data::{self, Item};
use super::plausibility::statistics;
use super::results::{Answer, DEFAULT, MASKLESS, OTHER_SETS, Results};
use super::{folds, row};
use crate::{Budget, Context};
use edifice_structure_completion::best::modes;
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::lines::lines;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::measure::{agreement, area_iou, off_lines, overlaps};
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::{Model, shipped_model};
use edifice_structure_completion::partial::PartialLayout;
use edifice_structure_completion::task::Task;
use edifice_base::rng::stream;
use edifice_shape::{Axis, Rect};
use edifice_base::{Error, Result};

/// Folds of the cross-validation.
const FOLDS: usize = 5;

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
    let default = shipped_model().map_err(Error::method)?;
    let mut others: BTreeMap<&str, Model> = BTreeMap::new();
    if !shipped && ctx.budget() != Budget::Smoke {
        for set in ["ecp2011", "graz50", "cmp"] {
            if used.iter().any(|i| i.dataset == set) && used.iter().any(|i| i.dataset != set) {
                let model = folds::model(&used, ctx.seed(), |i| used[i].dataset != set)?;
                others.insert(set, model);
            }
        }
    }
    // The methods that search take seconds a facade.
    let searched = ctx.budget().choose(1, 30, used.len());
    ctx.setting("facades_of_slow_methods", searched);
    let every = used.len().div_ceil(searched.max(1)).max(1);
    let mut units = Vec::new();
    for seed in 0..seeds {
        for task in Task::ALL {
            for (k, item) in used.iter().copied().enumerate() {
                let searched = seed == 0 && k % every == 0;
                let own = Method::ALL.into_iter().filter(|m| searched || !m.is_slow());
                let own = own.map(|m| (m.name(), m, &models[fold[k]]));
                let mut all: Vec<_> = own.collect();
                let other = others.get(item.dataset);
                all.push((DEFAULT, Method::Best, &default));
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
        let set = dataset(unit.item);
        result.add(
            (&set, &unit.item.layout.name),
            unit.task.name(),
            unit.seed,
            answer,
        );
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
        for (metric, value) in measures(&partial, &first, &hidden) {
            put(metric, value);
        }
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
            if let Some(inside) = inside(&windows, &hidden) {
                put("calibration", inside);
            }
        }
        if method == Method::Best && partial.unknown.is_some() {
            let maskless = PartialLayout {
                unknown: None,
                ..partial.clone()
            };
            let mut rng = stream(run_seed, &format!("completion/{name}"), unit.seed);
            let done = modes::complete(&maskless, model, 1, &mut rng).completions;
            let first = added(done.first());
            let f1 = agreement(&first, &hidden, 0.5).f1;
            values.push((format!("{label}{MASKLESS}"), "f1".into(), f1));
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

/// How near the added elements are to the hidden ones, and how coherent.
fn measures(
    partial: &PartialLayout,
    added: &[Element],
    hidden: &[Element],
) -> Vec<(&'static str, f64)> {
    let at = |least: f64| agreement(added, hidden, least).f1;
    let ten: f64 = (0..10).map(|k| at(0.5 + 0.05 * f64::from(k))).sum();
    let count = |elements: &[Element], class: Class| {
        let own = elements.iter().filter(|e| e.class == class);
        own.count() as f64
    };
    let mut all = vec![
        ("f1", at(0.5)),
        ("f1_25", at(0.25)),
        ("f1_75", at(0.75)),
        ("f1_50_95", ten / 10.0),
        ("iou", area_iou(added, hidden)),
        (
            "count_error",
            (added.len() as f64 - hidden.len() as f64).abs(),
        ),
        (
            "overlapping",
            f64::from(u8::from(overlaps(&partial.observed, added) > 0)),
        ),
        ("doors_added", count(added, Class::Door)),
    ];
    let windows = count(added, Class::Window);
    if windows > 0.0 {
        let off = off_lines(&partial.observed, added) as f64;
        all.push(("off_lines", off / windows));
    }
    for (name, axis) in [("columns_right", Axis::X), ("rows_right", Axis::Y)] {
        let lattice = |elements: &[Element]| {
            let all = partial.observed.iter().chain(elements);
            let windows = all.filter(|e| e.class == Class::Window);
            let rects: Vec<Rect> = windows.map(|e| e.rect).collect();
            lines(&rects, axis).0.len()
        };
        let right = lattice(added).abs_diff(lattice(hidden)) <= 1;
        all.push((name, f64::from(u8::from(right))));
    }
    all
}

fn added(completion: Option<&Completion>) -> Vec<Element> {
    completion
        .into_iter()
        .flat_map(|c| c.added.iter().map(|a| a.element))
        .collect()
}

/// 1 if the true number of windows lies between the 10 % and the 90 % quantile of the pool, otherwise 0; `None` if the
/// pool has no layout to count.
fn inside(windows: &[(usize, f64)], hidden: &[Element]) -> Option<f64> {
    let truth = hidden.iter().filter(|e| e.class == Class::Window).count();
    let weight = |test: &dyn Fn(usize) -> bool| -> f64 {
        windows.iter().filter(|w| test(w.0)).map(|w| w.1).sum()
    };
    // The weights are shares of the pool's origins, some of which a facade may lack.
    let total = weight(&|_| true);
    if total <= 0.0 {
        return None;
    }
    let inside = weight(&|n| n < truth) <= 0.9 * total && weight(&|n| n > truth) <= 0.9 * total;
    Some(f64::from(u8::from(inside)))
}
