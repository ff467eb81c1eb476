//! Roof planes over boxes (Sec. 6.1): flat, gable, hip, shed and cone, each the least of a few planes.

use edifice_shape::solid::exact::{Plane, SLOPES, units};
use edifice_shape::{Building, MassBox, PlanUnion, Rect, Ridge, RoofStyle};

/// The way in which roofs are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Joining {
    /// Each box has its own roof; the highest shows.
    #[default]
    Boxes,
    /// One roof over all boxes of a height: that of the straight skeleton of their outline.
    Merged,
}

/// A rectangle in whole units with the planes whose least is its roof.
#[derive(Debug, Clone, PartialEq)]
pub struct Roofed {
    /// Lower and upper x, lower and upper y.
    pub plan: [i128; 4],
    /// The planes.
    pub planes: Vec<Plane>,
}

/// Edges of a rectangle in whole units.
pub fn plan_units(r: &Rect) -> [i128; 4] {
    [units(r.x), units(r.right()), units(r.y), units(r.top())]
}

/// The planes of a box's own roof; each is as high as the box over an edge of its plan.
pub fn planes(b: &MassBox) -> Vec<Plane> {
    let plan = plan_units(&b.plan());
    let slope = (b.roof.pitch.to_radians().tan().min(10.0) * SLOPES as f64).round() as i128;
    rising(
        b.roof.style,
        b.roof.ridge,
        slope,
        plan,
        units(b.height),
        [true; 4],
    )
}

/// Planes that rise from the edges left, right, front and back; `hipped` says which edges of a hip roof do.
fn rising(
    style: RoofStyle,
    ridge: Ridge,
    slope: i128,
    [x0, x1, y0, y1]: [i128; 4],
    height: i128,
    hipped: [bool; 4],
) -> Vec<Plane> {
    let along_x = [
        Plane::rising(slope, [1, 0], [x0, y0], height),
        Plane::rising(slope, [-1, 0], [x1, y1], height),
    ];
    let along_y = [
        Plane::rising(slope, [0, 1], [x0, y0], height),
        Plane::rising(slope, [0, -1], [x1, y1], height),
    ];
    if slope == 0 {
        return vec![Plane::level(height)];
    }
    match (style, ridge) {
        (RoofStyle::Flat, _) => vec![Plane::level(height)],
        (RoofStyle::Gable, Ridge::X) => along_y.to_vec(),
        (RoofStyle::Gable, Ridge::Y) => along_x.to_vec(),
        (RoofStyle::Shed, Ridge::X) => along_y[..1].to_vec(),
        (RoofStyle::Shed, Ridge::Y) => along_x[..1].to_vec(),
        (RoofStyle::Hip, _) => {
            let all = along_x.into_iter().chain(along_y).zip(hipped);
            all.filter(|(_, hipped)| *hipped).map(|(p, _)| p).collect()
        }
        (RoofStyle::Cone, _) => {
            // A pyramid: the planes of both axes meet in one height over the middle.
            let least = (x1 - x0).min(y1 - y0);
            let share = |extent: i128| slope * least / extent.max(1);
            let mut planes = rising(
                RoofStyle::Gable,
                Ridge::Y,
                share(x1 - x0),
                [x0, x1, y0, y1],
                height,
                hipped,
            );
            planes.extend(rising(
                RoofStyle::Gable,
                Ridge::X,
                share(y1 - y0),
                [x0, x1, y0, y1],
                height,
                hipped,
            ));
            planes
        }
    }
}

/// One roof over all boxes of each height: the straight skeleton of a rectilinear outline rises everywhere by the
/// largest square around a place that fits into the plan, so that it is the envelope of the hips over all largest
/// rectangles of the plan. A gable stands on an edge that is a whole edge of the outline, where the box's style asks for gables.
pub fn merged(building: &Building, boxes: &[&MassBox]) -> Vec<Roofed> {
    let mut heights: Vec<i128> = boxes.iter().map(|b| units(b.height)).collect();
    heights.sort_unstable();
    heights.dedup();
    let mut roofs = Vec::new();
    for height in heights {
        let own: Vec<&&MassBox> = boxes.iter().filter(|b| units(b.height) == height).collect();
        let Some(main) = own
            .iter()
            .max_by(|a, b| (a.width * a.depth).total_cmp(&(b.width * b.depth)))
        else {
            continue;
        };
        let plans: Vec<Rect> = own.iter().map(|b| b.plan()).collect();
        let outline = PlanUnion::new(&plans).outline();
        let slope = (main.roof.pitch.to_radians().tan().min(10.0) * SLOPES as f64).round() as i128;
        for r in largest_rectangles(&plans) {
            let plan = plan_units(&r);
            let is_whole = |at: f64, start: f64, end: f64| {
                let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
                outline
                    .iter()
                    .any(|e| near(e.at, at) && near(e.start, start) && near(e.end, end))
            };
            let gable = main.roof.style == RoofStyle::Gable;
            let wide = r.width >= r.height;
            let hipped = [
                !(gable && wide && is_whole(r.x, r.y, r.top())),
                !(gable && wide && is_whole(r.right(), r.y, r.top())),
                !(gable && !wide && is_whole(r.y, r.x, r.right())),
                !(gable && !wide && is_whole(r.top(), r.x, r.right())),
            ];
            let style = match main.roof.style {
                RoofStyle::Gable => RoofStyle::Hip,
                style => style,
            };
            roofs.push(Roofed {
                planes: rising(style, main.roof.ridge, slope, plan, height, hipped),
                plan,
            });
        }
    }
    debug_assert!(building.boxes.is_empty() || boxes.is_empty() || !roofs.is_empty());
    roofs
}

/// The rectangles inside a union of rectangles that no other one contains.
pub fn largest_rectangles(plans: &[Rect]) -> Vec<Rect> {
    let lines = |f: fn(&Rect) -> [f64; 2]| {
        let mut v: Vec<f64> = plans.iter().flat_map(f).collect();
        v.sort_by(f64::total_cmp);
        v.dedup_by(|a, b| *a - *b < 1e-9);
        v
    };
    let (xs, ys) = (lines(|r| [r.x, r.right()]), lines(|r| [r.y, r.top()]));
    let inside = |i: usize, j: usize| {
        let (x, y) = ((xs[i] + xs[i + 1]) / 2.0, (ys[j] + ys[j + 1]) / 2.0);
        plans
            .iter()
            .any(|r| r.x < x && x < r.right() && r.y < y && y < r.top())
    };
    let full = |i0: usize, i1: usize, j0: usize, j1: usize| {
        (i0..i1).all(|i| (j0..j1).all(|j| inside(i, j)))
    };
    let (n, m) = (xs.len() - 1, ys.len() - 1);
    let mut found = Vec::new();
    for i0 in 0..n {
        for i1 in i0 + 1..=n {
            for j0 in 0..m {
                for j1 in j0 + 1..=m {
                    let grows = (i0 > 0 && full(i0 - 1, i1, j0, j1))
                        || (i1 < n && full(i0, i1 + 1, j0, j1))
                        || (j0 > 0 && full(i0, i1, j0 - 1, j1))
                        || (j1 < m && full(i0, i1, j0, j1 + 1));
                    if full(i0, i1, j0, j1) && !grows {
                        found.push(Rect::new(xs[i0], ys[j0], xs[i1] - xs[i0], ys[j1] - ys[j0]));
                    }
                }
            }
        }
    }
    found
}
