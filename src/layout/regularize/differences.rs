//! Systems of constraints on differences, some of which share a size that may be changed.
//!
//! ```text
//! lower_k <= v_k <= upper_k          positions
//! v_to - v_from >= least             order
//! v_to - v_from  = s_c               every span (from, to) of size c
//! ```
//! With the sizes `s` given, the least solution is that of a longest path, and a system without a
//! solution has a chain of constraints, from a lower bound to an upper one or around a cycle, whose
//! sum leaves no room (Bellman and Ford). Sizes that occur in the chain are then changed, the one whose
//! change is the smallest first, until no chain is left: [`Differences::solve`]. The repair is a heuristic: what
//! it finds is a solution, but it may miss one.

/// Most changes of sizes in one repair.
const MAX_CHANGES: usize = 8;

/// A size that all its spans have.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SharedSize {
    /// Present value.
    pub value: f64,
    /// Value that it should have.
    pub wanted: f64,
    /// Bounds.
    pub range: (f64, f64),
    /// Weight of a change of the value.
    pub weight: f64,
    /// Positions at both ends of each span.
    pub spans: Vec<(usize, usize)>,
}

/// `v[to] >= v[from] + least`, or for a size `c` with sign 1 or -1, `v[to] >= v[from] + sign * s_c`.
#[derive(Debug, Clone, Copy)]
struct Edge {
    from: usize,
    to: usize,
    least: f64,
    size: Option<(usize, f64)>,
}

/// A system; see the [module](self).
#[derive(Debug)]
pub(super) struct Differences {
    /// Bounds of the positions.
    pub lower: Vec<f64>,
    /// Bounds of the positions.
    pub upper: Vec<f64>,
    /// Sizes.
    pub sizes: Vec<SharedSize>,
    edges: Vec<Edge>,
    /// Edges by their `from`.
    out: Vec<Vec<usize>>,
    /// True if positions and sizes are whole numbers.
    whole: bool,
    /// Differences below this count as none.
    slack: f64,
}

impl Differences {
    /// A system of positions in order, each at least `gap` after the one before.
    pub(super) fn new(
        lower: Vec<f64>,
        upper: Vec<f64>,
        gap: &[f64],
        sizes: Vec<SharedSize>,
        whole: bool,
        slack: f64,
    ) -> Self {
        let order = gap.iter().enumerate().map(|(k, &least)| Edge {
            from: k,
            to: k + 1,
            least,
            size: None,
        });
        let mut edges: Vec<Edge> = order.collect();
        for (c, size) in sizes.iter().enumerate() {
            for &(from, to) in &size.spans {
                let edge = |from, to, sign| Edge {
                    from,
                    to,
                    least: 0.0,
                    size: Some((c, sign)),
                };
                edges.extend([edge(from, to, 1.0), edge(to, from, -1.0)]);
            }
        }
        let mut out = vec![Vec::new(); lower.len()];
        for (number, edge) in edges.iter().enumerate() {
            out[edge.from].push(number);
        }
        Self {
            lower,
            upper,
            sizes,
            edges,
            out,
            whole,
            slack,
        }
    }

    fn least(&self, edge: &Edge) -> f64 {
        match edge.size {
            Some((c, sign)) => sign * self.sizes[c].value - self.slack,
            None => edge.least - self.slack,
        }
    }

    /// The least solution, after changes to the sizes where there is none; `None` when none is found.
    pub(super) fn solve(&mut self) -> Option<Vec<f64>> {
        let mut changes = vec![0u32; self.sizes.len()];
        for _ in 0..MAX_CHANGES {
            let chain = match self.least_solution() {
                Ok(values) => return Some(values),
                Err(chain) => chain,
            };
            self.shorten(&chain, &mut changes)?;
        }
        None
    }

    /// The least solution with the sizes as they are, or a chain of edges that leaves none.
    pub(super) fn least_solution(&self) -> Result<Vec<f64>, Chain> {
        let n = self.lower.len();
        if let Some(k) = (0..n).find(|&k| self.lower[k] > self.upper[k]) {
            let excess = self.lower[k] - self.upper[k];
            return Err(Chain {
                edges: Vec::new(),
                excess,
            });
        }
        let mut values = self.lower.clone();
        let mut parent: Vec<Option<usize>> = vec![None; n];
        // Sweeps from left to right: most constraints point that way.
        let mut changed = vec![true; n];
        for _ in 0..=n {
            let mut any = false;
            for from in 0..n {
                if !std::mem::replace(&mut changed[from], false) {
                    continue;
                }
                any = true;
                for &number in &self.out[from] {
                    let edge = &self.edges[number];
                    let needed = values[from] + self.least(edge);
                    if needed <= values[edge.to] + 1e-9 {
                        continue;
                    }
                    values[edge.to] = needed;
                    parent[edge.to] = Some(number);
                    changed[edge.to] = true;
                    if needed > self.upper[edge.to] + 1e-9 {
                        return Err(self.chain(edge.to, &parent));
                    }
                }
            }
            if !any {
                return Ok(values);
            }
        }
        let raised = changed.iter().position(|&c| c).unwrap_or(0);
        Err(self.chain(raised, &parent))
    }

