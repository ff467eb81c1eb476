//! The 49 attributes: a house measured by hand, and laws of unions.

use edifice::methods::building_exteriors::attributes::{AttributeError, COLUMNS, attributes};
use edifice::shape::{
    BoxStyle, Building, ElementStyle, FacadeElement, FacadePiece, MassBox, PlanUnion, Rect, Ridge,
    Roof, RoofStyle, Side, Special,
};
use proptest::prelude::*;

fn mass_box(style: BoxStyle, left: f64, front: f64, w: f64, d: f64, h: f64) -> MassBox {
    MassBox {
        style,
        x: left + w / 2.0,
        y: front + d / 2.0,
        width: w,
        depth: d,
        height: h,
        roof: Roof {
            style: RoofStyle::Gable,
            pitch: 30.0,
            ridge: Ridge::X,
        },
    }
}

fn window(x: f64, y: f64, width: f64, height: f64) -> FacadeElement {
    FacadeElement {
        style: ElementStyle::Sash,
        x,
        y,
        width,
        height,
    }
}

fn piece(
    side: Side,
    start: f64,
    base: f64,
    width: f64,
    elements: Vec<FacadeElement>,
) -> FacadePiece {
    FacadePiece {
        side,
        start,
        base,
        width,
        height: 3.0,
        elements,
    }
}

/// Main body 10 x 8 on two floors behind a garage 4 x 6 that stands 2 in front of it, and a front
/// porch 3 x 2 at the right corner.
fn house() -> Building {
    let boxes = vec![
        mass_box(BoxStyle::Main, 0.0, 2.0, 10.0, 8.0, 6.0),
        mass_box(BoxStyle::Garage, 0.0, 0.0, 4.0, 6.0, 2.8),
        mass_box(BoxStyle::Porch, 7.0, 0.0, 3.0, 2.0, 2.5),
    ];
    let facades = vec![
        piece(
            Side::Front,
            0.0,
            0.0,
            10.0,
            vec![window(1.0, 1.0, 2.0, 1.5), window(7.0, 1.0, 2.0, 1.5)],
        ),
        piece(
            Side::Front,
            0.0,
            3.0,
            10.0,
            vec![window(1.0, 1.0, 2.0, 1.5), window(4.0, 1.0, 1.0, 1.5)],
        ),
        piece(Side::Left, 0.0, 0.0, 8.0, vec![]),
    ];
    Building::new("hand", "m", 3.0, boxes, facades, vec![Special::Tower]).unwrap()
}

fn value(row: &[Option<f64>], name: &str) -> Option<f64> {
    row[COLUMNS.iter().position(|c| *c == name).unwrap()]
}

#[test]
fn a_house_measured_by_hand() {
    let row = attributes(&house()).unwrap();
    assert_eq!(row.len(), 49);
    // Ground floor: 80 + 8 in front of the garage + 6 of the porch; the front silhouette has one
    // recess 2 deep between garage and porch.
    let expected = [
        ("bbox.w", 10.0),
        ("bbox.d", 10.0),
        ("bbox.h", 6.0),
        ("bcr", 0.94),
        ("bdry", 44.0 / 94.0_f64.sqrt()),
        ("far", 1.74),
        ("arf.0", 94.0 / 174.0),
        ("arf.1", 80.0 / 174.0),
        ("arf.2", 0.0),
        ("garage.x", 0.2),
        ("garage.y", 0.3),
        ("garage.w", 4.0),
        ("garage.d", 6.0),
        ("garage.h", 2.8),
        // Front 4, left 6 (the left wall of main and garage is one), right 2.
        ("garage.visible", (4.0 + 2.0 + 6.0) / 20.0),
        ("porch.front.x", 0.85),
        ("porch.front.visible", 7.0 / 10.0),
        ("porch.back.w", 0.0),
        ("wwr.front", (6.0 + 4.5) / 60.0),
        ("wwr.left", 0.0),
        ("symmetry.front", 0.5),
        ("symmetry.left", 1.0),
        // The window at 4 stands over none.
        ("alignment.front", 0.0),
        ("roof.flat", 0.0),
        ("roof.gable", 1.0),
        ("window.sash", 1.0),
        ("special.chimney", 0.0),
        ("special.tower", 1.0),
    ];
    for (name, expected) in expected {
        let found = value(&row, name).unwrap();
        assert!(
            (found - expected).abs() < 1e-12,
            "{name}: {found}, not {expected}"
        );
    }
    for name in ["wwr.back", "symmetry.right", "alignment.back"] {
        assert_eq!(value(&row, name), None, "{name} was not observed");
    }
}

#[test]
fn windows_over_windows_are_aligned() {
    let mut house = house();
    house.facades[1].elements.truncate(1);
    assert_eq!(
        value(&attributes(&house).unwrap(), "alignment.front"),
        Some(1.0)
    );
}

#[test]
fn a_courtyard_counts_for_the_perimeter_and_is_not_seen() {
    let ring = [
        mass_box(BoxStyle::Main, 0.0, 0.0, 9.0, 3.0, 3.0),
        mass_box(BoxStyle::Main, 0.0, 6.0, 9.0, 3.0, 3.0),
        mass_box(BoxStyle::Main, 0.0, 0.0, 3.0, 9.0, 3.0),
        mass_box(BoxStyle::Garage, 6.0, 0.0, 3.0, 9.0, 3.0),
    ];
    let house = Building::new("ring", "m", 3.0, ring.to_vec(), vec![], vec![]).unwrap();
    let row = attributes(&house).unwrap();
    assert_eq!(value(&row, "bdry"), Some((36.0 + 12.0) / 72.0_f64.sqrt()));
    // Right 9, front and back 3 each, of 24; the 3 on the courtyard are not seen.
    assert_eq!(value(&row, "garage.visible"), Some(15.0 / 24.0));
}

