//! Rows with a rhythm of their own: wide windows or shops of a ground floor, small windows under a roof.
//!
//! The windows of a lattice take their places from columns. A row whose elements stand at even distances, but off the
//! columns of the other rows or in another size, has no columns to take: it is continued at its own distance, with its own
//! size, into the part that is said to be unknown, and fills its own gaps there.
//!
//! - It is seen alone at its height: no other window and no other shop of more than half its height has its centre there.
//! - Sizes and distances of a row are even up to 0.12 and 0.1 of themselves; distances may be multiples of the smallest.
//! - No further element of its size would fit between two of them. Where three or more are even up to 0.02, it may be: nobody builds that by chance.
//! - More than a third of its elements stand off the columns of the other rows, or its width is not theirs; shops have no columns.
//! - At its free end a row keeps half the margin of its seen end, at most half of a wall between two of its elements and a quarter of a width.
//! - Where a door in the middle of the facade ends it, the mirror images of what is seen of it stand beyond the door.

use super::observation::{Observation, of};
use super::regular::clash;
use crate::layout::lines::median;
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// Sizes of a row differ by at most this share.
const SAME_SIZE: f64 = 0.12;
/// Distances of a row differ by at most this share.
const EVEN: f64 = 0.1;
/// Both, of a row whose elements may stand further apart.
const EXACT: f64 = 0.02;
/// Elements nearer than this number of widths have no room for another one between them.
const CLOSE: f64 = 2.0;
/// A row has a size of its own beyond this ratio to the typical width of a window.
const OTHER_SIZE: f64 = 1.15;
/// An element stands on a column nearer than this share of the typical width of a window.
const ON_COLUMN: f64 = 0.2;
/// Rows are parted where centres differ by more than this share of a height.
const SAME_ROW: f64 = 0.25;
/// Most elements of a row.
const MOST: f64 = 500.0;

/// The continuation of a row with a rhythm of its own.
#[derive(Debug, Clone)]
pub(super) struct Continued {
    /// The part of the row that its seen and new elements reach over, up to the edge of the facade where there is no
    /// room for another one before it: nothing else is added there.
    pub band: Rect,
    /// New elements of one class, none of which clashes with another one of any row or with an observed one.
    pub elements: Vec<Element>,
}

/// A row of even elements.
struct Row {
    class: Class,
    /// From left to right, two or more.
    members: Vec<Rect>,
    /// Median width, bottom and height.
    size: (f64, f64, f64),
    /// Distance of neighbours.
    pitch: f64,
}

/// All rows with a rhythm of their own that continue into the unknown part.
pub(super) fn continued(observation: &Observation) -> Vec<Continued> {
    // Without a mask a gap may be wall or not.
    if observation.partial.unknown.is_none() {
        return Vec::new();
    }
    let mut all: Vec<Continued> = Vec::new();
    for class in [Class::Shop, Class::Window] {
        for members in rows(observation, class) {
            let own = Row::new(class, members).filter(|row| row.is_own(observation));
            let Some(row) = own else { continue };
            let (mut elements, band) = row.continued(observation);
            elements.retain(|e| {
                let mut earlier = all.iter().flat_map(|c| &c.elements);
                !earlier.any(|o| clash(o, e))
            });
            if !elements.is_empty() {
                all.push(Continued { band, elements });
            }
        }
    }
    all
}

/// Observed elements of a class by rows, each from left to right.
fn rows(observation: &Observation, class: Class) -> Vec<Vec<Rect>> {
    let mut rects: Vec<Rect> = of(&observation.elements, class).map(|e| e.rect).collect();
    rects.sort_by(|a, b| a.centre().1.total_cmp(&b.centre().1));
    let mut rows: Vec<Vec<Rect>> = Vec::new();
    for rect in rects {
        let same =
            |row: &Vec<Rect>| (row[0].centre().1 - rect.centre().1).abs() < SAME_ROW * rect.height;
        match rows.iter_mut().find(|row| same(row)) {
            Some(row) => row.push(rect),
            None => rows.push(vec![rect]),
        }
    }
    for row in &mut rows {
        row.sort_by(|a, b| a.centre().0.total_cmp(&b.centre().0));
    }
    rows
}

