//! Cameras that show a whole scene.

use super::super::Scene;
use super::super::render::Camera;
use crate::vectors::{V, add, cross, dot, sub, times, unit};

/// Vertical angle of view in degrees.
const ANGLE: f32 = 30.0;
/// Share of the picture's half that the scene may fill.
const FILL: f32 = 0.92;

/// A camera that looks along a direction and stands so far back that all of a scene is seen in a picture of given
/// width over height.
pub fn framing(scene: &Scene, direction: [f32; 3], aspect: f32) -> Camera {
    framing_at(std::slice::from_ref(scene), direction, aspect, ANGLE)
}

/// As [`framing`], for several scenes seen from one place, with a vertical angle of view in degrees.
pub fn framing_at(scenes: &[Scene], direction: [f32; 3], aspect: f32, angle: f32) -> Camera {
    let mut corners: Vec<V> = Vec::new();
    for scene in scenes {
        for group in &scene.groups {
            for instance in &group.instances {
                let mesh = &scene.meshes[instance.mesh];
                corners.extend(
                    mesh.positions
                        .iter()
                        .map(|p| group.place(instance.place(*p))),
                );
            }
        }
    }
    let forward = unit(direction);
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let up = cross(right, forward);
    let extent = |axis: V| {
        let along = corners.iter().map(|p| dot(*p, axis));
        let (low, high) = along.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        if low <= high { (low, high) } else { (0.0, 1.0) }
    };
    let slope = (angle.to_radians() / 2.0).tan();
    let middle = |(low, high): (f32, f32)| (low + high) / 2.0;
    let (mut x, mut y) = (middle(extent(right)), middle(extent(up)));
    let mut back = 0.0;
    // The near parts look larger: a few rounds put the middle of what is seen into the middle of the picture.
    for _ in 0..4 {
        let axis_point = add(times(right, x), times(up, y));
        let least = |p: &V| {
            let p = sub(*p, axis_point);
            let across = dot(p, right).abs() / (slope * aspect * FILL);
            let height = dot(p, up).abs() / (slope * FILL);
            across.max(height) - dot(p, forward)
        };
        back = corners.iter().map(least).fold(f32::NEG_INFINITY, f32::max);
        if !back.is_finite() {
            back = 1.0;
        }
        let seen = |axis: V, centre: f32| {
            let each = corners
                .iter()
                .map(|p| (dot(*p, axis) - centre) / (dot(*p, forward) + back).max(0.1));
            let (low, high) = each.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            if low <= high { (low + high) / 2.0 } else { 0.0 }
        };
        x += seen(right, x) * back;
        y += seen(up, y) * back;
    }
    let target = add(times(right, x), times(up, y));
    Camera {
        eye: sub(target, times(forward, back)),
        target,
        angle,
    }
}
