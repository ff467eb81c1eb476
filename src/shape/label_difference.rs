//! The area on which two facades disagree.

use crate::{Facade, Rect, Region};

impl Facade {
    /// The area where the labels of two facades at the same origin differ, relative to the area of `truth`: 0 where they are alike. An
    /// area that only one of them labels differs, so that the ratio can be above 1 where this facade is the larger one.
    pub fn label_difference(&self, truth: &Facade) -> f64 {
        let edges = |low: fn(&Rect) -> f64, high: fn(&Rect) -> f64, end: f64| {
            let all = self.regions.iter().chain(&truth.regions);
            let mut edges: Vec<f64> = all.flat_map(|r| [low(&r.rect), high(&r.rect)]).collect();
            edges.extend([0.0, end]);
            edges.sort_by(f64::total_cmp);
            edges.dedup();
            edges
        };
        let xs = edges(|r| r.x, Rect::right, truth.width);
        let ys = edges(|r| r.y, Rect::top, truth.height);
        let columns = xs.len() - 1;
        let (a, b) = (
            painted(&self.regions, &xs, &ys),
            painted(&truth.regions, &xs, &ys),
        );
        let name = |side: &(Vec<&str>, Vec<usize>), cell: usize| {
            side.0.get(side.1[cell]).map(|label| (*label).to_owned())
        };
        let mut wrong = 0.0;
        for row in 0..ys.len() - 1 {
            for column in 0..columns {
                let cell = row * columns + column;
                if name(&a, cell) != name(&b, cell) {
                    wrong += (xs[column + 1] - xs[column]) * (ys[row + 1] - ys[row]);
                }
            }
        }
        wrong / (truth.width * truth.height)
    }
}

/// The label of each cell between sorted coordinates, row by row: distinct labels, and an index into them, which is beyond their end where no region
/// lies.
fn painted<'a>(regions: &'a [Region], xs: &[f64], ys: &[f64]) -> (Vec<&'a str>, Vec<usize>) {
    let columns = xs.len() - 1;
    let mut labels: Vec<&str> = Vec::new();
    let mut cells = vec![usize::MAX; columns * (ys.len() - 1)];
    let span = |edges: &[f64], from: f64, to: f64| {
        edges.partition_point(|e| *e < from)..edges.partition_point(|e| *e < to)
    };
    for region in regions {
        let r = &region.rect;
        let known = labels.iter().position(|label| *label == region.label);
        let label = known.unwrap_or_else(|| {
            labels.push(&region.label);
            labels.len() - 1
        });
        for row in span(ys, r.y, r.top()) {
            for column in span(xs, r.x, r.right()) {
                cells[row * columns + column] = label;
            }
        }
    }
    (labels, cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facade(split: f64) -> Facade {
        let region = |label: &str, x, width| Region {
            label: label.into(),
            rect: Rect::new(x, 0.0, width, 2.0),
        };
        let regions = vec![region("a", 0.0, split), region("b", split, 10.0 - split)];
        Facade::new("f", "px", 10.0, 2.0, regions).unwrap()
    }

    #[test]
    fn the_share_that_differs_by_hand() {
        assert_eq!(facade(4.0).label_difference(&facade(4.0)), 0.0);
        assert!((facade(4.0).label_difference(&facade(5.0)) - 0.1).abs() < 1e-12);
        // What lies outside the other's outline differs, too.
        let region = Region {
            label: "a".into(),
            rect: Rect::new(0.0, 0.0, 30.0, 2.0),
        };
        let long = Facade::new("f", "px", 30.0, 2.0, vec![region]).unwrap();
        assert!((long.label_difference(&facade(4.0)) - 2.6).abs() < 1e-12);
    }
}