impl Row {
    /// The row, if it is even.
    fn new(class: Class, members: Vec<Rect>) -> Option<Self> {
        let of = |value: fn(&Rect) -> f64| median(members.iter().map(value));
        let size = (of(|r| r.width)?, of(|r| r.y)?, of(|r| r.height)?);
        let sizes = |tolerance: f64| {
            let differs = |a: f64, b: f64| (a - b).abs() > tolerance * b;
            !members
                .iter()
                .any(|r| differs(r.width, size.0) || differs(r.height, size.2))
        };
        let gaps: Vec<f64> = members
            .windows(2)
            .map(|w| w[1].centre().0 - w[0].centre().0)
            .collect();
        let least = gaps.iter().copied().reduce(f64::min)?;
        let length: f64 = gaps.iter().sum();
        if least < (1.0 - EXACT) * size.0 || length > MOST * least {
            return None;
        }
        let steps: Vec<f64> = gaps.iter().map(|g| (g / least).round()).collect();
        let pitch = length / steps.iter().sum::<f64>();
        let even = |tolerance: f64| {
            let mut pairs = gaps.iter().zip(&steps);
            sizes(tolerance.max(EXACT))
                && pairs.all(|(g, n)| (g - n * pitch).abs() <= tolerance * pitch)
        };
        let exact = members.len() > 2 && even(EXACT);
        let close = pitch <= CLOSE * size.0 && sizes(SAME_SIZE) && even(EVEN);
        (exact || close).then_some(Self {
            class,
            members,
            // Elements that touch, up to rounding, touch.
            size: (size.0.min(pitch), size.1, size.2),
            pitch,
        })
    }

    /// True if the row is seen alone at its height and does not stand on the columns of the other rows with their width.
    fn is_own(&self, observation: &Observation) -> bool {
        let typical = observation.size.0;
        let (_, bottom, height) = self.size;
        let beside = observation.elements.iter().filter(|e| {
            let up = e.rect.centre().1 - bottom;
            let alike =
                matches!(e.class, Class::Window | Class::Shop) && e.rect.height > 0.5 * height;
            alike && up >= 0.0 && up <= height
        });
        if beside.count() > self.members.len() {
            return false;
        }
        let (wide, middle) = (self.size.0, self.members[0].centre().1);
        let others = || {
            let windows = of(&observation.elements, Class::Window).map(|w| w.rect.centre());
            windows.filter(|c| (c.1 - middle).abs() >= 0.5 * self.size.2)
        };
        let off = self.members.iter().filter(|r| {
            let x = r.centre().0;
            !others().any(|c| (c.0 - x).abs() < ON_COLUMN * typical)
        });
        self.class == Class::Shop
            || wide.max(typical) > OTHER_SIZE * wide.min(typical)
            || 3 * off.count() > self.members.len()
    }

    /// The element of the row with this centre.
    fn at(&self, x: f64) -> Element {
        let (width, y, height) = self.size;
        Element::new(self.class, Rect::new(x - width / 2.0, y, width, height))
    }

    /// New elements at both ends and in the gaps, and the part of the facade that the row then reaches over.
    fn continued(&self, observation: &Observation) -> (Vec<Element>, Rect) {
        let partial = observation.partial;
        let free = |e: &Element| {
            partial.has_room(e) && !observation.elements.any_near(&e.rect, |o| clash(o, e))
        };
        let mut new = Vec::new();
        let (width, y, height) = self.size;
        let ends = [0, self.members.len() - 1].map(|k| self.members[k]);
        let margins = [ends[0].x, partial.width - ends[1].right()];
        let edges = [0.0, partial.width];
        let is_seen = |end: usize| !partial.is_unknown(edges[end], y + height / 2.0);
        let mut reach = [ends[0].x, ends[1].right()];
        for (end, step) in [(0, -self.pitch), (1, self.pitch)] {
            let from = ends[end].centre().0;
            let margin = match is_seen(1 - end) {
                true => 0.5 * margins[1 - end].clamp(0.0, self.pitch - 0.75 * width),
                false => 0.0,
            };
            let slack = 1e-9 * partial.width;
            let is_inside = |e: &Element| {
                let own = [e.rect.x, partial.width - e.rect.right()][end];
                own >= margin - slack
            };
            let mut places = (1..MOST as usize).map(|k| self.at(from + step * k as f64));
            let before = new.len();
            let stop = places.find(|e| {
                let goes_on = is_inside(e) && free(e);
                new.extend(goes_on.then_some(*e));
                !goes_on
            });
            if new.len() == before && self.ends_at_middle_door(observation) {
                new.extend(self.images(partial.width, step, from, free));
            }
            if new.len() > before && stop.is_none_or(|e| !is_inside(&e)) {
                reach[end] = edges[end];
            }
        }
        for pair in self.members.windows(2) {
            let (a, b) = (pair[0].centre().0, pair[1].centre().0);
            let parts = ((b - a) / self.pitch).round();
            let places = (1..parts as usize).map(|k| self.at(a + (b - a) * k as f64 / parts));
            new.extend(places.filter(free));
        }
        let left = new.iter().map(|e| e.rect.x).fold(reach[0], f64::min);
        let right = new.iter().map(|e| e.rect.right()).fold(reach[1], f64::max);
        (new, Rect::new(left, y, right - left, height))
    }

