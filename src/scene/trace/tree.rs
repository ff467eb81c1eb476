//! Triangles in a tree of boxes, split at the middle of the longest axis.

use super::{V, cross, dot, sub, unit};

/// Triangles in a leaf at most.
const LEAF: usize = 4;

/// A tree of triangles.
pub(super) struct Tree {
    corners: Vec<[V; 3]>,
    order: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    low: V,
    high: V,
    /// A leaf has `count` triangles of the order from `first` on; an inner node (count 0) has its children at
    /// the next place and at `first`.
    first: u32,
    count: u32,
}

/// What a ray meets first.
pub(super) struct Hit {
    pub distance: f32,
    pub triangle: usize,
}

impl Tree {
    pub fn new(corners: Vec<[V; 3]>) -> Self {
        let mut tree = Self {
            order: (0..corners.len() as u32).collect(),
            nodes: Vec::with_capacity(corners.len()),
            corners,
        };
        if !tree.order.is_empty() {
            tree.build(0, tree.order.len());
        }
        tree
    }

    fn build(&mut self, from: usize, to: usize) {
        let fold = |start: f32, pick: fn(f32, f32) -> f32| {
            let mut out = [start; 3];
            for &t in &self.order[from..to] {
                for p in &self.corners[t as usize] {
                    out = [0, 1, 2].map(|i| pick(out[i], p[i]));
                }
            }
            out
        };
        let (low, high) = (
            fold(f32::INFINITY, f32::min),
            fold(f32::NEG_INFINITY, f32::max),
        );
        let index = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            first: from as u32,
            count: (to - from) as u32,
        });
        if to - from <= LEAF {
            return;
        }
        let axis = (0..3).max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b])));
        let axis = axis.unwrap_or(0);
        let corners = &self.corners;
        let middle = |t: &u32| corners[*t as usize].iter().map(|p| p[axis]).sum::<f32>();
        let half = (from + to) / 2;
        self.order[from..to].select_nth_unstable_by(half - from, |a, b| {
            middle(a).total_cmp(&middle(b)).then(a.cmp(b))
        });
        self.nodes[index].count = 0;
        self.build(from, half);
        self.nodes[index].first = self.nodes.len() as u32;
        self.build(half, to);
    }

    /// Unit normal of a triangle.
    pub fn normal(&self, triangle: usize) -> V {
        let [a, b, c] = self.corners[triangle];
        unit(cross(sub(b, a), sub(c, a)))
    }

    /// The first triangle that a ray meets from its front within a distance.
    pub fn nearest(&self, from: V, ray: V, most: f32) -> Option<Hit> {
        let inverse = ray.map(|v| 1.0 / if v.abs() < 1e-12 { 1e-12 } else { v });
        let mut best = Hit {
            distance: most,
            triangle: usize::MAX,
        };
        let mut stack = [0_u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if !node.meets(from, inverse, best.distance) {
                continue;
            }
            if node.count > 0 {
                let own = node.first as usize..(node.first + node.count) as usize;
                for &t in &self.order[own] {
                    if let Some(distance) = meet(&self.corners[t as usize], from, ray)
                        && distance < best.distance
                    {
                        best = Hit {
                            distance,
                            triangle: t as usize,
                        };
                    }
                }
            } else if depth + 2 <= stack.len() {
                stack[depth] = node.first;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
            }
        }
        (best.triangle != usize::MAX).then_some(best)
    }
}

impl Node {
    fn meets(&self, from: V, inverse: V, most: f32) -> bool {
        let (mut near, mut far) = (0.0_f32, most);
        for i in 0..3 {
            let (a, b) = (
                (self.low[i] - from[i]) * inverse[i],
                (self.high[i] - from[i]) * inverse[i],
            );
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        near <= far
    }
}

/// Distance to a triangle along a ray (Möller and Trumbore 1997), from its front only.
fn meet(corners: &[V; 3], from: V, ray: V) -> Option<f32> {
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
