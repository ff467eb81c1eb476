//! The door as one question: of all places where a door may stand, which is the door?
//!
//! Places are the columns that the pool has, the middles between two of them and the middle of the facade, each with 3
//! widths and 4 heights in units of a window. A place is a door with the probability that boosted trees give for features of
//! its position, size and surroundings, learnt on whole layouts whose door is hidden. A facade that is seen without a
//! door gets the most probable one, where it is likely enough.

use super::candidates::Candidates;
use super::observation::{Observation, of};
use super::pool::Draw;
use super::regular::clash;
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// Number of features of a place.
pub const FEATURES: usize = 28;
/// Widths of doors, in typical widths of a window.
const WIDTHS: [f64; 3] = [0.85, 1.25, 1.8];
/// Heights of doors, in typical heights of a window.
const HEIGHTS: [f64; 4] = [0.9, 1.25, 1.75, 2.4];
/// Least share of the pool that has a column.
const SHARE: f64 = 0.15;
/// Columns nearer than this share of a window are one.
const ONE_COLUMN: f64 = 0.3;

/// A place where a door may be.
#[derive(Debug, Clone)]
pub struct DoorCandidate {
    /// The door.
    pub element: Element,
    /// Features for its probability.
    pub features: Vec<f64>,
}

/// Columns that at least a share of the pool has, in order.
fn columns(observation: &Observation, draws: &[Draw]) -> Vec<f64> {
    let whole = draws.iter().filter(|d| d.origin.is_whole());
    let mut all: Vec<(f64, f64)> = whole
        .clone()
        .flat_map(|d| d.lines[0].iter().map(|x| (*x, d.weight)))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = whole.map(|d| d.weight).sum();
    let reach = ONE_COLUMN * observation.size.0;
    let mut groups: Vec<(f64, f64, f64)> = Vec::new();
    for (x, weight) in all {
        match groups.last_mut() {
            Some(last) if x - last.0 <= reach => {
                last.1 += weight * x;
                last.2 += weight;
            }
            _ => groups.push((x, weight * x, weight)),
        }
    }
    let enough = groups
        .into_iter()
        .filter(|g| g.2 >= SHARE * total && g.2 > 0.0);
    enough.map(|g| g.1 / g.2).collect()
}

/// All places of an observation; none where a door is seen.
pub fn places(
    observation: &Observation,
    draws: &[Draw],
    candidates: &Candidates,
) -> Vec<DoorCandidate> {
    if of(&observation.elements, Class::Door).next().is_some() {
        return Vec::new();
    }
    let columns = columns(observation, draws);
    let middle = observation.partial.width / 2.0;
    let mut at: Vec<(f64, f64)> = columns.iter().map(|x| (*x, 0.0)).collect();
    at.extend(columns.windows(2).map(|w| ((w[0] + w[1]) / 2.0, 1.0)));
    let taken = |x: f64| {
        at.iter()
            .any(|a| (a.0 - x).abs() < 0.1 * observation.size.0)
    };
    if !taken(middle) {
        at.push((middle, 2.0));
    }
    let around = Around::new(observation, draws, candidates, &columns);
    let mut places = Vec::new();
    for (x, kind) in at {
        for wide in WIDTHS {
            for high in HEIGHTS {
                let (width, height) = (wide * observation.size.0, high * observation.size.1);
                let rect = Rect::new(x - width / 2.0, 0.0, width, height);
                let element = Element::new(Class::Door, rect);
                let free = observation.elements.iter().all(|e| !clash(e, &element));
                if free && observation.partial.has_room(&element) {
                    let features = around.features(&rect, kind, wide, high);
                    places.push(DoorCandidate { element, features });
                }
            }
        }
    }
    places
}

/// Features that all places share.
struct Around<'a> {
    observation: &'a Observation<'a>,
    columns: &'a [f64],
    gap: f64,
    rows: f64,
    /// Lower edge of the lowest seen row, and height of the facade, in windows.
    lowest: f64,
    per_window: [f64; 4],
    hidden: f64,
    masked: f64,
    /// Doors of the pool with their support; other elements near the ground with theirs.
    doors: Vec<(Rect, f64)>,
    others: Vec<(Class, Rect, f64)>,
}

