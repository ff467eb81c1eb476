//! The score of a layout: changed one element at a time, in other units, mirrored, reordered.

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::score::{Change, ScoreModel, Scored, Term, Training};
use edifice::rng::{Stream, stream};
use edifice::shape::Rect;
use rand::RngExt;
use rand::seq::SliceRandom;

/// A facade of windows with a ground floor of a door and shops, and balconies under some windows.
fn layout(index: u64) -> Layout {
    let mut rng = stream(index, "layout", 0);
    let (columns, rows) = (rng.random_range(3..9), rng.random_range(2..6));
    let (w, h) = (rng.random_range(0.9..1.3), rng.random_range(1.4..2.0));
    let (dx, dy) = (
        w * rng.random_range(1.5..2.2),
        h * rng.random_range(1.4..1.9),
    );
    let mut elements = Vec::new();
    for column in 0..columns {
        let x = 0.8 + dx * f64::from(column);
        for row in 1..=rows {
            let rect = Rect::new(x, dy * f64::from(row), w, h);
            elements.push(Element::new(Class::Window, rect));
            if row == rows && index.is_multiple_of(3) {
                let rect = Rect::new(x - 0.1, rect.y - 0.2, w + 0.2, 0.5);
                elements.push(Element::new(Class::Balcony, rect));
            }
        }
        let (class, width) = match column == columns / 2 {
            true => (Class::Door, 0.9 * w),
            false => (Class::Shop, 1.3 * w),
        };
        let rect = Rect::new(x + 0.5 * (w - width), 0.0, width, 1.1 * h);
        elements.push(Element::new(class, rect));
    }
    let jitter = 0.01 * w;
    for element in &mut elements {
        element.rect.x += rng.random_range(-jitter..jitter);
        element.rect.y += rng.random_range(0.0..jitter);
    }
    Layout {
        name: format!("layout {index}"),
        width: 0.8 + dx * f64::from(columns),
        height: dy * f64::from(rows + 1) + 0.5,
        elements,
    }
}

fn model() -> ScoreModel {
    let mut model = ScoreModel::train(
        &(0..40).map(layout).collect::<Vec<_>>(),
        &Training::default(),
    )
    .unwrap();
    for (k, weight) in model.weights.iter_mut().enumerate() {
        *weight = 0.3 + 0.17 * k as f64;
    }
    model
}

fn facade(layout: &Layout) -> [f64; 2] {
    [layout.width, layout.height]
}

fn random_element(layout: &Layout, rng: &mut Stream) -> Element {
    let class = Class::ALL[rng.random_range(0..4)];
    let near = layout.elements[rng.random_range(0..layout.elements.len())].rect;
    let width = near.width * rng.random_range(0.5..2.0);
    let height = near.height * rng.random_range(0.5..2.0);
    let x = rng.random_range(0.0..layout.width - width);
    Element::new(class, Rect::new(x, near.y, width, height))
}

#[test]
fn changes_give_the_same_score_as_all_anew() {
    let model = model();
    let mut rng = stream(9, "changes", 0);
    let mut moves = 0;
    for index in 100..120 {
        let layout = layout(index);
        let mut scored = Scored::new(&model, facade(&layout), layout.elements.clone());
        for _ in 0..5000 {
            let count = scored.elements().len();
            let at = rng.random_range(0..count.max(1));
            let change = match rng.random_range(0..4) {
                _ if count < 3 => Change::Add(random_element(&layout, &mut rng)),
                0 if count < 90 => Change::Add(random_element(&layout, &mut rng)),
                1 => Change::Remove(at),
                2 => Change::Set(at, random_element(&layout, &mut rng)),
                _ => {
                    let mut moved = scored.elements()[at];
                    moved.rect.x += rng.random_range(-0.1..0.1);
                    Change::Set(at, moved)
                }
            };
            let (elements, before) = (scored.elements().to_vec(), *scored.features());
            let score = scored.apply(change);
            let anew = model.evaluate(facade(&layout), scored.elements());
            for (k, term) in Term::ALL.iter().enumerate() {
                let (a, b) = (scored.features()[k], anew.features[k]);
                assert!((a - b).abs() < 1e-9, "{term:?}: {a} {b} after {change:?}");
            }
            assert!((score - model.score(&anew.features)).abs() < 1e-9);
            assert!(score.is_finite() && anew.features.iter().all(|f| *f <= 0.0));
            if rng.random::<f64>() < 0.4 {
                scored.undo();
                assert_eq!(
                    (scored.elements(), scored.features()),
                    (&elements[..], &before)
                );
            }
            moves += 1;
        }
    }
    assert_eq!(moves, 100_000);
}

