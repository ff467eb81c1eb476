//! The ground floor that a layout leaves empty.
//!
//! A ground floor is empty where nothing but a new door stands at the height of that door, or, without a door, where the lowest
//! element of all, balconies aside, stands higher than the distance of two rows. Both are rare in whole facades: of the doors of CMP
//! 7 in 100 stand alone (`cargo test --test real_data new_doors`). A row of windows or of shops of one height `h` and one lower edge `y` is added, up to three rows without a door:
//!
//! - Windows stand below the windows above and have their widths. With `d` the distance of those windows, shops of a width `w` of
//!   at most `0.85 d` stand below them, too; wider ones stand `d ceil(w / (0.85 d))` apart, on both sides of the candidate's place.
//! - An element is added where its centre is unknown, clear of the door, of the row above and of everything else.
//! - Class, `y`, `h` and `w` are those of one of the 30 candidates of the highest value that fit, the one under which the sum of
//!   the values of the best candidates that are like the row's elements is largest.

use super::apart::Apart;
use super::fill::typical_gap;
use super::observation::Observation;
use super::regular::clash;
use crate::completion::Reason;
use crate::layout::lines::median;
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// An element stands beside a door if it reaches over this share of the smaller height.
const BESIDE: f64 = 0.3;
/// Most shops on each side of the first one.
const MOST: f64 = 100.0;
/// An element stays this share of the height of the windows above it below them.
const BELOW: f64 = 0.15;
/// Widest shop below a window, in distances of windows.
const WIDEST: f64 = 0.85;
/// Distance to the door, in widths of the door.
const FROM_DOOR: f64 = 0.1;
/// A window is at most this much higher than the one above it.
const HIGHER: f64 = 1.5;
/// Most empty storeys that are filled.
const STOREYS: usize = 3;
/// Most candidates that are tried as the row's height and lower edge.
const TRIED: usize = 30;

/// An added element, why, and the candidate that stands for it.
type Added = (Element, Reason, usize);

/// The facade that is completed, and the rules for its ground floor.
pub(super) struct Ground<'a> {
    /// The facade.
    pub observation: &'a Observation<'a>,
    /// The distance that windows keep.
    pub apart: &'a Apart,
}

impl Ground<'_> {
    /// Adds what stands on an empty ground floor; `templates` are candidates by falling value, `like` gives the candidate
    /// of the highest value that is like an element, and its value.
    pub(super) fn fill<'t>(
        &self,
        added: &mut Vec<Added>,
        templates: impl Iterator<Item = (usize, &'t Element)> + Clone,
        like: impl Fn(&Element) -> Option<(usize, f64)>,
    ) {
        for _ in 0..STOREYS {
            let seen = self.observation.elements.iter().copied();
            let all: Vec<Element> = seen.chain(added.iter().map(|a| a.0)).collect();
            let door = added.iter().find(|a| a.0.class == Class::Door);
            let door = door.map(|a| a.0.rect);
            let Some((height, bays)) = self.empty(&all, door) else {
                return;
            };
            let Some(bottom) = bays.iter().map(|b| b.y).reduce(f64::min) else {
                return;
            };
            let below = bottom - BELOW * bays[0].height;
            let fits = |e: &Element| {
                let higher = e.class == Class::Window && e.rect.height > HIGHER * bays[0].height;
                is_front(e) && !higher && e.rect.top() < below && stands_at(&e.rect, height)
            };
            let fitting = templates.clone().filter(|(_, e)| fits(e)).take(TRIED);
            let width = self.observation.partial.width;
            let mut best: (f64, Vec<Added>) = (0.0, Vec::new());
            for (template, element) in fitting {
                let row = self.standing(&all, door, &places(element, &bays, width));
                let own = row.into_iter().map(|e| (e, like(&e)));
                let row: Vec<(Element, Option<(usize, f64)>)> = own.collect();
                let sum: f64 = row.iter().filter_map(|(_, l)| Some((*l)?.1)).sum();
                if sum > best.0 {
                    let stands_for = |l: Option<(usize, f64)>| l.map_or(template, |l| l.0);
                    let row = row.into_iter();
                    let row = row.map(|(e, l)| (e, Reason::Lattice, stands_for(l)));
                    best = (sum, row.collect());
                }
            }
            if best.1.is_empty() {
                return;
            }
            added.extend(best.1);
        }
    }

    /// Height of an empty ground floor, and the windows of the row above it from left to right; `None` where it is not empty.
    fn empty(&self, all: &[Element], door: Option<Rect>) -> Option<(f64, Vec<Rect>)> {
        let fronts = || all.iter().filter(|e| is_front(e)).map(|e| e.rect);
        match door {
            Some(door) => {
                let alone = !fronts().any(|r| stands_at(&r, door.top()));
                alone.then(|| (door.top(), lowest_row(all, door.top())))
            }
            None => {
                let standing = all.iter().filter(|e| e.class != Class::Balcony);
                let lowest = standing.map(|e| e.rect.y).reduce(f64::min)?;
                let storey = typical_gap(&self.observation.rows)?;
                (lowest > storey).then(|| (lowest, lowest_row(all, 0.0)))
            }
        }
    }

    /// Those of some places that have room, beside those before them.
    fn standing(&self, all: &[Element], door: Option<Rect>, places: &[Element]) -> Vec<Element> {
        let too_close = |e: &Element, rect: &Rect| {
            e.class == Class::Window && self.apart.too_close(&e.rect, rect)
        };
        let before = door.map(|d| {
            let reach = FROM_DOOR * d.width;
            Rect::new(d.x - reach, 0.0, d.width + 2.0 * reach, d.top())
        });
        let mut row: Vec<Element> = Vec::new();
        for &element in places {
            let free = self.observation.partial.has_room(&element)
                && before.is_none_or(|b| b.overlap(&element.rect) <= 0.0)
                && !(all.iter().chain(&row))
                    .any(|o| clash(o, &element) || too_close(o, &element.rect));
            row.extend(free.then_some(element));
        }
        row
    }
}