impl<'a> Around<'a> {
    fn new(
        observation: &'a Observation<'a>,
        draws: &[Draw],
        candidates: &Candidates,
        columns: &'a [f64],
    ) -> Self {
        let windows = of(&observation.elements, Class::Window).count().max(1) as f64;
        let support = |s: &[f64]| s[..5].iter().sum::<f64>() / 5.0;
        let (mut doors, mut others) = (Vec::new(), Vec::new());
        for c in &candidates.all {
            let (class, rect) = (c.element.class, c.element.rect);
            match class {
                Class::Door => doors.push((rect, support(&c.support))),
                _ if rect.y < 2.5 * observation.size.1 => {
                    others.push((class, rect, support(&c.support)))
                }
                _ => {}
            }
        }
        let whole = draws.iter().filter(|d| d.origin.is_whole());
        let total: f64 = whole.clone().map(|d| d.weight).sum();
        let rows = whole.map(|d| d.weight * d.lattice.1 as f64).sum::<f64>() / total.max(1e-12);
        let area = observation.partial.width * observation.partial.height;
        let unknown = observation.partial.unknown.as_ref();
        let hidden = unknown.map(|u| u.iter().map(|r| r.area()).sum::<f64>() / area);
        let gaps = columns.windows(2).map(|w| w[1] - w[0]);
        Self {
            observation,
            columns,
            gap: gaps
                .fold(f64::INFINITY, f64::min)
                .min(observation.partial.width),
            rows,
            lowest: observation
                .rows
                .first()
                .map_or(observation.partial.height, |r| r.at - r.size / 2.0),
            per_window: Class::ALL.map(|c| of(&observation.elements, c).count() as f64 / windows),
            hidden: hidden.unwrap_or(1.0),
            masked: f64::from(u8::from(hidden.is_some())),
            doors,
            others,
        }
    }

    fn features(&self, r: &Rect, kind: f64, wide: f64, high: f64) -> Vec<f64> {
        let observation = self.observation;
        let (facade, height) = (observation.partial.width, observation.partial.height);
        let (x, _) = r.centre();
        let before = self.columns.iter().filter(|c| **c < x - 1e-9).count();
        let after = self.columns.iter().filter(|c| **c > x + 1e-9).count();
        let like = self.doors.iter().filter(|(d, _)| d.iou(r) >= 0.4);
        let near = self
            .doors
            .iter()
            .filter(|(d, _)| (d.centre().0 - x).abs() < 0.5 * r.width);
        let most = |found: &mut dyn Iterator<Item = f64>| found.fold(0.0, f64::max);
        let met = |class: Class| {
            let met = self
                .others
                .iter()
                .filter(|o| o.0 == class && o.1.overlap(r) > 0.2 * o.1.area().min(r.area()));
            most(&mut met.map(|o| o.2))
        };
        let image = Rect::new(facade - r.right(), r.y, r.width, r.height);
        let seen_ground = |class: Class| {
            let near = of(&observation.elements, class).filter(|e| e.rect.y < r.height);
            near.count() as f64
        };
        // A seen window of the ground floor that is as high as the door.
        let top = of(&observation.elements, Class::Window).map(|e| (e.rect.top() - r.height).abs());
        let top = top.fold(f64::INFINITY, f64::min) / observation.size.1;
        let features = vec![
            kind,
            (x - facade / 2.0).abs() / facade,
            (x - facade / 2.0).abs() / self.gap,
            before.min(after) as f64,
            before.abs_diff(after) as f64,
            self.columns.len() as f64,
            wide,
            high,
            r.width / self.gap,
            r.width / facade,
            r.height / height,
            (r.height / self.lowest.max(1e-3 * height)).min(9.0),
            self.lowest / observation.size.1,
            self.rows,
            most(&mut like.map(|d| d.1)),
            most(&mut near.map(|d| d.1)),
            met(Class::Window),
            met(Class::Shop),
            self.masked,
            self.hidden,
            observation.seen,
            self.per_window[Class::Balcony.index()],
            self.per_window[Class::Shop.index()],
            seen_ground(Class::Window),
            seen_ground(Class::Shop),
            top.min(5.0),
            f64::from(u8::from(
                observation
                    .partial
                    .is_unknown(image.centre().0, image.centre().1),
            )),
            observation.size.0 / observation.size.1,
        ];
        debug_assert_eq!(features.len(), FEATURES);
        features
    }
}
