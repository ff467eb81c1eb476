//! The draw that agrees best with all draws, and how probable its elements are.

use super::walls::Span;

/// Least intersection over union of elements that match.
const MATCH: f64 = 0.5;

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

/// The order of the elements of a draw: by kind, wall and left edge.
fn order(a: &Element, b: &Element) -> std::cmp::Ordering {
    (a.kind, a.wall)
        .cmp(&(b.kind, b.wall))
        .then(a.rect[0][0].total_cmp(&b.rect[0][0]))
}

/// True if a draw, in [`order`], has an element where another has one. Elements of a draw never overlap, so that at most
/// one matches with an intersection over union above one half.
fn has(draw: &[Element], e: &Element) -> bool {
    let [left, right] = e.rect[0];
    // What matches is at most twice as wide.
    let mut first = *e;
    first.rect[0][0] = left - 2.0 * (right - left);
    let start = draw.partition_point(|o| order(o, &first).is_lt());
    let near = draw[start..].iter();
    near.take_while(|o| (o.kind, o.wall) == (e.kind, e.wall) && o.rect[0][0] < right)
        .any(|o| iou(o.rect, e.rect) >= MATCH)
}

/// The draw of the largest mean F1 with all others, its elements with the share of draws that have them; the first of
/// equals. Empty without draws.
///
/// Complexity: draws squared times elements times the logarithm of the elements.
pub(super) fn choose(mut draws: Vec<Vec<Element>>) -> Vec<Probable> {
    draws.iter_mut().for_each(|d| d.sort_by(order));
    let f1 = |a: &[Element], b: &[Element]| {
        let common = a.iter().filter(|e| has(b, e)).count();
        match a.len() + b.len() {
            0 => 1.0,
            all => 2.0 * common as f64 / all as f64,
        }
    };
    let mean = |a: &[Element]| draws.iter().map(|b| f1(a, b)).sum::<f64>();
    let mut best: Option<(f64, &Vec<Element>)> = None;
    for draw in &draws {
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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::RngExt;

    #[test]
    fn an_element_is_found_as_by_looking_at_all() {
        let mut rng = stream(1, "choice", 0);
        let mut found = 0;
        for _ in 0..3000 {
            let mut element = || {
                let [u, z] = [0, 1].map(|_| rng.random_range(0.0..1.5_f64));
                let [w, h] = [0, 1].map(|_| rng.random_range(0.4..1.6_f64));
                Element {
                    kind: [ElementKind::Window, ElementKind::Door][rng.random_range(0..2)],
                    wall: rng.random_range(0..2),
                    storey: 0,
                    rect: [[u, u + w], [z, z + h]],
                }
            };
            let mut draw: Vec<Element> = (0..12).map(|_| element()).collect();
            let e = element();
            let same = |o: &&Element| o.wall == e.wall && o.kind == e.kind;
            let mut all = draw.iter().filter(same);
            let plain = all.any(|o| iou(o.rect, e.rect) >= MATCH);
            draw.sort_by(order);
            assert_eq!(has(&draw, &e), plain);
            found += usize::from(plain);
        }
        assert!(found > 100);
    }
}