/// The places of a row like one of the candidates: below windows, or, of shops too wide for that, on both sides of the candidate, as many
/// distances of windows apart as a shop needs. `length` is the width of the facade.
fn places(template: &Element, bays: &[Rect], length: f64) -> Vec<Element> {
    let (y, height) = (template.rect.y, template.rect.height);
    let element = |x: f64, width: f64| {
        let rect = Rect::new(x - width / 2.0, y, width, height);
        Element::new(template.class, rect)
    };
    let distances = bays.windows(2).map(|w| w[1].centre().0 - w[0].centre().0);
    let distance = median(distances).unwrap_or(2.0 * bays[0].width);
    if template.class == Class::Window || template.rect.width <= WIDEST * distance {
        let width = |bay: &Rect| match template.class {
            Class::Window => bay.width,
            _ => template.rect.width,
        };
        return bays
            .iter()
            .map(|bay| element(bay.centre().0, width(bay)))
            .collect();
    }
    let pitch = distance * (template.rect.width / (WIDEST * distance)).ceil();
    // Windows above that stand in one place tell no distance.
    if distance <= 0.0 || !pitch.is_finite() {
        return Vec::new();
    }
    let from = template.rect.centre().0;
    let on_each_side = (length / pitch).floor().min(MOST);
    (-(on_each_side as i64)..=on_each_side as i64)
        .map(|k| element(from + pitch * k as f64, template.rect.width))
        .collect()
}

/// True for a window or a shop.
fn is_front(element: &Element) -> bool {
    matches!(element.class, Class::Window | Class::Shop)
}

/// True if an element stands on a ground floor of that height.
fn stands_at(r: &Rect, height: f64) -> bool {
    r.top().min(height) - r.y.max(0.0) > BESIDE * r.height.min(height)
}

