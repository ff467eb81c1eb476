//! A plan of overlapping boxes that has the drawn numbers.
//!
//! ```text
//!  y = D     +-- wings --+------+ porch
//!   garage   |           +------+ D - back step
//!  +-behind--+                  |       the main body: a rectangle less what the parts take
//!  +---+   main body            |       and less the cuts of the plan's family
//!  garage                       |       ([`super::families`])
//!  beside   +--+ porch +--+ room|  y = front step
//!      +----+  +-------+  +-----+  y = 0
//! ```
//! Around garage and porches the walls are as their kinds say, whatever the family, so that how much of them is
//! seen tells nothing of the rest of the plan. The cuts are solved for in closed form: recesses for the boundary,
//! their widths and cut corners for the coverage.

use rand::{Rng, RngExt};

use super::draw::{Numbers, Part};
use super::families::Family;
use super::lengths::millimetres;
use super::site::Site;
use super::storeys;
use super::styles::{GaragePlace, Kinds};
use edifice_shape::{MassBox, PlanUnion, Rect};

pub(super) struct FloorPlan {
    pub floor_height: f64,
    pub boxes: Vec<MassBox>,
    pub family: Family,
}

/// Free wall between two parts, or a part and a corner (m).
const CLEAR: f64 = 0.05;
/// Length by which a wing behind or beside a garage laps over it (m).
const LAP: f64 = 0.1;
/// Thinnest wing and narrowest recess of the main body (m).
const THINNEST: f64 = 1.5;
const NARROWEST: f64 = 1.2;
/// Least width of the room in front beside the parts (m).
const ROOM: f64 = 2.0;

/// A plan of a family drawn at random, or `None` when the numbers do not fit together or into the family.
pub(super) fn build(n: &Numbers, kinds: &Kinds, rng: &mut impl Rng) -> Option<FloorPlan> {
    let site = Site::new(n, rng)?;
    let parts: Vec<Rect> = [site.garage, site.front, site.rear]
        .into_iter()
        .flatten()
        .collect();
    let area = n.bcr * n.width * n.depth;
    let perimeter = n.bdry * area.sqrt();
    let with_parts = |main: &[Rect]| {
        let all: Vec<Rect> = main.iter().chain(&parts).copied().collect();
        PlanUnion::new(&all)
    };
    let whole = with_parts(&less(&site, &[]));
    let recess = (perimeter - whole.perimeter()) / 2.0;
    let family = Family::draw(rng);
    let cuts = family.cuts(&site, whole.area() - area, recess, rng)?;
    let main = less(&site, &cuts);
    let body = PlanUnion::new(&main).soundness();
    if body.parts != 1 || body.courtyard || body.thickness < THINNEST || body.gap < NARROWEST {
        return None;
    }
    // Cuts that overlap, or lie beside the body, take less.
    let plan = with_parts(&main);
    let off = |a: f64, b: f64| (a - b).abs() > 1e-6 * b;
    if off(plan.area(), area) || off(plan.perimeter(), perimeter) {
        return None;
    }
    let boxes = storeys::boxes(&site, n, kinds, &main, rng)?;
    Some(FloorPlan {
        floor_height: millimetres(n.floor_height),
        boxes,
        family,
    })
}

