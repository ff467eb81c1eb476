//! Each side of a house as vertical strips.

use super::lengths::millimetres;
use super::plan::FloorPlan;
use edifice_shape::{BoxStyle, ElementStyle, MassBox, PlanEdge, PlanUnion, Rect, Side};

/// Narrowest strip with windows, and narrowest that can be seen to be asymmetric (m).
pub(super) const NARROWEST: f64 = 1.2;
pub(super) const NARROWEST_FREE: f64 = 1.6;
/// Thinnest strip that a cut may leave, blank (m).
const THINNEST: f64 = 0.3;
/// Length by which the roof of a porch reaches over it (m).
const EAVES: f64 = 0.4;
/// Narrowest wall for a garage door (m).
const GARAGE_DOOR: f64 = 2.55;

/// The use of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    Windows,
    /// A door instead of windows.
    Door,
    /// Nothing: a porch or a garage door is there.
    Blank,
}

/// The wall of one floor in a strip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wall {
    pub floor: usize,
    /// Coordinate across the side.
    pub at: f64,
    pub usage: Use,
}

/// A strip of one side, from the ground up.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    pub side: Side,
    pub start: f64,
    pub end: f64,
    pub walls: Vec<Wall>,
    pub symmetric: bool,
    pub style: ElementStyle,
}

impl Strip {
    pub(crate) fn width(&self) -> f64 {
        self.end - self.start
    }

    fn area(&self) -> f64 {
        self.width() * self.walls.len() as f64
    }

    pub(crate) fn has_door(&self) -> bool {
        self.walls.iter().any(|w| w.usage == Use::Door)
    }

    /// True if no wall is blank.
    fn is_bare(&self) -> bool {
        self.walls.iter().all(|w| w.usage != Use::Blank)
    }

    /// True if it has windows.
    pub(crate) fn is_glazed(&self) -> bool {
        let windows = |w: &Wall| w.usage == Use::Windows;
        self.width() >= NARROWEST && !self.has_door() && self.walls.iter().any(windows)
    }
}

/// The strips of all sides, all symmetric so far: cut wherever the outline of some floor has a corner and where the
/// roof of a porch ends. A door leads to each porch from the wall behind it; what else its roof hides is blank, and so
/// is the wall for the garage door. `None` when the garage has no wall for a door.
pub(super) fn strips(plan: &FloorPlan, floors: usize) -> Option<[Vec<Strip>; 4]> {
    let outlines: Vec<_> = (0..floors).map(|k| outline(plan, k)).collect();
    let mut sides = Side::ALL.map(|side| cut(side, &outlines, &porches(plan)));
    let garages: Vec<Rect> = plan
        .boxes
        .iter()
        .filter(|b| b.style == BoxStyle::Garage)
        .map(MassBox::plan)
        .collect();
    for garage in garages {
        let wall = garage_wall(&mut sides, &garage)?;
        wall.usage = Use::Blank;
    }
    Some(sides)
}

fn porches(plan: &FloorPlan) -> Vec<Rect> {
    let porches = plan.boxes.iter().filter(|b| b.style == BoxStyle::Porch);
    porches.map(MassBox::plan).collect()
}

/// Outline of the walls of floor `k`: porches have none.
fn outline(plan: &FloorPlan, k: usize) -> Vec<PlanEdge> {
    let reaching = |b: &&MassBox| {
        b.style != BoxStyle::Porch && (k == 0 || b.height > (k as f64 + 0.5) * plan.floor_height)
    };
    let walls: Vec<Rect> = plan
        .boxes
        .iter()
        .filter(reaching)
        .map(MassBox::plan)
        .collect();
    PlanUnion::new(&walls).outline()
}

/// The range along a wall of the ground floor where the roof of a porch meets it, in metres; `None` if it does not.
fn roofed(side: Side, at: f64, porch: &Rect) -> Option<[f64; 2]> {
    let (low, high, start, end) = match side {
        Side::Front | Side::Back => (porch.y, porch.top(), porch.x, porch.right()),
        Side::Left | Side::Right => (porch.x, porch.right(), porch.y, porch.top()),
    };
    (low - 0.05 < at && at < high + 0.05).then_some([start - EAVES, end + EAVES])
}

