//! Structure completion on real facades: the default method against every baseline.

use std::path::Path;

use edifice::io::{ReadOptions, read_source};
use edifice::methods::structure_completion::layout::{Element, Layout, extract, scope};
use edifice::methods::structure_completion::measure::agreement;
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::{Model, shipped_model};
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::{Watched, unwatched};
use edifice_experiments::layouts;

use crate::cases::cases;
use crate::doors::doors_and_alone;

fn read(path: &Path) -> Layout {
    let source = read_source(path, &ReadOptions::default()).expect("readable");
    extract::elements(&source.labelled().expect("a layout")).expect("elements")
}

#[test]
fn the_default_method_is_above_every_baseline_over_all_tasks_and_below_none_in_any() {
    let Some(folder) = crate::common::real_data("facades/ecp2011/labels") else {
        return;
    };
    let files = layouts::files(&folder.join("facades/ecp2011/labels"), ".png").expect("files");
    let all: Vec<Layout> = files.iter().map(|f| read(f)).collect();
    assert_eq!(all.iter().filter(|l| scope::in_scope(l)).count(), 104);
    let (known, test): (Vec<_>, Vec<_>) =
        all.into_iter().enumerate().partition(|(k, _)| k % 4 != 0);
    // Every other one, unless all cases are asked for.
    let every = test.len() / (2 * cases(test.len())).min(test.len());
    let test: Vec<_> = test.into_iter().step_by(every).collect();
    let known = known.into_iter().step_by(3).map(|(_, l)| l).collect();
    // No method that searches is asked, so that none needs the paper's part.
    let model = Model::of_best(known, 1, &Watched::new(&unwatched)).expect("learnt");
    let methods = Method::ALL.into_iter().filter(|m| !m.is_slow());
    let methods: Vec<Method> = methods.collect();
    let mut overall = vec![0.0; methods.len()];
    for task in Task::ALL {
        // F1 of each method on each facade, in pairs.
        let mut scores: Vec<Vec<f64>> = vec![Vec::new(); methods.len()];
        for (k, layout) in &test {
            let (partial, hidden) = task.hide(layout, &mut stream(2, "mask", *k as u64));
            for (scores, method) in scores.iter_mut().zip(&methods) {
                let done = complete(
                    *method,
                    &partial,
                    &model,
                    1,
                    &mut stream(2, "complete", *k as u64),
                );
                let added: Vec<Element> = done[0].added.iter().map(|a| a.element).collect();
                scores.push(agreement(&added, &hidden, 0.5).f1);
            }
        }
        let means: Vec<f64> = scores.iter().map(|s| mean(s)).collect();
        println!("{}: {means:.3?}", task.name());
        assert!(means[0] > 0.55, "{}: {means:?}", task.name());
        for (method, of) in methods.iter().zip(&scores).skip(1) {
            let differences: Vec<f64> = scores[0].iter().zip(of).map(|(a, b)| a - b).collect();
            let centre = mean(&differences);
            let squares: Vec<f64> = differences.iter().map(|d| (d - centre).powi(2)).collect();
            let error = (mean(&squares) / (differences.len() - 1) as f64).sqrt();
            // Below by more than chance in 25 comparisons (5 tasks, 5 baselines, one-sided, Holm's first step at 5 %).
            assert!(
                centre > -2.9 * error,
                "{}: below {method:?} by {:.3} +- {error:.3}",
                task.name(),
                -centre
            );
        }
        for (overall, mean) in overall.iter_mut().zip(&means) {
            *overall += mean / Task::ALL.len() as f64;
        }
    }
    println!("all tasks: {overall:.3?}");
    let strongest = overall[1..].iter().copied().fold(0.0, f64::max);
    assert!(overall[0] > strongest, "{overall:?}");
}

/// By the default model; the error of counts and F1 stand beside it in the output.
#[test]
fn new_doors_of_cmp_stand_alone_no_more_often_than_true_ones() {
    let Some(folder) = crate::common::real_data("facades/cmp") else {
        return;
    };
    let files = layouts::files(&folder.join("facades/cmp"), ".xml").expect("files");
    let all: Vec<Layout> = files.iter().map(|f| read(f)).collect();
    let share = |[doors, alone]: [usize; 2]| 100.0 * alone as f64 / doors.max(1) as f64;
    let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
    let of_truth = all
        .iter()
        .map(|l| doors_and_alone(&l.elements, &l.elements))
        .fold([0, 0], sum);
    println!(
        "true doors alone: {:.1} % of {}",
        share(of_truth),
        of_truth[0]
    );
    let model = shipped_model().expect("the shipped model");
    for task in [Task::R20, Task::Corner36, Task::Bottom40] {
        let (mut doors, mut scores, mut errors) = ([0, 0], Vec::new(), Vec::new());
        for (k, layout) in all.iter().enumerate() {
            let (partial, hidden) = task.hide_frozen(layout);
            let rng = &mut stream(1, "complete", k as u64);
            let done = complete(Method::Best, &partial, &model, 1, rng);
            let new: Vec<Element> = done[0].added.iter().map(|a| a.element).collect();
            let whole: Vec<Element> = partial.observed.iter().chain(&new).copied().collect();
            doors = sum(doors, doors_and_alone(&new, &whole));
            scores.push(agreement(&new, &hidden, 0.5).f1);
            errors.push(new.len().abs_diff(hidden.len()) as f64);
        }
        let (alone, name) = (share(doors), task.name());
        let [f1, error] = [&scores, &errors].map(|v| mean(v));
        println!(
            "{name}: {alone:.1} % of {} alone, F1 {f1:.3}, count {error:.2}",
            doors[0]
        );
        // Of elements seen one by one, those beside the door may be hidden or not.
        if task != Task::R20 {
            assert!(
                doors[0] > 150 && alone <= share(of_truth),
                "{name}: {doors:?}"
            );
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
