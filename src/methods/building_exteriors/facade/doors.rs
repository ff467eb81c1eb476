//! The doors of a house: one in front, on the main room, and one to each porch.

use super::glaze::{DOOR, millimetres};
use super::room::{CLEAR, Room, Strip, Walls};
use edifice_shape::{
    BoxStyle, Building, ElementStyle, FacadeElement, FacadePiece, MassBox, Rect, Side,
};

/// Least width of a strip with a door, and that of a wall that does not look like a stub (m).
const NARROWEST: f64 = 1.3;
const ROOMY: f64 = 2.4;
/// Clear wall between a door that is put in later and windows beside it (m), and steps in which its place is sought.
const BESIDE: f64 = 0.2;
const STEP: f64 = 0.1;
/// Clear wall beside a door that hardly has room, its width, and how far inside a porch its middle lies (m).
const TIGHT: f64 = 0.02;
const NARROW: f64 = 0.9;
const INSIDE: f64 = 0.3;
/// Largest height above the floor at which a door may begin (m): on a porch's floor.
const SILL: f64 = 0.45;

/// The porch on a side: the front one lies in the front half of the plan.
fn porch(building: &Building, side: Side) -> Option<&MassBox> {
    let ends = building
        .boxes
        .iter()
        .flat_map(|b| [b.plan().y, b.plan().top()]);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let middle = (low + high) / 2.0;
    let porches = building.boxes.iter().filter(|b| b.style == BoxStyle::Porch);
    let mut own = porches.filter(|b| match side {
        Side::Front => b.y < middle,
        Side::Back => b.y >= middle,
        Side::Left | Side::Right => false,
    });
    own.next()
}

/// The strip of a side for a door: behind the side's porch; in front without one, a wall of the main room at least 2.4 m
/// wide if there is one, the widest.
pub(super) fn door_strip(building: &Building, walls: &Walls, side: Side) -> Option<usize> {
    let strips = &walls.strips[place(side)];
    let porch = porch(building, side).map(|b| b.plan());
    let fitting: Vec<usize> = (0..strips.len())
        .filter(|&k| strips[k].width() >= NARROWEST && fits(walls, &strips[k]))
        .collect();
    let shared = |k: &usize| {
        let p = porch.unwrap_or(Rect::new(0.0, 0.0, 0.0, 0.0));
        strips[*k].end.min(p.right()) - strips[*k].start.max(p.x)
    };
    if porch.is_some() {
        let under = fitting
            .iter()
            .copied()
            .filter(|k| shared(k) > NARROWEST - 0.3);
        let widest = under.max_by(|a, b| shared(a).total_cmp(&shared(b)));
        if widest.is_some() || side != Side::Front {
            return widest;
        }
    }
    if side == Side::Back {
        return None;
    }
    let garage = |k: usize| {
        let ground = strips[k].rooms.iter().find(|r| r.piece.floor == 0);
        ground.is_some_and(|r| on_garage(building, r))
    };
    let rank = |k: &usize| {
        let wide = strips[*k].width() >= ROOMY;
        (!garage(*k), wide, strips[*k].width())
    };
    fitting.into_iter().max_by(|a, b| {
        let (p, q) = (rank(a), rank(b));
        (p.0, p.1).cmp(&(q.0, q.1)).then(p.2.total_cmp(&q.2))
    })
}

fn place(side: Side) -> usize {
    Side::ALL.iter().position(|s| *s == side).unwrap_or(0)
}

/// True if a door has room in the middle of the strip.
fn fits(walls: &Walls, strip: &Strip) -> bool {
    let middle = (strip.start + strip.end) / 2.0;
    let ground = strip.rooms.iter().find(|r| r.piece.floor == 0);
    ground.is_some_and(|r| is_free(walls, r, middle))
}

fn is_free(walls: &Walls, room: &Room, at: f64) -> bool {
    let span = [at - DOOR[0] / 2.0, at + DOOR[0] / 2.0];
    is_bare(walls.free(room, span))
}

/// True if a door stands between two heights.
fn is_bare(free: Option<[f64; 2]>) -> bool {
    // What is clear over a window may be the door's casing.
    free.is_some_and(|f| f[1] + CLEAR >= DOOR[1] + 0.02 && f[0] <= SILL)
}

/// True if a wall is one of the garage.
fn on_garage(building: &Building, room: &Room) -> bool {
    let wall = &room.piece;
    let middle = (wall.start + wall.end) / 2.0;
    let garages = building
        .boxes
        .iter()
        .filter(|b| b.style == BoxStyle::Garage);
    let mut plans = garages.map(MassBox::plan);
    plans.any(|p| {
        let (at, low, high) = match wall.side {
            Side::Front => (p.y, p.x, p.right()),
            Side::Back => (p.top(), p.x, p.right()),
            Side::Left => (p.x, p.y, p.top()),
            Side::Right => (p.right(), p.y, p.top()),
        };
        (wall.at - at).abs() < 1e-3 && low < middle && middle < high
    })
}

