//! Pictures of a few buildings by tracing rays: sun with true shadows, light of the open sky, a lawn.
//!
//! For scenes of up to some ten thousand triangles seen from near, where form matters; whole cities are drawn by
//! [`super::render`]. In three passes, so that the same scene gives the same bytes with any number of threads:
//!
//! 1. one ray through the middle of each pixel finds what is seen, whether the sun reaches it, and by six rays what
//!    it sees of the sky; these are turned by a pattern that repeats every four pixels;
//! 2. the share of open sky is averaged over four by four pixels of the same plane, which evens the pattern out;
//! 3. pixels on an edge of form, colour or shadow send further rays, which smooth it.

mod framing;
mod light;
mod tree;

pub use framing::{framing, framing_at};

use rayon::prelude::*;

use super::Scene;
use super::render::{Camera, Picture};
use crate::vectors::{V, add, cross, dot, sub, times, unit};
use light::{Seen, World, encoded};

/// Rays along each axis of a pixel on an edge.
const SAMPLES: usize = 3;
/// Half of the window that averages the open sky, in pixels.
const WINDOW: usize = 2;
/// Pixels nearer to one plane than this share of their distance are of one surface.
const PLANE: f32 = 0.004;

/// Draws a scene over level ground in `width` x `height` pixels.
pub fn trace(scene: &Scene, camera: &Camera, width: usize, height: usize) -> Picture {
    let world = World::new(scene);
    let view = View::new(camera, width, height);
    let first: Vec<Seen> = (0..width * height)
        .into_par_iter()
        .map(|i| {
            let (column, row) = (i % width, i / width);
            let turn = (column % 4 + 4 * (row % 4)) * 7 % 16;
            world.seen(view.eye, view.ray(column, row, [0.5, 0.5]), Some(turn))
        })
        .collect();
    let grid = Grid {
        seen: &first,
        width,
        height,
    };
    let open: Vec<f32> = (0..width * height)
        .into_par_iter()
        .map(|i| grid.openness(i))
        .collect();
    let rgb = (0..width * height)
        .into_par_iter()
        .flat_map_iter(|i| {
            let colour = match grid.is_edge(i) {
                false => world.light(&first[i], open[i]),
                true => smoothed(&world, &view, &grid, &open, i),
            };
            colour.map(encoded)
        })
        .collect();
    Picture { width, height, rgb }
}

/// Mean light of several rays through a pixel; what they see takes its open sky from the pixels around.
fn smoothed(world: &World, view: &View, grid: &Grid, open: &[f32], i: usize) -> V {
    let (column, row) = (i % grid.width, i / grid.width);
    let mut sum = [0.0; 3];
    for k in 0..SAMPLES * SAMPLES {
        let offset = |k: usize| (k as f32 + 0.5) / SAMPLES as f32;
        let at = [offset(k % SAMPLES), offset(k / SAMPLES)];
        let seen = world.seen(view.eye, view.ray(column, row, at), None);
        let near = grid.around(i, 1).filter(|&j| grid.seen[j].is_beside(&seen));
        let (count, total) = near.fold((0.0, 0.0), |(n, sum), j| (n + 1.0, sum + open[j]));
        let open = if count > 0.0 { total / count } else { open[i] };
        sum = add(sum, world.light(&seen, open));
    }
    times(sum, 1.0 / (SAMPLES * SAMPLES) as f32)
}

/// Rays of a camera.
struct View {
    eye: V,
    forward: V,
    right: V,
    up: V,
    scale: f32,
    half: [f32; 2],
}

impl View {
    fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let forward = unit(sub(camera.target, camera.eye));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        Self {
            eye: camera.eye,
            forward,
            right,
            up: cross(right, forward),
            scale: (camera.angle.to_radians() / 2.0).tan() / (height as f32 / 2.0),
            half: [width as f32 / 2.0, height as f32 / 2.0],
        }
    }

    /// The ray through a place of a pixel.
    fn ray(&self, column: usize, row: usize, [x, y]: [f32; 2]) -> V {
        let x = (column as f32 + x - self.half[0]) * self.scale;
        let y = (self.half[1] - row as f32 - y) * self.scale;
        unit(add(
            add(times(self.right, x), times(self.up, y)),
            self.forward,
        ))
    }
}

/// The surfaces that the pixels see, row by row.
struct Grid<'a> {
    seen: &'a [Seen],
    width: usize,
    height: usize,
}

impl Grid<'_> {
    /// Pixels at most `reach` columns and rows away.
    fn around(&self, i: usize, reach: usize) -> impl Iterator<Item = usize> + '_ {
        let (column, row) = (i % self.width, i / self.width);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.height);
        rows.flat_map(move |r| {
            let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.width);
            columns.map(move |c| r * self.width + c)
        })
    }

    /// Mean open sky over the window of four by four pixels, of those on the same plane.
    fn openness(&self, i: usize) -> f32 {
        let (column, row) = (i % self.width, i / self.width);
        let own = &self.seen[i];
        let (mut sum, mut count) = (0.0, 0.0);
        for j in self.around(i, WINDOW) {
            let (c, r) = (j % self.width, j / self.width);
            // An even window: each place of the pattern once.
            if c < column + WINDOW && r < row + WINDOW && own.is_beside(&self.seen[j]) {
                sum += self.seen[j].open;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { own.open }
    }

    /// True if a neighbour sees another plane or another colour, or differs in sunlight.
    fn is_edge(&self, i: usize) -> bool {
        let own = &self.seen[i];
        self.around(i, 1).any(|j| {
            let other = &self.seen[j];
            own.lit != other.lit || own.colour != other.colour || !own.is_beside(other)
        })
    }
}

impl Seen {
    /// True if both see one plane, or both the sky.
    fn is_beside(&self, other: &Self) -> bool {
        if self.is_sky() || other.is_sky() {
            return self.is_sky() && other.is_sky();
        }
        let apart = dot(sub(other.point, self.point), self.normal).abs();
        dot(self.normal, other.normal) > 0.999 && apart < PLANE * self.distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_one_plane_are_beside_each_other_by_their_distance() {
        let at = |x: f32, z: f32, distance: f32| Seen {
            point: [x, 0.0, z],
            normal: [0.0, 0.0, 1.0],
            colour: [0.5; 3],
            distance,
            ray: [0.0, 0.0, -1.0],
            ground: false,
            lit: true,
            open: 1.0,
        };
        for distance in [2.0, 50.0, 800.0] {
            let own = at(0.0, 0.0, distance);
            let near = PLANE * distance;
            assert!(own.is_beside(&at(3.0, 0.9 * near, distance)), "{distance}");
            assert!(!own.is_beside(&at(3.0, 1.1 * near, distance)), "{distance}");
            let mut turned = at(3.0, 0.0, distance);
            turned.normal = [1.0, 0.0, 0.0];
            assert!(!own.is_beside(&turned));
            let sky = at(0.0, 0.0, f32::INFINITY);
            assert!(!own.is_beside(&sky) && sky.is_beside(&sky));
        }
    }
}
