//! A generator of facades with the variety of real ones, from which a model may be learnt beside real ones.
//!
//! A generated facade has a pattern of bays (equal, in turn, in pairs, or wide in the middle, nearly always symmetric), floors
//! whose heights and window heights follow from their place (ground floor, main floors, attic), balconies (none, of single
//! windows, of whole floors), and a ground floor of its own: windows, shops or nothing, with a door in the middle, at a side or
//! between two bays. A few windows are missing, and everything is drawn with the small errors of an annotation.
//! Lengths are in units of a floor's height; only ratios matter to what is learnt.

use rand::RngExt;

use crate::layout::{Class, Element, Layout};
use edifice_base::rng::{Stream, categorical, stream};
use edifice_shape::Rect;

/// The bays of a facade: centres and widths of their windows.
struct Bays {
    at: Vec<f64>,
    wide: Vec<f64>,
    width: f64,
}

fn bays(rng: &mut Stream) -> Bays {
    let count = rng.random_range(2..=11_usize);
    let window = rng.random_range(0.25..0.55);
    let gap = window * rng.random_range(0.35..2.2);
    let other = gap * rng.random_range(0.4..2.5);
    let mut gaps = vec![gap; count - 1];
    let mut wide = vec![window; count];
    match categorical(&[0.45, 0.15, 0.15, 0.15, 0.1], rng) {
        // In turn, in pairs.
        1 => (0..count - 1)
            .filter(|k| k % 2 == 1)
            .for_each(|k| gaps[k] = other),
        // Wider gaps about the middle.
        2 => {
            let middle = count / 2;
            if middle > 0 {
                gaps[middle - 1] = other;
                gaps[count - 1 - middle] = other;
            }
        }
        // A wide middle bay.
        3 => wide[count / 2] *= rng.random_range(1.2..2.0),
        // Wide outer bays.
        4 => {
            let by = rng.random_range(0.7..1.8);
            wide[0] *= by;
            wide[count - 1] *= by;
        }
        _ => {}
    }
    // Nearly all are symmetric.
    if rng.random_bool(0.85) {
        for k in 0..count / 2 {
            wide[count - 1 - k] = wide[k];
        }
        for k in 0..(count - 1) / 2 {
            gaps[count - 2 - k] = gaps[k];
        }
    }
    let margin = window * rng.random_range(0.25..1.6);
    let (mut x, mut at) = (margin, Vec::with_capacity(count));
    for (k, own) in wide.iter().enumerate() {
        at.push(x + own / 2.0);
        x += own + gaps.get(k).copied().unwrap_or(0.0);
    }
    let right = match rng.random_bool(0.8) {
        true => margin,
        false => window * rng.random_range(0.25..1.6),
    };
    Bays {
        at,
        wide,
        width: x + right,
    }
}

/// The balconies of a floor.
#[derive(Clone, Copy, PartialEq)]
enum Balconies {
    None,
    Single,
    Running,
    /// Before the windows of the middle.
    Middle,
}

/// So many facades; the first ones do not depend on how many there are.
pub fn several(count: usize, seed: u64) -> Vec<Layout> {
    let one = |k: usize| facade(k, &mut stream(seed, "made facades", k as u64));
    (0..count).map(one).collect()
}

/// A facade drawn by the rules of this module; `index` only names it.
pub fn facade(index: usize, rng: &mut Stream) -> Layout {
    let bays = bays(rng);
    let (count, width) = (bays.at.len(), bays.width);
    let floors = rng.random_range(2..=7_usize);
    let mut elements: Vec<Element> = Vec::new();
    let ground = rng.random_range(0.85..1.6);
    let own_ground = rng.random_bool(0.75);
    let mut y = if own_ground { ground } else { 0.0 };
    let window_high = rng.random_range(0.45..0.72);
    let sill = rng.random_range(0.1..0.3);
    let balcony_style = match categorical(&[0.45, 0.2, 0.15, 0.2], rng) {
        0 => [Balconies::None; 3],
        1 => [Balconies::Single, Balconies::Single, Balconies::None],
        2 => [Balconies::Middle, Balconies::Middle, Balconies::Middle],
        // Of whole floors: the first above the ground and the last but one.
        _ => [Balconies::Running, Balconies::Single, Balconies::Running],
    };
    let balcony_high = rng.random_range(0.18..0.4);
    let balcony_wider = bays.wide[0] * rng.random_range(0.0..0.3);
    let attic = rng.random_bool(0.3);
    let shrink = rng.random_range(0.9..1.0);
    let mut high = window_high;
    for floor in 0..floors {
        let top = floor + 1 == floors;
        let by: f64 = if attic && top {
            rng.random_range(0.55..0.9)
        } else {
            1.0
        };
        let tall = high * by;
        let low = y + sill;
        let kind = match (floor, top) {
            (0, _) => balcony_style[0],
            (_, true) => Balconies::None,
            (f, _) if f + 2 == floors => balcony_style[2],
            _ => balcony_style[1],
        };
        for k in 0..count {
            if rng.random_bool(0.015) {
                continue;
            }
            let wide = bays.wide[k] * if attic && top { by.sqrt() } else { 1.0 };
            let x = bays.at[k] - wide / 2.0;
            elements.push(Element::new(Class::Window, Rect::new(x, low, wide, tall)));
            let middle = k == count / 2 || k == (count - 1) / 2;
            if kind == Balconies::Single || (kind == Balconies::Middle && middle) {
                let wide = wide + balcony_wider;
                let rect = Rect::new(bays.at[k] - wide / 2.0, low - 0.04, wide, balcony_high);
                elements.push(Element::new(Class::Balcony, rect));
            }
        }
        if kind == Balconies::Running {
            let x = bays.at[0] - bays.wide[0];
            let x = x.max(0.01 * width);
            let rect = Rect::new(x, low - 0.04, width - 2.0 * x, balcony_high);
            elements.push(Element::new(Class::Balcony, rect));
        }
        y += 1.0 * by.max(0.75);
        high *= shrink;
    }
    let height = y + rng.random_range(0.02..0.45);
    if own_ground {
        ground_floor(&bays, ground, &mut elements, rng);
    } else {
        door(&bays, rng.random_range(0.6..0.95), &mut elements, rng);
    }
    annotated(format!("made_{index}"), width, height, elements, rng)
}

