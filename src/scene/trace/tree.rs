//! Triangles in a tree of boxes, split where the surface area heuristic (MacDonald and Booth 1990) is least.

use crate::vectors::{V, cross, dot, sub, unit};

/// Triangles in a leaf at most, and places for a split along an axis.
const LEAF: usize = 4;
const BINS: usize = 12;
/// Most boxes that wait for a ray: deeper trees end in larger leaves.
const DEPTH: usize = 48;

/// A tree of triangles.
pub(super) struct Tree {
    corners: Vec<[V; 3]>,
    order: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Bounds,
    /// A leaf has `count` triangles of the order from `first` on; an inner node (count 0) has its children at
    /// the next place and at `first`.
    first: u32,
    count: u32,
}

/// A box.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: V,
    high: V,
}

/// The first triangle that a ray meets.
pub(super) struct Hit {
    pub distance: f32,
    pub triangle: usize,
}

impl Tree {
    pub(super) fn new(corners: Vec<[V; 3]>) -> Self {
        let mut tree = Self {
            order: (0..corners.len() as u32).collect(),
            nodes: Vec::with_capacity(corners.len()),
            corners,
        };
        if !tree.order.is_empty() {
            tree.build(0, tree.order.len(), 0);
        }
        tree
    }

    fn build(&mut self, from: usize, to: usize, depth: usize) {
        let own = self.order[from..to].iter();
        let bounds = own.fold(Bounds::EMPTY, |b, t| b.with(&self.corners[*t as usize]));
        let index = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            first: from as u32,
            count: (to - from) as u32,
        });
        if to - from <= LEAF || depth == DEPTH {
            return;
        }
        let Some(half) = self.split(from, to) else {
            return;
        };
        self.nodes[index].count = 0;
        self.build(from, half, depth + 1);
        self.nodes[index].first = self.nodes.len() as u32;
        self.build(half, to, depth + 1);
    }

    /// Parts the triangles where their areas times their numbers are least; `None` when all have one middle.
    fn split(&mut self, from: usize, to: usize) -> Option<usize> {
        let corners = &self.corners;
        let middle = |t: u32, axis: usize| {
            let c = &corners[t as usize];
            (c[0][axis] + c[1][axis] + c[2][axis]) / 3.0
        };
        let mut best: Option<(f32, usize, f32)> = None;
        for axis in 0..3 {
            let middles = self.order[from..to].iter().map(|t| middle(*t, axis));
            let (low, high) = middles.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            if high - low < 1e-6 {
                continue;
            }
            let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
            let bin = |v: f32| (((v - low) / (high - low) * BINS as f32) as usize).min(BINS - 1);
            for t in &self.order[from..to] {
                let own = &mut bins[bin(middle(*t, axis))];
                *own = (own.0.with(&corners[*t as usize]), own.1 + 1);
            }
            for cut in 1..BINS {
                let cost = |bins: &[(Bounds, usize)]| {
                    let all = bins
                        .iter()
                        .fold((Bounds::EMPTY, 0), |(b, n), (c, m)| (b.joined(c), n + m));
                    (all.1 as f32 * all.0.area(), all.1)
                };
                let ((a, n), (b, m)) = (cost(&bins[..cut]), cost(&bins[cut..]));
                if n > 0 && m > 0 && best.is_none_or(|(least, ..)| a + b < least) {
                    let at = low + (high - low) * cut as f32 / BINS as f32;
                    best = Some((a + b, axis, at));
                }
            }
        }
        let (_, axis, at) = best?;
        let (lower, upper): (Vec<u32>, Vec<u32>) = self.order[from..to]
            .iter()
            .partition(|t| middle(**t, axis) < at);
        let half = from + lower.len();
        self.order[from..half].copy_from_slice(&lower);
        self.order[half..to].copy_from_slice(&upper);
        (half > from && half < to).then_some(half)
    }

    /// Unit normal of a triangle.
    pub(super) fn normal(&self, triangle: usize) -> V {
        let [a, b, c] = self.corners[triangle];
        unit(cross(sub(b, a), sub(c, a)))
    }

    /// The first triangle that a ray meets from its front.
    pub(super) fn nearest(&self, from: V, ray: V) -> Option<Hit> {
        self.meet(from, ray, f32::INFINITY, false)
    }

    /// The first triangle that a ray meets from its front, within a distance.
    pub(super) fn nearest_within(&self, from: V, ray: V, most: f32) -> Option<Hit> {
        self.meet(from, ray, most, false)
    }

    /// True if a ray meets any triangle from its front.
    pub(super) fn blocks(&self, from: V, ray: V) -> bool {
        self.meet(from, ray, 1e4, true).is_some()
    }

    fn meet(&self, from: V, ray: V, most: f32, any: bool) -> Option<Hit> {
        let inverse = ray.map(|v| 1.0 / if v.abs() < 1e-12 { 1e-12 } else { v });
        let mut best = Hit {
            distance: most,
            triangle: usize::MAX,
        };
        let entry = |node: usize, best: &Hit| {
            let near = self.nodes[node].bounds.entry(from, inverse, best.distance);
            near.map(|near| (near, node))
        };
        let mut stack = [(0.0_f32, 0_usize); DEPTH + 2];
        let mut depth = 0;
        let mut next = (!self.nodes.is_empty()).then(|| entry(0, &best)).flatten();
        while let Some((near, index)) = next.take() {
            let node = &self.nodes[index];
            if near < best.distance && node.count > 0 {
                let own = node.first as usize..(node.first + node.count) as usize;
                for &t in &self.order[own] {
                    if let Some(distance) = crossing(&self.corners[t as usize], from, ray)
                        && distance < best.distance
                    {
                        best = Hit {
                            distance,
                            triangle: t as usize,
                        };
                    }
                }
                if any && best.triangle != usize::MAX {
                    return Some(best);
                }
            } else if near < best.distance {
                // The nearer child first.
                match (entry(index + 1, &best), entry(node.first as usize, &best)) {
                    (Some(a), Some(b)) => {
                        let (first, second) = if a.0 <= b.0 { (a, b) } else { (b, a) };
                        stack[depth] = second;
                        depth += 1;
                        next = Some(first);
                    }
                    (a, b) => next = a.or(b),
                }
            }
            if next.is_none() && depth > 0 {
                depth -= 1;
                next = Some(stack[depth]);
            }
        }
        (best.triangle != usize::MAX).then_some(best)
    }
}

