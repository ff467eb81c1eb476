//! The draw that agrees best with all draws, and how probable its elements are.

use std::cmp::Ordering;

use super::walls::Span;

/// Least intersection over union of elements that match.
const MATCH: f64 = 0.5;

/// Elements that are compared for one building at most, unless so few draws would judge: the mean over few draws of
/// thousands of elements is as sure as that over many of few.
const COMPARISONS: usize = 4_000_000;
const LEAST_JUDGES: usize = 10;

/// A window or a door.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ElementKind {
    /// A window.
    Window,
    /// A door.
    Door,
}

/// An element on a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Element {
    /// Its kind.
    pub(super) kind: ElementKind,
    /// Index of the wall.
    pub(super) wall: usize,
    /// Number of its storey, the ground floor is 0.
    pub(super) storey: usize,
    /// Extent along the wall and upwards (m).
    pub(super) rect: Span,
}

/// An element of the answer with its probability; a baseline knows none.
pub(super) type Probable = (Element, Option<f64>);

/// Intersection over union of two rectangles.
pub(super) fn iou(a: Span, b: Span) -> f64 {
    let common = |i: usize| (a[i][1].min(b[i][1]) - a[i][0].max(b[i][0])).max(0.0);
    let area = |r: Span| (r[0][1] - r[0][0]) * (r[1][1] - r[1][0]);
    let both = common(0) * common(1);
    both / (area(a) + area(b) - both)
}

/// The order of the elements of a draw: by kind, wall, lower and left edge, so that a row of windows stands together.
fn order(a: &Element, b: &Element) -> Ordering {
    compare(a, b.kind, b.wall, [b.rect[1][0], b.rect[0][0]])
}

/// The place of an element in that order against a kind, a wall, a lower and a left edge.
fn compare(a: &Element, kind: ElementKind, wall: usize, [foot, left]: [f64; 2]) -> Ordering {
    (a.kind, a.wall)
        .cmp(&(kind, wall))
        .then(a.rect[1][0].total_cmp(&foot))
        .then(a.rect[0][0].total_cmp(&left))
}

/// True if elements are next to each other in one row.
fn is_one_row(a: &Element, b: &Element) -> bool {
    (a.kind, a.wall, a.rect[1][0]) == (b.kind, b.wall, b.rect[1][0])
}

/// Tells the indices of a draw's elements that another draw has, too. Both are in [`order`]; elements of a draw never
/// overlap, so that at most one matches with an intersection over union above one half.
///
/// Complexity: the number of elements of both, and for each row the logarithm of the other's elements.
fn matches(draw: &[Element], other: &[Element], mut found: impl FnMut(usize)) {
    let mut index = 0;
    for row in draw.chunk_by(is_one_row) {
        let Element {
            kind, wall, rect, ..
        } = row[0];
        let foot = rect[1][0];
        let top = row.iter().map(|e| e.rect[1][1]).fold(foot, f64::max);
        // What matches is at most twice as high.
        let lowest = [3.0 * foot - 2.0 * top, f64::NEG_INFINITY];
        let first = other.partition_point(|o| compare(o, kind, wall, lowest).is_lt());
        let near = |o: &&Element| (o.kind, o.wall) == (kind, wall) && o.rect[1][0] < top;
        let near = other[first..].iter().take_while(near).count();
        let near = other[first..first + near].chunk_by(is_one_row);
        let mut near: Vec<&[Element]> = near.collect();
        for e in row {
            let [left, right] = e.rect[0];
            let has = |row: &mut &[Element]| {
                while let Some((_, rest)) = row.split_first().filter(|(o, _)| o.rect[0][1] <= left)
                {
                    *row = rest;
                }
                let mut here = row.iter().take_while(|o| o.rect[0][0] < right);
                here.any(|o| iou(o.rect, e.rect) >= MATCH)
            };
            if near.iter_mut().any(has) {
                found(index);
            }
            index += 1;
        }
    }
}

/// The draw of the largest mean F1 with all others, its elements with the share of draws that have them; the first of
/// equals. Empty without draws. Where all draws together have more than 40,000 elements, the first draws judge, as many
/// as four million comparisons allow, at least ten.
///
/// Complexity: draws squared times elements, at most linear in the elements of large buildings.
pub(super) fn choose(mut draws: Vec<Vec<Element>>) -> Vec<Probable> {
    draws.iter_mut().for_each(|d| d.sort_by(order));
    let f1 = |a: &[Element], b: &[Element]| {
        let mut common = 0;
        matches(a, b, |_| common += 1);
        match a.len() + b.len() {
            0 => 1.0,
            all => 2.0 * f64::from(common) / all as f64,
        }
    };
    let elements: usize = draws.iter().map(Vec::len).sum();
    let judges = (COMPARISONS / elements.max(1)).max(LEAST_JUDGES);
    let mean = |a: &[Element]| {
        let judges = draws.iter().take(judges);
        judges.map(|b| f1(a, b)).sum::<f64>()
    };
    let mut best: Option<(f64, &Vec<Element>)> = None;
    for draw in &draws {
        let score = mean(draw);
        if best.is_none_or(|(known, _)| score > known) {
            best = Some((score, draw));
        }
    }
    let Some((_, best)) = best else {
        return Vec::new();
    };
    let mut with = vec![0_u32; best.len()];
    for draw in &draws {
        matches(best, draw, |k| with[k] += 1);
    }
    let share = |with: u32| Some(f64::from(with) / draws.len() as f64);
    let probable = best.iter().zip(with).map(|(e, with)| (*e, share(with)));
    probable.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::{Rng, RngExt};

    /// Elements that do not overlap: rows of windows at equal heights, some left out, and others anywhere.
    fn drawn(rng: &mut impl Rng) -> Vec<Element> {
        let mut draw: Vec<Element> = Vec::new();
        let size = [0, 1].map(|_| rng.random_range(0.4..1.6_f64));
        for k in 0..40 {
            let (mut size, mut at) = (size, [1.7 * f64::from(k % 4), 1.8 * f64::from(k / 4 % 3)]);
            if k >= 12 {
                size = size.map(|_| rng.random_range(0.3..1.6_f64));
                at = at.map(|_| rng.random_range(0.0..6.0_f64));
            }
            let e = Element {
                kind: [ElementKind::Window, ElementKind::Door][usize::from(k == 39)],
                wall: rng.random_range(0..2),
                storey: 0,
                rect: [0, 1].map(|i| [at[i], at[i] + size[i]]),
            };
            let others = draw.iter().filter(|o| o.wall == e.wall);
            if rng.random_bool(0.8) && others.map(|o| iou(o.rect, e.rect)).all(|v| v <= 0.0) {
                draw.push(e);
            }
        }
        draw.sort_by(order);
        draw
    }

    #[test]
    fn elements_are_matched_as_by_looking_at_all() {
        let mut rng = stream(1, "choice", 0);
        let mut sum = 0;
        for _ in 0..3000 {
            let [a, b] = [0, 1].map(|_| drawn(&mut rng));
            let plain = |e: &Element| {
                let same = |o: &&Element| o.wall == e.wall && o.kind == e.kind;
                let mut all = b.iter().filter(same);
                all.any(|o| iou(o.rect, e.rect) >= MATCH)
            };
            let expected: Vec<usize> = (0..a.len()).filter(|&k| plain(&a[k])).collect();
            let mut found = Vec::new();
            matches(&a, &b, |k| found.push(k));
            assert_eq!(found, expected);
            sum += found.len();
        }
        assert!(sum > 3000, "{sum}");
    }
}