/// Puts a door on the ground, in place of what is there.
fn door(bays: &Bays, high: f64, elements: &mut Vec<Element>, rng: &mut Stream) {
    let count = bays.at.len();
    let bay = match categorical(&[0.5, 0.25, 0.25], rng) {
        0 => count / 2,
        1 => [0, count - 1][usize::from(rng.random_bool(0.5))],
        _ => rng.random_range(0..count),
    };
    // An even number of bays has its middle between two of them.
    let between = count.is_multiple_of(2) && bay == count / 2 && count > 1 && rng.random_bool(0.5);
    let x = match between {
        true => (bays.at[bay] + bays.at[bay - 1]) / 2.0,
        false => bays.at[bay],
    };
    // A door with its frame is seldom narrower than a window, a gateway twice as wide.
    let wide = bays.wide[bay] * rng.random_range(0.9..2.0);
    let left = (x - wide / 2.0).clamp(0.0, (bays.width - wide).max(0.0));
    let door = Element::new(Class::Door, Rect::new(left, 0.0, wide, high));
    elements.retain(|e| e.rect.overlap(&door.rect) <= 0.0);
    elements.push(door);
}

fn ground_floor(bays: &Bays, ground: f64, elements: &mut Vec<Element>, rng: &mut Stream) {
    let high = ground * rng.random_range(0.55..0.9);
    let kind = categorical(&[0.45, 0.4, 0.15], rng);
    let pair = bays.at.len() > 3 && rng.random_bool(0.35);
    let low = ground * rng.random_range(0.15..0.35);
    for k in 0..bays.at.len() {
        match kind {
            0 => {
                let rect = Rect::new(
                    bays.at[k] - bays.wide[k] / 2.0,
                    low,
                    bays.wide[k],
                    high - low,
                );
                elements.push(Element::new(Class::Window, rect));
            }
            1 if !pair || k % 2 == 0 => {
                let next = if pair { bays.at.get(k + 1) } else { None };
                let left = bays.at[k] - 0.65 * bays.wide[k];
                let end = next.map_or(bays.at[k] + 0.65 * bays.wide[k], |x| x + 0.6 * bays.wide[k]);
                let rect = Rect::new(
                    left.max(0.0),
                    0.0,
                    end.min(bays.width) - left.max(0.0),
                    high,
                );
                elements.push(Element::new(Class::Shop, rect));
            }
            _ => {}
        }
    }
    if rng.random_bool(0.9) {
        let door_high = high * rng.random_range(0.85..1.15);
        door(bays, door_high, elements, rng);
    }
}

/// The facade with errors of an annotation: each edge is off by about a hundredth of the element, for some not at all.
fn annotated(
    name: String,
    width: f64,
    height: f64,
    elements: Vec<Element>,
    rng: &mut Stream,
) -> Layout {
    let (width, height) = (rounded(width), rounded(height));
    let error = [0.0, 0.008, 0.02][categorical(&[0.35, 0.4, 0.25], rng)];
    let mut kept: Vec<Element> = Vec::new();
    for element in elements {
        let r = element.rect;
        let mut off =
            |extent: f64| extent * error * (rng.random::<f64>() + rng.random::<f64>() - 1.0);
        let (x, y) = (
            (r.x + off(r.width)).max(0.0),
            (r.y + off(r.height)).max(0.0),
        );
        let (right, top) = (r.right() + off(r.width), r.top() + off(r.height));
        let [x, y, right, top] = [x, y, right.min(width), top.min(height)].map(rounded);
        let rect = Rect::new(x, y, rounded(right - x), rounded(top - y));
        let own = Element::new(element.class, rect);
        let room = rect.width > 0.0 && rect.height > 0.0;
        if room && !kept.iter().any(|k| k.excludes(&own)) {
            kept.push(own);
        }
    }
    Layout {
        name,
        width,
        height,
        elements: kept,
    }
}

/// To ten thousandths of a floor: short in files.
fn rounded(length: f64) -> f64 {
    (length * 1e4).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::scope::in_scope;

    #[test]
    fn facades_are_whole_layouts_and_differ() {
        let made = several(200, 3);
        for layout in &made {
            for (k, e) in layout.elements.iter().enumerate() {
                let r = e.rect;
                assert!(r.x >= 0.0 && r.y >= 0.0 && r.width > 0.0 && r.height > 0.0);
                assert!(r.right() <= layout.width + 1e-9 && r.top() <= layout.height + 1e-9);
                assert!(
                    !layout.elements[..k].iter().any(|o| o.excludes(e)),
                    "{}",
                    layout.name
                );
            }
        }
        let share = |test: &dyn Fn(&Layout) -> bool| {
            made.iter().filter(|l| test(l)).count() as f64 / made.len() as f64
        };
        assert!(share(&in_scope) > 0.6);
        assert!(share(&|l| l.count(Class::Door) == 1) > 0.8);
        for class in [Class::Balcony, Class::Shop] {
            let some = share(&|l| l.count(class) > 0);
            assert!(some > 0.2 && some < 0.8, "{class:?} {some}");
        }
    }
}
