//! Fit of boxes to the triangles they stand for, measured by code that the fitting does not use.

use serde::Serialize;

use super::heights::HeightMap;
use super::surfaces::{ground, roof};
use edifice_shape::triangles::{Corners, TriangleMesh, plan_area};
use edifice_shape::{MassBox, PlanUnion, Rect, Ridge, RoofStyle};

/// Nearness of a measured house.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Fit {
    /// Intersection over union of the plans, from the file's triangles clipped by the boxes; in `[0, 1]`.
    pub iou: f64,
    /// Volume under the boxes' roofs over that under the file's highest surfaces.
    pub volume: f64,
    /// Mean absolute difference of the heights over the plan (m).
    pub height_error: f64,
    /// Boxes.
    pub boxes: usize,
}

impl Fit {
    /// Measures boxes in the axes of the mesh, or turned by half a circle.
    pub(super) fn new(boxes: &[MassBox], mesh: &TriangleMesh, map: &HeightMap) -> Self {
        let plans: Vec<Rect> = boxes.iter().map(MassBox::plan).collect();
        let union = PlanUnion::new(&plans);
        let middle = |r: Rect| [r.x + r.width / 2.0, r.y + r.height / 2.0];
        let own = union.bounding_box().map_or([0.0; 2], middle);
        let [[x0, x1], [y0, y1]] = map.bounds();
        // Half a turn maps the middle of the plan to the opposite of it.
        let at = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
        let apart = |sign: f64| (own[0] - sign * at[0]).hypot(own[1] - sign * at[1]);
        let sign = if apart(-1.0) < apart(1.0) { -1.0 } else { 1.0 };
        let turned = |t: Corners| t.map(|p| [sign * p[0], sign * p[1], p[2]]);

        let cells = disjoint(&plans);
        let mut plan: Vec<Corners> = ground(mesh).map(turned).collect();
        if plan.is_empty() {
            plan = roof(mesh).map(turned).collect();
        }
        let measured: f64 = plan.iter().map(|t| plan_area(t).abs()).sum();
        let shared: f64 = plan
            .iter()
            .flat_map(|t| cells.iter().map(move |c| clipped_area(t, c)))
            .sum();
        let iou = shared / (measured + union.area() - shared);

        let mut off = 0.0;
        let (mut n, mut fitted, mut truth) = (0.0, 0.0, 0.0);
        for s in map.samples() {
            let height = height(boxes, sign * s.x, sign * s.y);
            off += (height - s.height).abs();
            n += 1.0;
            fitted += height;
            truth += s.height;
        }
        // What of the boxes lies outside the plan counts with their mean height.
        let own = fitted / f64::max(n, 1.0) * union.area();
        // Faces inside, as between the parts of a derived city, are below the highest ones and count for nothing.
        let volume = truth * map.cell();
        Self {
            iou,
            volume: own / volume.max(1e-9),
            height_error: off / f64::max(n, 1.0),
            boxes: boxes.len(),
        }
    }
}

/// Height of the highest roof at a place, written from the definition of each style.
fn height(boxes: &[MassBox], x: f64, y: f64) -> f64 {
    let over = |b: &&MassBox| {
        (x - b.x).abs() <= b.width / 2.0 + 1e-9 && (y - b.y).abs() <= b.depth / 2.0 + 1e-9
    };
    let roof = |b: &MassBox| {
        let inset = [
            b.width / 2.0 - (x - b.x).abs(),
            b.depth / 2.0 - (y - b.y).abs(),
        ];
        let rise = match (b.roof.style, b.roof.ridge) {
            (RoofStyle::Flat, _) => 0.0,
            (RoofStyle::Gable, Ridge::X) => inset[1],
            (RoofStyle::Gable, Ridge::Y) => inset[0],
            (RoofStyle::Shed, Ridge::X) => y - b.y + b.depth / 2.0,
            (RoofStyle::Shed, Ridge::Y) => x - b.x + b.width / 2.0,
            (RoofStyle::Hip | RoofStyle::Cone, _) => inset[0].min(inset[1]),
        };
        b.height + b.roof.pitch.to_radians().tan() * rise
    };
    boxes.iter().filter(over).map(roof).fold(0.0, f64::max)
}

/// The same union as rectangles that do not overlap: cells between all edges.
fn disjoint(plans: &[Rect]) -> Vec<Rect> {
    let lines = |ends: fn(&Rect) -> [f64; 2]| {
        let mut lines: Vec<f64> = plans.iter().flat_map(ends).collect();
        lines.sort_by(f64::total_cmp);
        lines.dedup();
        lines
    };
    let (xs, ys) = (lines(|r| [r.x, r.right()]), lines(|r| [r.y, r.top()]));
    let mut cells = Vec::new();
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            let (u, v) = ((x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0);
            let covers = |r: &Rect| r.x < u && u < r.right() && r.y < v && v < r.top();
            if plans.iter().any(covers) {
                cells.push(Rect::new(x[0], y[0], x[1] - x[0], y[1] - y[0]));
            }
        }
    }
    cells
}

/// Area of the part of a triangle's plan inside a rectangle (Sutherland and Hodgman 1974).
fn clipped_area(t: &Corners, r: &Rect) -> f64 {
    let mut ring: Vec<[f64; 2]> = t.iter().map(|p| [p[0], p[1]]).collect();
    let sides = [
        (0, r.x, 1.0),
        (0, r.right(), -1.0),
        (1, r.y, 1.0),
        (1, r.top(), -1.0),
    ];
    for (axis, at, sign) in sides {
        let inside = |p: &[f64; 2]| sign * (p[axis] - at);
        let mut kept = Vec::with_capacity(ring.len() + 2);
        for k in 0..ring.len() {
            let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
            let (a, b) = (inside(&p), inside(&q));
            if a >= 0.0 {
                kept.push(p);
            }
            if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                let s = a / (a - b);
                kept.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
            }
        }
        ring = kept;
    }
    let twice = |k: usize| {
        let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
        p[0] * q[1] - q[0] * p[1]
    };
    ((0..ring.len()).map(twice).sum::<f64>() / 2.0).abs()
}

#[cfg(test)]
mod tests {
    use edifice_base::rng::stream;
    use rand::RngExt;

    use super::{Rect, clipped_area, plan_area};

    /// The parts of a triangle in the cells of a grid around it make up the triangle, and none is larger than its cell.
    #[test]
    fn a_triangle_is_the_sum_of_its_parts() {
        let mut rng = stream(1, "triangles", 0);
        for _ in 0..500 {
            // Corners on whole numbers meet the lines of the grid.
            let mut number = || {
                f64::from(rng.random_range(0..9_u8)) + f64::from(rng.random_range(0..3_u8)) / 4.0
            };
            let t = [(); 3].map(|()| [number(), number(), 0.0]);
            let mut sum = 0.0;
            for i in 0..10 {
                for j in 0..10 {
                    let cell = Rect::new(f64::from(i), f64::from(j), 1.0, 1.0);
                    let part = clipped_area(&t, &cell);
                    assert!(part <= 1.0 + 1e-9, "{t:?} {cell:?}");
                    sum += part;
                }
            }
            assert!((sum - plan_area(&t).abs()).abs() < 1e-9, "{t:?}");
        }
    }
}
