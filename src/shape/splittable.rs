//! Can a tiling be split by full lines down to its single regions (Wu et al. 2014, Sec. 6.3)?

use super::{Axis, Facade, IndexedLayout, LayoutError, Span};

impl Span {
    /// First and one-past-last cut index along `axis`.
    pub fn along(&self, axis: Axis) -> (usize, usize) {
        match axis {
            Axis::X => (self.left, self.right),
            Axis::Y => (self.bottom, self.top),
        }
    }
}

/// Checks that full lines can split a tiling down to single regions, as split grammars need.
///
/// Parts that a line can split are split along all lines of one direction, then of the other, until
/// parts are single regions or no line splits them. O(n) for each level of nesting, no recursion.
///
/// # Errors
/// The errors of [`Facade::check_tiling`]; [`LayoutError::Unsplittable`] with the first part that no
/// full line splits (a pinwheel).
pub fn splittable(facade: &Facade) -> Result<(), LayoutError> {
    facade.check_tiling()?;
    let layout = facade.indexed()?;
    let mut order: Vec<u32> = (0..layout.spans.len() as u32).collect();
    order.sort_unstable_by_key(|&i| layout.spans[i as usize].bottom);
    let all = Part {
        by_y: order.clone(),
        by_x: {
            order.sort_by_key(|&i| layout.spans[i as usize].left);
            order
        },
    };
    let mut group = vec![0u32; layout.spans.len()];
    let mut stack = vec![all];
    while let Some(part) = stack.pop() {
        if part.by_x.len() == 1 {
            continue;
        }
        let parts = part
            .split(Axis::Y, &layout, &mut group)
            .or_else(|| part.split(Axis::X, &layout, &mut group))
            .ok_or_else(|| pinwheel(facade, &part.by_x))?;
        stack.extend(parts);
    }
    Ok(())
}

/// Regions of one part of the facade, sorted by where they start along each axis.
struct Part {
    by_x: Vec<u32>,
    by_y: Vec<u32>,
}

impl Part {
    /// Splits along all full lines across `axis`; `None` if there is none.
    fn split(&self, axis: Axis, layout: &IndexedLayout, group: &mut [u32]) -> Option<Vec<Part>> {
        let sorted = match axis {
            Axis::X => &self.by_x,
            Axis::Y => &self.by_y,
        };
        let mut groups = 0;
        let mut reach = None;
        for &index in sorted {
            let (start, end) = layout.spans[index as usize].along(axis);
            // Where a region starts and none before it reaches further, a full line passes.
            groups += u32::from(reach.is_some_and(|reach| start >= reach));
            group[index as usize] = groups;
            reach = reach.max(Some(end));
        }
        if groups == 0 {
            return None;
        }
        let mut parts: Vec<Part> = (0..=groups)
            .map(|_| Part {
                by_x: Vec::new(),
                by_y: Vec::new(),
            })
            .collect();
        for &index in &self.by_x {
            parts[group[index as usize] as usize].by_x.push(index);
        }
        for &index in &self.by_y {
            parts[group[index as usize] as usize].by_y.push(index);
        }
        Some(parts)
    }
}

/// The error for a part that no full line splits.
fn pinwheel(facade: &Facade, indices: &[u32]) -> LayoutError {
    let rects = || indices.iter().map(|&i| facade.regions[i as usize].rect);
    let first = indices.iter().copied().min().unwrap_or(0) as usize;
    LayoutError::Unsplittable {
        x: rects().map(|r| r.x).fold(f64::INFINITY, f64::min),
        y: rects().map(|r| r.y).fold(f64::INFINITY, f64::min),
        right: rects().map(|r| r.right()).fold(0.0, f64::max),
        top: rects().map(|r| r.top()).fold(0.0, f64::max),
        count: indices.len(),
        index: first,
        label: facade.regions[first].label.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::facade;

    #[test]
    fn a_pinwheel_is_named_wherever_it_hides() {
        let wheel = [
            (0.0, 1.0, 1.0, 2.0),
            (1.0, 2.0, 2.0, 1.0),
            (2.0, 0.0, 1.0, 2.0),
            (0.0, 0.0, 2.0, 1.0),
            (1.0, 1.0, 1.0, 1.0),
        ];
        let alone = splittable(&facade(3.0, &wheel)).unwrap_err();
        assert!(matches!(
            alone,
            LayoutError::Unsplittable {
                count: 5,
                index: 0,
                ..
            }
        ));
        let mut inside = vec![(0.0, 0.0, 4.0, 1.0), (0.0, 1.0, 1.0, 3.0)];
        inside.extend(wheel.map(|(x, y, w, h)| (x + 1.0, y + 1.0, w, h)));
        let text = splittable(&facade(4.0, &inside)).unwrap_err().to_string();
        let expected =
            "no full line splits the 5 regions from (1, 1) to (4, 4), regions[2] (a) first";
        assert!(text.contains(expected), "{text}");
    }

    #[test]
    fn deep_spirals_neither_loop_nor_overflow() {
        // Peels one strip a side, a thousand times: nesting as deep as the regions are many.
        let (mut rects, n) = (Vec::new(), 1000);
        let (mut x, mut y, mut right, mut top) = (0, 0, n, n);
        for side in 0..n {
            let (strip, rest) = match side % 4 {
                0 => ((x, y, right, y + 1), (x, y + 1, right, top)),
                1 => ((right - 1, y, right, top), (x, y, right - 1, top)),
                2 => ((x, top - 1, right, top), (x, y, right, top - 1)),
                _ => ((x, y, x + 1, top), (x + 1, y, right, top)),
            };
            rects.push(strip);
            (x, y, right, top) = rest;
        }
        rects.push((x, y, right, top));
        let rects: Vec<_> = rects
            .iter()
            .map(|&(x, y, r, t)| (x as f64, y as f64, (r - x) as f64, (t - y) as f64))
            .collect();
        assert_eq!(splittable(&facade(n as f64, &rects)), Ok(()));
    }
}
