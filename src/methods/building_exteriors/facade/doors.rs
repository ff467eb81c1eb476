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
    // The house is entered in front; other sides have a door for a porch only.
    if side != Side::Front {
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

pub(super) fn place(side: Side) -> usize {
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
    let free = walls.free(room, span);
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

/// Puts a door where a house has none: on the first wall with room, in front before the sides and the back. Windows in its place are left out.
/// The side that it is on, if it is new.
pub(super) fn entered(
    building: &Building,
    walls: &Walls,
    pieces: &mut [FacadePiece],
) -> Option<Side> {
    let sides = [Side::Front, Side::Left, Side::Right, Side::Back];
    match has_door(pieces, None) {
        true => None,
        false => put(building, walls, pieces, &sides, None),
    }
}

/// Puts a door behind the porch of a side if none leads to it, in place of windows; true if there is one more.
pub(super) fn porch_door(
    building: &Building,
    walls: &Walls,
    pieces: &mut [FacadePiece],
    side: Side,
) -> bool {
    let Some(plan) = porch(building, side).map(MassBox::plan) else {
        return false;
    };
    let span = [plan.x, plan.right()];
    !has_door(pieces, Some((side, span)))
        && put(building, walls, pieces, &[side], Some(span)).is_some()
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

fn put(
    building: &Building,
    walls: &Walls,
    pieces: &mut [FacadePiece],
    sides: &[Side],
    within: Option<[f64; 2]>,
) -> Option<Side> {
    let half = DOOR[0] / 2.0;
    for garages in [false, true] {
        for side in sides {
            for strip in &walls.strips[place(*side)] {
                let grounds = strip
                    .rooms
                    .iter()
                    .filter(|r| r.piece.floor == 0 && r.fixed.is_none());
                for room in grounds.filter(|r| on_garage(building, r) == garages) {
                    let [low, high] = within.map_or([strip.start, strip.end], |w| {
                        [w[0].max(strip.start), w[1].min(strip.end)]
                    });
                    let (low, high) = (low + half + CLEAR, high - half - CLEAR);
                    let steps = ((high - low) / STEP).floor();
                    if steps.is_nan() || steps < 0.0 {
                        continue;
                    }
                    let mut places: Vec<f64> = (0..=steps as usize)
                        .map(|k| low + k as f64 * STEP)
                        .collect();
                    let middle = (low + high) / 2.0;
                    places.push(middle);
                    places.sort_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()));
                    let place = places.into_iter().find(|at| is_free(walls, room, *at));
                    if place.is_some_and(|at| hang(pieces, strip, *side, at)) {
                        return Some(*side);
                    }
                }
            }
        }
    }
    None
}

/// Hangs a door on the piece of the ground floor at a place: of several behind each other, the one of the strip; `false`
/// where it cannot be told.
fn hang(pieces: &mut [FacadePiece], strip: &Strip, side: Side, at: f64) -> bool {
    let half = DOOR[0] / 2.0;
    let here = |p: &&mut FacadePiece| {
        let reach =
            p.start <= at - half - CLEAR / 2.0 && at + half + CLEAR / 2.0 <= p.start + p.width;
        p.side == side && p.base < 1e-6 && reach && p.height >= DOOR[1]
    };
    let mut own: Vec<&mut FacadePiece> = pieces.iter_mut().filter(here).collect();
    if own.len() > 1 {
        let near = |a: f64, b: f64| (a - b).abs() < 2e-3;
        own.retain(|p| near(p.start, strip.start) && near(p.width, strip.width()));
    }
    let [piece] = own.as_mut_slice() else {
        return false;
    };
    let x = at - piece.start - half;
    let clear = |e: &FacadeElement| e.x + e.width < x - BESIDE || e.x > x + DOOR[0] + BESIDE;
    piece.elements.retain(clear);
    piece.elements.push(FacadeElement {
        style: ElementStyle::Door,
        x: millimetres(x),
        y: 0.0,
        width: DOOR[0],
        height: DOOR[1],
    });
    true
}
