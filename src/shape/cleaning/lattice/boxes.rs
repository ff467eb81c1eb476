//! Elements of a facade as boxes, and their clusters along an axis.

use crate::{LabelGrid, Span, components};

/// An element smaller than this share of the median area is a speck.
const SPECK: f64 = 0.3;

/// The share of columns from which on all have what these have.
const MOST: f64 = 0.7;

/// Elements this near to each other, as a share of the larger side of a facade, touch.
const TOUCH: f64 = 0.01;

/// A box: left and right, bottom and top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Box4 {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Box4 {
    pub(super) fn area(&self) -> f64 {
        (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
    }
}

/// The bounding boxes of all connected areas, with their labels.
pub(super) fn boxes(grid: &LabelGrid) -> Vec<(usize, Box4)> {
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let found = components(grid, whole, &mut vec![0; grid.cells.len()]);
    let bounds = found.iter().map(|area| {
        let b = area.bounds;
        let x = [grid.xs[b.left], grid.xs[b.right]];
        (
            usize::from(area.label),
            Box4 {
                x,
                y: [grid.ys[b.bottom], grid.ys[b.top]],
            },
        )
    });
    bounds.collect()
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

pub(super) fn without_specks(boxes: Vec<Box4>) -> Vec<Box4> {
    let usual = median(boxes.iter().map(Box4::area).collect());
    boxes
        .into_iter()
        .filter(|b| b.area() >= SPECK * usual)
        .collect()
}

/// A window as far as it is seen, and with the part of it that a balcony hides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub seen: Box4,
    pub whole: Box4,
}

/// Upper sides of boxes in order.
struct Tops(Vec<(f64, usize)>);

impl Tops {
    fn new(boxes: &[Box4]) -> Self {
        let mut tops: Vec<(f64, usize)> = boxes.iter().map(|b| b.y[1]).zip(0..).collect();
        tops.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(tops)
    }

    /// The boxes that end within `reach` of a height, by their upper side.
    fn near(&self, at: f64, reach: f64) -> impl Iterator<Item = usize> + '_ {
        let from = self.0.partition_point(|top| top.0 < at - reach);
        let near = self.0[from..]
            .iter()
            .take_while(move |top| top.0 <= at + reach);
        near.map(|top| top.1)
    }
}

/// The windows without specks: one that stands on a balcony reaches down behind it. What is seen of it below is a speck; a whole
/// window that begins right below the balcony is one of its own.
pub(super) fn behind_balconies(seen: &[Box4], balconies: &[Box4], size: f64) -> Vec<Window> {
    let before =
        |b: &Box4, w: &Box4| b.x[1].min(w.x[1]) - b.x[0].max(w.x[0]) >= 0.5 * (w.x[1] - w.x[0]);
    let tops = Tops::new(balconies);
    let windows = seen.iter().map(|&own| {
        let under = tops.near(own.y[0], TOUCH * size).map(|b| &balconies[b]);
        let hidden = under.filter(|b| before(b, &own)).map(|b| b.y[0]);
        let mut whole = own;
        whole.y[0] = hidden.fold(own.y[0], f64::min);
        Window { seen: own, whole }
    });
    let mut windows: Vec<Window> = windows.collect();
    let usual = median(windows.iter().map(|w| w.whole.area()).collect());
    windows.retain(|w| w.whole.area() >= SPECK * usual);
    windows
}

/// Indices of boxes in clusters of neighbouring centres along one axis, in order.
pub(super) fn clusters(boxes: &[Box4], side: impl Fn(&Box4) -> [f64; 2]) -> Vec<Vec<usize>> {
    let centre = |k: usize| side(&boxes[k]).iter().sum::<f64>() / 2.0;
    let usual = median(boxes.iter().map(|b| side(b)[1] - side(b)[0]).collect());
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| centre(a).total_cmp(&centre(b)));
    let mut out: Vec<Vec<usize>> = Vec::new();
    for k in order {
        match out.last_mut() {
            Some(cluster)
                if cluster
                    .last()
                    .is_some_and(|&last| centre(k) - centre(last) <= usual / 2.0) =>
            {
                cluster.push(k);
            }
            _ => out.push(vec![k]),
        }
    }
    out
}

/// Median lower and upper side of a cluster.
pub(super) fn middle(
    cluster: &[usize],
    boxes: &[Box4],
    side: impl Fn(&Box4) -> [f64; 2],
) -> [f64; 2] {
    [0, 1].map(|end| median(cluster.iter().map(|&k| side(&boxes[k])[end]).collect()))
}

/// True if two lengths have more than an end in common.
pub(super) fn overlap(a: &[f64; 2], b: &[f64; 2]) -> bool {
    a[0] < b[1] && b[0] < a[1]
}

/// All true where most are.
pub(super) fn filled(mut has: Vec<bool>) -> Vec<bool> {
    let count = has.iter().filter(|has| **has).count();
    if count as f64 >= MOST * has.len() as f64 {
        has.fill(true);
    }
    has
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_found_by_their_upper_sides() {
        let tops = [5.0, 1.0, 9.0, 5.5, 3.0, 5.0, 12.0];
        let boxes = tops.map(|top| Box4 {
            x: [0.0, 1.0],
            y: [0.0, top],
        });
        let index = Tops::new(&boxes);
        for at in [-5.0, 1.0, 4.0, 5.0, 5.2, 9.0, 40.0] {
            for reach in [0.0, 0.5, 2.0, 100.0] {
                let mut found: Vec<usize> = index.near(at, reach).collect();
                found.sort_unstable();
                let near = |i: &usize| (tops[*i] - at).abs() <= reach;
                let slow: Vec<usize> = (0..tops.len()).filter(near).collect();
                assert_eq!(found, slow, "{at} {reach}");
            }
        }
    }
}
