//! Pictures of a few buildings by tracing rays: sun with true shadows, light of the open sky, a lawn.
//!
//! For scenes of up to some ten thousand triangles seen from near, where form matters; whole cities are drawn by
//! [`super::render`]. Every pixel sends four rays; each hit asks for the sun and for a few directions of the
//! sky, spread by a fixed sequence, so that the same scene gives the same bytes.

mod framing;
mod tree;

pub use framing::framing;

use rayon::prelude::*;

use super::Scene;
use super::render::{Camera, Picture};
use tree::{Hit, Tree};

type V = [f32; 3];

/// Direction towards the sun.
const SUN: V = [-0.46, 0.68, 0.57];
const SUNLIGHT: V = [2.3, 2.1, 1.8];
const SKYLIGHT: V = [0.62, 0.72, 0.9];
/// Rays along each axis of a pixel, and towards the sky at each hit.
const SAMPLES: usize = 2;
const SKY_RAYS: usize = 6;
/// How far light of the sky is blocked (m).
const REACH: f32 = 8.0;
/// Colour of the ground, linear.
const LAWN: V = [0.16, 0.21, 0.1];

/// Draws a scene over level ground in `width` x `height` pixels.
pub fn trace(scene: &Scene, camera: &Camera, width: usize, height: usize) -> Picture {
    let (tree, colours) = triangles(scene);
    let forward = unit(sub(camera.target, camera.eye));
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let up = cross(right, forward);
    let scale = (camera.angle.to_radians() / 2.0).tan() / (height as f32 / 2.0);
    let pixel = |column: usize, row: usize| -> [u8; 3] {
        let mut sum = [0.0; 3];
        for k in 0..SAMPLES * SAMPLES {
            let offset = |i: usize| (i as f32 + 0.5) / SAMPLES as f32;
            let x = (column as f32 + offset(k % SAMPLES) - width as f32 / 2.0) * scale;
            let y = (height as f32 / 2.0 - row as f32 - offset(k / SAMPLES)) * scale;
            let ray = unit(add(add(times(right, x), times(up, y)), forward));
            let turn = (column * 7 + row * 13 + k * 5) as f32 * 0.618_034;
            sum = add(sum, light(&tree, &colours, camera.eye, ray, turn.fract()));
        }
        sum.map(|v| encoded(v / (SAMPLES * SAMPLES) as f32))
    };
    let rgb = (0..height)
        .into_par_iter()
        .flat_map_iter(|row| (0..width).flat_map(move |column| pixel(column, row)))
        .collect();
    Picture { width, height, rgb }
}

/// Triangles in the world and their colours.
fn triangles(scene: &Scene) -> (Tree, Vec<V>) {
    let mut corners = Vec::new();
    let mut colours = Vec::new();
    for group in &scene.groups {
        for instance in &group.instances {
            let mesh = &scene.meshes[instance.mesh];
            let place = |p: &V| group.place(instance.place(*p));
            let placed: Vec<V> = mesh.positions.iter().map(place).collect();
            for (material, indices) in &mesh.parts {
                let colour = scene.materials[*material].color.map(linear);
                for t in indices.chunks_exact(3) {
                    corners.push([0, 1, 2].map(|i| placed[t[i] as usize]));
                    colours.push(colour);
                }
            }
        }
    }
    (Tree::new(corners), colours)
}

/// Light that comes along a ray to its start.
fn light(tree: &Tree, colours: &[V], from: V, ray: V, turn: f32) -> V {
    let hit = tree.nearest(from, ray, f32::INFINITY);
    let ground = (ray[1] < -1e-4).then(|| -from[1] / ray[1]);
    let ground = ground.filter(|t| hit.as_ref().is_none_or(|h| *t < h.distance));
    let (point, normal, colour) = match (ground, hit) {
        (Some(t), _) => (add(from, times(ray, t)), [0.0, 1.0, 0.0], LAWN),
        (None, Some(Hit { distance, triangle })) => {
            let normal = tree.normal(triangle);
            (add(from, times(ray, distance)), normal, colours[triangle])
        }
        (None, None) => return sky(ray),
    };
    let start = add(point, times(normal, 2e-3));
    let sun = unit(SUN);
    let facing = dot(normal, sun).max(0.0);
    let lit = facing > 0.0 && tree.nearest(start, sun, 1e4).is_none();
    let direct = if lit { facing } else { 0.0 };
    let open = openness(tree, start, normal, turn);
    let bounce = 0.25 * (0.5 - 0.5 * normal[1]) * open;
    let shade = |i: usize| {
        let sky = SKYLIGHT[i] * open * (0.65 + 0.35 * normal[1]);
        colour[i] * (SUNLIGHT[i] * direct + sky + bounce)
    };
    let seen = [shade(0), shade(1), shade(2)];
    // The ground fades into the horizon.
    let far = ground.map_or(0.0, |t| 1.0 - (-t / 900.0).exp());
    let haze = sky([ray[0], 0.02, ray[2]]);
    [0, 1, 2].map(|i| seen[i] * (1.0 - far) + haze[i] * far)
}

/// Share of the sky that a point sees, from cosine-weighted directions.
fn openness(tree: &Tree, point: V, normal: V, turn: f32) -> f32 {
    let side = if normal[1].abs() < 0.9 {
        [0.0, 1.0, 0.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let across = unit(cross(side, normal));
    let along = cross(normal, across);
    let mut open = 0.0;
    for k in 0..SKY_RAYS {
        let u = (k as f32 + 0.5) / SKY_RAYS as f32;
        let angle = (k as f32 * 0.618_034 + turn).fract() * std::f32::consts::TAU;
        let (sin, cos) = angle.sin_cos();
        let radius = u.sqrt();
        let flat = add(times(across, radius * cos), times(along, radius * sin));
        let ray = add(flat, times(normal, (1.0 - u).sqrt()));
        let blocked = tree.nearest(point, ray, REACH);
        open += blocked.map_or(1.0, |h| (h.distance / REACH).min(1.0).powf(0.7));
    }
    open / SKY_RAYS as f32
}

fn sky(ray: V) -> V {
    let t = ray[1].clamp(0.0, 1.0).sqrt();
    let (low, high) = ([0.86, 0.9, 0.94], [0.34, 0.52, 0.8]);
    [0, 1, 2].map(|i| low[i] * (1.0 - t) + high[i] * t)
}

fn linear(c: u8) -> f32 {
    (f32::from(c) / 255.0).powf(2.2)
}

fn encoded(v: f32) -> u8 {
    let mapped = v * (1.0 + v / 6.0) / (1.0 + 0.55 * v);
    (mapped.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8
}

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times(a: V, s: f32) -> V {
    a.map(|v| v * s)
}

fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: V) -> V {
    times(a, 1.0 / dot(a, a).sqrt().max(1e-20))
}