fn cut(side: Side, outlines: &[Vec<PlanEdge>], porches: &[Rect]) -> Vec<Strip> {
    let edges = || {
        let floors = outlines.iter().enumerate();
        floors.flat_map(move |(k, edges)| {
            let own = edges.iter().filter(move |e| e.side == side);
            own.map(move |e| (k, e))
        })
    };
    let mut corners: Vec<f64> = edges().flat_map(|(_, e)| [e.start, e.end]).collect();
    for (_, e) in edges().filter(|(k, _)| *k == 0) {
        let ends = porches.iter().filter_map(|p| roofed(side, e.at, p));
        let inside = |v: &f64| e.start + THINNEST < *v && *v < e.end - THINNEST;
        corners.extend(ends.flatten().filter(inside));
    }
    corners.sort_by(f64::total_cmp);
    corners.dedup_by(|next, kept| *next - *kept < 1e-3);
    let strips = corners.windows(2).map(|w| {
        let middle = (w[0] + w[1]) / 2.0;
        let here = edges().filter(|(_, e)| e.start < middle && middle < e.end);
        let usage = |k: usize, at: f64| {
            let mut spans = porches.iter().filter_map(|p| roofed(side, at, p));
            let is_under = k == 0 && spans.any(|s| s[0] < w[1] - 0.01 && w[0] + 0.01 < s[1]);
            let leads_out =
                matches!(side, Side::Front | Side::Back) && w[1] - w[0] >= NARROWEST_FREE;
            match (is_under, leads_out) {
                (false, _) => Use::Windows,
                (true, true) => Use::Door,
                (true, false) => Use::Blank,
            }
        };
        Strip {
            side,
            start: millimetres(w[0]),
            end: millimetres(w[1]),
            walls: here
                .map(|(floor, e)| Wall {
                    floor,
                    at: e.at,
                    usage: usage(floor, e.at),
                })
                .collect(),
            symmetric: true,
            style: ElementStyle::Fixed,
        }
    });
    strips.filter(|s| !s.walls.is_empty()).collect()
}

/// The wall of a garage that has its door: in front, else at a side, else at the back; the widest.
fn garage_wall<'a>(sides: &'a mut [Vec<Strip>; 4], garage: &Rect) -> Option<&'a mut Wall> {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-3;
    let mut best: Option<(usize, f64, [usize; 3])> = None;
    for (s, strips) in sides.iter().enumerate() {
        for (i, strip) in strips.iter().enumerate() {
            let (at, start, end, rank) = match strip.side {
                Side::Front => (garage.y, garage.x, garage.right(), 0),
                Side::Left => (garage.x, garage.y, garage.top(), 1),
                Side::Right => (garage.right(), garage.y, garage.top(), 1),
                Side::Back => (garage.top(), garage.x, garage.right(), 2),
            };
            let within = strip.start > start - 1e-3 && strip.end < end + 1e-3;
            let wall = strip
                .walls
                .iter()
                .position(|w| w.floor == 0 && near(w.at, at) && w.usage == Use::Windows);
            let width = strip.width();
            if let (true, true, Some(k)) = (within, width >= GARAGE_DOOR, wall)
                && best.is_none_or(|b| (rank, -width) < (b.0, -b.1))
            {
                best = Some((rank, width, [s, i, k]));
            }
        }
    }
    let (_, _, [s, i, k]) = best?;
    Some(&mut sides[s][i].walls[k])
}

/// Makes some strips asymmetric, one of them cut in two, so that the symmetric share of the area is
/// `share`; `None` when the strips do not allow it.
pub(super) fn make_symmetric(mut strips: Vec<Strip>, share: f64) -> Option<Vec<Strip>> {
    let total: f64 = strips.iter().map(Strip::area).sum();
    let wanted = (1.0 - share) * total;
    let mut free: Vec<usize> = (0..strips.len())
        .filter(|&i| strips[i].width() >= NARROWEST_FREE && strips[i].is_bare())
        .collect();
    free.sort_by(|&a, &b| strips[b].area().total_cmp(&strips[a].area()));
    free.truncate(8);
    let chosen = |mask: u32| {
        free.iter()
            .enumerate()
            .filter(move |(k, _)| mask >> k & 1 == 1)
    };
    let whole = 1_u32 << free.len();
    let fits = free.iter().enumerate().find_map(|(k, &split)| {
        (0..whole)
            .filter(|mask| mask >> k & 1 == 0)
            .find_map(|mask| {
                let area: f64 = chosen(mask).map(|(_, &i)| strips[i].area()).sum();
                let width = (wanted - area) / strips[split].walls.len() as f64;
                let rest = strips[split].width() - width;
                let fits = width >= NARROWEST_FREE && rest >= THINNEST;
                (fits && !strips[split].has_door()).then_some((mask, split, width))
            })
    });
    let (mask, split, width) = fits?;
    let asymmetric: Vec<usize> = chosen(mask).map(|(_, &i)| i).collect();
    for i in asymmetric {
        strips[i].symmetric = false;
    }
    let mut rest = strips[split].clone();
    rest.start = millimetres(rest.start + width);
    strips[split].end = rest.start;
    strips[split].symmetric = false;
    strips.insert(split + 1, rest);
    Some(strips)
}
