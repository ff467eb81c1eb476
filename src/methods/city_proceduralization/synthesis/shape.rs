//! Shapes on the ground.

/// A shape on the ground: rings in metres, even-odd.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shape {
    /// The rings; the last corner joins the first.
    pub rings: Vec<Vec<[f64; 2]>>,
}

impl Shape {
    /// True if a point is inside.
    pub fn contains(&self, p: [f64; 2]) -> bool {
        let mut inside = false;
        for ring in &self.rings {
            for (i, a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if (a[1] > p[1]) != (b[1] > p[1])
                    && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                {
                    inside = !inside;
                }
            }
        }
        inside
    }

    /// Lowest and highest coordinates; `None` without corners.
    pub fn bounds(&self) -> Option<([f64; 2], [f64; 2])> {
        let corners = self.rings.iter().flatten();
        corners.fold(None, |b: Option<([f64; 2], [f64; 2])>, p| {
            let (l, h) = b.unwrap_or((*p, *p));
            Some((
                [l[0].min(p[0]), l[1].min(p[1])],
                [h[0].max(p[0]), h[1].max(p[1])],
            ))
        })
    }

    /// Area, holes taken off.
    pub fn area(&self) -> f64 {
        // Rings inside others count against them, whatever way they turn.
        let ring_area = |ring: &Vec<[f64; 2]>| {
            let n = ring.len();
            let doubled: f64 = (0..n)
                .map(|i| {
                    let (a, b) = (ring[i], ring[(i + 1) % n]);
                    a[0] * b[1] - a[1] * b[0]
                })
                .sum();
            doubled.abs() / 2.0
        };
        let depth = |i: usize| {
            let others = self.rings.iter().enumerate().filter(|(j, _)| *j != i);
            let around = others.filter(|(_, r)| {
                let one = Self {
                    rings: vec![(*r).clone()],
                };
                self.rings[i].first().is_some_and(|&p| one.contains(p))
            });
            around.count()
        };
        (0..self.rings.len())
            .map(|i| ring_area(&self.rings[i]) * if depth(i) % 2 == 0 { 1.0 } else { -1.0 })
            .sum()
    }
}

/// A vector turned by degrees.
pub(super) fn rotated([x, y]: [f64; 2], degrees: f64) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}
