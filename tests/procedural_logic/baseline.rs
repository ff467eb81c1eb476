//! The split-only baseline derives back what it was given, and shares what is equal.

use std::path::Path;

use edifice::grammar::{Costs, Operation, evaluate};
use edifice::io::facade_json;
use edifice::methods::procedural_logic::{
    BaselineError, Extent, Facing, Joining, Parameters, baseline_grammar, baseline_grammar_joining,
    search_axes,
};
use edifice::rng::stream;
use edifice::shape::{Axis, Facade, LayoutError, Rect, Region};
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
        let axis = if wide { Axis::X } else { Axis::Y };
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
        let cost = |joining| {
            let grammar = baseline_grammar_joining(&facade, &Parameters::COMPRESSION, joining)
                .expect("guillotine");
            evaluate(&grammar, std::slice::from_ref(&facade), &Costs::default())
                .unwrap_or_else(|error| panic!("tiling {index}, {joining:?}: {error}"))
                .cost
        };
        let [_, used_once, binary] = [Joining::All, Joining::UsedOnce, Joining::Binary].map(cost);
        // Joining a split that is used once saves its operation and its successor.
        assert!(used_once <= binary + 1e-9, "tiling {index}");
    }
}

/// Table 2 prints 51 for facade (i): no setting and no reading of the energy gives it, since no part of this facade has
/// full lines in both directions.
#[test]
fn parameters_do_not_matter_on_facade_i() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/facade_grammar/wu2014_fig9.facade.json");
    let facade = facade_json::read(&file).expect("the shipped facade");
    let cost = |parameters: &Parameters, joining| {
        let grammar = baseline_grammar_joining(&facade, parameters, joining).expect("guillotine");
        let found = evaluate(&grammar, std::slice::from_ref(&facade), &Costs::default());
        found.expect("derives back").cost
    };
    let [alphas, parental, horizontal] = search_axes();
    let mut binary = std::collections::BTreeSet::new();
    for extent in [Extent::Line, Extent::Scope, Extent::Facade] {
        for facing in [Facing::Across, Facing::Adjacent] {
            for &alpha in &alphas {
                for &parental_bias in &parental {
                    for &horizontal_bias in &horizontal {
                        let setting = Parameters {
                            alpha,
                            parental_bias,
                            horizontal_bias,
                            extent,
                            facing,
                        };
                        let text = cost(&setting, Joining::All);
                        assert!((text - 43.4).abs() < 1e-9, "{setting:?}: {text}");
                        binary.insert((10.0 * cost(&setting, Joining::Binary)).round() as i64);
                    }
                }
            }
        }
    }
    // Without joining, the order of the lines stays, and the parameters matter.
    assert_eq!(binary.into_iter().collect::<Vec<_>>(), [693, 756]);
}

/// If full lines go both ways, the parameters decide which go first.
#[test]
fn parameters_decide_where_lines_cross() {
    // Three floors of a wall and a window; along the floors something faces every line, across them nothing does.
    let mut regions = Vec::new();
    for floor in 0..3 {
        let y = 2.0 * f64::from(floor);
        regions.push(region("wall", Rect::new(0.0, y, 1.0, 2.0)));
        regions.push(region("window", Rect::new(1.0, y, 9.0, 2.0)));
    }
    let facade = Facade::new("grid", "m", 10.0, 6.0, regions).expect("a layout");
    let first = |alpha| {
        let setting = Parameters::new(alpha, 0.25, 0.5).expect("in range");
        let grammar = baseline_grammar(&facade, &setting).expect("guillotine");
        match grammar.rules[0].operation {
            Operation::Split { axis, .. } => axis,
            _ => panic!("the baseline only splits"),
        }
    };
    // All lines are edges from end to end; what faces them makes those along the floors dear.
    assert_eq!((first(0.5), first(1.0)), (Axis::X, Axis::Y));
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