/// The windows of the lowest row whose centres lie above a height, from left to right.
fn lowest_row(all: &[Element], height: f64) -> Vec<Rect> {
    let windows = all.iter().filter(|e| e.class == Class::Window);
    let mut row: Vec<Rect> = windows
        .map(|e| e.rect)
        .filter(|r| r.centre().1 > height)
        .collect();
    row.sort_by(|a, b| a.centre().1.total_cmp(&b.centre().1));
    let top = row.first().map_or(0.0, |lowest| lowest.top());
    row.retain(|r| r.centre().1 < top);
    row.sort_by(|a, b| a.x.total_cmp(&b.x));
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partial::PartialLayout;

    const TEMPLATES: [Element; 3] = [
        Element {
            class: Class::Window,
            rect: Rect {
                x: 10.0,
                y: 8.0,
                width: 12.0,
                height: 22.0,
            },
        },
        Element {
            class: Class::Shop,
            rect: Rect {
                x: 26.0,
                y: 2.0,
                width: 28.0,
                height: 28.0,
            },
        },
        // Too high for a ground floor below windows of 20.
        Element {
            class: Class::Window,
            rect: Rect {
                x: 10.0,
                y: 2.0,
                width: 12.0,
                height: 34.0,
            },
        },
    ];

    /// The elements that are added below two rows of four windows, 30 apart, seen above `edge`, where elements of a class are
    /// worth that much.
    fn filled(door: Option<Rect>, edge: f64, worth: [f64; 2]) -> Vec<Element> {
        let windows = (0..8).map(|k| {
            let column = k % 4;
            let x = 10.0 + 30.0 * f64::from(column);
            let rect = Rect::new(x, 50.0 + 35.0 * f64::from(k / 4), 12.0, 20.0);
            Element::new(Class::Window, rect)
        });
        let observed: Vec<Element> = windows.collect();
        let partial = PartialLayout {
            width: 122.0,
            height: 120.0,
            observed: observed.clone(),
            unknown: Some(vec![Rect::new(0.0, 0.0, 122.0, edge)]),
            forbidden: Vec::new(),
        };
        let observation = Observation::new(&partial, observed, (12.0, 20.0));
        let ground = Ground {
            observation: &observation,
            apart: &Apart::new(&observation),
        };
        let door = door.map(|d| (Element::new(Class::Door, d), Reason::Database, 9));
        let mut added: Vec<Added> = door.into_iter().collect();
        let before = added.len();
        ground.fill(&mut added, TEMPLATES.iter().enumerate(), |e| {
            let windows = e.class == Class::Window;
            Some((7, worth[usize::from(!windows)]))
        });
        added[before..].iter().map(|a| a.0).collect()
    }

    #[test]
    fn windows_stand_beside_a_door_in_the_columns_above() {
        let door = Some(Rect::new(38.0, 0.0, 16.0, 30.0));
        let row = filled(door, 48.0, [0.3, 0.1]);
        let at: Vec<f64> = row.iter().map(|e| e.rect.x).collect();
        assert_eq!(at, [10.0, 70.0, 100.0]);
        let alike = |e: &Element| (e.class, e.rect.y, e.rect.height) == (Class::Window, 8.0, 22.0);
        assert!(row.iter().all(alike));
    }

    #[test]
    fn wide_shops_stand_two_columns_apart() {
        let row = filled(None, 48.0, [0.1, 0.5]);
        let at: Vec<f64> = row.iter().map(|e| e.rect.x).collect();
        assert_eq!(at, [26.0, 86.0]);
        let size = |e: &Element| (e.class, e.rect.width, e.rect.height);
        assert!(row.iter().all(|e| size(e) == (Class::Shop, 28.0, 28.0)));
        let before_one = Some(Rect::new(88.0, 0.0, 16.0, 30.0));
        assert_eq!(filled(before_one, 48.0, [0.1, 0.5]).len(), 1);
    }

    #[test]
    fn windows_in_one_place_tell_no_distance() {
        let bays = [Rect::new(10.0, 50.0, 12.0, 20.0); 3];
        assert!(places(&TEMPLATES[1], &bays, 122.0).is_empty());
        assert_eq!(places(&TEMPLATES[0], &bays, 122.0).len(), 3);
    }

    #[test]
    fn a_ground_floor_that_is_not_empty_or_not_hidden_stays() {
        // A wide door reaches up to the windows: they stand beside it.
        let beside_windows = Some(Rect::new(38.0, 0.0, 16.0, 64.0));
        assert!(filled(beside_windows, 48.0, [0.3, 0.1]).is_empty());
        // The centres of all templates lie on known wall.
        assert!(filled(None, 10.0, [0.3, 0.1]).is_empty());
        // No candidate is worth anything.
        assert!(filled(None, 48.0, [0.0, 0.0]).is_empty());
    }
}