    /// True if an observed door beside the row stands in the middle of the facade.
    fn ends_at_middle_door(&self, observation: &Observation) -> bool {
        let middle = observation.partial.width / 2.0;
        let reach = EVEN * self.pitch;
        let (_, y, height) = self.size;
        of(&observation.elements, Class::Door).any(|door| {
            let across = door.rect.x - reach <= middle && middle <= door.rect.right() + reach;
            across && door.rect.y < y + height / 2.0
        })
    }

    /// The mirror images of the row on that side, if all of them are free; else none.
    fn images(
        &self,
        width: f64,
        step: f64,
        from: f64,
        free: impl Fn(&Element) -> bool,
    ) -> Vec<Element> {
        let images = self.members.iter().map(|r| self.at(width - r.centre().0));
        let images: Vec<Element> = images
            .filter(|e| (e.rect.centre().0 - from) * step > 0.0)
            .collect();
        match images.iter().all(free) {
            true => images,
            false => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partial::PartialLayout;

    fn element(class: Class, rect: [f64; 4]) -> Element {
        Element::new(class, Rect::new(rect[0], rect[1], rect[2], rect[3]))
    }

    /// A facade of width 180 with six columns of windows above `ground`; its part left of `edge` is hidden.
    fn continued_of(ground: &[Element], edge: f64) -> Vec<Continued> {
        let windows = (0..24).map(|k| {
            let (x, y) = (
                9.0 + 30.0 * f64::from(k % 6),
                60.0 + 40.0 * f64::from(k / 6),
            );
            element(Class::Window, [x, y, 12.0, 20.0])
        });
        let all = windows.chain(ground.iter().copied());
        let observed: Vec<Element> = all.filter(|e| e.rect.centre().0 > edge).collect();
        let partial = PartialLayout {
            width: 180.0,
            height: 220.0,
            observed: observed.clone(),
            unknown: Some(vec![Rect::new(0.0, 0.0, edge, 220.0)]),
            forbidden: Vec::new(),
        };
        continued(&Observation::new(&partial, observed, (12.0, 20.0)))
    }

    fn shops(wide: f64, starts: &[f64]) -> Vec<Element> {
        let shop = |x: &f64| element(Class::Window, [*x, 5.0, wide, 35.0]);
        starts.iter().map(shop).collect()
    }

    #[test]
    fn wide_windows_go_on_to_the_other_margin() {
        let all = shops(32.0, &[8.0, 52.0, 96.0, 140.0]);
        let found = continued_of(&all, 85.0);
        assert_eq!(found.len(), 1);
        let mut left: Vec<f64> = found[0].elements.iter().map(|e| e.rect.x).collect();
        left.sort_by(f64::total_cmp);
        assert_eq!(left, [8.0, 52.0]);
        assert_eq!(found[0].elements[0].rect.width, 32.0);
        assert_eq!((found[0].band.x, found[0].band.right()), (0.0, 172.0));
    }

    #[test]
    fn beyond_a_door_in_the_middle_stand_the_mirror_images() {
        let mut all = shops(30.0, &[4.0, 40.0, 110.0, 146.0]);
        all.push(element(Class::Door, [80.0, 0.0, 20.0, 30.0]));
        let found = continued_of(&all, 85.0);
        let mut left: Vec<f64> = found[0].elements.iter().map(|e| e.rect.x).collect();
        left.sort_by(f64::total_cmp);
        assert_eq!(left, [4.0, 40.0]);
    }

    #[test]
    fn rows_on_columns_and_uneven_rows_have_no_rhythm_of_their_own() {
        assert!(continued_of(&[], 85.0).is_empty());
        assert!(continued_of(&shops(12.0, &[99.0, 129.0, 159.0]), 85.0).is_empty());
        assert!(continued_of(&shops(20.0, &[92.0, 115.0, 150.0]), 85.0).is_empty());
        // One alone tells no distance.
        assert!(continued_of(&shops(30.0, &[140.0]), 85.0).is_empty());
    }

    #[test]
    fn an_element_between_two_of_them_is_not_invented_where_it_could_be_hidden() {
        // Two far apart might have a third one between them.
        assert!(continued_of(&shops(15.0, &[95.0, 145.0]), 85.0).is_empty());
        // Three that are exact have none; a third new one would stand nearer to the edge than half the other margin.
        let found = continued_of(&shops(9.0, &[92.0, 122.0, 152.0]), 85.0);
        let left: Vec<f64> = found[0].elements.iter().map(|e| e.rect.x).collect();
        assert_eq!(left, [62.0, 32.0]);
    }
}
