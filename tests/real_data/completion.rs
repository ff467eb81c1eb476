//! Structure completion on real facades: the default method against every baseline.

use edifice::io::{ReadOptions, read_source};
use edifice::methods::structure_completion::layout::{Element, Layout, extract, scope};
use edifice::methods::structure_completion::measure::agreement;
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::Model;
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice_base::unwatched;
use edifice_experiments::layouts;

#[test]
fn the_default_method_is_above_every_baseline_on_paris_facades() {
    let Some(folder) = crate::common::real_data("facades/ecp2011/labels") else {
        return;
    };
    let files = layouts::files(&folder.join("facades/ecp2011/labels"), ".png").expect("files");
    let read = |path: &std::path::PathBuf| {
        let source = read_source(path, &ReadOptions::default()).expect("readable");
        extract::elements(&source.labelled().expect("a layout")).expect("elements")
    };
    let all: Vec<Layout> = files.iter().map(read).collect();
    assert_eq!(all.iter().filter(|l| scope::in_scope(l)).count(), 104);
    let (known, test): (Vec<_>, Vec<_>) =
        all.into_iter().enumerate().partition(|(k, _)| k % 4 != 0);
    let known = known.into_iter().step_by(3).map(|(_, l)| l).collect();
    let model = Model::train(known, 1, &unwatched).expect("learnt").model;
    for task in Task::ALL {
        let methods = Method::ALL.into_iter().filter(|m| !m.is_slow());
        let methods: Vec<Method> = methods.collect();
        let mut mean = vec![0.0; methods.len()];
        for (k, layout) in test.iter().step_by(2) {
            let (partial, hidden) = task.hide(layout, &mut stream(2, "mask", *k as u64));
            for (mean, method) in mean.iter_mut().zip(&methods) {
                let done = complete(
                    *method,
                    &partial,
                    &model,
                    1,
                    &mut stream(2, "complete", *k as u64),
                );
                let added: Vec<Element> = done[0].added.iter().map(|a| a.element).collect();
                *mean += agreement(&added, &hidden, 0.5).f1 / 13.0;
            }
        }
        let strongest = mean[1..].iter().copied().fold(0.0, f64::max);
        assert!(mean[0] > strongest, "{}: {mean:?}", task.name());
        assert!(mean[0] > 0.6, "{}: {mean:?}", task.name());
    }
}