#[test]
fn four_floors_are_refused() {
    let tower = mass_box(BoxStyle::Main, 0.0, 0.0, 5.0, 5.0, 12.0);
    let house = Building::new("tower", "m", 3.0, vec![tower], vec![], vec![]).unwrap();
    let error = attributes(&house).unwrap_err();
    assert_eq!(
        error,
        AttributeError::TooManyFloors {
            name: "tower".into(),
            floors: 4
        }
    );
}

fn boxes() -> impl Strategy<Value = Vec<MassBox>> {
    let style = prop_oneof![
        3 => Just(BoxStyle::Main),
        1 => Just(BoxStyle::Garage),
        1 => Just(BoxStyle::Porch)
    ];
    let one = (style, 0..40_i32, 0..40_i32, 1..30_i32, 1..30_i32, 1..90_i32).prop_map(
        |(style, x, y, w, d, h)| {
            // Tenths are not exact in binary: rounding must not open gaps.
            let tenth = |n: i32| f64::from(n) * 0.1;
            mass_box(style, tenth(x), tenth(y), tenth(w), tenth(d), tenth(h))
        },
    );
    proptest::collection::vec(one, 1..7)
}

fn close(a: &[Option<f64>], b: &[Option<f64>]) -> Result<(), TestCaseError> {
    for ((x, y), name) in a.iter().zip(b).zip(COLUMNS) {
        let same = match (x, y) {
            (Some(x), Some(y)) => (x - y).abs() <= 1e-9 * (1.0 + x.abs()),
            (None, None) => true,
            _ => false,
        };
        prop_assert!(same, "{name}: {x:?} and {y:?}");
    }
    Ok(())
}

fn of_boxes(boxes: Vec<MassBox>) -> Vec<Option<f64>> {
    attributes(&Building::new("p", "m", 3.0, boxes, vec![], vec![]).unwrap()).unwrap()
}

/// True if some porch centre lies so near the middle line that rounding decides its half.
fn porch_on_the_middle_line(boxes: &[MassBox]) -> bool {
    let plan: Vec<Rect> = boxes.iter().map(MassBox::plan).collect();
    let bounds = PlanUnion::new(&plan).bounding_box().unwrap();
    let middle = bounds.y + bounds.height / 2.0;
    boxes
        .iter()
        .any(|b| b.style == BoxStyle::Porch && (b.y - middle).abs() < 1e-6)
}

proptest! {
    #[test]
    fn moving_a_house_changes_nothing(boxes in boxes(), dx in -1e3..1e3_f64, dy in -1e3..1e3_f64) {
        prop_assume!(!porch_on_the_middle_line(&boxes));
        let moved = boxes.iter().map(|b| MassBox { x: b.x + dx, y: b.y + dy, ..*b }).collect();
        close(&of_boxes(boxes), &of_boxes(moved))?;
    }

    #[test]
    fn how_a_union_is_cut_into_boxes_changes_nothing(
        boxes in boxes(), which in 0..6_usize, share in 0.05..0.95_f64, across in any::<bool>(),
    ) {
        // A porch is front or back by its centre, so that only other boxes may be cut.
        let which = which % boxes.len();
        let b = boxes[which];
        prop_assume!(b.style != BoxStyle::Porch && !porch_on_the_middle_line(&boxes));
        let mut cut = boxes.clone();
        cut.remove(which);
        let p = b.plan();
        if across {
            let w = p.width * share;
            cut.push(mass_box(b.style, p.x, p.y, w, p.height, b.height));
            cut.push(mass_box(b.style, p.x + w, p.y, p.width - w, p.height, b.height));
        } else {
            let d = p.height * share;
            cut.push(mass_box(b.style, p.x, p.y, p.width, d, b.height));
            cut.push(mass_box(b.style, p.x, p.y + d, p.width, p.height - d, b.height));
            cut.push(mass_box(b.style, p.x, p.y, p.width, p.height, b.height));
        }
        close(&of_boxes(boxes), &of_boxes(cut))?;
    }

    #[test]
    fn area_and_perimeter_meet_a_counting_oracle(boxes in boxes()) {
        let plan: Vec<Rect> = boxes.iter().map(MassBox::plan).collect();
        let inside = |i: i32, j: i32| {
            let (x, y) = ((f64::from(i) + 0.5) * 0.1, (f64::from(j) + 0.5) * 0.1);
            plan.iter().any(|r| r.x < x && x < r.right() && r.y < y && y < r.top())
        };
        let (mut cells, mut sides) = (0, 0);
        for i in -1..75 {
            for j in -1..75 {
                cells += i32::from(inside(i, j));
                sides += i32::from(inside(i, j) != inside(i + 1, j));
                sides += i32::from(inside(i, j) != inside(i, j + 1));
            }
        }
        let union = PlanUnion::new(&plan);
        prop_assert!((union.area() - f64::from(cells) * 0.01).abs() < 1e-9);
        prop_assert!((union.perimeter() - f64::from(sides) * 0.1).abs() < 1e-9);
        let outline: f64 = union.outline().iter().map(|e| e.end - e.start).sum();
        prop_assert!((union.perimeter() - outline).abs() < 1e-9);
    }
}
