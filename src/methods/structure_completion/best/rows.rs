//! Balconies of single windows, row by row: one decision for the windows of a row that are of one width.
//!
//! Of such windows some are seen to have a balcony (`W`), some are known to have none (`A`), and of the others, the open
//! ones, nothing is known. What the open ones get is one of
//!
//! - nothing, unless a window of the row has one and none is known to lack it;
//! - one each, unless one is known to lack it;
//! - where the mirror image of the window about the middle of the facade has one;
//! - where the window of the same column in the nearest row that shows balconies has one.
//!
//! With `p` the value of the best candidate for the balcony of an open window, 0 where there is none, the sum of `p - t` over
//! those that get one is largest for the pattern that is taken; `t` is what a further element must be worth. Patterns that
//! differ from what is seen in a row are not among them, so that a row is either even or follows another row or the
//! symmetry of the facade.

use super::belong;
use super::belong::Host;
use super::observation::{Observation, of};
use super::regular::clash;
use super::shared::SAME_SIZE;
use crate::completion::Reason;
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// Mirror images stand at most this share of the width of a window apart.
const IMAGE: f64 = 0.25;

/// The balcony of a window, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Known {
    /// Seen.
    With,
    /// There is none.
    Without,
    /// It may have one.
    Open,
    /// There is no room for one, which says nothing of the others.
    Blocked,
}

/// A window with what is known of its balcony.
struct Cell {
    host: Host,
    known: Known,
    /// The place of its balcony, and the candidate for it with its value.
    place: Rect,
    candidate: Option<(usize, f64)>,
}

/// True for a balcony of one window.
pub(super) fn is_single(observation: &Observation, element: &Element) -> bool {
    element.class == Class::Balcony && element.rect.width <= belong::WIDE * observation.size.0
}

/// The balconies of single windows that a layout gets, each with the candidate that stands for it; `None` where there are
/// none to decide on. `hosts` are the windows of the layout, `added` what it adds, `like` gives the best candidate that is like
/// an element with its value, and `least` what a further balcony must be worth.
pub(super) fn even(
    observation: &Observation,
    hosts: &[Host],
    added: &[(Element, Reason, usize)],
    least: f64,
    like: impl Fn(&Element) -> Option<(usize, f64)>,
) -> Option<Vec<(Element, Reason, usize)>> {
    let seen: Vec<Rect> = of(&observation.elements, Class::Balcony)
        .map(|b| b.rect)
        .filter(|r| r.width <= belong::WIDE * observation.size.0)
        .collect();
    let drawn = added.iter().filter(|a| is_single(observation, &a.0));
    let drawn: Vec<Rect> = drawn.map(|a| a.0.rect).collect();
    if drawn.is_empty() && seen.is_empty() {
        return None;
    }
    // Every balcony to its nearest window.
    let own = |balconies: &[Rect]| -> Vec<Option<Rect>> {
        let mut of_host = vec![None; hosts.len()];
        for balcony in balconies {
            let near = (0..hosts.len()).filter(|&h| belong::is_host(&hosts[h].rect, balcony));
            let distance = |h: &usize| {
                let (a, b) = (hosts[*h].rect.centre(), balcony.centre());
                (a.0 - b.0).abs() + (a.1 - b.1).abs()
            };
            if let Some(h) = near.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                of_host[h] = Some(*balcony);
            }
        }
        of_host
    };
    let (seen, drawn) = (own(&seen), own(&drawn));
    let hung: Vec<(Host, Rect)> = (0..hosts.len())
        .filter_map(|h| Some((hosts[h], seen[h].or(drawn[h])?)))
        .collect();
    let cell = |h: usize| -> Option<Cell> {
        let host = hosts[h];
        let place = seen[h].or(drawn[h]).or_else(|| as_nearest(&hung, &host))?;
        let element = Element::new(Class::Balcony, place);
        let (x, y) = place.centre();
        let taken = |e: &Element| clash(e, &element);
        let known = match seen[h] {
            Some(_) => Known::With,
            None if host.given.is_none() && !observation.partial.is_unknown(x, y) => Known::Without,
            None if !observation.partial.has_room(&element)
                || observation.elements.any_near(&place, taken) =>
            {
                Known::Blocked
            }
            None => Known::Open,
        };
        let candidate = like(&element);
        Some(Cell {
            host,
            known,
            place,
            candidate,
        })
    };
    let cells: Vec<Cell> = (0..hosts.len()).filter_map(cell).collect();
    let mut balconies = Vec::new();
    for group in groups(&cells) {
        balconies.extend(decided(observation, &cells, &group, least));
    }
    Some(balconies)
}

