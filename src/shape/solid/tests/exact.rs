//! Lines, points and planes against their definitions, and faults of surfaces by name.

use rand::RngExt;

use super::cuboid;
use crate::solid::exact::{Line, Plane, Point, SLOPES, UNIT};
use crate::solid::{Surface, SurfaceError, faces};
use edifice_base::rng::stream;

#[test]
fn lines_points_and_planes_are_exact() {
    let mut rng = stream(3, "lines", 0);
    for _ in 0..2000 {
        let mut small = || -> i128 { rng.random_range(-20..=20) };
        let [a, b, c, d, e, f] = [small(), small(), small(), small(), small(), small()];
        if (a, b) == (0, 0) || (d, e) == (0, 0) {
            continue;
        }
        let (l, m) = (Line::new(a, b, c), Line::new(d, e, f));
        assert_eq!(l.undirected(), l.reversed().undirected());
        assert!(l.undirected().a > 0 || (l.undirected().a == 0 && l.undirected().b > 0));
        let [x, y, w] = [small(), small(), small().abs() + 1];
        let p = Point::new(x, y, w);
        assert_eq!(p, Point::new(-3 * x, -3 * y, -3 * w));
        assert_eq!(l.side(&p), (a * x + b * y + c * w).cmp(&0));
        assert_eq!(l.reversed().side(&p), l.side(&p).reverse());
        match l.crossing(&m) {
            None => assert_eq!(a * e, b * d),
            Some(at) => {
                assert!(l.side(&at).is_eq() && m.side(&at).is_eq());
                // Points of the line in the order of its direction (b, -a).
                let further = Point::new(at.x + b * at.w, at.y - a * at.w, at.w);
                assert!(l.along(&at, &further).is_lt() && l.along(&further, &at).is_gt());
                let thirds = Point::new(3 * at.x + b * at.w, 3 * at.y - a * at.w, 3 * at.w);
                assert!(l.along(&at, &thirds).is_lt() && l.along(&thirds, &further).is_lt());
            }
        }
        let plane = Plane::rising(a, [1, 0], [x, y], c);
        let foot = Point::new(x, y, 1);
        assert_eq!(plane.at(&foot), SLOPES * c);
        assert!((plane.metres(&foot) - c as f64 * UNIT).abs() < 1e-12);
        let ten = Point::new(x + 10 * SLOPES, y + 7, 1);
        assert_eq!(plane.raised(d).at(&ten), SLOPES * (c + d + 10 * a));
        let across = Plane::rising(b, [0, -1], [x, y], c);
        assert_eq!(across.at(&Point::new(x + 5, y - 2, 1)), SLOPES * c + 2 * b);
        if let Some(line) = plane.above(&across) {
            let (here, there) = (plane.at(&p), across.at(&p));
            assert_eq!(line.side(&p), here.cmp(&there));
        }
    }
}

#[test]
fn faults_of_surfaces_are_named() {
    let sound = faces(&[cuboid([0, 0, 0], [2, 2, 2])])
        .triangulated()
        .unwrap();
    assert!(sound.check().is_ok());
    assert_eq!(Surface::default().check(), Err(SurfaceError::Empty));
    let mut open = sound.clone();
    open.triangles.pop();
    assert!(matches!(open.check(), Err(SurfaceError::Open { .. })));
    let mut twice = sound.clone();
    twice.triangles.push(twice.triangles[0]);
    assert!(matches!(twice.check(), Err(SurfaceError::Twice { .. })));
    let mut flat = sound.clone();
    flat.triangles[3].0[1] = flat.triangles[3].0[0];
    assert_eq!(flat.check(), Err(SurfaceError::Degenerate { triangle: 3 }));
    let mut missing = sound.clone();
    missing.triangles[2].0[0] = 99;
    assert_eq!(missing.check(), Err(SurfaceError::Corner { triangle: 2 }));
    let mut far = sound;
    far.positions[0][1] = f64::NAN;
    assert!(matches!(far.check(), Err(SurfaceError::Corner { .. })));
}
