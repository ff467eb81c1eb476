//! Crossings of triangles against distances of convex sets, and on cases known by hand.

use rand::RngExt;

use crate::solid::crossings::{Contact, contact, crossings};
use crate::vec3::{add, dot, norm, sub};
use edifice_base::rng::stream;

type Triangle = [[i64; 3]; 3];

/// The point of a triangle nearest to another (Ericson 2004, Sec. 5.1.5).
fn nearest(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let along = |o: [f64; 3], d: [f64; 3], t: f64| add(o, d.map(|v| v * t));
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(a, ab, d1 / (d1 - d3));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(a, ac, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return along(b, sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    add(a, add(ab.map(|v| v * vb / sum), ac.map(|v| v * vc / sum)))
}

/// Distance of two triangles by alternating projections (von Neumann).
fn distance(a: Triangle, b: Triangle) -> f64 {
    let (a, b) = [a, b].map(|t| t.map(|p| p.map(|v| v as f64))).into();
    let mut p: [f64; 3] = a[0];
    let mut last = f64::INFINITY;
    for _ in 0..20_000 {
        let q = nearest(p, b);
        p = nearest(q, a);
        let now = norm(sub(p, q));
        if now < 1e-9 || last - now < 1e-13 {
            return now;
        }
        last = now;
    }
    last
}

fn has_area([a, b, c]: Triangle) -> bool {
    let d = |p: [i64; 3]| sub(p.map(|v| v as f64), a.map(|v| v as f64));
    norm(crate::vec3::cross(d(b), d(c))) > 0.0
}

#[test]
fn triangles_without_a_common_corner_meet_if_and_only_if_their_distance_is_zero() {
    let mut rng = stream(5, "crossings", 0);
    let (mut seen, mut meet) = (0, 0);
    while seen < 6000 {
        // Small numbers, so that corners on edges and triangles in one plane are common; in a third all in one plane.
        let side = [3, 6, 40][seen % 3];
        let flat = seen % 9 < 3;
        let mut point = || {
            let p: [i64; 3] = std::array::from_fn(|_| rng.random_range(0..side));
            if flat { [p[0], p[1], p[0] + p[1]] } else { p }
        };
        let [a, b]: [Triangle; 2] = std::array::from_fn(|_| std::array::from_fn(|_| point()));
        if !has_area(a) || !has_area(b) || a.iter().any(|p| b.contains(p)) {
            continue;
        }
        seen += 1;
        let found = contact(a, b);
        let d = distance(a, b);
        assert!(
            !(1e-5..=1e-3).contains(&d),
            "no clear distance: {a:?} {b:?} {d}"
        );
        assert_eq!(found.is_some(), d < 1e-5, "{a:?} {b:?} {d}");
        meet += usize::from(found.is_some());
        // Not a matter of order, of direction, of place, or of scale.
        let [turned, moved] = [
            |t: Triangle| [t[2], t[1], t[0]],
            |t: Triangle| t.map(|p| [p[2] * 7 - 1_000_000_007, p[0] * 7, p[1] * 7]),
        ];
        assert_eq!(contact(b, a), found);
        assert_eq!(contact(turned(a), b), found);
        assert_eq!(contact(moved(a), moved(b)), found);
    }
    assert!(meet > 1000 && meet < 5000, "{meet}");
}

#[test]
fn neighbours_of_a_surface_do_not_meet_and_folds_do() {
    let [o, x, y, z] = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]];
    // An edge in common, and a corner.
    assert_eq!(contact([o, x, y], [x, o, z]), None);
    assert_eq!(contact([o, x, y], [o, [-9, 0, 0], z]), None);
    // In one plane, on either side of a common edge, and both on one side.
    assert_eq!(contact([o, x, y], [x, [9, 9, 0], y]), None);
    assert_eq!(contact([o, x, y], [y, x, [1, 1, 0]]), Some(Contact::Cross));
    assert_eq!(
        contact([o, x, y], [o, [9, 1, 0], [1, 9, 0]]),
        Some(Contact::Cross)
    );
    // A common corner, the other triangle passing through.
    assert_eq!(
        contact([o, x, y], [o, [4, 4, 4], [4, 4, -4]]),
        Some(Contact::Cross)
    );
    // A corner in the middle of an edge, and in the middle of a face.
    assert_eq!(
        contact([o, x, y], [[4, 0, 0], [4, -9, 0], [5, -9, 3]]),
        Some(Contact::Touch)
    );
    assert_eq!(
        contact([o, x, y], [[2, 2, 0], [4, 4, 9], [5, 2, 9]]),
        Some(Contact::Touch)
    );
}

/// The surface of a box, outwards.
fn cube(at: [i64; 3], size: i64) -> (Vec<[i64; 3]>, Vec<[u32; 3]>) {
    let corner = |i: i64| {
        [
            at[0] + size * (i & 1),
            at[1] + size * (i >> 1 & 1),
            at[2] + size * (i >> 2),
        ]
    };
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    ((0..8).map(corner).collect(), triangles.collect())
}

#[test]
fn boxes_cross_touch_or_are_apart() {
    let contacts = |at: [i64; 3], size: i64| {
        let (mut positions, mut triangles) = cube([0; 3], 10);
        let (more, others) = cube(at, size);
        triangles.extend(others.iter().map(|t| t.map(|v| v + 8)));
        positions.extend(more);
        crossings(&positions, &triangles).unwrap()
    };
    assert_eq!(contacts([20, 0, 0], 5), []);
    assert_eq!(contacts([3, 3, 3], 4), [], "one inside the other");
    let has = |found: &[super::super::crossings::Crossing], contact| {
        found.iter().any(|c| c.contact == contact)
    };
    assert!(has(&contacts([5, 4, 3], 10), Contact::Cross));
    // Through the diagonals of the faces only: each triangle touches.
    assert!(has(&contacts([5, 5, 5], 10), Contact::Touch));
    assert!(
        has(&contacts([10, 2, 2], 5), Contact::Cross),
        "face on face"
    );
    let edge = contacts([10, 10, 2], 5);
    assert!(has(&edge, Contact::Touch), "edge on edge");
    assert!(!has(&edge, Contact::Cross));
    assert!(crossings(&[[1 << 50, 0, 0]], &[]).is_err());
}
