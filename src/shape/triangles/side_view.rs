//! Orthographic views of what stands in an oriented box, from its sides and from above.

use super::{OrientedBox, Painted};

/// Views of a box: its sides that look along +x, +y, -x, -y of the box, and its top.
pub const VIEWS: usize = 5;
/// The view from above.
pub const TOP: usize = 4;
/// A triangle is seen in a view if its normal turns no more than 60 degrees away from it.
const FACING: f64 = 0.5;

/// Colours, row after row from below; `None` where nothing is painted.
#[derive(Debug, Clone, PartialEq)]
pub struct SideView {
    /// Columns.
    pub width: usize,
    /// Pixels.
    pub colours: Vec<Option<[u8; 3]>>,
}

/// Metres across and up of a view of a box.
pub fn view_size(frame: &OrientedBox, view: usize) -> [f64; 2] {
    let [w, d, h] = frame.size;
    match view {
        TOP => [w, d],
        _ if view.is_multiple_of(2) => [d, h],
        _ => [w, h],
    }
}

/// The frame of a view: to the right, upwards, towards the viewer.
fn axes(frame: &OrientedBox, view: usize) -> [[f64; 3]; 3] {
    let (sin, cos) = frame.angle.sin_cos();
    if view == TOP {
        return [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
    }
    let (sin, cos) = (frame.angle + view as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
    [[-sin, cos, 0.0], [0.0, 0.0, 1.0], [cos, sin, 0.0]]
}

impl SideView {
    /// The view in `width` x `height` pixels of `pixel` metres across and up, from the lower left corner of the side on.
    pub fn of(
        paint: &[Painted],
        frame: &OrientedBox,
        view: usize,
        [width, height]: [usize; 2],
        pixel: [f64; 2],
    ) -> Self {
        let [right, up, normal] = axes(frame, view);
        let size = view_size(frame, view);
        // From above the middle of the box is in the middle, from the side it stands on the lower edge.
        let rise = if view == TOP { size[1] / 2.0 } else { 0.0 };
        let mut colours = vec![None; width * height];
        let mut depths = vec![f64::NEG_INFINITY; width * height];
        for painted in paint {
            if facing(&painted.corners, normal) < FACING {
                continue;
            }
            // Pixels to the right and up, and metres towards the viewer.
            let seen = painted.corners.map(|p| {
                let from: [f64; 3] = std::array::from_fn(|k| p[k] - frame.base[k]);
                let along = |axis: [f64; 3]| (0..3).map(|k| from[k] * axis[k]).sum::<f64>();
                let x = (along(right) + size[0] / 2.0) / pixel[0];
                [x, (along(up) + rise) / pixel[1], along(normal)]
            });
            // What reaches out of the box belongs to its neighbours above and below.
            cover(&seen, width, height, |at, weights| {
                let depth: f64 = (0..3).map(|k| weights[k] * seen[k][2]).sum();
                if depth > depths[at] {
                    depths[at] = depth;
                    colours[at] = Some(painted.colour(weights));
                }
            });
        }
        Self { width, colours }
    }

    /// The whole side in `width` x `height` pixels.
    pub fn whole(
        paint: &[Painted],
        frame: &OrientedBox,
        view: usize,
        [width, height]: [usize; 2],
    ) -> Self {
        let [across, up] = view_size(frame, view);
        let pixel = [across / width as f64, up / height as f64];
        Self::of(paint, frame, view, [width, height], pixel)
    }

    /// Share of the pixels that are painted.
    pub fn painted(&self) -> f64 {
        self.colours.iter().flatten().count() as f64 / self.colours.len().max(1) as f64
    }
}

/// Cosine between a triangle's normal and a direction.
fn facing([a, b, c]: &[[f64; 3]; 3], direction: [f64; 3]) -> f64 {
    let edge = |q: &[f64; 3]| [0, 1, 2].map(|k| q[k] - a[k]);
    let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
    let n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    let length = n.iter().map(|v| v * v).sum::<f64>().sqrt();
    let along: f64 = (0..3).map(|k| n[k] * direction[k]).sum();
    along / length.max(f64::MIN_POSITIVE)
}

/// Calls `visit` with every pixel whose middle the triangle covers, and the barycentric coordinates there.
fn cover(t: &[[f64; 3]; 3], width: usize, height: usize, mut visit: impl FnMut(usize, [f64; 3])) {
    let [a, b, c] = t;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }
    let range = |k: usize, n: usize| {
        let low = a[k].min(b[k]).min(c[k]);
        let high = a[k].max(b[k]).max(c[k]);
        // Conversions of floats saturate.
        ((low - 0.5).ceil().max(0.0) as usize)..((high + 0.5).ceil().max(0.0) as usize).min(n)
    };
    for j in range(1, height) {
        for i in range(0, width) {
            let (x, y) = (i as f64 + 0.5, j as f64 + 0.5);
            let part = |p: &[f64; 3], q: &[f64; 3]| {
                ((p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x)) / area
            };
            let weights = [part(b, c), part(c, a), part(a, b)];
            if weights.iter().all(|w| *w >= 0.0) {
                visit(j * width + i, weights);
            }
        }
    }
}
