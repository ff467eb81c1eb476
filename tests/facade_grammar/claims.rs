//! "Proven optimal" on layouts that once made it false: other units, free items, A B A, costs and limits out of range.

use edifice::grammar::{Costs, evaluate};
use edifice::io::facade_json;
use edifice::methods::facade_grammar::{
    BoundLimits, InferError, Operations, Settings, Weakness, infer, lower_bound,
};
use edifice::shape::{Facade, Rect, Region};
use edifice::unwatched;

fn shipped(name: &str) -> Facade {
    let root = env!("CARGO_MANIFEST_DIR");
    facade_json::read(format!("{root}/datasets/facade_grammar/{name}.facade.json").as_ref())
        .unwrap()
}

/// A row of cells, one character a cell.
fn row(labels: &str, width: f64) -> Facade {
    let cells = labels.chars().enumerate().map(|(i, label)| Region {
        label: label.to_string(),
        rect: Rect::new(i as f64 * width, 0.0, width, 1.0),
    });
    let count = labels.chars().count() as f64;
    Facade::new("row", "m", count * width, 1.0, cells.collect()).unwrap()
}

/// Every length times a factor.
fn scaled(facade: &Facade, factor: f64) -> Facade {
    let mut scaled = facade.clone();
    scaled.width *= factor;
    scaled.height *= factor;
    for region in &mut scaled.regions {
        let r = region.rect;
        let [x, y, width, height] = [r.x, r.y, r.width, r.height].map(|v| v * factor);
        region.rect = Rect::new(x, y, width, height);
    }
    scaled
}

fn with(ops: &str) -> Settings {
    Settings {
        operations: ops.parse().unwrap(),
        ..Settings::default()
    }
}

/// The cost of the grammar found, and true if it is proven optimal.
fn cost(facade: &Facade, settings: &Settings) -> (f64, bool) {
    let facades = std::slice::from_ref(facade);
    let outcome = infer(facades, settings, &unwatched).unwrap();
    let cost = evaluate(&outcome.grammar, facades, &settings.costs)
        .unwrap()
        .cost;
    (cost, outcome.proves(cost))
}

#[track_caller]
fn assert_proven(found: (f64, bool), least: f64) {
    assert!((found.0 - least).abs() < 1e-6 && found.1, "{found:?}");
}

#[test]
fn a_layout_costs_the_same_in_any_unit() {
    let (hotel, settings) = (shipped("layouts/hotel_4"), Settings::default());
    let own = cost(&hotel, &settings);
    assert!((own.0 - 189.9).abs() < 1e-6, "{own:?}");
    for factor in [1.0 / 2.54, 0.3048, 1.0 / 3.0, 1e-4, 12_345.678] {
        let other = cost(&scaled(&hotel, factor), &settings);
        assert!((other.0 - own.0).abs() < 1e-6, "times {factor}: {other:?}");
        assert_eq!(other.1, own.1, "times {factor}");
    }
}

#[test]
fn three_thirds_are_one_repeat() {
    assert_proven(cost(&row("aaa", 1.0 / 3.0), &Settings::default()), 1.5);
    let thirds = [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|x| Region {
        label: "a".into(),
        rect: Rect::new(x, 0.0, 1.0 / 3.0, 1.0),
    });
    let facade = Facade::new("thirds", "m", 1.0, 1.0, thirds.to_vec()).unwrap();
    assert_proven(cost(&facade, &Settings::default()), 1.5);
}

#[test]
fn halves_that_meet_close_for_nothing() {
    let settings = with("split,repeat,sym_split");
    assert_proven(cost(&row("baaaacaa", 1.0), &settings), 6.2);
}

#[test]
fn an_alternation_may_have_one_b() {
    let settings = with("split,repeat,repeat_aba");
    assert_proven(cost(&row("aba", 1.0), &settings), 2.5);
    let (found, _) = cost(&shipped("wu2014_fig9"), &settings);
    assert!(found < 37.6 + 1e-6, "{found}");
}

#[test]
fn costs_out_of_range_are_refused() {
    for split in [1e300, 1e-9, -1.0, f64::NAN, f64::INFINITY] {
        let costs = Costs {
            split,
            ..Costs::default()
        };
        let settings = Settings {
            costs,
            ..Settings::default()
        };
        let refused = infer(&[row("ab", 1.0)], &settings, &unwatched);
        assert!(matches!(refused, Err(InferError::Cost(_))), "{split}");
    }
}

#[test]
fn no_work_proves_nothing() {
    // One iteration, so that the search has no proof of its own.
    let settings = Settings {
        iterations: 1,
        ..Settings::default()
    };
    let facade = shipped("layouts/hotel_4");
    for (root_steps, branch_steps, nodes) in [(0, 0, 0), (0, 0, 1), (0, 0, 50), (1, 0, 50)] {
        let limits = BoundLimits {
            root_steps,
            branch_steps,
            nodes,
            ..BoundLimits::default()
        };
        let bound = lower_bound(&facade, &settings, &limits, &unwatched).unwrap();
        assert!(bound.lower < 189.9 - 1e-6 && !bound.proven, "{bound:?}");
    }
}

#[test]
fn bounds_with_grids_say_why_they_are_weak() {
    let mut settings = with("split,repeat,grid_split");
    settings.iterations = 100;
    let facade = shipped("wu2014_fig9");
    let bound = lower_bound(&facade, &settings, &BoundLimits::default(), &unwatched).unwrap();
    assert_eq!(bound.weak, Some(Weakness::Grids));
    // Without grids 38.1; two by two cells cost 4.1 as a grid, 6.3 as splits.
    assert!((bound.lower - 38.1 * 4.1 / 6.3).abs() < 1e-6, "{bound:?}");
    assert!(bound.upper >= bound.lower);
    let one = Settings {
        operations: Operations::all(),
        ..settings
    };
    let bound = lower_bound(&row("abcd", 1.0), &one, &BoundLimits::default(), &unwatched).unwrap();
    assert!(bound.lower <= 4.1 && bound.upper >= 4.1 - 1e-6, "{bound:?}");
}
