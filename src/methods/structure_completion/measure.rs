//! Agreement of a completion with the truth, computed without knowledge of any method.

use super::layout::{Class, Element};
use edifice_shape::comparison::covered;
use edifice_shape::{Axis, Rect};

/// Precision, recall and their harmonic mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// 2 matched / (predicted + true); 1 where both are empty.
    pub f1: f64,
    /// matched / true; 1 where nothing is hidden.
    pub recall: f64,
    /// matched / predicted; 1 where nothing is predicted.
    pub precision: f64,
    /// Number of matched pairs.
    pub matched: usize,
}

/// Pairs predicted and true elements of one class one to one, by falling intersection over union, as
/// long as that is at least `least`.
pub fn agreement(predicted: &[Element], truth: &[Element], least: f64) -> Agreement {
    let mut pairs = Vec::new();
    for (i, p) in predicted.iter().enumerate() {
        for (j, t) in truth.iter().enumerate().filter(|(_, t)| t.class == p.class) {
            let iou = p.rect.iou(&t.rect);
            if iou >= least && iou > 0.0 {
                pairs.push((iou, i, j));
            }
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut taken = (vec![false; predicted.len()], vec![false; truth.len()]);
    let mut matched = 0;
    for (_, i, j) in pairs {
        if !taken.0[i] && !taken.1[j] {
            (taken.0[i], taken.1[j]) = (true, true);
            matched += 1;
        }
    }
    let share = |of: usize| {
        if of == 0 {
            1.0
        } else {
            matched as f64 / of as f64
        }
    };
    let both = predicted.len() + truth.len();
    Agreement {
        f1: if both == 0 {
            1.0
        } else {
            2.0 * matched as f64 / both as f64
        },
        recall: share(truth.len()),
        precision: share(predicted.len()),
        matched,
    }
}

/// Intersection over union of the areas that predicted and true elements cover, class by class; 1 where
/// neither covers any.
pub fn area_iou(predicted: &[Element], truth: &[Element]) -> f64 {
    let (mut shared, mut union) = (0.0, 0.0);
    for class in Class::ALL {
        let of = |elements: &[Element]| -> Vec<Rect> {
            let same = elements.iter().filter(|e| e.class == class);
            same.map(|e| e.rect).collect()
        };
        let (p, t) = (of(predicted), of(truth));
        let all: Vec<Rect> = p.iter().chain(&t).copied().collect();
        let (a, b, both) = (covered(&p), covered(&t), covered(&all));
        shared += a + b - both;
        union += both;
    }
    if union > 0.0 { shared / union } else { 1.0 }
}

/// Share of the smaller of two elements above which they overlap.
const OVERLAP: f64 = 0.02;

/// Number of pairs of elements, at least one of them added, that overlap by more than 2 % of the smaller one, but for
/// balconies before something else.
pub fn overlaps(observed: &[Element], added: &[Element]) -> usize {
    let overlap = |a: &Element, b: &Element| {
        let least = a.rect.area().min(b.rect.area());
        !a.class.may_overlap(b.class) && a.rect.overlap(&b.rect) > OVERLAP * least
    };
    let of = |(k, a): (usize, &Element)| {
        let others = observed.iter().chain(&added[..k]);
        others.filter(|b| overlap(a, b)).count()
    };
    added.iter().enumerate().map(of).sum()
}

/// Windows share a line when their centres differ by at most this share of the extent of the smaller one.
const IN_LINE: f64 = 0.05;

/// Number of added windows whose centre is in line with that of no other window, observed or added, along x or along y:
/// windows that lack a column or a row.
pub fn off_lines(observed: &[Element], added: &[Element]) -> usize {
    let windows: Vec<Rect> = (added.iter().chain(observed))
        .filter(|e| e.class == Class::Window)
        .map(|e| e.rect)
        .collect();
    let new = added.iter().filter(|e| e.class == Class::Window).count();
    let in_line = |a: &Rect, b: &Rect, axis: Axis| {
        let centre = |r: &Rect| r.start(axis) + r.extent(axis) / 2.0;
        let least = a.extent(axis).min(b.extent(axis));
        (centre(a) - centre(b)).abs() <= IN_LINE * least
    };
    let off = |k: &usize| {
        let lacks = |axis: Axis| {
            let mut others = windows.iter().enumerate().filter(|(o, _)| o != k);
            !others.any(|(_, other)| in_line(&windows[*k], other, axis))
        };
        lacks(Axis::X) || lacks(Axis::Y)
    };
    (0..new).filter(off).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(x: f64) -> Element {
        Element::new(Class::Window, Rect::new(x, 0.0, 2.0, 2.0))
    }

    #[test]
    fn agreement_by_hand() {
        // What does not overlap is no pair, whatever is asked.
        assert_eq!(agreement(&[window(0.0)], &[window(500.0)], 0.0).matched, 0);
        let truth = [window(0.0), window(10.0), window(20.0)];
        let predicted = [window(0.1), window(10.9), window(30.0)];
        let half = agreement(&predicted, &truth, 0.5);
        assert_eq!(half.matched, 1);
        assert!((half.f1 - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(agreement(&predicted, &truth, 0.25).matched, 2);
        // One prediction serves one element only.
        assert_eq!(
            agreement(&[window(0.0), window(0.0)], &truth, 0.5).matched,
            1
        );
        let door = Element::new(Class::Door, truth[0].rect);
        assert_eq!(agreement(&[door], &truth, 0.25).matched, 0);
        assert_eq!(agreement(&[], &[], 0.5).f1, 1.0);
    }

    #[test]
    fn coherence_by_hand() {
        let at = |x: f64, y: f64| Element::new(Class::Window, Rect::new(x, y, 2.0, 2.0));
        let observed = [at(0.0, 0.0), at(10.0, 0.0), at(0.0, 10.0)];
        assert_eq!(off_lines(&observed, &[at(10.0, 10.0)]), 0);
        // On a column, on no row.
        assert_eq!(off_lines(&observed, &[at(10.0, 11.0)]), 1);
        // Two that make a row of their own.
        assert_eq!(off_lines(&observed, &[at(10.0, 20.0), at(0.0, 20.05)]), 0);
        assert_eq!(overlaps(&observed, &[at(11.0, 0.0), at(20.0, 0.0)]), 1);
        assert_eq!(overlaps(&observed, &[at(1.99, 0.0)]), 0);
        let balcony = Element::new(Class::Balcony, Rect::new(0.0, 0.0, 2.0, 1.0));
        assert_eq!(overlaps(&observed, &[balcony]), 0);
        assert_eq!(overlaps(&observed, &[balcony, balcony]), 1);
    }

    #[test]
    fn areas_by_hand() {
        let iou = area_iou(&[window(0.0), window(1.0)], &[window(1.0)]);
        assert!((iou - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!(area_iou(&[], &[]), 1.0);
    }
}