/// Puts a door where a house has none, and one behind each porch that none leads to: on the first wall with room, in
/// front before the sides and the back. Windows in its place are left out, and the front door elsewhere is that of the
/// front porch. Whether each asked for found a place.
pub(super) fn completed(building: &Building, walls: &Walls, pieces: &mut [FacadePiece]) -> bool {
    let mut all = true;
    for side in [Side::Front, Side::Back] {
        let Some(plan) = porch(building, side).map(MassBox::plan) else {
            continue;
        };
        let span = [plan.x, plan.right()];
        if has_door(pieces, Some((side, span))) {
            continue;
        }
        let found = put(building, walls, pieces, &[side], Some(span));
        if found {
            for piece in pieces.iter_mut().filter(|p| p.side == side) {
                let inside = |e: &FacadeElement| {
                    let middle = piece.start + e.x + e.width / 2.0;
                    span[0] < middle && middle < span[1]
                };
                (piece.elements).retain(|e| e.style != ElementStyle::Door || inside(e));
            }
        }
        all &= found;
    }
    if !has_door(pieces, None) {
        let sides = [Side::Front, Side::Left, Side::Right, Side::Back];
        all &= put(building, walls, pieces, &sides, None);
    }
    all
}

fn has_door(pieces: &[FacadePiece], within: Option<(Side, [f64; 2])>) -> bool {
    pieces.iter().any(|p| {
        p.elements.iter().any(|e| {
            let middle = p.start + e.x + e.width / 2.0;
            let here = within
                .is_none_or(|(side, span)| p.side == side && span[0] < middle && middle < span[1]);
            e.style == ElementStyle::Door && here
        })
    })
}

/// A door of usual width with clear wall beside it if there is room, else a narrow one that fills its wall.
fn put(
    building: &Building,
    walls: &Walls,
    pieces: &mut [FacadePiece],
    sides: &[Side],
    within: Option<[f64; 2]>,
) -> bool {
    for (width, clear) in [(DOOR[0], CLEAR), (DOOR[0], TIGHT), (NARROW, TIGHT)] {
        for garages in [false, true] {
            for side in sides {
                for strip in &walls.strips[place(*side)] {
                    let grounds = strip
                        .rooms
                        .iter()
                        .filter(|r| r.piece.floor == 0 && r.fixed.is_none());
                    for room in grounds.filter(|r| on_garage(building, r) == garages) {
                        let reach = [strip.start + clear, strip.end - clear];
                        let places = places(reach, within, width);
                        let fits = |at: f64| {
                            let span = [at - width / 2.0, at + width / 2.0];
                            is_bare(walls.within(room, span, clear))
                        };
                        let mut fitting = places.into_iter().filter(|at| fits(*at));
                        if fitting.any(|at| hang(pieces, *side, at, width, clear)) {
                            return true;
                        }
                    }
                }
            }
        }
    }
    false
}

/// Middles of a door of a width on a wall, from the middle of what is shared with the porch outwards; below a porch the
/// middle of the door is.
fn places(reach: [f64; 2], within: Option<[f64; 2]>, width: f64) -> Vec<f64> {
    let half = width / 2.0;
    let porch = within.map_or(reach, |w| [w[0] + INSIDE, w[1] - INSIDE]);
    let low = (reach[0] + half).max(porch[0]);
    let high = (reach[1] - half).min(porch[1]);
    let steps = ((high - low) / STEP).floor();
    if steps.is_nan() || steps < 0.0 {
        return Vec::new();
    }
    let mut places: Vec<f64> = (0..=steps as usize)
        .map(|k| low + k as f64 * STEP)
        .collect();
    let middle = (low + high) / 2.0;
    places.push(middle);
    places.sort_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()));
    places
}

/// Hangs a door on the one piece of the ground floor at a place; `false` where there are several, behind each other.
fn hang(pieces: &mut [FacadePiece], side: Side, at: f64, width: f64, clear: f64) -> bool {
    let half = width / 2.0;
    let margin = half + clear / 2.0;
    let here = |p: &&mut FacadePiece| {
        let reach = p.start <= at - margin && at + margin <= p.start + p.width;
        p.side == side && p.base < 1e-6 && reach && p.height >= DOOR[1]
    };
    let mut own: Vec<&mut FacadePiece> = pieces.iter_mut().filter(here).collect();
    let [piece] = own.as_mut_slice() else {
        return false;
    };
    let x = at - piece.start - half;
    let clear = |e: &FacadeElement| e.x + e.width < x - BESIDE || e.x > x + width + BESIDE;
    piece.elements.retain(clear);
    piece.elements.push(FacadeElement {
        style: ElementStyle::Door,
        x: millimetres(x),
        y: 0.0,
        width,
        height: DOOR[1],
    });
    true
}
