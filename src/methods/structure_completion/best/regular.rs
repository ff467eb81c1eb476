//! A layout on shared lines: what a completion adds, moved to the lines that it shares with the seen elements and with
//! itself.
//!
//! 1. Windows are assigned to the seen columns and rows, or to new ones, whose places follow by rule ([`super::spacing`]); each
//!    takes the width of its column and the height of its row ([`super::shared`]); a cell holds one window.
//! 2. Balconies, shops and doors follow ([`super::belong`]).
//! 3. Whatever then overlaps an observed element or an earlier one of the layout is left out.
//!
//! Observed elements are read, never moved.

use std::collections::HashSet;

use super::belong::{self, Host};
use super::by_place::ByPlace;
use super::observation::{Observation, of};
use super::shared::Lines;
use crate::completion::Reason;
use crate::layout::{Class, Element};
use edifice_shape::{Axis, Rect};

/// Share of the smaller of two elements up to which they do not overlap: rounding only.
const TOUCH: f64 = 1e-6;

/// True if two elements may not stand together in a completion: they overlap, and neither is a balcony before something else.
pub(super) fn clash(a: &Element, b: &Element) -> bool {
    let least = a.rect.area().min(b.rect.area());
    !a.class.may_overlap(b.class) && a.rect.overlap(&b.rect) > TOUCH * least
}

/// A regular layout: added elements in the order in which they were given, each with the index of the element that it was,
/// and the lines that it has.
#[derive(Debug, Clone)]
pub(super) struct Regular {
    /// Added elements, and the index of each among those given.
    pub added: Vec<(Element, Reason, usize)>,
    /// Columns and rows.
    pub lines: [Lines; 2],
    /// Windows in their cells, the seen ones first.
    pub hosts: Vec<Host>,
}

/// Moves added elements to shared lines.
pub(super) fn regular(observation: &Observation, added: &[(Element, Reason)]) -> Regular {
    let seen: Vec<Rect> = of(&observation.elements, Class::Window)
        .map(|e| e.rect)
        .collect();
    let is_window = |k: &usize| added[*k].0.class == Class::Window;
    let windows: Vec<usize> = (0..added.len()).filter(is_window).collect();
    let new: Vec<Rect> = windows.iter().map(|&k| added[k].0.rect).collect();
    let [columns, rows] = Axis::BOTH.map(|axis| Lines::new(observation, axis, &seen, &new));
    let mut hosts: Vec<Host> = (seen.iter().enumerate())
        .map(|(k, &rect)| Host {
            column: columns.of_seen[k],
            row: rows.of_seen[k],
            rect,
            given: None,
        })
        .collect();
    let mut taken = vec![false; columns.all.len() * rows.all.len()];
    for host in &hosts {
        taken[host.row * columns.all.len() + host.column] = true;
    }
    let facade = [observation.partial.width, observation.partial.height];
    let mut kept = Kept {
        observation,
        elements: ByPlace::new(facade, observation.size, added.len()),
        added: Vec::with_capacity(added.len()),
    };
    for (w, &k) in windows.iter().enumerate() {
        let (column, row) = (columns.of_new[w], rows.of_new[w]);
        let cell = row * columns.all.len() + column;
        if taken[cell] {
            continue;
        }
        let (x, width) = columns.all[column].place(rows.all[row].at);
        let (y, height) = rows.all[row].place(columns.all[column].at);
        let rect = Rect::new(x - width / 2.0, y - height / 2.0, width, height);
        if kept.add(Element::new(Class::Window, rect), added[k].1, k) {
            taken[cell] = true;
            let given = Some(k);
            hosts.push(Host {
                column,
                row,
                rect,
                given,
            });
        }
    }
    let others: Vec<usize> = (0..added.len()).filter(|k| !is_window(k)).collect();
    let placed = belong::placed(observation, &hosts, [&columns, &rows], added, &others);
    for (k, rect) in placed {
        kept.add(Element::new(added[k].0.class, rect), added[k].1, k);
    }
    let mut added = kept.added;
    added.sort_by_key(|(_, _, k)| *k);
    Regular {
        added,
        lines: [columns, rows],
        hosts,
    }
}

/// Elements that stand together.
struct Kept<'a> {
    observation: &'a Observation<'a>,
    elements: ByPlace,
    added: Vec<(Element, Reason, usize)>,
}

impl Kept<'_> {
    /// Adds an element where there is room; whether there was.
    fn add(&mut self, element: Element, reason: Reason, index: usize) -> bool {
        let free = |others: &ByPlace| !others.any_near(&element.rect, |o| clash(o, &element));
        let room = self.observation.partial.has_room(&element);
        if !room || !free(&self.observation.elements) || !free(&self.elements) {
            return false;
        }
        self.elements.push(element);
        self.added.push((element, reason, index));
        true
    }
}

/// The layout without new windows that stand alone on a column or on a row, where others do not.
pub(super) fn without_loners(
    observation: &Observation,
    layout: Regular,
) -> Vec<(Element, Reason, usize)> {
    let mut hosts = layout.hosts;
    let [columns, rows] = layout.lines.map(|l| l.all.len());
    loop {
        let (mut in_column, mut in_row) = (vec![0; columns], vec![0; rows]);
        for host in &hosts {
            in_column[host.column] += 1;
            in_row[host.row] += 1;
        }
        // A facade of one column or of one row has no others.
        let single = [&in_column, &in_row].map(|counts| counts.iter().all(|n| *n <= 1));
        let before = hosts.len();
        hosts.retain(|h| {
            let alone =
                (in_column[h.column] < 2 && !single[0]) || (in_row[h.row] < 2 && !single[1]);
            h.given.is_none() || !alone
        });
        if hosts.len() == before {
            break;
        }
    }
    let stands: HashSet<usize> = hosts.iter().filter_map(|h| h.given).collect();
    let held = |b: &Rect| {
        // A balcony of one window goes with it.
        let wide = b.width > belong::WIDE * observation.size.0;
        wide || hosts.iter().any(|h| belong::is_host(&h.rect, b))
    };
    let mut added = layout.added;
    added.retain(|(e, _, k)| match e.class {
        Class::Window => stands.contains(k),
        Class::Balcony => held(&e.rect),
        Class::Door | Class::Shop => true,
    });
    added
}
