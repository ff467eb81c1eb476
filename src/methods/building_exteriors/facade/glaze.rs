//! Windows on the strips of one side, at one scale that gives the wanted window-to-wall ratio.

use super::room::{CLEAR, EYE, Room, Strip, Walls};
use edifice_shape::{ElementStyle, FacadeElement, FacadePiece};

/// Width and height of a window at scale 1, the medians of 101,549 windows of audited Canadian houses, and of a door (m).
pub(super) const WINDOW: [f64; 2] = [0.91, 1.22];
pub(super) const DOOR: [f64; 2] = [1.0, 2.1];
/// Coefficient and exponent of the usual number of windows of a side on its glazed area (square metres): least squares of
/// the logarithms over the 17,361 glazed sides of 4,874 audited Canadian houses, windows of basements left out.
const COUNT: [f64; 2] = [1.27, 0.603];
/// Tallest window (m).
const TALLEST: f64 = 2.2;
/// Narrowest piece with a window, and narrowest window (m).
const NARROWEST: f64 = 0.85;
pub(super) const SLIMMEST: f64 = 0.35;

/// Number of windows that a side with this area of windows (square metres) usually has.
pub(super) fn usual_count(area: f64) -> f64 {
    COUNT[0] * area.max(0.0).powf(COUNT[1])
}

/// The plan by which a strip is furnished.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Furnishing {
    pub symmetric: bool,
    pub aligned: bool,
    pub style: ElementStyle,
    pub door: bool,
}

/// A window whose size is open.
struct Slot {
    piece: usize,
    centre: f64,
    widest: f64,
    free: [f64; 2],
    style: ElementStyle,
}

