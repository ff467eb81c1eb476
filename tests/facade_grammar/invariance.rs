//! The cost of a facade grammar does not depend on units, on orientation or on the order in which regions are listed.

use std::path::Path;

use edifice::grammar::evaluate;
use edifice::io::facade_json;
use edifice::methods::facade_grammar::{Operations, Settings, infer};
use edifice::rng::{Stream, stream};
use edifice::shape::{Facade, Rect, Region};
use edifice::unwatched;
use edifice_smallest_grammar::{Content, layouts, operation_sets};
use rand::RngExt;

/// Cost of the grammar that is found, and whether it is proven optimal; infinite when it is no grammar of them.
fn inferred(facades: &[Facade], operations: Operations, iterations: u64) -> (f64, bool) {
    let settings = Settings {
        operations,
        iterations,
        ..Settings::default()
    };
    let found = infer(facades, &settings, &unwatched).unwrap();
    let cost = evaluate(&found.grammar, facades, &settings.costs).map_or(f64::INFINITY, |e| e.cost);
    let proven = found.lower_bound.is_some_and(|bound| cost <= bound + 1e-6);
    (cost, proven)
}

/// The layout with every rectangle mapped.
fn mapped(facade: &Facade, size: (f64, f64), mut map: impl FnMut(Rect) -> Rect) -> Facade {
    let regions = facade.regions.iter().map(|region| Region {
        label: region.label.clone(),
        rect: map(region.rect),
    });
    let (name, unit) = (facade.name.as_str(), facade.unit.as_str());
    Facade::new(name, unit, size.0, size.1, regions.collect()).unwrap()
}

/// Every number times `factor`: corners and sizes are rounded each on their own, as a converter of units does.
fn scaled(facade: &Facade, factor: f64) -> Facade {
    let size = (facade.width * factor, facade.height * factor);
    mapped(facade, size, |r| {
        Rect::new(
            r.x * factor,
            r.y * factor,
            r.width * factor,
            r.height * factor,
        )
    })
}

/// As [`scaled`], with sizes that are differences of corners.
fn scaled_corners(facade: &Facade, factor: f64) -> Facade {
    let size = (facade.width * factor, facade.height * factor);
    mapped(facade, size, |r| {
        let [left, right, bottom, top] =
            [r.x, r.right(), r.y, r.top()].map(|position| position * factor);
        Rect::new(left, bottom, right - left, top - bottom)
    })
}

/// Every corner off by up to `share` of the longer side, but inside the facade.
fn noisy(facade: &Facade, share: f64, rng: &mut Stream) -> Facade {
    let most = share * facade.width.max(facade.height);
    let mut off = |value: f64, end: f64| (value + rng.random_range(-most..=most)).clamp(0.0, end);
    let (width, height) = (facade.width, facade.height);
    mapped(facade, (width, height), |r| {
        let (left, right) = (off(r.x, width), off(r.right(), width));
        let (bottom, top) = (off(r.y, height), off(r.top(), height));
        Rect::new(left, bottom, right - left, top - bottom)
    })
}

/// Moved far away and back: what is left is the noise of the far coordinates.
fn moved_and_back(facade: &Facade, by: f64) -> Facade {
    mapped(facade, (facade.width, facade.height), |r| {
        Rect::new(r.x + by - by, r.y + by - by, r.width, r.height)
    })
}

/// Left and right changed.
fn mirrored_x(facade: &Facade) -> Facade {
    mapped(facade, (facade.width, facade.height), |r| {
        Rect::new(facade.width - r.right(), r.y, r.width, r.height)
    })
}

/// Top and bottom changed.
fn mirrored_y(facade: &Facade) -> Facade {
    mapped(facade, (facade.width, facade.height), |r| {
        Rect::new(r.x, facade.height - r.top(), r.width, r.height)
    })
}

/// x and y changed.
fn transposed(facade: &Facade) -> Facade {
    mapped(facade, (facade.height, facade.width), |r| {
        Rect::new(r.y, r.x, r.height, r.width)
    })
}

/// The regions in another order.
fn shuffled(facade: &Facade, rng: &mut Stream) -> Facade {
    let mut out = facade.clone();
    for i in (1..out.regions.len()).rev() {
        out.regions.swap(i, rng.random_range(0..=i));
    }
    out
}

/// Factors of units: inches, feet, yards, thirds, millimetres, ...
const FACTORS: [f64; 12] = [
    1.0 / 2.54,
    0.3048,
    0.9144,
    1.0 / 3.0,
    1.0 / 7.0,
    1e-3,
    1e6,
    1e-9,
    std::f64::consts::PI,
    std::f64::consts::SQRT_2,
    0.1,
    1.0 / 0.3048,
];