/// The place of a balcony before a window as before the nearest one, in rows first, that has one.
fn as_nearest(hung: &[(Host, Rect)], host: &Host) -> Option<Rect> {
    let distance = |h: &Host| (h.row.abs_diff(host.row), h.column.abs_diff(host.column));
    let (from, balcony) = hung.iter().min_by_key(|(h, _)| distance(h))?;
    let wide = (host.rect.width + balcony.width - from.rect.width).max(0.5 * host.rect.width);
    let across = balcony.centre().0 - from.rect.centre().0;
    let x = host.rect.centre().0 + across - wide / 2.0;
    let up = balcony.y - from.rect.y;
    Some(Rect::new(x, host.rect.y + up, wide, balcony.height))
}

/// Cells of one row whose windows have one width, up to a ratio of 1.15 between neighbours in size.
fn groups(cells: &[Cell]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    let wide = |k: usize| cells[k].host.rect.width;
    order.sort_by(|&a, &b| {
        let rows = cells[a].host.row.cmp(&cells[b].host.row);
        rows.then(wide(a).total_cmp(&wide(b)))
    });
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for k in order {
        let joins = groups.last().and_then(|g| g.last()).is_some_and(|&last| {
            let same = wide(k) <= SAME_SIZE * wide(last);
            cells[last].host.row == cells[k].host.row && same
        });
        match groups.last_mut() {
            Some(group) if joins => group.push(k),
            _ => groups.push(vec![k]),
        }
    }
    groups
}

/// The balconies that the open windows of a group get.
fn decided(
    observation: &Observation,
    cells: &[Cell],
    group: &[usize],
    least: f64,
) -> Vec<(Element, Reason, usize)> {
    let with = |known: Known| group.iter().filter(|&&k| cells[k].known == known).count();
    let (seen, lacking) = (with(Known::With), with(Known::Without));
    let open: Vec<usize> = group
        .iter()
        .copied()
        .filter(|&k| cells[k].known == Known::Open)
        .collect();
    let best = open.iter().filter_map(|&k| cells[k].candidate);
    // Where no candidate is, the weakest one of the row stands for it.
    let Some(weakest) = best.reduce(|a, b| if b.1 < a.1 { b } else { a }) else {
        return Vec::new();
    };
    let has =
        |place: &dyn Fn(&Cell) -> bool| cells.iter().any(|c| c.known == Known::With && place(c));
    let middle = observation.partial.width;
    let reach = IMAGE * observation.size.0;
    let row = cells[group[0]].host.row;
    let image = |k: usize| {
        let x = middle - cells[k].host.rect.centre().0;
        has(&|c: &Cell| c.host.row == row && (c.host.rect.centre().0 - x).abs() < reach)
    };
    let others = cells
        .iter()
        .filter(|c| c.known == Known::With && c.host.row != row);
    let nearest = others.map(|c| c.host.row).min_by_key(|r| r.abs_diff(row));
    let column = |k: usize| {
        has(&|c: &Cell| Some(c.host.row) == nearest && c.host.column == cells[k].host.column)
    };
    let mut patterns: Vec<Vec<usize>> = Vec::new();
    if seen == 0 || lacking > 0 {
        patterns.push(Vec::new());
    }
    if lacking == 0 {
        patterns.push(open.clone());
    }
    let images: Vec<usize> = open.iter().copied().filter(|&k| image(k)).collect();
    let symmetric = group
        .iter()
        .all(|&k| cells[k].known != Known::With || image(k));
    if !images.is_empty() || (seen > 0 && symmetric) {
        patterns.push(images);
    }
    let columns: Vec<usize> = open.iter().copied().filter(|&k| column(k)).collect();
    if !columns.is_empty() {
        patterns.push(columns);
    }
    let gain = |pattern: &Vec<usize>| {
        let each = pattern
            .iter()
            .map(|&k| cells[k].candidate.map_or(0.0, |c| c.1) - least);
        each.sum::<f64>()
    };
    let best = patterns
        .into_iter()
        .reduce(|a, b| if gain(&b) > gain(&a) { b } else { a });
    let balcony = |k: usize| {
        let element = Element::new(Class::Balcony, cells[k].place);
        let candidate = cells[k].candidate.unwrap_or(weakest).0;
        (element, Reason::Lattice, candidate)
    };
    best.unwrap_or_default().into_iter().map(balcony).collect()
}
