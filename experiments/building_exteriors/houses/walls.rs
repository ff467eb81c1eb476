//! Walls with windows and doors that have the drawn window-to-wall ratio, symmetry and alignment.
//!
//! Each side is cut into vertical strips wherever the outline of some floor has a corner; the wall
//! of one floor in one strip is a facade piece. A strip is symmetric or not on all its floors; one
//! strip of a side is cut in two so that the symmetric share comes out as drawn.

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

use super::draw::Numbers;
use super::plan::{Plan, millimetres};
use super::styles::Kinds;
use crate::shape::{
    BoxStyle, ElementStyle, FacadeElement, FacadePiece, MassBox, PlanUnion, Rect, Side,
};

/// Narrowest strip with windows, and narrowest that can be seen to be asymmetric (m).
const NARROWEST: f64 = 1.2;
const NARROWEST_FREE: f64 = 1.6;
/// Thinnest strip that a cut may leave, blank (m).
const THINNEST: f64 = 0.3;
/// Usual distance between windows (m).
const SPACING: f64 = 2.4;
/// Width and height of a window and of a door (m).
const WINDOW: (f64, f64) = (1.1, 1.3);
const DOOR: (f64, f64) = (1.0, 2.1);
/// Height of the centre of a window above its floor, and its greatest height (m).
const EYE: f64 = 1.5;
const TALLEST: f64 = 2.3;

/// A strip of one side, from the ground up.
#[derive(Debug, Clone)]
struct Strip {
    side: Side,
    start: f64,
    end: f64,
    /// The floor of each piece of wall in the strip.
    floors: Vec<usize>,
    symmetric: bool,
    door: bool,
    style: ElementStyle,
}

impl Strip {
    fn width(&self) -> f64 {
        self.end - self.start
    }

    fn area(&self) -> f64 {
        self.width() * self.floors.len() as f64
    }
}

/// The facade pieces, or `None` when the numbers cannot be met.
pub(super) fn build(
    plan: &Plan,
    numbers: &Numbers,
    kinds: &Kinds,
    rng: &mut impl Rng,
) -> Option<Vec<FacadePiece>> {
    let outlines: Vec<_> = (0..numbers.floors).map(|k| outline(plan, k)).collect();
    let mut strips = Vec::new();
    for (side, symmetry) in Side::ALL.into_iter().zip(numbers.symmetry) {
        strips.extend(make_symmetric(cut(side, &outlines), symmetry)?);
    }
    let front = |s: &&mut Strip| s.side == Side::Front && s.width() >= NARROWEST_FREE;
    let narrowest = strips.iter_mut().filter(front);
    narrowest
        .min_by(|a, b| a.width().total_cmp(&b.width()))?
        .door = true;
    choose_styles(&mut strips, &kinds.windows, rng)?;

    let mut pieces = Vec::new();
    for (side, ratio) in Side::ALL.into_iter().zip(numbers.wwr) {
        let aligned = match kinds.alignment {
            0 => true,
            1 => matches!(side, Side::Front | Side::Back),
            _ => false,
        };
        let strips: Vec<&Strip> = strips.iter().filter(|s| s.side == side).collect();
        pieces.extend(glaze(&strips, aligned, ratio, plan.floor_height)?);
    }
    Some(pieces)
}

/// Outline of the walls of floor `k`: porches have none.
fn outline(plan: &Plan, k: usize) -> Vec<crate::shape::PlanEdge> {
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

/// The strips of a side, all symmetric so far.
fn cut(side: Side, outlines: &[Vec<crate::shape::PlanEdge>]) -> Vec<Strip> {
    let edges = || {
        let floors = outlines.iter().enumerate();
        floors.flat_map(move |(k, edges)| {
            edges
                .iter()
                .filter(move |e| e.side == side)
                .map(move |e| (k, e))
        })
    };
    let mut corners: Vec<f64> = edges().flat_map(|(_, e)| [e.start, e.end]).collect();
    corners.sort_by(f64::total_cmp);
    corners.dedup_by(|next, kept| *next - *kept < 1e-3);
    let strips = corners.windows(2).map(|w| {
        let middle = (w[0] + w[1]) / 2.0;
        let here = edges().filter(|(_, e)| e.start < middle && middle < e.end);
        Strip {
            side,
            start: millimetres(w[0]),
            end: millimetres(w[1]),
            floors: here.map(|(k, _)| k).collect(),
            symmetric: true,
            door: false,
            style: ElementStyle::Fixed,
        }
    });
    strips.filter(|s| !s.floors.is_empty()).collect()
}

/// Makes some strips asymmetric, one of them cut in two, so that the symmetric share of the area is
/// `share`; `None` when the strips do not allow it.
fn make_symmetric(mut strips: Vec<Strip>, share: f64) -> Option<Vec<Strip>> {
    let total: f64 = strips.iter().map(Strip::area).sum();
    let wanted = (1.0 - share) * total;
    let mut free: Vec<usize> = (0..strips.len())
        .filter(|&i| strips[i].width() >= NARROWEST_FREE)
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
                let width = (wanted - area) / strips[split].floors.len() as f64;
                let rest = strips[split].width() - width;
                (width >= NARROWEST_FREE && rest >= THINNEST).then_some((mask, split, width))
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

/// Gives every strip with windows a window style, every present style at least one strip.
fn choose_styles(strips: &mut [Strip], styles: &[ElementStyle], rng: &mut impl Rng) -> Option<()> {
    // A door takes the place of the only window of its strip on the ground floor.
    let has_windows = |s: &&mut Strip| s.width() >= NARROWEST && !s.door;
    let mut glazed: Vec<&mut Strip> = strips.iter_mut().filter(has_windows).collect();
    if glazed.len() < styles.len() {
        return None;
    }
    glazed.shuffle(rng);
    for (i, strip) in glazed.into_iter().enumerate() {
        strip.style = match styles.get(i) {
            Some(style) => *style,
            None => styles[rng.random_range(0..styles.len())],
        };
    }
    for strip in strips.iter_mut().filter(|s| s.door) {
        strip.style = styles[0];
    }
    Some(())
}

/// Distance of edges and centres that are not in line (m).
const APART: f64 = 0.07;
/// Most steps towards the middle, and how much closer one step brings.
const CLOSER: usize = 12;
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
fn glaze(strips: &[&Strip], aligned: bool, ratio: f64, floor: f64) -> Option<Vec<FacadePiece>> {
    let mut pieces = Vec::new();
    let mut slots = Vec::new();
    for strip in strips {
        let mut door = strip.door;
        for &k in &strip.floors {
            let here = door && k == 0;
            let widest_and_centres = centres(strip, k, aligned);
            for (centre, widest) in widest_and_centres {
                slots.push(Slot {
                    piece: pieces.len(),
                    centre,
                    widest,
                    style: if here {
                        ElementStyle::Door
                    } else {
                        strip.style
                    },
                });
            }
            door = door && k != 0;
            pieces.push(FacadePiece {
                side: strip.side,
                start: strip.start,
                base: millimetres(k as f64 * floor),
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

/// Whether each mark (left edge, centre, right edge) of the fewer windows meets one of the others.
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
    let usual = if strip.door {
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