impl Site {
    fn new(n: &Numbers, rng: &mut impl Rng) -> Option<Self> {
        let (w, d, step) = (n.width, n.depth, n.front_step);
        let garage = n.garage.map(|p| place(&p, w, d));
        let front = n.front_porch.map(|p| place(&p, w, d));
        let rear = n.back_porch.map(|p| place(&p, w, d));
        let mut taken = Vec::new();
        let mut free = [[0.0, w], [0.0, w], [0.0, d], [0.0, d]];
        let mut deepest = [0.52 * d; 4];
        // Where the room in front may begin.
        let mut room = None;
        let mut left: f64 = 0.0;
        match (garage, n.place) {
            (Some(g), Some(GaragePlace::Front)) => {
                stands_before(&g, step, d)?;
                room = Some(g.right());
            }
            (Some(g), Some(GaragePlace::Beside)) => {
                let fits = g.x > CLEAR && g.right() > n.side_step + CLEAR && g.y > step + CLEAR;
                let wing = d - g.top();
                if !fits || wing < 0.6 {
                    return None;
                }
                taken.push(Rect::new(0.0, 0.0, n.side_step, g.top() - LAP));
                left = n.side_step;
                room = Some(left);
                free[2] = [g.top() - LAP, d];
                deepest[0] = wing - THINNEST;
            }
            (Some(g), Some(GaragePlace::Behind)) => {
                if g.x < CLEAR || g.top() > d - CLEAR || g.y > d - n.yard - LAP {
                    return None;
                }
                let corner = Rect::new(0.0, d - n.yard, g.right() - LAP, n.yard);
                taken.push(corner);
                free[1][0] = corner.right();
                free[2][1] = d - n.yard;
                deepest[0] = 0.0;
            }
            _ => {}
        }
        if let Some(p) = front {
            stands_before(&p, step, d)?;
            if p.x < left.max(garage.map_or(0.0, |g| g.right())) + CLEAR {
                return None;
            }
            room = Some(p.right());
        }
        if let Some(right) = room {
            let most = w - ROOM - right - 0.35;
            if most < 0.0 {
                return None;
            }
            let gap = 0.35 + rng.random::<f64>().powi(2) * most.min(0.25 * w);
            let start = right.max(left) + gap;
            taken.push(Rect::new(left, 0.0, start - left, step));
            free[0][0] = start;
            free[2][0] = free[2][0].max(step);
            deepest[2] = 0.0;
        }
        if let Some(p) = rear {
            let wing = p.x - free[1][0];
            if p.right() > w - 0.02 || p.y > d - n.back_step - 0.1 || wing < THINNEST {
                return None;
            }
            // The porch leans on a wing to its left.
            taken.push(Rect::new(p.x, d - n.back_step, w - p.x, n.back_step));
            free[1][1] = p.x;
            free[3][1] = d - n.back_step;
            deepest[1] = 0.0;
        }
        Some(Self {
            width: w,
            depth: d,
            taken,
            garage,
            front,
            rear,
            free,
            deepest,
        })
    }
}

/// Tests that a part before the front wall stands out of it and meets it; `None` if not.
fn stands_before(part: &Rect, step: f64, depth: f64) -> Option<()> {
    let meets = part.top() > step + CLEAR && part.top() < 0.7 * depth;
    (part.x > CLEAR && part.y > CLEAR && part.y < step - CLEAR && meets).then_some(())
}

/// The main body less what the parts and the cuts take, as disjoint rectangles.
fn less(site: &Site, cuts: &[Rect]) -> Vec<Rect> {
    let gone = || site.taken.iter().chain(cuts);
    let lines = |extent: f64, edges: fn(&Rect) -> [f64; 2]| {
        let mut at: Vec<f64> = gone().flat_map(edges).chain([0.0, extent]).collect();
        at.retain(|v| (-1e-9..=extent + 1e-9).contains(v));
        at.sort_by(f64::total_cmp);
        at.dedup_by(|a, b| *a - *b < 1e-9);
        at
    };
    let xs = lines(site.width, |r| [r.x, r.right()]);
    let ys = lines(site.depth, |r| [r.y, r.top()]);
    let mut cells = Vec::new();
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            let (mx, my) = ((x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0);
            let is_gone = |r: &Rect| r.x < mx && mx < r.right() && r.y < my && my < r.top();
            if !gone().any(is_gone) {
                cells.push(Rect::new(x[0], y[0], x[1] - x[0], y[1] - y[0]));
            }
        }
    }
    cells
}

/// A part in plan, in metres.
fn place(part: &Part, width: f64, depth: f64) -> Rect {
    Rect::new(
        part.x * width - part.width / 2.0,
        part.y * depth - part.depth / 2.0,
        part.width,
        part.depth,
    )
}
