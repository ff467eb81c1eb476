//! The draw that agrees best with all draws, and how probable its elements are.

use super::walls::Span;

/// Least intersection over union of elements that match.
const MATCH: f64 = 0.5;

/// A window or a door.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// True if a draw has an element where another has one. Elements of a draw never overlap, so that at most one matches
/// with an intersection over union above one half.
fn has(draw: &[Element], e: &Element) -> bool {
    let same = |o: &&Element| o.wall == e.wall && o.kind == e.kind;
    draw.iter()
        .filter(same)
        .any(|o| iou(o.rect, e.rect) >= MATCH)
}

/// The draw of the largest mean F1 with all others, its elements with the share of draws that have them; the first of
/// equals. Empty without draws.
pub(super) fn choose(draws: &[Vec<Element>]) -> Vec<Probable> {
    let f1 = |a: &[Element], b: &[Element]| {
        let common = a.iter().filter(|e| has(b, e)).count();
        match a.len() + b.len() {
            0 => 1.0,
            all => 2.0 * common as f64 / all as f64,
        }
    };
    let mean = |a: &[Element]| draws.iter().map(|b| f1(a, b)).sum::<f64>();
    let mut best: Option<(f64, &Vec<Element>)> = None;
    for draw in draws {
        let score = mean(draw);
        if best.is_none_or(|(known, _)| score > known) {
            best = Some((score, draw));
        }
    }
    let probable = |e: &Element| {
        let with = draws.iter().filter(|d| has(d, e)).count();
        (*e, Some(with as f64 / draws.len() as f64))
    };
    best.map_or_else(Vec::new, |(_, d)| d.iter().map(probable).collect())
}