impl Bounds {
    const EMPTY: Self = Self {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    fn with(self, corners: &[V; 3]) -> Self {
        corners
            .iter()
            .fold(self, |b, p| b.joined(&Self { low: *p, high: *p }))
    }

    fn joined(self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1, 2].map(|i| self.high[i].max(other.high[i])),
        }
    }

    fn area(&self) -> f32 {
        let [x, y, z] = sub(self.high, self.low);
        if x < 0.0 { 0.0 } else { x * y + y * z + z * x }
    }

    /// The distance at which a ray enters the box; `None` if it does not before `most`.
    fn entry(&self, from: V, inverse: V, most: f32) -> Option<f32> {
        let (mut near, mut far) = (0.0_f32, most);
        for i in 0..3 {
            let (a, b) = (
                (self.low[i] - from[i]) * inverse[i],
                (self.high[i] - from[i]) * inverse[i],
            );
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some(near)
    }
}

/// Distance to a triangle along a ray (Möller and Trumbore 1997), from its front only.
fn crossing(corners: &[V; 3], from: V, ray: V) -> Option<f32> {
    let (e, f) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let p = cross(ray, f);
    let determinant = dot(e, p);
    if determinant < 1e-12 {
        return None;
    }
    let s = sub(from, corners[0]);
    let u = dot(s, p);
    if u < 0.0 || u > determinant {
        return None;
    }
    let q = cross(s, e);
    let v = dot(ray, q);
    if v < 0.0 || u + v > determinant {
        return None;
    }
    let distance = dot(f, q) / determinant;
    (distance > 1e-4).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_of_a_box_is_half_its_surface() {
        let bounds = Bounds {
            low: [1.0, -2.0, 0.5],
            high: [3.0, 1.0, 5.5],
        };
        assert_eq!(bounds.area(), 2.0 * 3.0 + 3.0 * 5.0 + 5.0 * 2.0);
        assert_eq!(Bounds::EMPTY.area(), 0.0);
    }
}
