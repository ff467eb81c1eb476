use std::sync::Arc;

use super::*;
use edifice_shape::triangles::{Surface, Texture};

/// A rectangle on the side of `frame` that looks along +x, in metres from the lower left, `front` metres before the wall.
fn quad(frame: &OrientedBox, [l, b, r, t]: [f64; 4], front: f64, grey: u8) -> [Painted; 2] {
    let [w, d, _] = frame.size;
    let corner = |u: f64, z: f64| {
        let (sin, cos) = frame.angle.sin_cos();
        let (x, y) = (w / 2.0 + front, u - d / 2.0);
        [
            frame.base[0] + x * cos - y * sin,
            frame.base[1] + x * sin + y * cos,
            frame.base[2] + z,
        ]
    };
    let surface = Arc::new(Surface::Plain([grey; 3]));
    let [p, q, s, o] = [corner(l, b), corner(r, b), corner(r, t), corner(l, t)];
    [[p, q, s], [p, s, o]].map(|corners| Painted {
        corners,
        uv: [[0.0; 2]; 3],
        surface: surface.clone(),
    })
}

fn frame() -> OrientedBox {
    OrientedBox {
        base: [100.0, -20.0, 5.0],
        size: [8.0, 14.0, 9.0],
        angle: 0.4,
    }
}

/// Five columns and three rows of windows of 1.2 x 1.6 m, 1.3 m and 1.1 m apart, and a door.
fn facade() -> Vec<Painted> {
    let frame = frame();
    let mut paint = quad(&frame, [0.0, 0.0, 14.0, 9.0], 0.0, 200).to_vec();
    for i in 0..5 {
        for j in 0..3 {
            let (x, y) = (0.8 + 2.5 * f64::from(i), 0.9 + 2.7 * f64::from(j));
            paint.extend(quad(&frame, [x, y, x + 1.2, y + 1.6], 0.01, 40));
        }
    }
    paint.extend(quad(&frame, [12.9, 0.3, 13.8, 2.9], 0.01, 60));
    paint
}

#[test]
fn windows_of_a_known_facade_are_measured() {
    let found = window_features(&facade(), &frame()).unwrap();
    let known = [1.2, 1.6, 1.3, 1.1, 0.0, 200.0 / 255.0];
    for (k, (f, t)) in found.iter().zip(known).enumerate() {
        let most = if k < 4 { 0.11 } else { 0.02 };
        assert!((f - t).abs() <= most, "{k}: {found:?}");
    }
}

#[test]
fn a_side_that_looks_away_or_is_not_painted_says_nothing() {
    assert_eq!(window_features(&[], &frame()), None);
    let mut turned = facade();
    turned.iter_mut().for_each(|p| p.corners.swap(0, 1));
    assert_eq!(window_features(&turned, &frame()), None);
    // One grey: nothing to tell apart.
    let plain = quad(&frame(), [0.0, 0.0, 14.0, 9.0], 0.0, 90);
    assert_eq!(window_features(&plain, &frame()), None);
    // Triangles without an area, or far away.
    let mut odd = facade();
    odd.push(Painted {
        corners: [[1e300; 3]; 3],
        uv: [[0.0; 2]; 3],
        surface: Arc::new(Surface::Plain([1; 3])),
    });
    assert_eq!(
        window_features(&odd, &frame()),
        window_features(&facade(), &frame())
    );
}

#[test]
fn a_texture_is_the_same_as_painting() {
    // The facade as a picture of 0.1 m a texel.
    let frame = frame();
    let picture = Picture::of(&facade(), &frame, 0).unwrap();
    let rows = picture.greys.chunks(picture.width).rev();
    let texture = Texture {
        name: "facade".into(),
        width: picture.width,
        colours: rows.flatten().map(|g| [g.unwrap_or(0); 3]).collect(),
        file: Arc::new([1]),
    };
    let surface = Arc::new(Surface::Texture(texture));
    let mut wall = quad(&frame, [0.0, 0.0, 14.0, 9.0], 0.0, 0);
    wall[0].uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    wall[1].uv = [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    wall.iter_mut().for_each(|p| p.surface = surface.clone());
    let (a, b) = (
        window_features(&facade(), &frame).unwrap(),
        window_features(&wall, &frame).unwrap(),
    );
    for k in 0..6 {
        assert!((a[k] - b[k]).abs() < 0.02, "{a:?} {b:?}");
    }
    let texels: f64 = wall.iter().map(Painted::texels).sum();
    assert!((texels - picture.greys.len() as f64).abs() < 1e-6);
}

#[test]
fn otsu_separates_two_greys() {
    let mut counts = [0; 256];
    assert_eq!(otsu(&counts), None);
    counts[30] = 10;
    assert_eq!(otsu(&counts), None);
    counts[200] = 90;
    let threshold = otsu(&counts).unwrap();
    assert!(threshold > 30 && threshold <= 200);
}

#[test]
fn the_most_frequent_distance_is_taken() {
    assert_eq!(usual_distance(vec![], 1.0), None);
    assert_eq!(usual_distance(vec![3, 3, 13, 23, 40], 1.0), Some(10));
    assert_eq!(usual_distance(vec![0, 5, 12], 1.0), Some(5));
}
