//! Orders of elimination, and the sizes of tables that they lead to.
//!
//! A best order is NP-hard to find. Greedy orders by three costs are tried: the next table's size, the number of edges that
//! an elimination adds, and their weighted number (Koller and Friedman 2009, Sec. 9.4.3.2). The first alone where it is
//! good enough, as on small problems finding an order takes longer than the elimination itself.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Most cells of one table.
pub const MOST_CELLS: f64 = (1 << 26) as f64;
/// Most cells of all tables together (1 GiB).
pub const MOST_CELLS_IN_ALL: f64 = (1 << 27) as f64;
/// Cells of all tables below which no other order is looked for.
const FEW_CELLS: f64 = 10_000.0;

/// Exact elimination would need tables that are too large: more than [`MOST_CELLS`] cells in one, or [`MOST_CELLS_IN_ALL`]
/// together, 8 bytes each. As [`Order::widest`] the same numbers of any order, too large or not.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the elimination of variable {variable} needs a table of {width} variables and {cells:.1e} cells, {in_all:.1e} cells in \
     all ({MOST_CELLS:.1e} and {MOST_CELLS_IN_ALL:.1e} are the most)"
)]
pub struct TooWide {
    /// The variable whose elimination needs the largest table.
    pub variable: usize,
    /// Number of variables of that table.
    pub width: usize,
    /// Its number of cells.
    pub cells: f64,
    /// Cells of all tables.
    pub in_all: f64,
}

/// An order of elimination, and what it costs: for the bucket of v with the scope U_v, `Π_(u ∈ U_v) k_u` cells for variables of
/// k_u categories; [`TooWide::in_all`] is the sum over v.
///
/// The scopes follow from the graph alone: when v is eliminated, its neighbours become neighbours of each other. Time for n
/// variables, of which none ever has more than m neighbours nor more than w when it is eliminated: `O(n w m log m)` for
/// the first cost of [the module](self), for the others `O(m²)` for every variable near an eliminated one besides.
///
/// # Examples
/// ```
/// use edifice_model::elimination::Order;
/// // A chain is eliminated from its ends, with tables of two variables.
/// let chain: Vec<[usize; 2]> = (0..99).map(|i| [i, i + 1]).collect();
/// let order = Order::new(chain.iter().map(|c| &c[..]), &[10; 100]);
/// assert_eq!((order.widest.width, order.widest.cells), (2, 100.0));
/// assert!(order.check().is_ok());
/// // Thirty variables in one factor need 2³⁰ cells, whatever the order.
/// let all: Vec<usize> = (0..30).collect();
/// let wide = Order::new([&all[..]].into_iter(), &[2; 30]).check();
/// assert!(wide.is_err_and(|e| e.width == 30 && e.cells == f64::from(1 << 30)));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The variables, first eliminated first.
    pub variables: Vec<usize>,
    /// The largest table of the elimination, and the cells of all its tables.
    pub widest: TooWide,
}

impl Order {
    /// A good order for the elimination of all variables of some scopes (sets of variables that share a factor); `sizes` are the
    /// numbers of categories of all variables. Of several that cost the same, the first variable: always the same order.
    pub fn new<'a>(scopes: impl Iterator<Item = &'a [usize]>, sizes: &[usize]) -> Self {
        let graph = Graph::new(scopes, sizes);
        let mut best = graph.clone().eliminate(Cost::Cells);
        if best.widest.in_all > FEW_CELLS {
            for cost in [Cost::Fill, Cost::WeightedFill] {
                let other = graph.clone().eliminate(cost);
                if other.widest.in_all < best.widest.in_all {
                    best = other;
                }
            }
        }
        best
    }

    /// Checks that all tables can be made.
    ///
    /// # Errors
    /// [`TooWide`].
    pub fn check(&self) -> Result<(), TooWide> {
        let TooWide { cells, in_all, .. } = self.widest;
        match cells <= MOST_CELLS && in_all <= MOST_CELLS_IN_ALL {
            true => Ok(()),
            false => Err(self.widest),
        }
    }
}

/// The measure by which a greedy order picks the next variable.
#[derive(Clone, Copy, PartialEq)]
enum Cost {
    /// Cells of the table.
    Cells,
    /// Edges that are added between neighbours.
    Fill,
    /// The same, an edge weighing the product of its ends' sizes.
    WeightedFill,
}

