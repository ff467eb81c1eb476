//! Bays under eaves: what stands out of a wall meets no roof.

use edifice::methods::building_exteriors::house::model::expected_volume;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::shape::{
    BoxStyle, Building, ElementStyle, FacadeElement, FacadePiece, MassBox, Ridge, Roof, RoofStyle,
    Side,
};

/// A house of one storey with a window of a style in its front, that ends `below` metres under the eaves.
fn house(style: ElementStyle, below: f64) -> Building {
    let window = FacadeElement {
        style,
        x: 3.0,
        y: 2.9 - below - 1.4,
        width: 2.0,
        height: 1.4,
    };
    Building {
        name: "h".into(),
        unit: "m".into(),
        floor_height: 2.9,
        boxes: vec![MassBox {
            style: BoxStyle::Main,
            x: 5.0,
            y: 4.0,
            width: 10.0,
            depth: 8.0,
            height: 2.9,
            roof: Roof {
                style: RoofStyle::Gable,
                pitch: 40.0,
                ridge: Ridge::X,
            },
        }],
        facades: vec![FacadePiece {
            side: Side::Front,
            start: 0.0,
            base: 0.0,
            width: 10.0,
            height: 2.9,
            elements: vec![window],
        }],
        special: Vec::new(),
        unobserved: Vec::new(),
    }
}

/// The volume that stands out of the walls of a house, negative where more is set back; `None` without room for the window.
fn outside(house: &Building) -> Option<f64> {
    let made = model(house, Joining::Boxes).unwrap();
    made.unplaced.is_empty().then_some(-made.openings)
}

#[test]
fn a_bay_that_would_reach_into_the_eaves_is_a_plain_window() {
    // Far below the eaves it stands out; as high as the wall has room for a window it does not, and is still there.
    assert!(outside(&house(ElementStyle::Bay, 1.0)).unwrap() > 0.3);
    let heights = (0..40).map(|k| 0.02 * f64::from(k));
    let placed = heights.filter_map(|z| Some((z, outside(&house(ElementStyle::Fixed, z))?)));
    let (below, plain) = placed.into_iter().next().unwrap();
    assert_eq!(outside(&house(ElementStyle::Bay, below)), Some(plain));
    let far = outside(&house(ElementStyle::Fixed, 1.0)).unwrap();
    assert!(outside(&house(ElementStyle::Bay, 1.0)).unwrap() > far + 0.3);
}

/// Coordinates that are no whole tenths of millimetres, as annealing gives them.
#[test]
fn walls_between_whole_units_hold_their_windows() {
    for shift in [0.000_033, 0.000_047, 0.012_345_6] {
        let mut house = house(ElementStyle::Fixed, 0.6);
        for b in &mut house.boxes {
            (b.x, b.y) = (b.x + shift, b.y + shift);
        }
        let piece = &mut house.facades[0];
        piece.start += shift;
        let windows = (0..4).map(|k| FacadeElement {
            x: 0.6 + 2.3 * f64::from(k),
            ..piece.elements[0]
        });
        piece.elements = windows.collect();
        let made = model(&house, Joining::Boxes).unwrap();
        assert!(made.unplaced.is_empty());
        let expected = expected_volume(&house, Joining::Boxes, made.openings);
        let off = (made.report.volume - expected).abs() / expected;
        assert!(off < 1e-9, "{shift}: {off:e}");
    }
}
