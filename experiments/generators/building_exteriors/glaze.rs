//! Windows and doors of a side, sized for its window-to-wall ratio.

use super::lengths::millimetres;
use super::strips::{NARROWEST, Strip, Use};
use edifice_shape::{ElementStyle, FacadeElement, FacadePiece};

/// Usual distance between windows (m).
const SPACING: f64 = 2.4;
/// Width and height of a window and of a door (m).
const WINDOW: (f64, f64) = (1.1, 1.3);
const DOOR: (f64, f64) = (1.0, 2.1);
/// Height of the centre of a window above its floor, and its greatest height (m).
const EYE: f64 = 1.5;
const TALLEST: f64 = 2.2;
/// Narrowest window (m).
const SLIMMEST: f64 = 0.26;

/// Distance of edges and centres that are not in line (m).
const APART: f64 = 0.07;
/// Most steps towards the middle, and how much closer one step brings.
const CLOSER: usize = 5;
const CLOSER_BY: f64 = 0.95;
/// Most rounds of moving windows and sizing them anew.
const ROUNDS: usize = 4;

/// An element whose size is still open.
struct Slot {
    piece: usize,
    centre: f64,
    widest: f64,
    style: ElementStyle,
}

/// Sizes the windows of a side so that they cover `ratio` of its walls.
pub(super) fn glaze(
    strips: &[&Strip],
    aligned: bool,
    ratio: f64,
    floor: f64,
) -> Option<Vec<FacadePiece>> {
    let mut pieces = Vec::new();
    let mut slots = Vec::new();
    for strip in strips {
        for wall in &strip.walls {
            let style = match wall.usage {
                Use::Windows => Some(strip.style),
                Use::Door => Some(ElementStyle::Door),
                Use::Blank => None,
            };
            if let Some(style) = style {
                for (centre, widest) in centres(strip, wall.floor, aligned) {
                    slots.push(Slot {
                        piece: pieces.len(),
                        centre,
                        widest,
                        style,
                    });
                }
            }
            pieces.push(FacadePiece {
                side: strip.side,
                start: strip.start,
                base: millimetres(wall.floor as f64 * floor),
                width: millimetres(strip.width()),
                height: floor,
                elements: Vec::new(),
            });
        }
    }
    let walls: f64 = pieces.iter().map(FacadePiece::area).sum();
    let mut scale = scale_for(ratio, &slots, walls)?;
    for _ in 0..ROUNDS {
        if aligned || !set_apart(&mut slots, &pieces, scale) {
            break;
        }
        scale = scale_for(ratio, &slots, walls)?;
    }
    if slots.iter().any(|s| s.size(scale).0 < SLIMMEST) {
        return None;
    }
    for slot in &slots {
        let (width, height) = slot.size(scale);
        let below = if slot.style == ElementStyle::Door {
            0.0
        } else {
            EYE - height / 2.0
        };
        pieces[slot.piece].elements.push(FacadeElement {
            style: slot.style,
            x: millimetres(slot.centre - width / 2.0),
            y: millimetres(below),
            width: millimetres(width),
            height: millimetres(height),
        });
    }
    Some(pieces)
}

/// The scale of the windows at which they cover `ratio` of the walls; `None` where none does.
fn scale_for(ratio: f64, slots: &[Slot], walls: f64) -> Option<f64> {
    let covered = |scale: f64| {
        let areas = slots.iter().map(|s| s.size(scale)).map(|(w, h)| w * h);
        areas.sum::<f64>() / walls
    };
    let (mut low, mut high) = (0.2, 4.0);
    if !(covered(low)..covered(high)).contains(&ratio) {
        return None;
    }
    for _ in 0..50 {
        let middle = (low + high) / 2.0;
        if covered(middle) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// Moves the windows of upper floors together, about the middle of their piece, where all of them
/// happen to stand in line with those of a piece below; whether it moved any. They get narrower as
/// they get closer, so that the scale has to be found anew.
fn set_apart(slots: &mut [Slot], pieces: &[FacadePiece], scale: f64) -> bool {
    let marks = |slots: &[Slot], p: usize| -> Vec<[f64; 3]> {
        let own = slots.iter().filter(|s| s.piece == p);
        let marks = own.map(|s| {
            let half = s.size(scale).0 / 2.0;
            [s.centre - half, s.centre, s.centre + half]
        });
        marks.collect()
    };
    let mut moved = false;
    for upper in 1..pieces.len() {
        for lower in (0..upper).filter(|&p| pieces[p].start == pieces[upper].start) {
            let middle = pieces[upper].width / 2.0;
            for _ in 0..CLOSER {
                if !in_line(marks(slots, lower), marks(slots, upper)) {
                    break;
                }
                moved = true;
                for slot in slots.iter_mut().filter(|s| s.piece == upper) {
                    slot.centre = middle + CLOSER_BY * (slot.centre - middle);
                    slot.widest *= CLOSER_BY;
                }
            }
        }
    }
    moved
}

/// True if each mark (left edge, centre, right edge) of the fewer windows meets one of the others.
fn in_line(a: Vec<[f64; 3]>, b: Vec<[f64; 3]>) -> bool {
    let (few, many) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    let meet = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).any(|(a, b)| (a - b).abs() < APART);
    !few.is_empty() && few.iter().all(|a| many.iter().any(|b| meet(a, b)))
}

impl Slot {
    fn size(&self, scale: f64) -> (f64, f64) {
        if self.style == ElementStyle::Door {
            return DOOR;
        }
        (
            (WINDOW.0 * scale).min(self.widest),
            (WINDOW.1 * scale).min(TALLEST),
        )
    }
}

/// Centres and greatest widths of the windows of a strip on floor `k`. On an aligned side all
/// floors have the same centres; else upper floors have one window more than the ground floor.
fn centres(strip: &Strip, k: usize, aligned: bool) -> Vec<(f64, f64)> {
    let width = strip.width();
    if width < NARROWEST {
        return Vec::new();
    }
    let usual = if strip.has_door() {
        1
    } else {
        ((width / SPACING).round() as usize).clamp(1, 4)
    };
    let count = if aligned { usual } else { usual + k.min(1) };
    let spacing = width / count as f64;
    // Very narrow windows look like loopholes.
    if spacing < 0.8 {
        return Vec::new();
    }
    let (shift, widest) = if strip.symmetric {
        (0.5, 0.8 * spacing)
    } else {
        (0.32, 0.64 * spacing - 0.16)
    };
    let centre = |i: usize| (i as f64 + shift) * spacing;
    (0..count).map(|i| (centre(i), widest)).collect()
}
