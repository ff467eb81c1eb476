//! Structure completion: what holds for every method and every input.

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::measure::agreement;
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::{Model, TrainError, shipped_model};
use edifice::methods::structure_completion::partial::{PartialError, PartialLayout};
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::Rect;
use edifice::unwatched;
use rand::RngExt;

use crate::cases::cases;

/// The layouts that ship, as the shipped model holds them.
fn shipped() -> Vec<Layout> {
    let model = shipped_model().expect("the shipped model");
    model.examples.into_iter().map(|e| e.layout).collect()
}

/// The methods that take milliseconds.
fn quick() -> impl Iterator<Item = Method> {
    Method::ALL.into_iter().filter(|m| !m.is_slow())
}

/// A lattice of windows.
fn grid(columns: usize, rows: usize) -> Layout {
    let mut elements = Vec::new();
    for r in 0..rows {
        for c in 0..columns {
            let (x, y) = (8.0 + 25.0 * c as f64, 10.0 + 30.0 * r as f64);
            elements.push(Element::new(Class::Window, Rect::new(x, y, 10.0, 16.0)));
        }
    }
    Layout {
        name: "grid".into(),
        width: 1.0 + 25.0 * columns as f64,
        height: 6.0 + 30.0 * rows as f64,
        elements,
    }
}

fn check(partial: &PartialLayout, method: Method, model: &Model, what: &str) {
    let completions = complete(method, partial, model, 5, &mut stream(1, what, 0));
    assert!(!completions.is_empty());
    let mass: f64 = completions.iter().map(|c| c.mass).sum();
    assert!(mass <= 1.0 + 1e-9, "{what}: {mass}");
    for completion in &completions {
        for (k, a) in completion.added.iter().enumerate() {
            assert!(
                partial.allows(&a.element),
                "{what}, {method:?}: {:?}",
                a.element
            );
            assert!((0.0..=1.0).contains(&a.probability), "{what}");
            let others = &completion.added[..k];
            assert!(
                !others.iter().any(|o| o.element.excludes(&a.element)),
                "{what}, {method:?}"
            );
        }
    }
}

#[test]
fn completions_respect_what_is_known() {
    let model = shipped_model().expect("the shipped model");
    for (k, layout) in shipped().iter().enumerate().step_by(5) {
        for task in Task::ALL {
            let mut rng = stream(7, "tasks", k as u64);
            let (mut partial, hidden) = task.hide(layout, &mut rng);
            assert_eq!(partial.observed.len() + hidden.len(), layout.elements.len());
            partial.check().expect("observed elements are consistent");
            let x = rng.random::<f64>() * layout.width * 0.5;
            partial
                .forbidden
                .push(Rect::new(x, 0.0, layout.width / 5.0, layout.height / 2.0));
            for method in quick() {
                check(
                    &partial,
                    method,
                    &model,
                    &format!("{} {}", layout.name, task.name()),
                );
            }
        }
    }
}

#[test]
fn random_and_degenerate_inputs_are_completed() {
    let model = shipped_model().expect("the shipped model");
    let mut rng = stream(8, "random", 0);
    for case in 0..60 {
        let (width, height) = (
            10.0_f64.powf(rng.random_range(-2.0..4.0)),
            10.0_f64.powf(rng.random_range(-2.0..4.0)),
        );
        let mut partial = PartialLayout {
            width,
            height,
            observed: Vec::new(),
            unknown: None,
            forbidden: Vec::new(),
        };
        for _ in 0..rng.random_range(0..8) {
            let (w, h) = (
                width * rng.random_range(0.001..0.5),
                height * rng.random_range(0.001..0.5),
            );
            let (x, y) = (
                (width - w) * rng.random::<f64>(),
                (height - h) * rng.random::<f64>(),
            );
            let element = Element::new(Class::ALL[rng.random_range(0..4)], Rect::new(x, y, w, h));
            if !partial.observed.iter().any(|o| o.excludes(&element)) {
                partial.observed.push(element);
            }
        }
        if rng.random::<bool>() {
            let half = Rect::new(0.0, 0.0, width / 2.0, height);
            partial
                .observed
                .retain(|e| !half.contains(e.rect.centre().0, e.rect.centre().1));
            partial.unknown = Some(vec![half]);
        }
        for method in quick() {
            check(&partial, method, &model, &format!("random {case}"));
        }
    }
}

#[test]
fn slow_methods_respect_what_is_known() {
    let model = shipped_model().expect("the shipped model");
    let (partial, _) = Task::Side50.hide(&grid(4, 3), &mut stream(3, "grid", 0));
    for method in Method::ALL.into_iter().filter(|m| m.is_slow()) {
        check(&partial, method, &model, method.name());
    }
}

#[test]
fn a_regular_grid_comes_back() {
    let model = shipped_model().expect("the shipped model");
    let layout = grid(7, 6);
    for task in [Task::R50, Task::Side50] {
        let (partial, hidden) = task.hide(&layout, &mut stream(3, "grid", 0));
        let done = complete(Method::Best, &partial, &model, 1, &mut stream(3, "grid", 1));
        let added: Vec<Element> = done[0].added.iter().map(|a| a.element).collect();
        let windows: Vec<Element> = added
            .into_iter()
            .filter(|e| e.class == Class::Window)
            .collect();
        let f1 = agreement(&windows, &hidden, 0.5).f1;
        assert!(f1 > 0.85, "{}: {f1}", task.name());
    }
}

