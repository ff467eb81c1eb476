//! The split-only baseline derives back what it was given, and shares what is equal.

use edifice::grammar::{Costs, evaluate};
use edifice::methods::procedural_logic::{BaselineError, Parameters, baseline_grammar};
use edifice::rng::stream;
use edifice::shape::{Facade, LayoutError, Rect, Region};
use rand::{Rng, RngExt};

fn region(label: &str, rect: Rect) -> Region {
    Region {
        label: label.into(),
        rect,
    }
}

/// Cuts a rectangle at random into labelled parts, with whole or broken sizes.
fn cut<R: Rng>(rect: Rect, depth: usize, rng: &mut R, out: &mut Vec<Region>) {
    let wide = rng.random_bool(0.5);
    let parts = rng.random_range(1..4);
    let extent = if wide { rect.width } else { rect.height };
    if depth == 0 || parts == 1 || extent < 4.0 {
        let label = ["wall", "window", "door"][rng.random_range(0..3)];
        return out.push(region(label, rect));
    }
    let step = extent / f64::from(parts);
    for part in 0..parts {
        let axis = if wide {
            edifice::shape::Axis::X
        } else {
            edifice::shape::Axis::Y
        };
        let start = rect.start(axis) + step * f64::from(part);
        cut(rect.strip(axis, start, step), depth - 1, rng, out);
    }
}

#[test]
fn derives_back_any_guillotine_tiling() {
    for index in 0..200 {
        let mut rng = stream(1, "baseline", index);
        let (width, height) = (
            rng.random_range(5.0..90.0_f64),
            rng.random_range(5..90) as f64,
        );
        let mut regions = Vec::new();
        cut(
            Rect::new(0.0, 0.0, width, height),
            5,
            &mut rng,
            &mut regions,
        );
        let facade = Facade::new("cut", "m", width, height, regions).expect("a layout");
        let grammar = baseline_grammar(&facade, &Parameters::COMPRESSION).expect("guillotine");
        evaluate(&grammar, std::slice::from_ref(&facade), &Costs::default())
            .unwrap_or_else(|error| panic!("tiling {index}: {error}"));
    }
}

#[test]
fn equal_content_shares_a_symbol() {
    // Two equal floors of wall and window, and one with another window width.
    let mut regions = Vec::new();
    for (floor, window) in [(0.0, 2.0), (1.0, 2.0), (2.0, 3.0)] {
        regions.push(region("window", Rect::new(0.0, floor * 4.0, window, 4.0)));
        let wall = Rect::new(window, floor * 4.0, 10.0 - window, 4.0);
        regions.push(region("wall", wall));
    }
    let facade = Facade::new("floors", "m", 10.0, 12.0, regions).expect("a layout");
    let grammar = baseline_grammar(&facade, &Parameters::COMPRESSION).expect("guillotine");
    let found = evaluate(&grammar, &[facade], &Costs::default()).expect("derives back");
    assert_eq!((found.rules, found.terminals), (3, 6));
    assert!((found.cost - (3.1 + 2.0 * 2.1)).abs() < 1e-12);
}

#[test]
fn says_what_is_wrong() {
    let pinwheel = [
        ("a", Rect::new(0.0, 0.0, 2.0, 1.0)),
        ("b", Rect::new(2.0, 0.0, 1.0, 2.0)),
        ("c", Rect::new(1.0, 2.0, 2.0, 1.0)),
        ("d", Rect::new(0.0, 1.0, 1.0, 2.0)),
        ("e", Rect::new(1.0, 1.0, 1.0, 1.0)),
    ];
    let regions = pinwheel.iter().map(|(label, rect)| region(label, *rect));
    let facade = Facade::new("pinwheel", "m", 3.0, 3.0, regions.collect()).expect("a layout");
    let error = baseline_grammar(&facade, &Parameters::COMPRESSION);
    assert!(matches!(error, Err(BaselineError::NoSplit(_))), "{error:?}");

    let mut gap = facade.clone();
    gap.regions.pop();
    let error = baseline_grammar(&gap, &Parameters::COMPRESSION);
    assert!(
        matches!(error, Err(BaselineError::Layout(LayoutError::Gap { .. }))),
        "{error:?}"
    );

    let alpha = Parameters {
        alpha: f64::NAN,
        ..Parameters::COMPRESSION
    };
    let error = baseline_grammar(&facade, &alpha);
    assert!(
        matches!(error, Err(BaselineError::Parameter(_))),
        "{error:?}"
    );
}
