//! Openings in the four walls of a room: the volume that they take, and bare stretches between them.

use super::{measured, prism};
use crate::solid::exact::{Plane, units};
use crate::solid::{Finish, Opening, Panel, Wall, faces};

/// A panel set back by `depth`, its face smaller by `bevel` on each side.
fn panel(mouth: [[f64; 2]; 2], depth: f64, bevel: f64) -> Panel {
    Panel {
        mouth,
        face: mouth.map(|[a, b]| [a + bevel, b - bevel]),
        depth,
        reveal: Finish::Frame,
        finish: Finish::Pane,
        inner: Vec::new(),
    }
}

#[test]
fn openings_take_what_they_say_from_each_wall() {
    // A room from (-1, 2) to (5, 6), three metres high.
    let room = prism(
        [-1, 2, 5, 6].map(|v| v * units(1.0)),
        Plane::level(0),
        Plane::level(units(3.0)),
    );
    for (axis, at, positive, from) in [
        (0, 5.0, true, 2.0),
        (0, -1.0, false, 2.0),
        (1, 6.0, true, -1.0),
        (1, 2.0, false, -1.0),
    ] {
        let wall = Wall { axis, at, positive };
        let mut built = faces(std::slice::from_ref(&room));
        let mut window = panel([[from + 0.5, from + 1.5], [1.0, 2.2]], 0.2, 0.0);
        window
            .inner
            .push(panel([[from + 0.6, from + 0.9], [1.1, 2.1]], 0.3, 0.05));
        let taken = built
            .cut(&Opening {
                wall,
                panel: window,
            })
            .unwrap();
        // A prism of 1 by 1.2 by 0.2, and a frustum of 0.3 by 1 to 0.2 by 0.9 that is 0.1 deep (Heron's formula).
        let frustum: f64 = 0.1 / 3.0 * (0.3 + 0.18 + (0.25 * 0.95 * 4.0 - 0.3 - 0.18) / 2.0);
        assert!((taken - 0.24 - frustum).abs() < 1e-9, "{taken}, {frustum}");
        let out = panel([[from + 2.5, from + 3.5], [0.5, 1.5]], -0.1, 0.0);
        let added = built.cut(&Opening { wall, panel: out }).unwrap();
        assert!((added + 0.1).abs() < 1e-9, "{added}");
        // No room on the other, beyond the outline, or on a wall that is not there.
        for span in [
            [[from + 1.4, from + 2.0], [1.5, 1.8]],
            [[from + 3.0, from + 6.5], [2.0, 2.5]],
            [[from + 1.7, from + 2.2], [2.0, 3.0]],
            [[from + 0.2, from + 1.7], [0.5, 2.7]],
        ] {
            assert_eq!(
                built.cut(&Opening {
                    wall,
                    panel: panel(span, 0.1, 0.0)
                }),
                None,
                "{span:?}"
            );
        }
        let beside = Wall {
            at: at + 0.5,
            ..wall
        };
        assert_eq!(
            built.cut(&Opening {
                wall: beside,
                panel: panel([[from + 1.7, from + 2.2], [2.5, 2.8]], 0.1, 0.0)
            }),
            None
        );
        let back = Wall {
            positive: !positive,
            ..wall
        };
        assert_eq!(
            built.around(&back, &[[from + 1.7, from + 2.2], [2.5, 2.8]]),
            None
        );
        let band = |u: [f64; 2], z: f64| built.free_band(&wall, u, z);
        assert_eq!(band([from + 1.8, from + 2.2], 1.0), Some([0.0, 3.0]));
        assert_eq!(band([from + 0.7, from + 0.8], 0.5), Some([0.0, 1.0]));
        assert_eq!(band([from + 0.7, from + 0.8], 2.5), Some([2.2, 3.0]));
        assert_eq!(band([from + 1.0, from + 2.0], 2.5), Some([2.2, 3.0]));
        assert_eq!(band([from + 0.7, from + 0.8], 1.5), None);
        assert_eq!(band([from + 1.2, from + 1.8], 1.5), None);
        assert_eq!(band([from - 0.5, from - 0.1], 1.5), None);
        assert_eq!(band([from + 1.8, from + 2.2], 3.5), None);
        assert_eq!(
            built.free_band(&beside, [from + 1.8, from + 2.2], 1.0),
            None
        );
        let surface = built.triangulated().unwrap();
        let report = surface.check().unwrap();
        assert_eq!(report.shells, 1);
        assert!(
            (report.volume - (72.0 - taken - added)).abs() < 1e-9,
            "{}",
            report.volume
        );
        assert!((measured(&surface).0 - report.volume).abs() < 1e-9);
        // The panes are where they are cut: no corner beyond the wall but those of the part that stands out.
        let beyond = surface.positions.iter().filter(|p| {
            if positive {
                p[axis] > at + 1e-9
            } else {
                p[axis] < at - 1e-9
            }
        });
        assert_eq!(beyond.count(), 4);
    }
}

/// Below a roof that rises along the wall, a rectangle is inside where its upper left corner is, told by hand.
#[test]
fn rectangles_below_a_rising_roof_are_inside_where_their_corners_are() {
    // A wall from (0, 0) to (4, 0), two metres high on the left and six on the right.
    let roof = Plane {
        a: 1000,
        b: 0,
        c: 1000 * units(2.0),
    };
    let shed = prism([0, 0, 4, 3].map(|v| v * units(1.0)), Plane::level(0), roof);
    let built = faces(&[shed]);
    let wall = Wall {
        axis: 1,
        at: 0.0,
        positive: false,
    };
    let (mut inside, mut outside) = (0, 0);
    for i in 0..40 {
        for j in 0..60 {
            let (x, z) = (f64::from(i) * 0.1 + 0.03, f64::from(j) * 0.1 + 0.03);
            let (right, top) = (x + 0.2, z + 0.2);
            let is_inside = right < 3.99 && top < 1.99 + x;
            let found = built.around(&wall, &[[x, right], [z, top]]);
            assert_eq!(found.is_some(), is_inside, "{x} {z}");
            inside += usize::from(is_inside);
            outside += usize::from(!is_inside);
        }
    }
    assert!(inside > 500 && outside > 500, "{inside} {outside}");
}
