//! Nearest neighbours of weighted points, exact, with a lower bound for the distance of Ward.

/// Points in a leaf at most.
const LEAF: usize = 8;

/// A kd-tree over some rows of a table of points; rows can be removed.
pub struct KdTree {
    dimension: usize,
    /// Rows, leaf by leaf.
    order: Vec<u32>,
    nodes: Vec<Node>,
    /// Low and high corner of each node's box.
    boxes: Vec<f64>,
}

struct Node {
    from: u32,
    to: u32,
    /// Index of the second child, the first one follows; 0 for a leaf.
    second: u32,
    /// Least weight below.
    weight: f64,
}

impl KdTree {
    /// Builds a tree over `rows`; O(n log² n).
    pub fn new(points: &[f64], dimension: usize, weights: &[f64], rows: Vec<u32>) -> Self {
        let mut tree = Self {
            dimension,
            order: rows,
            nodes: Vec::new(),
            boxes: Vec::new(),
        };
        if !tree.order.is_empty() {
            tree.build(points, weights, 0, tree.order.len());
        }
        tree
    }

    fn build(&mut self, points: &[f64], weights: &[f64], from: usize, to: usize) -> u32 {
        let d = self.dimension;
        let index = self.nodes.len();
        let start = self.boxes.len();
        self.boxes.extend(std::iter::repeat_n(f64::INFINITY, d));
        self.boxes.extend(std::iter::repeat_n(f64::NEG_INFINITY, d));
        let mut weight = f64::INFINITY;
        for &row in &self.order[from..to] {
            let row = row as usize;
            weight = weight.min(weights[row]);
            for k in 0..d {
                let v = points[row * d + k];
                self.boxes[start + k] = self.boxes[start + k].min(v);
                self.boxes[start + d + k] = self.boxes[start + d + k].max(v);
            }
        }
        self.nodes.push(Node {
            from: from as u32,
            to: to as u32,
            second: 0,
            weight,
        });
        let extent = |k: usize| self.boxes[start + d + k] - self.boxes[start + k];
        let axis = (0..d).max_by(|&a, &b| extent(a).total_cmp(&extent(b)));
        if let Some(axis) = axis
            && to - from > LEAF
        {
            let key = |row: u32| points[row as usize * d + axis];
            let middle = (to - from) / 2;
            self.order[from..to]
                .select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            self.build(points, weights, from, from + middle);
            self.nodes[index].second = self.build(points, weights, from + middle, to);
        }
        index as u32
    }

    /// Squared distance from a point to a node's box.
    fn gap(&self, node: usize, p: &[f64]) -> f64 {
        let d = self.dimension;
        let b = &self.boxes[node * 2 * d..(node + 1) * 2 * d];
        let mut sum = 0.0;
        for k in 0..d {
            let out = (b[k] - p[k]).max(p[k] - b[d + k]).max(0.0);
            sum += out * out;
        }
        sum
    }

    /// Offers rows to `visit` in an order that tends to be near first. `bound(gap, weight)` is a lower
    /// bound of the cost of any row in a box at squared distance `gap` whose rows weigh at least `weight`;
    /// `visit` returns the cost above which rows no longer matter.
    pub fn search(
        &self,
        p: &[f64],
        mut limit: f64,
        bound: impl Fn(f64, f64) -> f64,
        mut visit: impl FnMut(u32) -> f64,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let cost = |node: usize| bound(self.gap(node, p), self.nodes[node].weight);
        let mut stack = vec![(cost(0), 0usize)];
        while let Some((least, index)) = stack.pop() {
            if least > limit {
                continue;
            }
            let node = &self.nodes[index];
            if node.second == 0 {
                for &row in &self.order[node.from as usize..node.to as usize] {
                    limit = visit(row);
                }
                continue;
            }
            let children = [index + 1, node.second as usize].map(|c| (cost(c), c));
            let near = usize::from(children[1].0 < children[0].0);
            stack.push(children[1 - near]);
            stack.push(children[near]);
        }
    }
}