/// The undirected graph of variables that share a factor.
#[derive(Clone)]
struct Graph {
    /// Variables, rising; below, a variable is its place here.
    variables: Vec<usize>,
    sizes: Vec<f64>,
    /// Neighbours, rising.
    neighbours: Vec<Vec<u32>>,
}

impl Graph {
    fn new<'a>(scopes: impl Iterator<Item = &'a [usize]>, sizes: &[usize]) -> Self {
        let scopes: Vec<&[usize]> = scopes.collect();
        let mut variables: Vec<usize> = scopes.iter().copied().flatten().copied().collect();
        variables.sort_unstable();
        variables.dedup();
        let mut place = vec![0_u32; sizes.len()];
        for (i, &v) in variables.iter().enumerate() {
            place[v] = i as u32;
        }
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); variables.len()];
        for scope in scopes {
            for &v in scope {
                let others = scope.iter().filter(|&&w| w != v);
                neighbours[place[v] as usize].extend(others.map(|&w| place[w]));
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self {
            sizes: variables.iter().map(|&v| sizes[v] as f64).collect(),
            variables,
            neighbours,
        }
    }

    /// Cells of the table that the elimination of v needs.
    fn cells(&self, v: usize) -> f64 {
        let around = self.neighbours[v].iter();
        around.fold(self.sizes[v], |c, &n| c * self.sizes[n as usize])
    }

    /// Edges that the elimination of v adds.
    fn fill(&self, v: usize, weighted: bool) -> f64 {
        let around = &self.neighbours[v];
        let mut sum = 0.0;
        for (i, &a) in around.iter().enumerate() {
            let mut known = self.neighbours[a as usize].iter().peekable();
            for &b in &around[i + 1..] {
                while known.next_if(|&&n| n < b).is_some() {}
                if known.peek() != Some(&&b) {
                    sum += match weighted {
                        true => self.sizes[a as usize] * self.sizes[b as usize],
                        false => 1.0,
                    };
                }
            }
        }
        sum
    }

    fn cost(&self, v: usize, cost: Cost) -> f64 {
        match cost {
            Cost::Cells => self.cells(v),
            Cost::Fill => self.fill(v, false),
            Cost::WeightedFill => self.fill(v, true),
        }
    }

    /// Greedily the variable of lowest cost; of several, the first.
    fn eliminate(mut self, cost: Cost) -> Order {
        let count = self.variables.len();
        let mut costs: Vec<f64> = (0..count).map(|v| self.cost(v, cost)).collect();
        let mut queue: BinaryHeap<Reverse<(Ordered, usize)>> = (0..count)
            .map(|v| Reverse((Ordered(costs[v]), v)))
            .collect();
        let mut done = vec![false; count];
        let mut order = Order {
            variables: Vec::with_capacity(count),
            widest: TooWide {
                variable: 0,
                width: 0,
                cells: 0.0,
                in_all: 0.0,
            },
        };
        let mut touched: Vec<u32> = Vec::new();
        while let Some(Reverse((Ordered(known), v))) = queue.pop() {
            if done[v] || known != costs[v] {
                continue;
            }
            done[v] = true;
            let cells = self.cells(v);
            order.widest.in_all += cells;
            if cells > order.widest.cells {
                order.widest.variable = self.variables[v];
                order.widest.width = self.neighbours[v].len() + 1;
                order.widest.cells = cells;
            }
            order.variables.push(self.variables[v]);
            let around = std::mem::take(&mut self.neighbours[v]);
            touched.clear();
            for &a in &around {
                let list = &mut self.neighbours[a as usize];
                let before = list.len();
                list.extend(around.iter().filter(|&&b| b != a));
                list.sort_unstable();
                list.dedup();
                list.retain(|&b| b as usize != v);
                touched.push(a);
                // New edges close triangles of the neighbours' neighbours.
                if cost != Cost::Cells && list.len() + 1 > before {
                    touched.extend(&self.neighbours[a as usize]);
                }
            }
            touched.sort_unstable();
            touched.dedup();
            for &a in &touched {
                let a = a as usize;
                let now = self.cost(a, cost);
                if now != costs[a] {
                    costs[a] = now;
                    queue.push(Reverse((Ordered(now), a)));
                }
            }
        }
        order
    }
}

