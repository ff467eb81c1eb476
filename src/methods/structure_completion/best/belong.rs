//! Places of what belongs to windows or to the ground: balconies, shops and doors.
//!
//! - A balcony of one window hangs before it as the seen balconies of its row do, else as those of the nearest row with
//!   one, else as the median of those that were drawn for the row. Without a window it is left out.
//! - A balcony of a floor (wider than 2 windows) has the height above its row, and the ends, that the seen ones have.
//! - Shops and doors stand as high, and as wide up to a ratio of 1.25, as the seen ones of their class, and on the column, the
//!   middle between two columns, or the middle of the facade if one of these is nearer than a quarter of their width.

use super::observation::{Observation, of};
use super::shared::Lines;
use crate::completion::Reason;
use crate::layout::lines::median;
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// A balcony is one of a floor above this width, in typical widths of a window.
pub(super) const WIDE: f64 = 2.0;
/// Widths of shops and of doors are one up to this ratio.
const SAME_WIDTH: f64 = 1.25;
/// Largest way of a shop or door to its place by rule, in units of its width.
const REACH: f64 = 0.25;

/// A window in its cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Host {
    /// Its column.
    pub column: usize,
    /// Its row.
    pub row: usize,
    /// Its place.
    pub rect: Rect,
    /// Its index among the elements given; `None` of a seen one.
    pub given: Option<usize>,
}

/// True if a balcony hangs before or below a window.
pub(super) fn is_host(window: &Rect, balcony: &Rect) -> bool {
    let (x, y) = window.centre();
    let beside = (balcony.centre().0 - x).abs() < 0.5 * window.width.max(balcony.width);
    beside && balcony.y < y && balcony.top() > window.y - 0.5 * window.height
}

/// The nearest window that a balcony may belong to.
fn host<'a>(hosts: &'a [Host], balcony: &Rect) -> Option<&'a Host> {
    let own = hosts.iter().filter(|h| is_host(&h.rect, balcony));
    let distance = |h: &Host| (h.rect.centre().0 - balcony.centre().0).abs();
    own.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// A balcony before its window: offsets of its centre and its lower edge, width beyond that of the window, height.
#[derive(Debug, Clone, Copy)]
struct Hanging {
    row: usize,
    across: f64,
    up: f64,
    wider: f64,
    high: f64,
}

impl Hanging {
    fn new(host: &Host, balcony: &Rect) -> Self {
        Self {
            row: host.row,
            across: balcony.centre().0 - host.rect.centre().0,
            up: balcony.y - host.rect.y,
            wider: balcony.width - host.rect.width,
            high: balcony.height,
        }
    }

    /// The median of several; `None` of nothing.
    fn median(all: &[Hanging]) -> Option<Hanging> {
        let of = |value: fn(&Hanging) -> f64| median(all.iter().map(value));
        Some(Hanging {
            row: all.first()?.row,
            across: of(|h| h.across)?,
            up: of(|h| h.up)?,
            wider: of(|h| h.wider)?,
            high: of(|h| h.high)?,
        })
    }

    fn before(&self, window: &Rect) -> Rect {
        let width = window.width + self.wider;
        let x = window.centre().0 + self.across - width / 2.0;
        Rect::new(x, window.y + self.up, width, self.high)
    }
}

/// Places of the added elements `others` (indices of those that are no windows), in an order in which they may be added.
pub(super) fn placed(
    observation: &Observation,
    hosts: &[Host],
    [columns, rows]: [&Lines; 2],
    added: &[(Element, Reason)],
    others: &[usize],
) -> Vec<(usize, Rect)> {
    let of_class = |class: Class| {
        let own = others.iter().filter(move |k| added[**k].0.class == class);
        own.map(|&k| (k, added[k].0.rect)).collect::<Vec<_>>()
    };
    let is_wide = |r: &Rect| r.width > WIDE * observation.size.0;
    let (wide, narrow): (Vec<_>, Vec<_>) = of_class(Class::Balcony)
        .into_iter()
        .partition(|(_, r)| is_wide(r));
    let mut out = hanging(observation, hosts, &narrow);
    out.extend(running(observation, rows, &wide));
    for class in [Class::Door, Class::Shop] {
        out.extend(standing(observation, columns, class, &of_class(class)));
    }
    out
}

