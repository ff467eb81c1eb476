use super::{FootprintError, rectangles};
use edifice_shape::PlanUnion;
use serde_json::json;

const L: [[f64; 2]; 7] = [
    [0.0, 0.0],
    [14.0, 0.0],
    [14.0, 6.0],
    [9.0, 6.0],
    [9.0, 11.0],
    [0.0, 11.0],
    [0.0, 0.0],
];

fn polygon(ring: &[[f64; 2]]) -> serde_json::Value {
    json!({ "type": "Polygon", "coordinates": [ring] })
}

#[test]
fn turned_shifted_and_in_degrees_it_is_the_same_plan() {
    let area = |ring: &[[f64; 2]]| {
        PlanUnion::new(&rectangles(&polygon(ring)).expect("a footprint")).area()
    };
    let expected = 14.0 * 6.0 + 9.0 * 5.0;
    assert!((area(&L) - expected).abs() < 1e-9);
    let (sin, cos) = 0.3_f64.sin_cos();
    let turned = L.map(|[x, y]| [1e3 + x * cos - y * sin, x * sin + y * cos]);
    assert!((area(&turned) - expected).abs() < 0.05);
    let across = 111_195.0 * 52.0_f64.to_radians().cos();
    let degrees = L.map(|[x, y]| [4.3 + x / across, 52.0 + y / 111_195.0]);
    assert!((area(&degrees) - expected).abs() < 0.05);
    let mut backwards = L;
    backwards.reverse();
    assert!((area(&backwards) - expected).abs() < 1e-9);
}

#[test]
fn what_is_no_footprint_is_named() {
    let refused = |ring: &[[f64; 2]]| rectangles(&polygon(ring)).unwrap_err();
    let crossing = [
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 9.0],
        [4.0, 9.0],
        [4.0, -5.0],
        [0.0, -5.0],
    ];
    assert!(matches!(
        refused(&crossing),
        FootprintError::Crossing { .. }
    ));
    let roof = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [4.5, 13.0], [0.0, 9.0]];
    assert!(matches!(refused(&roof), FootprintError::Angle { .. }));
    let thin = [
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 9.0],
        [8.7, 9.0],
        [8.7, 5.0],
        [0.0, 5.0],
    ];
    assert_eq!(refused(&thin), FootprintError::Unsound);
    let small = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    assert!(matches!(refused(&small), FootprintError::Size { .. }));
    assert!(matches!(
        refused(&L[..2]),
        FootprintError::Corners { corners: 2 }
    ));
    let hole = json!({ "type": "Polygon", "coordinates": [L, L] });
    assert_eq!(rectangles(&hole), Err(FootprintError::Holes(1)));
    let point =
        json!({ "type": "Feature", "geometry": { "type": "Point", "coordinates": [0, 0] } });
    assert!(matches!(rectangles(&point), Err(FootprintError::Kind(_))));
    let text = json!({ "type": "Polygon", "coordinates": [[["a", 0]]] });
    assert_eq!(
        rectangles(&text),
        Err(FootprintError::Position { index: 0 })
    );
}
