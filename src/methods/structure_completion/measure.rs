//! Agreement of a completion with the truth, computed without knowledge of any method.

use super::layout::Element;
use edifice_shape::Rect;

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
    for class in super::layout::Class::ALL {
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

/// Area of a union of rectangles, strip by strip.
fn covered(rects: &[Rect]) -> f64 {
    let mut xs: Vec<f64> = rects.iter().flat_map(|r| [r.x, r.right()]).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    let mut area = 0.0;
    for strip in xs.windows(2) {
        let across = rects
            .iter()
            .filter(|r| r.x <= strip[0] && r.right() >= strip[1]);
        let mut spans: Vec<(f64, f64)> = across.map(|r| (r.y, r.top())).collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut length, mut reached) = (0.0, f64::NEG_INFINITY);
        for (from, to) in spans {
            length += (to - from.max(reached)).max(0.0);
            reached = reached.max(to);
        }
        area += length * (strip[1] - strip[0]);
    }
    area
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Class;

    fn window(x: f64) -> Element {
        Element::new(Class::Window, Rect::new(x, 0.0, 2.0, 2.0))
    }

    #[test]
    fn agreement_by_hand() {
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
    fn areas_by_hand() {
        let iou = area_iou(&[window(0.0), window(1.0)], &[window(1.0)]);
        assert!((iou - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!(area_iou(&[], &[]), 1.0);
    }
}