/// Numbers that are not NaN, in order.
#[derive(PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Cost, Graph};
    use edifice_base::rng::{Stream, stream};
    use rand::RngExt;

    type Edges = BTreeSet<(usize, usize)>;

    /// Scopes of two or three of some variables, and the numbers of categories of the variables.
    fn random(rng: &mut Stream) -> (Vec<Vec<usize>>, Vec<usize>) {
        let n = rng.random_range(4..=12);
        let sizes = (0..n).map(|_| rng.random_range(2..=7)).collect();
        let scope = |rng: &mut Stream| {
            let many = rng.random_range(2..=3);
            let vars: BTreeSet<usize> = (0..many).map(|_| rng.random_range(0..n)).collect();
            vars.into_iter().collect()
        };
        let count = rng.random_range(n..=2 * n);
        ((0..count).map(|_| scope(rng)).collect(), sizes)
    }

    /// Both directions of every edge between variables that share a scope.
    fn edges(scopes: &[Vec<usize>]) -> Edges {
        let pairs = |scope: &Vec<usize>| {
            let all = scope
                .iter()
                .flat_map(|&a| scope.iter().map(move |&b| (a, b)));
            all.filter(|(a, b)| a != b).collect::<Vec<_>>()
        };
        scopes.iter().flat_map(pairs).collect()
    }

    /// Edges that must be added to join all neighbours of a variable, each once.
    fn missing(edges: &Edges, v: usize) -> Vec<(usize, usize)> {
        let around = || edges.iter().filter(move |e| e.0 == v).map(|e| e.1);
        let pairs = around().flat_map(|a| around().map(move |b| (a, b)));
        pairs
            .filter(|(a, b)| a < b && !edges.contains(&(*a, *b)))
            .collect()
    }

    fn cost_of(edges: &Edges, sizes: &[usize], v: usize, cost: Cost) -> usize {
        let added = missing(edges, v);
        match cost {
            Cost::Cells => {
                let around = edges.iter().filter(|e| e.0 == v);
                sizes[v] * around.map(|e| sizes[e.1]).product::<usize>()
            }
            Cost::Fill => added.len(),
            Cost::WeightedFill => added.iter().map(|&(a, b)| sizes[a] * sizes[b]).sum(),
        }
    }

    const COSTS: [Cost; 3] = [Cost::Cells, Cost::Fill, Cost::WeightedFill];

    #[test]
    fn costs_are_the_cells_and_the_edges_that_an_elimination_adds() {
        let mut rng = stream(1, "costs", 0);
        for _ in 0..100 {
            let (scopes, sizes) = random(&mut rng);
            let graph = Graph::new(scopes.iter().map(|s| &s[..]), &sizes);
            let edges = edges(&scopes);
            for (place, &v) in graph.variables.iter().enumerate() {
                for cost in COSTS {
                    let slow = cost_of(&edges, &sizes, v, cost) as f64;
                    assert_eq!(graph.cost(place, cost), slow, "of {v} in {scopes:?}");
                }
            }
        }
    }

    #[test]
    fn the_variable_of_least_cost_is_always_eliminated_next() {
        let mut rng = stream(1, "orders", 0);
        for _ in 0..200 {
            let (scopes, sizes) = random(&mut rng);
            let graph = Graph::new(scopes.iter().map(|s| &s[..]), &sizes);
            for cost in COSTS {
                let order = graph.clone().eliminate(cost);
                let mut edges = edges(&scopes);
                let mut left: BTreeSet<usize> = scopes.iter().flatten().copied().collect();
                let (mut slow, mut in_all) = (Vec::new(), 0);
                // All costs are computed anew at every step; of equal ones the first variable is taken.
                while let Some(&v) = left
                    .iter()
                    .min_by_key(|&&v| (cost_of(&edges, &sizes, v, cost), v))
                {
                    in_all += cost_of(&edges, &sizes, v, Cost::Cells);
                    for (a, b) in missing(&edges, v) {
                        edges.extend([(a, b), (b, a)]);
                    }
                    edges.retain(|e| e.0 != v && e.1 != v);
                    left.remove(&v);
                    slow.push(v);
                }
                assert_eq!(order.variables, slow, "{scopes:?} of {sizes:?}");
                assert_eq!(order.widest.in_all, in_all as f64);
            }
        }
    }
}
