//! The benchmark: parts of whole facades are hidden and completed by all methods, five-fold cross-validated by building.

use std::collections::BTreeMap;
use std::time::Instant;

use super::data::{self, Item};
use super::folds::{self, Parted};
use super::plausibility::statistics;
use super::results::{Answer, OTHER_SETS, Results};
use super::row;
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::{Budget, Context};
use edifice_structure_completion::best::modes;
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::{Class, Element};
use edifice_structure_completion::measure::{agreement, area_iou};
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::task::Task;

/// One facade, one task, one seed; the models that have not seen it.
struct Unit<'a> {
    item: &'a Item,
    task: Task,
    seed: u64,
    models: Vec<(&'static str, Method, &'a Model)>,
}

/// Runs the benchmark.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seeds = ctx.budget().choose(1, 1, 5);
    ctx.setting("mask_seeds", seeds);
    // The shipped layouts are few and quick to be told apart; every model takes seconds.
    let few = if ctx.data().is_some() { 5 } else { 3 };
    let folds = ctx.budget().choose(2, few, 5);
    ctx.setting("folds", folds);
    let all = data::items(ctx)?;
    let shipped = all.iter().all(|i| i.dataset == "shipped");
    // The methods that search take seconds a facade.
    let searched = ctx.budget().choose(1, 3, usize::MAX);
    // The few shipped layouts are too few to leave any out.
    let Parted {
        used,
        apart,
        fold,
        every,
        models,
        by_default,
    } = Parted::new(&all, folds, shipped, searched, ctx.seed())?;
    ctx.setting("facades_of_slow_methods", searched.min(used.len()));
    let mut others: BTreeMap<&str, Model> = BTreeMap::new();
    if !shipped && ctx.budget() != Budget::Smoke {
        for set in ["ecp2011", "graz50", "cmp"] {
            if used.iter().any(|i| i.dataset == set) && used.iter().any(|i| i.dataset != set) {
                let model = folds::fast_model(&used, ctx.seed(), |i| used[i].dataset != set)?;
                others.insert(set, model);
            }
        }
    }
    // A part of the facades shows that the path works.
    let step = ctx.budget().choose(4, 1, 1);
    let mut units = Vec::new();
    for seed in 0..seeds {
        for task in Task::ALL {
            for (k, item) in used.iter().copied().enumerate().step_by(step) {
                let searched = seed == 0 && k % every == 0;
                let own = Method::ALL.into_iter().filter(|m| searched || !m.is_slow());
                let own = own.map(|m| (m.name(), m, &models[fold[k]]));
                let mut all: Vec<_> = own.collect();
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
    let dataset = |item: &Item| match apart.iter().any(|other| std::ptr::eq(*other, item)) {
        false => item.dataset.to_string(),
        true => format!("{}_out_of_scope", item.dataset),
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
    if by_default {
        ctx.note("All facades are near-twins, so that none could be learnt from to complete another: the model that ships completed them.");
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
            if let Some(inside) = inside(&windows, &hidden) {
                put("calibration", inside);
            }
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
