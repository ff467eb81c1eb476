//! A building as a union of prisms: walls up to the roof planes, eaves, open porches, chimney and tower.

use super::roofs::{Joining, Roofed, merged, plan_units, planes};
use edifice_shape::solid::exact::{Line, Plane, UNIT, units};
use edifice_shape::solid::{Finish, Prism};
use edifice_shape::{BoxStyle, Building, MassBox, RoofStyle, Special};

/// Length by which sloped roofs reach over the walls, and flat ones (m).
const EAVES: f64 = 0.35;
const CORNICE: f64 = 0.12;
/// Thickness of a roof, upright (m).
const ROOF: f64 = 0.18;
/// Height of a porch's floor and of the beam under its roof, width of its posts, and most between two (m).
const DECK: f64 = 0.15;
const BEAM: f64 = 0.22;
const POST: f64 = 0.16;
const BAY: f64 = 3.0;
/// A chimney: plan, height over the ridge (m).
const CHIMNEY: [f64; 2] = [0.9, 0.6];
const STACK: f64 = 0.9;
/// A tower: half its width, walls over the eaves, slope of its cone in thousandths.
const TOWER: f64 = 1.5;
const RISE: f64 = 1.9;
const CONE: i128 = 1600;

/// The prisms of a building.
pub fn prisms(building: &Building, joining: Joining) -> Vec<Prism> {
    let mut out = Vec::new();
    let general: Vec<&MassBox> = building
        .boxes
        .iter()
        .filter(|b| b.style != BoxStyle::Porch)
        .collect();
    match joining {
        Joining::Boxes => {
            for (k, b) in general.iter().enumerate() {
                let plan = plan_units(&b.plan());
                let roofed = Roofed {
                    plan,
                    planes: planes(b),
                };
                walls(&roofed, 0, &mut out);
                eaves(&roofed, k, &mut out);
            }
        }
        Joining::Merged => {
            for (k, roofed) in merged(building, &general).iter().enumerate() {
                walls(roofed, 0, &mut out);
                eaves(roofed, k, &mut out);
            }
        }
    }
    let porches = building.boxes.iter().filter(|b| b.style == BoxStyle::Porch);
    for (k, b) in porches.enumerate() {
        porch(b, building, general.len() + k, &mut out);
    }
    let tallest = general.iter().max_by(|a, b| {
        let key = |b: &MassBox| (b.height, b.width * b.depth);
        key(a)
            .partial_cmp(&key(b))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    if let Some(tallest) = tallest {
        if building.special.contains(&Special::Chimney) {
            chimney(tallest, &mut out);
        }
        if building.special.contains(&Special::Tower) {
            tower(tallest, &mut out);
        }
    }
    out
}

/// A rectangle as half planes.
fn rectangle([x0, x1, y0, y1]: [i128; 4]) -> Vec<Line> {
    vec![
        Line::new(1, 0, -x0),
        Line::new(-1, 0, x1),
        Line::new(0, 1, -y0),
        Line::new(0, -1, y1),
    ]
}

/// The part of a region where plane `i` is the least.
fn facet(region: [i128; 4], planes: &[Plane], i: usize) -> Vec<Line> {
    let mut lines = rectangle(region);
    let others = planes.iter().enumerate().filter(|(j, _)| *j != i);
    lines.extend(others.filter_map(|(_, q)| q.above(&planes[i])));
    lines
}

fn walls(roofed: &Roofed, base: i128, out: &mut Vec<Prism>) {
    for (i, plane) in roofed.planes.iter().enumerate() {
        out.push(Prism {
            region: facet(roofed.plan, &roofed.planes, i),
            lower: Plane::level(base),
            upper: *plane,
            sides: Finish::Wall,
            top: Finish::Roof,
        });
    }
}

/// The roof as a slab that reaches over the walls. Number `k` makes each a hair different from the others, so that
/// eaves of neighbours never meet in a line.
fn eaves(roofed: &Roofed, k: usize, out: &mut Vec<Prism>) {
    let is_flat = roofed.planes.len() == 1 && roofed.planes[0].a == 0 && roofed.planes[0].b == 0;
    let reach = if is_flat { CORNICE } else { EAVES };
    let hair = 7 * k as i128;
    let o = units(reach) + hair;
    let [x0, x1, y0, y1] = roofed.plan;
    let region = [x0 - o, x1 + o, y0 - o, y1 + o];
    for (i, plane) in roofed.planes.iter().enumerate() {
        out.push(Prism {
            region: facet(region, &roofed.planes, i),
            lower: plane.raised(-units(ROOF) - hair),
            upper: *plane,
            sides: Finish::Trim,
            top: Finish::Roof,
        });
    }
}

/// An open porch: floor, posts, a roof on a beam.
fn porch(b: &MassBox, building: &Building, k: usize, out: &mut Vec<Prism>) {
    let plan = plan_units(&b.plan());
    let height = units(b.height);
    let roofed = Roofed {
        plan,
        planes: planes(b),
    };
    let hair = 3 * k as i128;
    let beam = (height - units(BEAM) - hair).max(height / 2);
    let deck = units(DECK).min(height / 4) + hair;
    out.push(Prism {
        region: rectangle(plan),
        lower: Plane::level(0),
        upper: Plane::level(deck),
        sides: Finish::Deck,
        top: Finish::Deck,
    });
    for (i, plane) in roofed.planes.iter().enumerate() {
        out.push(Prism {
            region: facet(roofed.plan, &roofed.planes, i),
            lower: Plane::level(beam),
            upper: *plane,
            sides: Finish::Trim,
            top: Finish::Roof,
        });
    }
    eaves(&roofed, k, out);
    let (x0, x1, y0, y1) = (plan[0], plan[1], plan[2], plan[3]);
    let post = units(POST).min((x1 - x0) / 3).min((y1 - y0) / 3);
    let places = |low: i128, high: i128| {
        let n = ((high - low) as f64 * UNIT / BAY).ceil().max(1.0) as i128;
        let inset = post / 2 + units(0.03);
        let (low, high) = (low + inset, high - inset);
        (0..=n)
            .map(|i| low + (high - low) * i / n)
            .collect::<Vec<_>>()
    };
    let (xs, ys) = (places(x0, x1), places(y0, y1));
    let last = (xs.len() - 1, ys.len() - 1);
    for (i, &x) in xs.iter().enumerate() {
        for (j, &y) in ys.iter().enumerate() {
            let on_edge = i == 0 || j == 0 || i == last.0 || j == last.1;
            if on_edge && !is_near_walls(building, [x, y], post, beam) {
                let half = post / 2;
                out.push(Prism {
                    region: rectangle([x - half, x + half, y - half, y + half]),
                    lower: Plane::level(0),
                    upper: Plane::level(height),
                    sides: Finish::Trim,
                    top: Finish::Trim,
                });
            }
        }
    }
}

/// True if a post would stand in or near a wall that reaches the beam and carries the roof.
fn is_near_walls(building: &Building, [x, y]: [i128; 2], post: i128, beam: i128) -> bool {
    let margin = post * 3;
    let carries = |b: &&MassBox| b.style != BoxStyle::Porch && units(b.height) > beam;
    let walls = building.boxes.iter().filter(carries);
    walls
        .map(|b| plan_units(&b.plan()))
        .any(|[x0, x1, y0, y1]| {
            x > x0 - margin && x < x1 + margin && y > y0 - margin && y < y1 + margin
        })
}

/// Height of a box's roof over a place of its plan, in units.
fn roof_at(b: &MassBox, x: i128, y: i128) -> i128 {
    let heights = planes(b)
        .into_iter()
        .map(|p| (p.a * x + p.b * y + p.c) / 1000);
    heights.min().unwrap_or(0)
}

fn chimney(b: &MassBox, out: &mut Vec<Prism>) {
    let [x0, x1, y0, y1] = plan_units(&b.plan());
    // Beside the ridge, a quarter of the way along it.
    let place = |low: i128, high: i128, share: f64, size: f64| {
        let size = units(size).min((high - low) / 3);
        let middle = low + ((high - low) as f64 * share) as i128;
        [middle - size / 2, middle - size / 2 + size]
    };
    let [cx0, cx1] = place(x0, x1, 0.73, CHIMNEY[0]);
    let [cy0, cy1] = place(y0, y1, 0.58, CHIMNEY[1]);
    let corners = [(cx0, cy0), (cx0, cy1), (cx1, cy0), (cx1, cy1)];
    let middle = roof_at(b, (x0 + x1) / 2, (y0 + y1) / 2);
    let roof = corners.map(|(x, y)| roof_at(b, x, y));
    let top = roof.into_iter().max().unwrap_or(0).max(middle) + units(STACK);
    let mut stack = |region: [i128; 4], lower: i128, upper: i128| {
        out.push(Prism {
            region: rectangle(region),
            lower: Plane::level(lower),
            upper: Plane::level(upper),
            sides: Finish::Chimney,
            top: Finish::Chimney,
        });
    };
    stack([cx0, cx1, cy0, cy1], 0, top);
    let lip = units(0.06);
    stack(
        [cx0 - lip, cx1 + lip, cy0 - lip, cy1 + lip],
        top - units(0.22),
        top - units(0.06),
    );
}

/// An octagon over a front corner of the box, with a steep roof of eight slopes.
fn tower(b: &MassBox, out: &mut Vec<Prism>) {
    let [x0, x1, y0, y1] = plan_units(&b.plan());
    let half = units(TOWER).min((x1 - x0) / 2 - 10).min((y1 - y0) / 2 - 10);
    let inset = units(0.02);
    let (cx, cy) = (x1 - half - inset, y0 + half + inset);
    let top = units(b.height) + units(RISE);
    // Corners are cut at 0.586 of half the width, which makes the sides nearly equal.
    let octagon = |half: i128| {
        let mut lines = rectangle([cx - half, cx + half, cy - half, cy + half]);
        let reach = half * 1414 / 1000;
        for (sx, sy) in [(1, 1), (1, -1), (-1, 1), (-1, -1)] {
            // reach - sx (x - cx) - sy (y - cy) >= 0
            lines.push(Line::new(-sx, -sy, reach + sx * cx + sy * cy));
        }
        lines
    };
    let slope = CONE;
    let eave = half + units(0.2);
    let mut planes: Vec<Plane> = [[1, 0], [-1, 0], [0, 1], [0, -1]]
        .map(|d: [i128; 2]| Plane::rising(slope, d, [cx - d[0] * half, cy - d[1] * half], top))
        .to_vec();
    // Over the diagonal sides, less steep per axis by the root of two.
    for d in [[1, 1], [1, -1], [-1, 1], [-1, -1]] {
        let from = half * 707 / 1000;
        planes.push(Plane::rising(
            slope * 707 / 1000,
            d,
            [cx - d[0] * from, cy - d[1] * from],
            top,
        ));
    }
    out.push(Prism {
        region: octagon(half),
        lower: Plane::level(0),
        upper: Plane::level(top),
        sides: Finish::Wall,
        top: Finish::Roof,
    });
    for (i, plane) in planes.iter().enumerate() {
        let mut region = octagon(eave);
        let others = planes.iter().enumerate().filter(|(j, _)| *j != i);
        region.extend(others.filter_map(|(_, q)| q.above(plane)));
        out.push(Prism {
            region,
            lower: Plane::level(top - units(0.4)),
            upper: *plane,
            sides: Finish::Trim,
            top: Finish::Roof,
        });
    }
}

/// True if the roof of a box slopes.
pub fn is_sloped(b: &MassBox) -> bool {
    b.roof.style != RoofStyle::Flat && b.roof.pitch > 0.5
}