    /// The chain that raised position `end` too far.
    fn chain(&self, end: usize, parent: &[Option<usize>]) -> Chain {
        let mut edges = Vec::new();
        let mut seen = vec![usize::MAX; parent.len()];
        let mut at = end;
        loop {
            if seen[at] != usize::MAX {
                // A cycle: only its own edges matter.
                edges.drain(..seen[at]);
                let sum = |sum: f64, &e: &usize| sum + self.least(&self.edges[e]);
                let excess = edges.iter().fold(0.0, sum);
                return Chain { edges, excess };
            }
            seen[at] = edges.len();
            match parent[at] {
                Some(edge) => {
                    edges.push(edge);
                    at = self.edges[edge].from;
                }
                None => break,
            }
        }
        let sum = |sum: f64, &e: &usize| sum + self.least(&self.edges[e]);
        let excess = edges.iter().fold(self.lower[at], sum) - self.upper[end];
        Chain { edges, excess }
    }

    /// Changes the size that lets the chain have room at the least expense.
    fn shorten(&mut self, chain: &Chain, changes: &mut [u32]) -> Option<()> {
        let mut count: Vec<(usize, f64)> = Vec::new();
        for &edge in &chain.edges {
            if let Some((c, sign)) = self.edges[edge].size {
                match count.iter_mut().find(|(d, _)| *d == c) {
                    Some(known) => known.1 += sign,
                    None => count.push((c, sign)),
                }
            }
        }
        let change = |&(c, times): &(usize, f64)| {
            let size = &self.sizes[c];
            let mut by = chain.excess / times.abs();
            if self.whole {
                by = (by - 1e-9).ceil();
            }
            let tried = size.value - times.signum() * by;
            let value = tried.max(size.range.0).min(size.range.1);
            let moves = (value - size.value).abs();
            let shorter = (size.value - value) * times > 1e-9;
            let possible = times != 0.0 && shorter;
            let share = moves / by;
            let expense =
                size.weight * (1.0 + (value - size.wanted).abs()) * f64::from(1 + changes[c])
                    / share;
            possible.then_some((c, value, expense))
        };
        let options = count.iter().filter_map(change);
        let (c, value, _) = options.min_by(|a, b| a.2.total_cmp(&b.2))?;
        self.sizes[c].value = value;
        changes[c] += 1;
        Some(())
    }

    /// True if positions satisfy every bound and constraint.
    pub(super) fn holds(&self, values: &[f64]) -> bool {
        let bounds =
            |k: usize| self.lower[k] <= values[k] + 1e-6 && values[k] <= self.upper[k] + 1e-6;
        let edges = |e: &Edge| values[e.to] >= values[e.from] + self.least(e) - 1e-6;
        (0..values.len()).all(bounds) && self.edges.iter().all(edges)
    }
}

/// Constraints that leave no room together.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    edges: Vec<usize>,
    /// The room that is lacking.
    excess: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Oracle: try all values of four positions between 0 and 5.
        #[test]
        fn the_least_solution_agrees_with_enumeration(
            spans in prop::collection::vec((0usize..4, 0usize..4, 0i32..5), 1..5),
            fixed in 0i32..6,
        ) {
            let size = |&(from, to, value): &(usize, usize, i32)| SharedSize {
                value: value.into(),
                wanted: value.into(),
                range: (0.0, 5.0),
                weight: 1.0,
                spans: vec![(from, to)],
            };
            let sizes: Vec<SharedSize> = spans.iter().map(size).collect();
            let last = f64::from(fixed);
            let (lower, upper) = (vec![0.0, 0.0, 0.0, last], vec![5.0, 5.0, 5.0, last]);
            let mut system = Differences::new(lower, upper, &[0.0; 3], sizes, true, 0.0);
            let all = (0..6i32.pow(4)).map(|code| {
                [code % 6, code / 6 % 6, code / 36 % 6, code / 216].map(f64::from)
            });
            let any = all.into_iter().any(|values| system.holds(&values));
            let found = system.least_solution();
            prop_assert_eq!(found.is_ok(), any);
            if let Ok(values) = found {
                prop_assert!(system.holds(&values));
            }
            // What the repair finds is a solution.
            if let Some(values) = system.solve() {
                prop_assert!(system.holds(&values));
            }
        }
    }
}