#[test]
fn nothing_is_a_layout_too() {
    let model = model();
    let mut scored = Scored::new(&model, [10.0, 10.0], Vec::new());
    assert!(scored.score().is_finite());
    assert_eq!(scored.apply(Change::Remove(0)), scored.score());
    let whole = scored.apply(Change::Add(layout(0).elements[0]));
    assert!(whole > -1e3 && whole.is_finite());
    assert!(ScoreModel::train(&[], &Training::default()).is_err());
    // One facade, and one with a single element, are databases.
    for count in [1, 100] {
        let mut one = layout(1);
        one.elements.truncate(count);
        let model = ScoreModel::train(&[one.clone()], &Training::default()).unwrap();
        let score = model.score(&model.evaluate(facade(&one), &one.elements).features);
        assert!(score > -3.0, "its own facade is typical: {score}");
    }
}

#[test]
fn units_order_and_mirroring_change_nothing() {
    let layouts: Vec<Layout> = (0..40).map(layout).collect();
    let model = ScoreModel::train(&layouts, &Training::default()).unwrap();
    let scaled = |layout: &Layout, c: f64| {
        let mut layout = layout.clone();
        layout.width *= c;
        layout.height *= c;
        for e in &mut layout.elements {
            let r = e.rect;
            e.rect = Rect::new(c * r.x, c * r.y, c * r.width, c * r.height);
        }
        layout
    };
    let many: Vec<Layout> = layouts.iter().map(|l| scaled(l, 256.0)).collect();
    let in_other_unit = ScoreModel::train(&many, &Training::default()).unwrap();
    let mut rng = stream(2, "order", 0);
    for index in 200..230 {
        let layout = layout(index);
        let features = model.evaluate(facade(&layout), &layout.elements).features;
        let close = |other: &ScoreModel, changed: &Layout, what: &str| {
            let f = other.evaluate(facade(changed), &changed.elements).features;
            for k in 0..Term::ALL.len() {
                let (a, b) = (features[k], f[k]);
                assert!(
                    (a - b).abs() < 1e-6 * (1.0 + a.abs()),
                    "{what}: {:?} {a} {b}",
                    Term::ALL[k]
                );
            }
        };
        close(&in_other_unit, &scaled(&layout, 256.0), "unit");
        let mut shuffled = layout.clone();
        shuffled.elements.shuffle(&mut rng);
        close(&model, &shuffled, "order");
    }
}

#[test]
fn each_term_names_its_culprit() {
    let model = model();
    let layout = layout(4);
    let evaluation = model.evaluate(facade(&layout), &layout.elements);
    let lines = model.explain(&evaluation, facade(&layout));
    assert_eq!(lines.len(), 10);
    let sum: f64 = lines.iter().map(|l| l.weight * l.feature).sum();
    assert!((sum - model.score(&evaluation.features)).abs() < 1e-9);
    assert!(
        lines
            .iter()
            .all(|l| !l.culprit.is_empty() && l.least <= l.feature + 1e-9)
    );
    // A window taken out of the middle makes its grid the culprit of incompleteness.
    let mut holed = layout.clone();
    let window = holed.elements.iter().position(|e| e.class == Class::Window);
    holed.elements.remove(window.unwrap() + 5);
    let evaluation = model.evaluate(facade(&holed), &holed.elements);
    let line = &model.explain(&evaluation, facade(&holed))[3];
    assert!(line.culprit.starts_with("window grid"), "{}", line.culprit);
}
