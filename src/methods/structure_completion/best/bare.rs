//! Seen windows without a balcony, where no mask tells what is hidden.
//!
//! A balcony may be hidden though its window is seen where elements are hidden one by one. Where a region is hidden, a window
//! and its balcony are hidden or seen together, those of the lowest seen row apart: their balconies may hang into the region. The rows tell
//! which it is: of the cells that three seen windows at the corners of a rectangle imply, few are empty where no single
//! window is hidden, and then no single balcony is.

use super::at_most;
use super::belong::is_host;
use super::candidates::Candidate;
use crate::layout::Class;
use edifice_shape::Rect;

/// Share of the implied cells that is seen: up to the first, elements are hidden one by one; from the second on none is.
const CLOSED: [f64; 2] = [0.5, 0.9];

/// Changes the probabilities of balconies at both overlaps that would hang on a seen window. `closed` is the share of the
/// implied cells that is seen.
pub(super) fn weigh(
    windows: &[Rect],
    closed: f64,
    candidates: &[Candidate],
    [loose, tight]: [&mut [f64]; 2],
) {
    let factor = at_most(closed, CLOSED);
    let lowest = windows.iter().map(|w| w.y).fold(f64::INFINITY, f64::min);
    let above: Vec<&Rect> = windows
        .iter()
        .filter(|w| w.y > lowest + 0.5 * w.height)
        .collect();
    for (candidate, (loose, tight)) in candidates.iter().zip(loose.iter_mut().zip(tight)) {
        let element = &candidate.element;
        if element.class == Class::Balcony && above.iter().any(|w| is_host(w, &element.rect)) {
            *loose *= factor;
            *tight *= factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::completion::Reason;
    use crate::layout::Element;

    #[test]
    fn a_seen_window_keeps_no_balcony_where_none_is_hidden_one_by_one() {
        let window = |r: f64| Rect::new(10.0, 50.0 * r, 20.0, 30.0);
        let windows = [window(0.0), window(1.0)];
        let under = |w: Rect| Rect::new(w.x - 2.0, w.y - 5.0, 24.0, 12.0);
        let all = [
            (Class::Balcony, under(window(0.0))),
            (Class::Balcony, under(window(1.0))),
            (Class::Balcony, under(window(2.0))),
            (Class::Window, window(1.0)),
        ];
        let candidate = |(class, rect): (Class, Rect)| Candidate {
            element: Element::new(class, rect),
            reason: Reason::Lattice,
            support: Default::default(),
            features: Vec::new(),
        };
        let candidates = all.map(candidate);
        let weighed = |closed: f64| {
            let (mut loose, mut tight) = (vec![0.8; 4], vec![0.4; 4]);
            weigh(&windows, closed, &candidates, [&mut loose, &mut tight]);
            (loose, tight)
        };
        assert_eq!(weighed(0.4), (vec![0.8; 4], vec![0.4; 4]));
        // The lowest balcony may be hidden with what is below, the third has no seen window.
        assert_eq!(weighed(1.0).0, [0.8, 0.0, 0.8, 0.8]);
        let half = weighed(0.7).1[1];
        assert!((half - 0.2).abs() < 1e-12, "{half}");
    }
}