/// The pieces of a side with windows that cover `ratio` of it as nearly as the walls allow. `spacing` is the usual
/// distance between windows.
pub(super) fn glaze(
    walls: &Walls,
    strips: &[Strip],
    plans: &[Furnishing],
    ratio: f64,
    spacing: f64,
) -> Vec<FacadePiece> {
    let mut pieces = Vec::new();
    let mut slots: Vec<Slot> = Vec::new();
    for (strip, plan) in strips.iter().zip(plans) {
        let mut has_door = false;
        for room in &strip.rooms {
            let index = pieces.len();
            if let Some(fixed) = &room.fixed {
                pieces.push(fixed.clone());
                continue;
            }
            pieces.push(FacadePiece {
                side: room.piece.side,
                start: millimetres(strip.start),
                base: room.piece.floor as f64 * walls.floor_height,
                width: millimetres(strip.width()),
                height: walls.floor_height,
                elements: Vec::new(),
            });
            let mut own = openings(walls, strip, room, plan, spacing);
            let door = plan.door && room.piece.floor == 0 && !has_door;
            if let Some(k) = door
                .then(|| door_place(walls, strip, room, plan, &own))
                .flatten()
            {
                has_door = true;
                own[k].style = ElementStyle::Door;
            }
            slots.extend(own.into_iter().map(|slot| Slot {
                piece: index,
                ..slot
            }));
        }
    }
    let walls_area: f64 = pieces.iter().map(FacadePiece::area).sum();
    let fixed = pieces.iter().flat_map(|p| &p.elements);
    let fixed: f64 = fixed.map(|e| e.width * e.height).sum();
    let covered = |scale: f64| {
        let areas = slots.iter().map(|s| s.size(scale)).map(|[w, h]| w * h);
        (fixed + areas.sum::<f64>()) / walls_area
    };
    let (mut low, mut high) = (0.25, 4.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if covered(middle) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    for slot in &slots {
        let [width, height] = slot.size(low);
        let y = match slot.style {
            ElementStyle::Door => 0.0,
            _ => (EYE - height / 2.0)
                .min(slot.free[1] - height)
                .max(slot.free[0]),
        };
        pieces[slot.piece].elements.push(FacadeElement {
            style: slot.style,
            x: millimetres(slot.centre - width / 2.0),
            y: millimetres(y),
            width: millimetres(width),
            height: millimetres(height),
        });
    }
    pieces
}

/// Places for windows on a piece, all of one size: those that the wall has room for and, on a symmetric piece, whose
/// mirror images it has room for, too.
fn openings(
    walls: &Walls,
    strip: &Strip,
    room: &Room,
    plan: &Furnishing,
    spacing: f64,
) -> Vec<Slot> {
    let places = centres(strip.width(), room.piece.floor, plan, spacing);
    let Some(&(_, widest)) = places.first() else {
        return Vec::new();
    };
    let free = |centre: f64, width: f64| {
        let at = strip.start + centre;
        walls.free(room, [at - width / 2.0, at + width / 2.0])
    };
    let slim = SLIMMEST.min(widest);
    let bare: Vec<bool> = places
        .iter()
        .map(|(c, _)| free(*c, slim).is_some())
        .collect();
    let kept: Vec<f64> = (0..places.len())
        .filter(|&k| bare[k] && (!plan.symmetric || bare[places.len() - 1 - k]))
        .map(|k| places[k].0)
        .collect();
    // As wide as all of them can be in walls bare at the same heights.
    for share in [1.0, 0.8, 0.62, 0.48, 0.36, 0.0] {
        let width = (widest * share).max(slim);
        let mut band = [f64::NEG_INFINITY, f64::INFINITY];
        let all = kept.iter().all(|c| match free(*c, width) {
            Some(free) => {
                band = [band[0].max(free[0]), band[1].min(free[1])];
                band[1] - band[0] > 0.35
            }
            None => false,
        });
        if all {
            let slot = |centre: &f64| Slot {
                piece: 0,
                centre: *centre,
                widest: width,
                free: band,
                style: plan.style,
            };
            return kept.iter().map(slot).collect();
        }
    }
    Vec::new()
}

/// True if some window can stand on a piece off its middle.
pub(super) fn holds_asymmetric(walls: &Walls, strip: &Strip, room: &Room, spacing: f64) -> bool {
    let plan = Furnishing {
        symmetric: false,
        aligned: true,
        style: ElementStyle::Fixed,
        door: false,
    };
    !openings(walls, strip, room, &plan, spacing).is_empty()
}

/// Index of the window of the ground floor that becomes the door: the middle one, or the first that has room.
fn door_place(
    walls: &Walls,
    strip: &Strip,
    room: &Room,
    plan: &Furnishing,
    slots: &[Slot],
) -> Option<usize> {
    let fits = |k: &usize| {
        let at = strip.start + slots[*k].centre;
        let inside = slots[*k].centre - DOOR[0] / 2.0 >= CLEAR
            && slots[*k].centre + DOOR[0] / 2.0 <= strip.width() - CLEAR;
        let others = (0..slots.len()).filter(|j| j != k);
        let mut gaps = others.map(|j| (slots[j].centre - slots[*k].centre).abs());
        let free = walls.free(room, [at - DOOR[0] / 2.0, at + DOOR[0] / 2.0]);
        inside && gaps.all(|gap| gap > 1.3) && free.is_some_and(|f| f[1] >= DOOR[1])
    };
    let middle = slots.len() / 2;
    match plan.symmetric {
        true => (slots.len() % 2 == 1).then_some(middle).filter(fits),
        false => (0..slots.len()).find(fits),
    }
}

/// Centres and greatest widths of the windows of a piece.
fn centres(width: f64, floor: usize, plan: &Furnishing, spacing: f64) -> Vec<(f64, f64)> {
    if width < NARROWEST {
        return Vec::new();
    }
    let most = ((width - CLEAR) / (SLIMMEST + 2.0 * CLEAR)) as usize;
    // A strip much narrower than the usual distance is left bare, unless something has to stand on it.
    let least = usize::from(plan.door || !plan.symmetric);
    let mut count = ((width / spacing).round() as usize).clamp(least, most.max(1));
    if plan.door {
        // An odd number, so that the door stands in the middle, and room for it.
        count = count.min((width / 1.4) as usize).max(1);
        count -= usize::from(plan.symmetric && count.is_multiple_of(2));
    }
    // Where floors are not to stand in line they have other numbers of windows, or none.
    if !plan.aligned && floor > 0 {
        count = match (floor, count) {
            (1, n) if n < most => n + 1,
            (1, n) if n > 1 => n - 1,
            _ => 0,
        };
    }
    let (from, room) = match plan.symmetric {
        true => (0.0, width),
        // Towards one end, the other end left bare.
        false => (0.0, width * 0.8),
    };
    let cell = room / count.max(1) as f64;
    let widest = (cell - 2.0 * CLEAR).max(SLIMMEST);
    (0..count)
        .map(|k| (from + (k as f64 + 0.5) * cell, widest))
        .collect()
}

impl Slot {
    fn size(&self, scale: f64) -> [f64; 2] {
        if self.style == ElementStyle::Door {
            return DOOR;
        }
        [
            (WINDOW[0] * scale)
                .min(self.widest)
                .max(SLIMMEST.min(self.widest)),
            (WINDOW[1] * scale)
                .min(TALLEST)
                .min(self.free[1] - self.free[0]),
        ]
    }
}

/// Rounded to whole millimetres.
pub(super) fn millimetres(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
