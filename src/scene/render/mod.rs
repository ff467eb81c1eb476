//! Pictures of scenes: a software z-buffer with a sun, its shadows, sky light and haze.
//!
//! Large meshes cast the shadow of their bounding box, enough for buildings seen from afar.

mod camera;
mod depth;

pub use camera::Camera;

use rayon::prelude::*;

use crate::vectors::{V, add, cross, dot, sub, times, unit};
use crate::{Group, Instance, Mesh, Scene};
use camera::View;
use depth::DepthBuffer;

/// Rays per pixel along each axis.
const SAMPLES: usize = 2;
/// Pixels of the shadow map along each side.
const SHADOWS: usize = 4096;
/// Direction towards the sun.
const SUN: V = [0.52, 0.62, 0.59];
/// Distance from a surface at which its shadow is looked up, in metres, so that no box shades its own content.
const OFFSET: f32 = 1.0;
/// A caster must be nearer to the sun by this, in metres.
const BIAS: f32 = 1.2;
/// Meshes of at most this many triangles cast their own shadow, larger ones that of their box.
const EXACT: usize = 80;
/// Slabs of at most this height, in metres, need no place in the shadow map.
const FLAT: f32 = 0.5;
/// Distance in metres at which haze hides two thirds, at least,
const HAZE: f32 = 5000.0;
/// and in distances from the eye to the middle of the scene: a large scene is seen from afar.
const HAZE_DISTANCES: f32 = 8.0;
/// Least distance by which a caster must be nearer to the sun, in pixels of the shadow map.
const BIAS_PIXELS: f32 = 1.5;

/// An RGB picture of 8 bits a channel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

/// Draws a scene in `width` x `height` pixels.
pub fn render(scene: &Scene, camera: &Camera, width: usize, height: usize) -> Picture {
    let (wide, high) = (width * SAMPLES, height * SAMPLES);
    let view = View::new(camera, wide, high);
    let bounds: Vec<Bounds> = scene.meshes.iter().map(Bounds::new).collect();
    let shadows = Shadows::new(scene, &bounds);
    let middle = middle_of(scene, &bounds);
    let away = sub(middle, camera.eye);
    let haze = HAZE.max(HAZE_DISTANCES * dot(away, away).sqrt());
    let colors: Vec<V> = scene
        .materials
        .iter()
        .map(|m| m.color.map(linear))
        .collect();

    let mut buffer = DepthBuffer::new(wide, high);
    let mut surfaces: Vec<(V, u32)> = vec![([0.0; 3], 0); wide * high];
    for (group, instance) in instances(scene) {
        let (center, radius) = bounds[instance.mesh].ball(group, instance);
        if view.sees(center, radius) {
            let mesh = &scene.meshes[instance.mesh];
            draw(mesh, group, instance, &view, &mut buffer, &mut surfaces);
        }
    }
    let shade = |pixel: usize| -> V {
        let (column, row) = (pixel % wide, pixel / wide);
        let depth = buffer.depths[pixel];
        let (point, ray) = view.point(column, row, depth.max(f32::MIN_POSITIVE));
        let sky = sky(ray);
        if depth == 0.0 {
            return sky;
        }
        let (normal, material) = surfaces[pixel];
        let sun =
            dot(normal, unit(SUN)).max(0.0) * shadows.light(add(point, times(normal, OFFSET)));
        let open = 0.5 + 0.5 * normal[1];
        let color = colors[material as usize];
        let light =
            |i: usize| [2.1, 1.95, 1.65][i] * sun + [0.46, 0.54, 0.68][i] * (0.45 + 0.55 * open);
        let clear = (-1.0 / depth / haze).exp();
        let lit = |i: usize| color[i] * light(i) * clear + sky[i] * (1.0 - clear);
        [lit(0), lit(1), lit(2)]
    };
    let rows = (0..height).into_par_iter().flat_map_iter(|y| {
        let shade = &shade;
        (0..width).flat_map(move |x| {
            let mut sum = [0.0; 3];
            for k in 0..SAMPLES * SAMPLES {
                let (column, row) = (x * SAMPLES + k % SAMPLES, y * SAMPLES + k / SAMPLES);
                sum = add(sum, shade(row * wide + column));
            }
            sum.map(|v| encoded(v / (SAMPLES * SAMPLES) as f32))
        })
    });
    Picture {
        width,
        height,
        rgb: rows.collect(),
    }
}

fn instances(scene: &Scene) -> impl Iterator<Item = (&Group, &Instance)> {
    let groups = scene.groups.iter();
    groups.flat_map(|group| group.instances.iter().map(move |i| (group, i)))
}

/// The middle of the box around all instances.
fn middle_of(scene: &Scene, bounds: &[Bounds]) -> V {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for (group, instance) in instances(scene) {
        let (centre, radius) = bounds[instance.mesh].ball(group, instance);
        if radius.is_finite() {
            low = [0, 1, 2].map(|k| low[k].min(centre[k]));
            high = [0, 1, 2].map(|k| high[k].max(centre[k]));
        }
    }
    match low[0] <= high[0] {
        true => times(add(low, high), 0.5),
        false => [0.0; 3],
    }
}

/// Puts the triangles that face the eye into the buffer.
fn draw(
    mesh: &Mesh,
    group: &Group,
    instance: &Instance,
    view: &View,
    buffer: &mut DepthBuffer,
    surfaces: &mut [(V, u32)],
) {
    let place = |p: &V| group.place(instance.place(*p));
    let corners: Vec<V> = mesh.positions.iter().map(place).collect();
    for (material, indices) in &mesh.parts {
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| corners[triangle[i] as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            if dot(normal, sub(view.eye(), a)) <= 0.0 {
                continue;
            }
            let surface = (unit(normal), *material as u32);
            view.project([a, b, c], |pixels| {
                buffer.triangle(pixels, |pixel| surfaces[pixel] = surface);
            });
        }
    }
}

