//! Lines that windows share: the seen ones with their members, new ones by rule.
//!
//! A new window takes its abscissa and width from its column, its ordinate and height from its row. What a seen line
//! gives is the place of one of its windows, so that a new window is exactly in line with a seen one: the median window, and
//! the nearest one along the line where the windows on it differ by more than 0.12 of their extent (a ground floor
//! with columns of its own).

use super::observation::Observation;
use super::spacing::by_rule;
use crate::layout::lines::{lines, median};
use edifice_shape::{Axis, Rect};

/// A window is on a seen line when its centre is nearer than this share of the typical extent.
const ON_LINE: f64 = 0.35;
/// Windows of a line that differ by more than this share of their extent do not share one place.
const SPREAD: f64 = 0.12;
/// Sizes are one size up to this ratio.
pub(super) const SAME_SIZE: f64 = 1.15;

/// A window on a line.
#[derive(Debug, Clone, Copy)]
struct Member {
    /// Place along the line.
    along: f64,
    /// Centre across the line.
    at: f64,
    /// Extent across the line.
    size: f64,
}

/// A line of windows.
#[derive(Debug, Clone)]
pub(super) struct Shared {
    /// Centre.
    pub at: f64,
    /// Extent across the line.
    pub size: f64,
    members: Vec<Member>,
}

impl Shared {
    /// Centre and extent at a place along the line.
    pub(super) fn place(&self, along: f64) -> (f64, f64) {
        let nearest = self.members.iter().min_by(|a, b| {
            let distance = |m: &Member| (m.along - along).abs();
            distance(a).total_cmp(&distance(b))
        });
        let Some(nearest) = nearest else {
            return (self.at, self.size);
        };
        let spread = |value: fn(&Member) -> f64| {
            let values = self.members.iter().map(value);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            high - low > SPREAD * self.size
        };
        let at = if spread(|m| m.at) {
            nearest.at
        } else {
            self.at
        };
        let size = if spread(|m| m.size) {
            nearest.size
        } else {
            self.size
        };
        (at, size)
    }
}

/// The lines of the seen windows along an axis, in order, and the line of each rectangle.
fn seen_lines(rects: &[Rect], axis: Axis) -> (Vec<Shared>, Vec<usize>) {
    let (found, of) = lines(rects, axis);
    let member = |r: &Rect| Member {
        along: r.start(axis.other()) + r.extent(axis.other()) / 2.0,
        at: r.start(axis) + r.extent(axis) / 2.0,
        size: r.extent(axis),
    };
    let line = |k: usize| {
        let own = rects.iter().zip(&of).filter(|(_, line)| **line == k);
        let members: Vec<Member> = own.map(|(r, _)| member(r)).collect();
        Shared {
            at: median(members.iter().map(|m| m.at)).unwrap_or(found[k].at),
            size: median(members.iter().map(|m| m.size)).unwrap_or(found[k].size),
            members,
        }
    };
    ((0..found.len()).map(line).collect(), of)
}

/// The lines of one axis, in order, and the line of each new window.
#[derive(Debug, Clone)]
pub(super) struct Lines {
    /// Seen and new ones, in order.
    pub all: Vec<Shared>,
    /// The line of each seen window.
    pub of_seen: Vec<usize>,
    /// The line of each new window.
    pub of_new: Vec<usize>,
}

impl Lines {
    /// Lines along `axis`: columns for x, rows for y.
    pub(super) fn new(observation: &Observation, axis: Axis, seen: &[Rect], new: &[Rect]) -> Self {
        // A balcony of one window stands for a window that may be hidden itself.
        let standing = match axis {
            Axis::X => observation.standing(),
            Axis::Y => seen.to_vec(),
        };
        let (mut all, mut of) = seen_lines(&standing, axis);
        let of_seen = of.split_off(standing.len() - seen.len());
        let (typical, length) = (observation.extent(axis), observation.length(axis));
        let centre = |r: &Rect| r.start(axis) + r.extent(axis) / 2.0;
        let count = all.len();
        let near = |r: &Rect| {
            let distance = |k: &usize| (all[*k].at - centre(r)).abs();
            let line = (0..count).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            (distance(&line) < ON_LINE * typical).then_some(line)
        };
        let of_seen_lines: Vec<Option<usize>> = new.iter().map(near).collect();
        let beside: Vec<Rect> = (new.iter().zip(&of_seen_lines))
            .filter(|(_, line)| line.is_none())
            .map(|(r, _)| *r)
            .collect();
        let (mut drawn, of_beside) = seen_lines(&beside, axis);
        let seen_at: Vec<f64> = all.iter().map(|l| l.at).collect();
        let drawn_at: Vec<f64> = drawn.iter().map(|l| l.at).collect();
        let placed = by_rule(&seen_at, &drawn_at, length, typical);
        for (line, at) in drawn.iter_mut().zip(placed) {
            *line = Shared {
                at,
                size: tied(&all, line.size, at, length),
                members: Vec::new(),
            };
        }
        all.extend(drawn);
        let mut next = of_beside.into_iter();
        let of_new = of_seen_lines.into_iter();
        let of_new: Vec<usize> = of_new
            .map(|line| line.or_else(|| next.next().map(|k| count + k)).unwrap_or(0))
            .collect();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| all[a].at.total_cmp(&all[b].at));
        let mut rank = vec![0; all.len()];
        for (place, &line) in order.iter().enumerate() {
            rank[line] = place;
        }
        let ranked = |of: Vec<usize>| of.into_iter().map(|line| rank[line]).collect();
        Self {
            of_seen: ranked(of_seen),
            of_new: ranked(of_new),
            all: order.into_iter().map(|line| all[line].clone()).collect(),
        }
    }
}

/// The seen size that a new line shares: that of its mirror image, the nearest line, or any other one that is its own up to a
/// ratio of 1.15; else its own.
fn tied(seen: &[Shared], own: f64, at: f64, length: f64) -> f64 {
    let nearest = |place: f64| {
        let distance = |line: &&Shared| (line.at - place).abs();
        seen.iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let same = |size: f64| size.max(own) <= SAME_SIZE * size.min(own);
    let image = nearest(length - at).filter(|l| (l.at - (length - at)).abs() < SPREAD * l.size);
    let first = [image, nearest(at)].into_iter().flatten().map(|l| l.size);
    let mut others: Vec<f64> = seen.iter().map(|l| l.size).collect();
    others.sort_by(|a, b| (a / own).ln().abs().total_cmp(&(b / own).ln().abs()));
    first.chain(others).find(|size| same(*size)).unwrap_or(own)
}
