//! The nearest surface on a ray, and the light that comes back along it.

use super::tree::Tree;
use crate::Scene;
use crate::vectors::{V, add, cross, dot, times, unit};

/// Direction towards the sun.
const SUN: V = [-0.46, 0.68, 0.57];
const SUNLIGHT: V = [2.3, 2.1, 1.8];
const SKYLIGHT: V = [0.62, 0.72, 0.9];
/// Rays towards the sky.
const SKY_RAYS: usize = 6;
/// Distance within which the light of the sky is blocked, in metres.
const REACH: f32 = 8.0;
/// Colour of the ground, linear.
const LAWN: V = [0.16, 0.21, 0.1];

/// Triangles with their colours.
pub(super) struct World {
    tree: Tree,
    colours: Vec<V>,
}

/// The first surface that a ray meets, or the sky.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    pub point: V,
    pub normal: V,
    pub colour: V,
    /// Distance along the ray; infinite for the sky.
    pub distance: f32,
    pub ray: V,
    pub ground: bool,
    pub lit: bool,
    /// Share of the sky that it sees, when asked for.
    pub open: f32,
}

impl Seen {
    pub(super) fn is_sky(&self) -> bool {
        self.distance.is_infinite()
    }
}

impl World {
    /// The triangles of a scene in their places.
    pub(super) fn new(scene: &Scene) -> Self {
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
        Self {
            tree: Tree::new(corners),
            colours,
        }
    }

    /// The first surface that a ray meets; with a turn of 0 to 15 also the share of open sky, from directions turned by
    /// it.
    pub(super) fn seen(&self, from: V, ray: V, turn: Option<usize>) -> Seen {
        let hit = self.tree.nearest(from, ray);
        let ground = (ray[1] < -1e-4).then(|| -from[1] / ray[1]);
        let ground = ground.filter(|t| hit.as_ref().is_none_or(|h| *t < h.distance));
        let (distance, normal, colour) = match (ground, &hit) {
            (Some(t), _) => (t, [0.0, 1.0, 0.0], LAWN),
            (None, Some(hit)) => {
                let normal = self.tree.normal(hit.triangle);
                (hit.distance, normal, self.colours[hit.triangle])
            }
            (None, None) => (f32::INFINITY, [0.0; 3], [0.0; 3]),
        };
        let mut seen = Seen {
            point: [0.0; 3],
            normal,
            colour,
            distance,
            ray,
            ground: ground.is_some(),
            lit: false,
            open: 1.0,
        };
        if !seen.is_sky() {
            seen.point = add(from, times(ray, distance));
            let start = add(seen.point, times(normal, 2e-3));
            seen.lit = dot(normal, unit(SUN)) > 0.0 && !self.tree.blocks(start, unit(SUN));
            seen.open = turn.map_or(1.0, |turn| self.openness(start, normal, turn));
        }
        seen
    }

    /// Share of the sky that a point sees, from cosine-weighted directions.
    fn openness(&self, point: V, normal: V, turn: usize) -> f32 {
        let side = if normal[1].abs() < 0.9 {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let across = unit(cross(side, normal));
        let along = cross(normal, across);
        let shift = turn as f32 / 16.0;
        let mut open = 0.0;
        for k in 0..SKY_RAYS {
            let u = (k as f32 + shift) / SKY_RAYS as f32;
            let angle = (k as f32 * 0.618_034 + shift).fract() * std::f32::consts::TAU;
            let (sin, cos) = angle.sin_cos();
            let radius = u.sqrt();
            let flat = add(times(across, radius * cos), times(along, radius * sin));
            let ray = add(flat, times(normal, (1.0 - u).sqrt()));
            let blocked = self.tree.nearest_within(point, ray, REACH);
            open += blocked.map_or(1.0, |h| (h.distance / REACH).min(1.0).powf(0.7));
        }
        open / SKY_RAYS as f32
    }

    /// Light that comes back along the ray.
    pub(super) fn light(&self, seen: &Seen, open: f32) -> V {
        if seen.is_sky() {
            return sky(seen.ray);
        }
        let direct = match seen.lit {
            true => dot(seen.normal, unit(SUN)),
            false => 0.0,
        };
        let up = seen.normal[1];
        let bounce = 0.25 * (0.5 - 0.5 * up) * open;
        let shade = |i: usize| {
            let sky = SKYLIGHT[i] * open * (0.65 + 0.35 * up);
            seen.colour[i] * (SUNLIGHT[i] * direct + sky + bounce)
        };
        let colour = [shade(0), shade(1), shade(2)];
        // The ground fades into the horizon.
        let far = match seen.ground {
            true => 1.0 - (-seen.distance / 900.0).exp(),
            false => 0.0,
        };
        let haze = sky([seen.ray[0], 0.02, seen.ray[2]]);
        [0, 1, 2].map(|i| colour[i] * (1.0 - far) + haze[i] * far)
    }
}

fn sky(ray: V) -> V {
    let t = ray[1].clamp(0.0, 1.0).sqrt();
    let (low, high) = ([0.86, 0.9, 0.94], [0.34, 0.52, 0.8]);
    [0, 1, 2].map(|i| low[i] * (1.0 - t) + high[i] * t)
}

fn linear(c: u8) -> f32 {
    (f32::from(c) / 255.0).powf(2.2)
}

/// Linear light as a byte of sRGB.
pub(super) fn encoded(v: f32) -> u8 {
    let mapped = v * (1.0 + v / 6.0) / (1.0 + 0.55 * v);
    (mapped.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8
}