/// The box around a mesh.
struct Bounds {
    low: V,
    high: V,
}

impl Bounds {
    fn new(mesh: &Mesh) -> Self {
        let fold = |start: f32, pick: fn(f32, f32) -> f32| {
            let join = |a: V, b: &V| [0, 1, 2].map(|i| pick(a[i], b[i]));
            mesh.positions.iter().fold([start; 3], join)
        };
        Self {
            low: fold(f32::INFINITY, f32::min),
            high: fold(f32::NEG_INFINITY, f32::max),
        }
    }

    /// Corners in the world.
    fn corners(&self, group: &Group, instance: &Instance) -> [V; 8] {
        std::array::from_fn(|k| {
            let pick = |i: usize| {
                if k >> i & 1 == 0 {
                    self.low[i]
                } else {
                    self.high[i]
                }
            };
            group.place(instance.place([pick(0), pick(1), pick(2)]))
        })
    }

    /// A ball around the instance in the world.
    fn ball(&self, group: &Group, instance: &Instance) -> (V, f32) {
        let corners = self.corners(group, instance);
        let center = times(add(corners[0], corners[7]), 0.5);
        let reach = corners.map(|c| dot(sub(c, center), sub(c, center)));
        (center, reach.into_iter().fold(0.0, f32::max).sqrt())
    }
}

/// The depths seen from the sun.
struct Shadows {
    across: V,
    along: V,
    /// Pixels per metre.
    scale: f32,
    buffer: DepthBuffer,
}

impl Shadows {
    fn new(scene: &Scene, bounds: &[Bounds]) -> Self {
        let across = unit(cross([0.0, 1.0, 0.0], SUN));
        let along = cross(unit(SUN), across);
        let far = scene
            .groups
            .iter()
            .map(|g| g.translation[0].hypot(g.translation[2]));
        let reach = far.fold(50.0, f32::max) + 60.0;
        // A group may be larger than a building; what lies flat, as open country does, casts no shadow that is seen.
        let high = |(_, i): &(&Group, &Instance)| {
            (bounds[i.mesh].high[1] - bounds[i.mesh].low[1]) * i.scale[1] > FLAT
        };
        let balls = instances(scene).filter(high).map(|(group, instance)| {
            let (centre, radius) = bounds[instance.mesh].ball(group, instance);
            centre[0].hypot(centre[2]) + radius
        });
        let reach = balls.filter(|r| r.is_finite()).fold(reach, f32::max);
        let mut shadows = Self {
            across,
            along,
            scale: SHADOWS as f32 / (2.0 * reach),
            buffer: DepthBuffer::new(SHADOWS, SHADOWS),
        };
        // Corners with an even number of ones and back, on each of the six faces.
        const FACES: [[usize; 4]; 6] = [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ];
        for (group, instance) in instances(scene) {
            let mesh = &scene.meshes[instance.mesh];
            if mesh.triangles() <= EXACT {
                let place = |p: &V| shadows.place(group.place(instance.place(*p)));
                let corners: Vec<V> = mesh.positions.iter().map(place).collect();
                for triangle in mesh.parts.iter().flat_map(|(_, i)| i.chunks_exact(3)) {
                    let corners = [0, 1, 2].map(|i| corners[triangle[i] as usize]);
                    shadows.buffer.triangle(corners, |_| ());
                }
                continue;
            }
            let corners = bounds[instance.mesh].corners(group, instance);
            let corners = corners.map(|c| shadows.place(c));
            for [a, b, c, d] in FACES {
                for [i, j, k] in [[a, b, c], [a, c, d]] {
                    shadows
                        .buffer
                        .triangle([corners[i], corners[j], corners[k]], |_| ());
                }
            }
        }
        shadows
    }

    /// Pixel and height above the light's horizon, always above zero.
    fn place(&self, p: V) -> V {
        let half = SHADOWS as f32 / 2.0;
        [
            half + dot(p, self.across) * self.scale,
            half + dot(p, self.along) * self.scale,
            dot(p, unit(SUN)) + 1e5,
        ]
    }

    /// Share of the sun that reaches a point, from four places around it.
    fn light(&self, p: V) -> f32 {
        let [x, y, height] = self.place(p);
        let bias = BIAS.max(BIAS_PIXELS / self.scale);
        let taps = [(-0.7, -0.3), (0.3, -0.7), (0.7, 0.3), (-0.3, 0.7)];
        let open = taps.iter().filter(|(dx, dy)| {
            let (x, y) = ((x + dx) as usize, (y + dy) as usize);
            let inside = x < SHADOWS && y < SHADOWS;
            !inside || self.buffer.depths[y * SHADOWS + x] <= height + bias
        });
        open.count() as f32 / 4.0
    }
}

/// Light of the sky in a direction, linear.
fn sky(ray: V) -> V {
    let t = ray[1].clamp(0.0, 1.0).sqrt();
    let (low, high) = ([0.78, 0.84, 0.9], [0.24, 0.42, 0.72]);
    [0, 1, 2].map(|i| low[i] * (1.0 - t) + high[i] * t)
}

fn linear(c: u8) -> f32 {
    (f32::from(c) / 255.0).powf(2.2)
}

/// Soft shoulder, then gamma.
fn encoded(v: f32) -> u8 {
    let mapped = v * (1.0 + v / 4.0) / (1.0 + v);
    (mapped.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8
}
