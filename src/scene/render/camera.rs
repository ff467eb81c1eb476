//! The camera that a scene is seen from.

use crate::vectors::{V, add, cross, dot, sub, times, unit};

/// Nothing nearer than this is seen, in metres.
const NEAR: f32 = 0.5;

/// A perspective view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the eye, in metres, y up.
    pub eye: [f32; 3],
    /// The point that it looks at, in metres.
    pub target: [f32; 3],
    /// Vertical angle of view in degrees.
    pub angle: f32,
}

/// A camera with its directions, for a picture of given size.
pub(super) struct View {
    eye: V,
    right: V,
    up: V,
    forward: V,
    /// Pixels per unit of slope.
    focal: f32,
    middle: [f32; 2],
}

impl View {
    pub(super) fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let forward = unit(sub(camera.target, camera.eye));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        Self {
            eye: camera.eye,
            right,
            up: cross(right, forward),
            forward,
            focal: height as f32 / 2.0 / (camera.angle.to_radians() / 2.0).tan(),
            middle: [width as f32 / 2.0, height as f32 / 2.0],
        }
    }

    /// Position of the eye, in metres.
    pub(super) fn eye(&self) -> V {
        self.eye
    }

    /// Coordinates along right, up and forward.
    fn local(&self, p: V) -> V {
        let p = sub(p, self.eye);
        [dot(p, self.right), dot(p, self.up), dot(p, self.forward)]
    }

    /// True if a part of a ball may be in the picture.
    pub(super) fn sees(&self, center: V, radius: f32) -> bool {
        let [x, y, z] = self.local(center);
        let inside = |across: f32, half: f32| {
            // Distance from the side plane of the view, outwards.
            let slope = half / self.focal;
            (across.abs() - z * slope) / (1.0 + slope * slope).sqrt() < radius
        };
        z > NEAR - radius && inside(x, self.middle[0]) && inside(y, self.middle[1])
    }

    /// The triangle in pixels with depth 1/z, cut at the near plane: none, one or two triangles.
    pub(super) fn project(&self, corners: [V; 3], mut each: impl FnMut([[f32; 3]; 3])) {
        let local = corners.map(|p| self.local(p));
        let mut kept = [[0.0; 3]; 4];
        let mut count = 0;
        for i in 0..3 {
            let (a, b) = (local[i], local[(i + 1) % 3]);
            if a[2] >= NEAR {
                kept[count] = a;
                count += 1;
            }
            if (a[2] >= NEAR) != (b[2] >= NEAR) {
                kept[count] = add(a, times(sub(b, a), (NEAR - a[2]) / (b[2] - a[2])));
                count += 1;
            }
        }
        let pixel = |[x, y, z]: V| {
            let scale = self.focal / z;
            [
                self.middle[0] + x * scale,
                self.middle[1] - y * scale,
                1.0 / z,
            ]
        };
        for i in 2..count {
            each([pixel(kept[0]), pixel(kept[i - 1]), pixel(kept[i])]);
        }
    }

    /// The point seen at a pixel's centre with depth 1/z, and the direction towards it.
    pub(super) fn point(&self, column: usize, row: usize, depth: f32) -> (V, V) {
        let x = (column as f32 + 0.5 - self.middle[0]) / self.focal;
        let y = (self.middle[1] - row as f32 - 0.5) / self.focal;
        let ray = add(add(times(self.right, x), times(self.up, y)), self.forward);
        (add(self.eye, times(ray, 1.0 / depth)), unit(ray))
    }
}