/// The same layouts in other ways, each with a name. Changes of size alone come first; their number is returned too.
fn views(facades: &[Facade], rng: &mut Stream) -> (usize, Vec<(String, Vec<Facade>)>) {
    let factor = FACTORS[rng.random_range(0..FACTORS.len())];
    let random = 10f64.powf(rng.random_range(-6.0..6.0));
    let longest = facades.iter().map(|f| f.width.max(f.height));
    let far = 1e6 / 3.0 * longest.fold(0.0, f64::max);
    type Map<'a> = Box<dyn FnMut(&Facade) -> Facade + 'a>;
    let same_order: Vec<(String, Map)> = vec![
        (format!("times {factor}"), Box::new(|f| scaled(f, factor))),
        (format!("times {random}"), Box::new(|f| scaled(f, random))),
        (
            format!("corners times {random}"),
            Box::new(|f| scaled_corners(f, random)),
        ),
        (
            "moved and back".into(),
            Box::new(|f| moved_and_back(f, far)),
        ),
        (
            "with noise".into(),
            Box::new({
                let mut rng = rng.clone();
                move |f| noisy(f, 1e-8, &mut rng)
            }),
        ),
    ];
    let turned: Vec<(String, Map)> = vec![
        ("mirrored along x".into(), Box::new(mirrored_x)),
        ("mirrored along y".into(), Box::new(mirrored_y)),
        ("transposed".into(), Box::new(transposed)),
        ("shuffled".into(), Box::new(|f| shuffled(f, rng))),
        (
            format!("times {factor}, turned"),
            Box::new(|f| transposed(&mirrored_x(&scaled(f, factor)))),
        ),
    ];
    let count = same_order.len();
    let all = same_order.into_iter().chain(turned);
    let views = all.map(|(name, map)| (name, facades.iter().map(map).collect()));
    (count, views.collect())
}

/// The differences in the cost or the proof of the other views, in words.
fn differences(
    facades: &[Facade],
    operations: Operations,
    iterations: u64,
    rng: &mut Stream,
) -> Vec<String> {
    let (cost, proven) = inferred(facades, operations, iterations);
    let (same_order, views) = views(facades, rng);
    let mut faults = Vec::new();
    for (i, (name, view)) in views.into_iter().enumerate() {
        // Where nothing is proven, a search that meets types in another order may end elsewhere.
        if i >= same_order && !proven {
            continue;
        }
        let (other, other_proven) = inferred(&view, operations, iterations);
        if (other - cost).abs() > 1e-6 || other_proven != proven {
            faults.push(format!(
                "{name}: {other} (proven: {other_proven}) instead of {cost} (proven: {proven})"
            ));
        }
    }
    faults
}

#[test]
fn random_layouts_cost_the_same_in_every_view() {
    let sets: Vec<Operations> = operation_sets().collect();
    let mut faults = Vec::new();
    for index in 0..160 {
        let rng = &mut stream(3, "invariance", index);
        let operations = sets[index as usize % sets.len()];
        let contents = layouts::random_layouts(rng, 1 + (index as usize / 16) % 3, 2, 14);
        let facades: Vec<Facade> = contents.iter().map(|c| c.facade("tiny")).collect();
        for fault in differences(&facades, operations, 200, rng) {
            let text: Vec<String> = contents.iter().map(Content::to_string).collect();
            faults.push(format!(
                "{index} {operations}, {}: {fault}",
                text.join("; ")
            ));
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

#[test]
fn shipped_layouts_cost_the_same_in_every_view() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let mut faults = Vec::new();
    for name in ["shophouse_1", "terrace_d", "cottage_2"] {
        let facade = facade_json::read(&folder.join(format!("{name}.facade.json"))).unwrap();
        let rng = &mut stream(4, name, 0);
        for fault in differences(&[facade], Operations::default(), 10_000, rng) {
            faults.push(format!("{name}: {fault}"));
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

#[test]
fn centimetres_and_inches_of_a_hotel_cost_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let facade = facade_json::read(&folder.join("hotel_4.facade.json")).unwrap();
    let (cost, _) = inferred(
        &[scaled(&facade, 1.0 / 2.54)],
        Operations::default(),
        10_000,
    );
    assert!((cost - 189.9).abs() < 1e-6, "{cost}");
}

#[test]
fn three_equal_thirds_are_one_repeat() {
    let row = Content::row("aaa").facade("thirds");
    for factor in FACTORS.into_iter().flat_map(|f| [f, f / 3.0]) {
        let found = inferred(&[scaled(&row, factor)], Operations::default(), 100);
        assert_eq!(found, (1.5, true), "times {factor}");
    }
}
