//! Exact distances from points to a set of triangles, by a tree of boxes.

use super::Corners;
use crate::vec3::{cross, dot, norm, sub};

/// Triangles in a leaf of the tree at most.
const LEAF: usize = 6;

/// Triangles in a tree of boxes.
pub struct SurfaceDistance {
    triangles: Vec<Corners>,
    nodes: Vec<Node>,
}

struct Node {
    low: [f64; 3],
    high: [f64; 3],
    /// Range of triangles.
    range: (usize, usize),
    /// Index of the second child; the first one follows its parent. 0 for a leaf.
    second: usize,
}

impl SurfaceDistance {
    /// Builds the tree; O(n log² n).
    pub fn new(triangles: impl Iterator<Item = Corners>) -> Self {
        let mut tree = Self {
            triangles: triangles.collect(),
            nodes: Vec::new(),
        };
        if !tree.triangles.is_empty() {
            tree.build(0, tree.triangles.len());
        }
        tree
    }

    fn build(&mut self, from: usize, to: usize) -> usize {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in self.triangles[from..to].iter().flatten() {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let index = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            range: (from, to),
            second: 0,
        });
        if to - from > LEAF {
            let extent = sub(high, low);
            let longer = |a: &usize, b: &usize| extent[*a].total_cmp(&extent[*b]);
            let axis = (0..3).max_by(longer).unwrap_or(0);
            let key = |t: &Corners| t[0][axis] + t[1][axis] + t[2][axis];
            let middle = (to - from) / 2;
            self.triangles[from..to]
                .select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
            self.build(from, from + middle);
            self.nodes[index].second = self.build(from + middle, to);
        }
        index
    }

    /// Distance from a point to the nearest triangle; infinite without triangles.
    pub fn distance(&self, p: [f64; 3]) -> f64 {
        let mut best = f64::INFINITY;
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let Some(node) = self.nodes.get(index) else {
                break;
            };
            if node.gap(p) >= best {
                continue;
            }
            if node.second == 0 {
                for t in &self.triangles[node.range.0..node.range.1] {
                    best = best.min(point_triangle_distance(p, t));
                }
                continue;
            }
            let children = [index + 1, node.second];
            let near = usize::from(self.nodes[children[1]].gap(p) < self.nodes[children[0]].gap(p));
            stack.push(children[1 - near]);
            stack.push(children[near]);
        }
        best
    }
}

impl Node {
    fn gap(&self, p: [f64; 3]) -> f64 {
        let out = |k: usize| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0);
        norm([out(0), out(1), out(2)])
    }
}

/// Exact distance from a point to a triangle (Ericson 2005, Sec. 5.1.5, by projection).
pub fn point_triangle_distance(p: [f64; 3], t: &Corners) -> f64 {
    let [a, b, c] = *t;
    let n = cross(sub(b, a), sub(c, a));
    let length = dot(n, n);
    let left = |u: [f64; 3], v: [f64; 3]| dot(cross(sub(v, u), sub(p, u)), n) >= 0.0;
    if length > 0.0 && left(a, b) && left(b, c) && left(c, a) {
        return dot(sub(p, a), n).abs() / length.sqrt();
    }
    let edges = [(a, b), (b, c), (c, a)];
    let distances = edges.map(|(u, v)| point_segment_distance(p, u, v));
    distances[0].min(distances[1]).min(distances[2])
}

fn point_segment_distance(p: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = sub(b, a);
    let length = dot(d, d);
    let s = match length > 0.0 {
        true => (dot(sub(p, a), d) / length).clamp(0.0, 1.0),
        false => 0.0,
    };
    norm(sub(p, [a[0] + s * d[0], a[1] + s * d[1], a[2] + s * d[2]]))
}

/// Points spread evenly over the triangles of meshes, by area: `count` of them, seeded.
pub fn surface_samples<R: rand::Rng>(
    triangles: impl Iterator<Item = Corners>,
    count: usize,
    rng: &mut R,
) -> Vec<[f64; 3]> {
    use rand::RngExt;
    let triangles: Vec<Corners> = triangles.collect();
    let area = |t: &Corners| norm(super::normal(t)) / 2.0;
    let step = triangles.iter().map(area).sum::<f64>() / count.max(1) as f64;
    let mut points = Vec::with_capacity(count);
    // One point in each stretch of `step` along the running sum of areas.
    let mut next = rng.random::<f64>() * step;
    for t in &triangles {
        next -= area(t);
        while next < 0.0 && points.len() < count {
            let (mut u, mut v): (f64, f64) = (rng.random(), rng.random());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = t;
            points.push([0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])));
            next += step;
        }
    }
    points
}