fn hanging(
    observation: &Observation,
    hosts: &[Host],
    drawn: &[(usize, Rect)],
) -> Vec<(usize, Rect)> {
    let seen_hosts: Vec<Host> = hosts
        .iter()
        .filter(|h| h.given.is_none())
        .copied()
        .collect();
    let pair = |hosts: &[Host], r: &Rect| Some(Hanging::new(host(hosts, r)?, r));
    let seen: Vec<Hanging> = of(&observation.elements, Class::Balcony)
        .filter(|b| b.rect.width <= WIDE * observation.size.0)
        .filter_map(|b| pair(&seen_hosts, &b.rect))
        .collect();
    let own: Vec<Hanging> = drawn.iter().filter_map(|(_, r)| pair(hosts, r)).collect();
    let in_row = |all: &[Hanging], row: usize| {
        let own: Vec<Hanging> = all.iter().filter(|h| h.row == row).copied().collect();
        Hanging::median(&own)
    };
    let mut out = Vec::new();
    let mut taken = Vec::new();
    for &(k, rect) in drawn {
        let Some(window) = host(hosts, &rect) else {
            continue;
        };
        let cell = (window.column, window.row);
        if taken.contains(&cell) {
            continue;
        }
        let nearest = seen.iter().min_by_key(|h| h.row.abs_diff(window.row));
        let nearest = nearest.and_then(|h| in_row(&seen, h.row));
        if let Some(as_those) = nearest.or_else(|| in_row(&own, window.row)) {
            taken.push(cell);
            out.push((k, as_those.before(&window.rect)));
        }
    }
    out
}

fn running(observation: &Observation, rows: &Lines, drawn: &[(usize, Rect)]) -> Vec<(usize, Rect)> {
    // Height of the lower edge above the row, and the balcony.
    let above = |r: &Rect| {
        let distance = |at: f64| (r.y - at).abs();
        let near = rows.all.iter().map(|l| l.at).filter(|at| *at > r.y);
        let near = near.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        Some((near, r.y - near))
    };
    let seen: Vec<(f64, Rect)> = of(&observation.elements, Class::Balcony)
        .filter(|b| b.rect.width > WIDE * observation.size.0)
        .filter_map(|b| Some((above(&b.rect)?.1, b.rect)))
        .collect();
    let place = |r: &Rect| {
        let (row, own) = above(r)?;
        let distance = |s: &&(f64, Rect)| (s.0 - own).abs();
        let like = seen
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let shared = r.right().min(like.1.right()) - r.x.max(like.1.x);
        let ends = shared > 0.7 * r.width.max(like.1.width);
        let (x, width) = if ends {
            (like.1.x, like.1.width)
        } else {
            (r.x, r.width)
        };
        let near = (like.0 - own).abs() < 0.5 * observation.size.1;
        let up = if near { like.0 } else { own };
        Some(Rect::new(x, row + up, width, like.1.height))
    };
    drawn
        .iter()
        .map(|&(k, r)| (k, place(&r).unwrap_or(r)))
        .collect()
}

fn standing(
    observation: &Observation,
    columns: &Lines,
    class: Class,
    drawn: &[(usize, Rect)],
) -> Vec<(usize, Rect)> {
    let seen: Vec<Rect> = of(&observation.elements, class).map(|e| e.rect).collect();
    let typical = |value: fn(&Rect) -> f64| {
        let own = drawn.iter().map(|(_, r)| value(r));
        median(seen.iter().map(value)).or_else(|| median(own))
    };
    let (Some(bottom), Some(height)) = (typical(|r| r.y), typical(|r| r.height)) else {
        return Vec::new();
    };
    let at: Vec<f64> = columns.all.iter().map(|l| l.at).collect();
    let mut rules = vec![observation.partial.width / 2.0];
    rules.extend(at.windows(2).map(|w| (w[0] + w[1]) / 2.0));
    rules.extend(at);
    let mut widths: Vec<f64> = seen.iter().map(|r| r.width).collect();
    widths.extend(median(drawn.iter().map(|(_, r)| r.width)));
    let place = |r: &Rect| {
        let ratio = |w: &f64| (w / r.width).ln().abs();
        let nearest = widths
            .iter()
            .copied()
            .min_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        let same = nearest.filter(|w| ratio(w) <= SAME_WIDTH.ln());
        let width = same.unwrap_or(r.width);
        let x = r.centre().0;
        let way = |rule: &f64| (rule - x).abs();
        let rule = rules
            .iter()
            .copied()
            .min_by(|a, b| way(a).total_cmp(&way(b)));
        let x = rule.filter(|rule| way(rule) < REACH * r.width).unwrap_or(x);
        Rect::new(x - width / 2.0, bottom, width, height)
    };
    drawn.iter().map(|(k, r)| (*k, place(r))).collect()
}