#[test]
fn same_seed_same_completions_with_any_number_of_threads() {
    let layouts: Vec<Layout> = shipped().into_iter().step_by(34 / cases(2)).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let model = Model::train(layouts.clone(), 5, &unwatched)
                .expect("learnt")
                .model;
            let (partial, _) = Task::Side50.hide(&layouts[0], &mut stream(5, "mask", 0));
            let done = complete(
                Method::Best,
                &partial,
                &model,
                5,
                &mut stream(5, "complete", 0),
            );
            (model.to_json(), format!("{done:?}"))
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn models_come_back_from_their_text_and_bad_ones_are_named() {
    let model = shipped_model().expect("the shipped model");
    let text = model.to_json();
    assert_eq!(Model::from_json(&text).expect("its own text"), model);
    for (from, to, expected) in [
        (
            "edifice/completion_model",
            "edifice/facade",
            "format is edifice/facade",
        ),
        ("\"version\":1", "\"version\":2", "version is 2"),
        ("\"width\":", "\"width\":-", "no positive width"),
        (
            "\"prior\":",
            "\"prior\":1e400,\"p\":",
            "number out of range",
        ),
    ] {
        let message = Model::from_json(&text.replacen(from, to, 1))
            .expect_err(to)
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
    for end in (0..text.len()).step_by(text.len() / 40) {
        assert!(Model::from_json(&text[..end]).is_err());
    }
    assert_eq!(
        Model::train(Vec::new(), 0, &unwatched),
        Err(TrainError::Empty)
    );
    let one = Model::train(vec![grid(5, 4)], 0, &unwatched)
        .expect("one facade")
        .model;
    assert!(one.elements.is_none());
    let (partial, _) = Task::Side50.hide(&grid(5, 4), &mut stream(1, "mask", 0));
    check(&partial, Method::Best, &one, "one facade");
}

#[test]
fn bad_partial_layouts_are_named() {
    let window = |x: f64| Element::new(Class::Window, Rect::new(x, 0.0, 10.0, 10.0));
    let partial = |observed: Vec<Element>, unknown: Option<Vec<Rect>>| PartialLayout {
        width: 100.0,
        height: 50.0,
        observed,
        unknown,
        forbidden: Vec::new(),
    };
    let outside = partial(vec![window(0.0), window(95.0)], None).check();
    assert!(matches!(
        outside,
        Err(PartialError::Outside { index: 1, .. })
    ));
    let unknown = Some(vec![Rect::new(50.0, 0.0, 50.0, 50.0)]);
    let inside = partial(vec![window(60.0)], unknown).check();
    assert!(matches!(
        inside,
        Err(PartialError::InUnknown {
            index: 0,
            unknown: 0,
            ..
        })
    ));
    // Annotations of real facades overlap.
    let overlap = partial(vec![window(0.0), window(5.0)], None);
    assert_eq!((overlap.check(), overlap.overlaps().len()), (Ok(()), 1));
    // A balcony may lie over a window.
    let balcony = Element::new(Class::Balcony, Rect::new(0.0, 0.0, 12.0, 4.0));
    assert!(
        partial(vec![window(0.0), balcony], None)
            .overlaps()
            .is_empty()
    );
}

#[test]
fn the_first_overlap_is_that_of_all_pairs() {
    for case in 0..2000 {
        let mut rng = stream(9, "overlaps", case);
        let count = rng.random_range(0..12);
        let mut observed = Vec::new();
        for _ in 0..count {
            let class = Class::ALL[rng.random_range(0..4)];
            // Some have no area, and many meet at an edge.
            let mut place = |most: i32| f64::from(rng.random_range(0..=most)) * 2.5;
            let (w, h) = (place(8), place(6));
            let rect = Rect::new(place(24), place(14), w, h);
            observed.push(Element::new(class, rect));
        }
        let pairs = (0..count).flat_map(|b| (0..b).map(move |a| (a, b)));
        let wrong = pairs
            .clone()
            .find(|&(a, b)| observed[a].excludes(&observed[b]));
        let partial = PartialLayout {
            width: 90.0,
            height: 60.0,
            observed,
            unknown: None,
            forbidden: Vec::new(),
        };
        assert_eq!(partial.check(), Ok(()));
        let found = partial.overlaps().first().map(|o| (o.first, o.second));
        assert_eq!(found, wrong, "case {case}");
    }
}

#[test]
fn labels_are_told_by_their_beginning() {
    for (label, class) in [
        ("window", Some(Class::Window)),
        ("Windows", Some(Class::Window)),
        ("Window_2", Some(Class::Window)),
        ("DOOR", Some(Class::Door)),
        ("door left", Some(Class::Door)),
        ("windowless", None),
        ("shop1", Some(Class::Shop)),
        ("wall", None),
    ] {
        assert_eq!(Class::of_label(label), class, "{label}");
    }
}

#[test]
fn changed_model_files_are_errors_or_models_that_complete() {
    let text = Model::train(vec![grid(4, 3)], 0, &unwatched)
        .expect("one facade")
        .model
        .to_json();
    let (partial, _) = Task::R50.hide(&grid(4, 3), &mut stream(1, "mask", 0));
    let mut rng = stream(9, "changes", 0);
    let mut read = 0;
    for case in 0..400 {
        let mut bytes = text.clone().into_bytes();
        // Layouts stand first; tables of spacings are long.
        let place = rng.random_range(0..900.min(bytes.len()));
        bytes[place] = b"0123456789-.e,\"[]{}"[rng.random_range(0..19)];
        let text = String::from_utf8(bytes).expect("text");
        if let Ok(model) = Model::from_json(&text) {
            read += 1;
            check(&partial, Method::Best, &model, &format!("change {case}"));
            assert_eq!(
                Model::from_json(&model.to_json()).expect("its own text"),
                model
            );
        }
    }
    assert!(read > 20, "{read}");
}
