//! Branch and bound over phrases, with a Lagrangian bound.
//!
//! Multipliers `l_a >= 0` on `z_a <= y_p` (see `phrases.rs`) leave independent shortest paths, with arcs of
//! phrases at `1 + l_a`:
//! ```text
//! L(l) = sum over strings of their shortest path + sum_p min(0, r_p),
//! r_p  = c_split + shortest path of p - sum of l_a over the arcs a of p
//! ```
//! `L` bounds the cost whatever the multipliers are; those of the linear relaxation, from Clarabel, make it
//! largest. The bound that is told is `L`, computed by dynamic programs here: nothing rests on the accuracy of the solver.
//! Phrases with `L + r_p` above the cheapest known cost are closed for good (variable fixing), which leaves a small
//! program. Costs are multiples of a unit, so that bounds are rounded up to the next one.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use super::texts::Texts;

/// Nodes of branch and bound.
const NODES: usize = 2000;

/// Arcs of all programs that are solved together.
const WORK: usize = 1_000_000;

/// Programs with more arcs than this are not solved: the bound is that of no multipliers.
const MOST_ARCS: usize = 40_000;

/// Sums of costs are equal up to this.
const NOISE: f64 = 1e-7;

/// A set of programs: phrases that are open, closed, or left to choose.
struct Node {
    fixed: Vec<Option<bool>>,
    bound: f64,
}

/// The relaxation of a node.
struct Relaxed {
    /// The Lagrangian bound.
    bound: f64,
    /// `r_p` of each phrase.
    reduced: Vec<f64>,
    /// The share by which each phrase is open, from 0 to 1.
    open: Vec<f64>,
}

/// The cheapest choice found from a start, and a bound on all choices, without the operations of the bodies.
pub(super) fn branch_and_bound(texts: &Texts, start: Vec<bool>, split: f64) -> (Vec<bool>, f64) {
    let count = texts.texts.len();
    let mut best = start;
    let mut cost = texts.cost(&best, split);
    let unit = unit(split);
    let round_up = |bound: f64| match unit {
        Some(unit) => ((bound - NOISE) / unit).ceil() * unit,
        None => bound,
    };
    let fixed = (0..count)
        .map(|k| (k < texts.bodies).then_some(true))
        .collect();
    let root = Node { fixed, bound: 0.0 };
    let mut open = vec![root];
    let (mut solved, mut work) = (0, 0);
    while let Some(at) = (0..open.len()).min_by(|&a, &b| open[a].bound.total_cmp(&open[b].bound)) {
        if open[at].bound >= cost - NOISE || solved == NODES || work >= WORK {
            break;
        }
        solved += 1;
        let mut node = open.swap_remove(at);
        let mut relaxed = relax(texts, &node.fixed, split);
        work += arcs(texts, &node.fixed);
        // Fixing makes the program smaller; what is left is solved again while much was fixed.
        for _ in 0..3 {
            let rounded: Vec<bool> = (0..count)
                .map(|k| node.fixed[k].unwrap_or(relaxed.open[k] > 0.5))
                .collect();
            let mut rounded = rounded;
            let found = texts.close(&mut rounded, split);
            if found < cost - NOISE {
                (best, cost) = (rounded, found);
            }
            let before = free(&node.fixed);
            for k in texts.bodies..count {
                let dear = |r: f64| round_up(relaxed.bound + r) >= cost - NOISE;
                if node.fixed[k].is_none() && relaxed.reduced[k] > 0.0 && dear(relaxed.reduced[k]) {
                    node.fixed[k] = Some(false);
                } else if node.fixed[k].is_none()
                    && relaxed.reduced[k] < 0.0
                    && dear(-relaxed.reduced[k])
                {
                    node.fixed[k] = Some(true);
                }
            }
            node.bound = node.bound.max(round_up(relaxed.bound));
            let after = free(&node.fixed);
            if node.bound >= cost - NOISE || after == 0 || 4 * after > 3 * before {
                break;
            }
            relaxed = relax(texts, &node.fixed, split);
            work += arcs(texts, &node.fixed);
        }
        if node.bound >= cost - NOISE {
            continue;
        }
        let fractional = (texts.bodies..count)
            .filter(|&k| node.fixed[k].is_none())
            .min_by(|&a, &b| {
                (relaxed.open[a] - 0.5)
                    .abs()
                    .total_cmp(&(relaxed.open[b] - 0.5).abs())
            });
        let Some(branch) = fractional else {
            // Everything is decided: the cost of this choice is known.
            let choice: Vec<bool> = node.fixed.iter().map(|f| f.unwrap_or(true)).collect();
            let found = texts.cost(&choice, split);
            if found < cost - NOISE {
                (best, cost) = (choice, found);
            }
            continue;
        };
        for choice in [false, true] {
            let mut fixed = node.fixed.clone();
            fixed[branch] = Some(choice);
            open.push(Node {
                fixed,
                bound: node.bound,
            });
        }
    }
    let bound = open.iter().map(|node| node.bound).fold(cost, f64::min);
    (best, bound)
}

/// Arcs of the texts that are not closed.
fn arcs(texts: &Texts, fixed: &[Option<bool>]) -> usize {
    let used = texts
        .texts
        .iter()
        .zip(fixed)
        .filter(|(_, fixed)| **fixed != Some(false));
    used.map(|(text, _)| text.arcs.len()).sum()
}

fn free(fixed: &[Option<bool>]) -> usize {
    fixed.iter().filter(|f| f.is_none()).count()
}

/// The largest of a few units of which a cost of splits and letters is a multiple.
fn unit(split: f64) -> Option<f64> {
    let units = [1.0, 0.5, 0.25, 0.1, 0.05, 0.01];
    units
        .into_iter()
        .find(|unit| (split / unit - (split / unit).round()).abs() < 1e-9)
}

/// The linear relaxation of a node, and the bound of its multipliers.
fn relax(texts: &Texts, fixed: &[Option<bool>], split: f64) -> Relaxed {
    let (multipliers, open) = multipliers(texts, fixed, split).unwrap_or_else(|| {
        (
            texts
                .texts
                .iter()
                .map(|text| vec![0.0; text.arcs.len()])
                .collect(),
            vec![0.0; texts.texts.len()],
        )
    });
    let mut reduced = vec![0.0; texts.texts.len()];
    for (text, own) in texts
        .texts
        .iter()
        .zip(&multipliers)
        .enumerate()
        .filter_map(|(k, pair)| (fixed[k] != Some(false)).then_some(pair))
    {
        for (&(_, _, phrase), multiplier) in text.arcs.iter().zip(own) {
            if phrase >= texts.bodies && fixed[phrase] != Some(false) {
                reduced[phrase] -= multiplier;
            }
        }
    }
    let mut bound = 0.0;
    for (k, own) in multipliers.iter().enumerate() {
        if fixed[k] == Some(false) {
            reduced[k] = 0.0;
            continue;
        }
        let path = shortest(texts, k, own, fixed);
        if k < texts.bodies {
            bound += path;
            continue;
        }
        reduced[k] += split + path;
        bound += if fixed[k] == Some(true) {
            reduced[k]
        } else {
            reduced[k].min(0.0)
        };
    }
    Relaxed {
        bound,
        reduced,
        open,
    }
}

/// The shortest path of a text, arcs of phrases at 1 and their multiplier.
fn shortest(texts: &Texts, text: usize, multipliers: &[f64], fixed: &[Option<bool>]) -> f64 {
    let text = &texts.texts[text];
    let mut best = vec![f64::INFINITY; text.letters.len() + 1];
    best[0] = 0.0;
    let mut arcs = text.arcs.iter().zip(multipliers).peekable();
    for from in 0..text.letters.len() {
        let reached = best[from] + 1.0;
        best[from + 1] = best[from + 1].min(reached);
        while let Some((&(_, to, phrase), multiplier)) = arcs.next_if(|arc| arc.0.0 == from) {
            if fixed[phrase] != Some(false) {
                let extra = if phrase < texts.bodies {
                    0.0
                } else {
                    *multiplier
                };
                best[to] = best[to].min(reached + extra);
            }
        }
    }
    best[text.letters.len()]
}

/// Entries of a sparse matrix, and the bounds of its rows.
#[derive(Default)]
struct Rows {
    row: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
    bound: Vec<f64>,
}

impl Rows {
    /// Adds a row with its entries.
    fn push(&mut self, entries: &[(usize, f64)], bound: f64) {
        for &(column, value) in entries {
            self.row.push(self.bound.len());
            self.column.push(column);
            self.value.push(value);
        }
        self.bound.push(bound);
    }
}

/// Multipliers of every arc (not negative), and how far every text is open; none where the solver fails.
fn multipliers(
    texts: &Texts,
    fixed: &[Option<bool>],
    split: f64,
) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
    let used = |k: usize| fixed[k] != Some(false);
    let arcs = arcs(texts, fixed);
    if arcs > MOST_ARCS || arcs == 0 {
        return None;
    }
    let mut costs: Vec<f64> = Vec::new();
    let mut variable = |cost: f64| {
        costs.push(cost);
        costs.len() - 1
    };
    // Variables that say how far a phrase is open; those that are open for sure have none.
    let opens: Vec<Option<usize>> = (0..texts.texts.len())
        .map(|k| fixed[k].is_none().then(|| variable(split)))
        .collect();
    let mut flows = Rows::default();
    let mut limits = Rows::default();
    let mut limited: Vec<(usize, usize)> = Vec::new();
    for (k, text) in texts.texts.iter().enumerate().filter(|(k, _)| used(*k)) {
        let n = text.letters.len();
        let mut balance: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n + 1];
        let mut join = |from: usize, to: usize, variable: usize| {
            balance[from].push((variable, 1.0));
            balance[to].push((variable, -1.0));
        };
        for from in 0..n {
            join(from, from + 1, variable(1.0));
        }
        for (number, &(from, to, phrase)) in
            text.arcs.iter().enumerate().filter(|(_, arc)| used(arc.2))
        {
            let arc = variable(1.0);
            join(from, to, arc);
            if let Some(open) = opens[phrase] {
                limits.push(&[(arc, 1.0), (open, -1.0)], 0.0);
                limited.push((k, number));
            }
        }
        for (place, mut entries) in balance.into_iter().enumerate().take(n) {
            let out = match (place, opens[k]) {
                (0, Some(open)) => {
                    entries.push((open, -1.0));
                    0.0
                }
                (0, None) => 1.0,
                _ => 0.0,
            };
            flows.push(&entries, out);
        }
    }
    let solution = solve(&costs, &flows, &limits)?;
    let mut multipliers: Vec<Vec<f64>> = texts
        .texts
        .iter()
        .map(|text| vec![0.0; text.arcs.len()])
        .collect();
    for (&(text, number), dual) in limited.iter().zip(&solution.1) {
        multipliers[text][number] = dual.max(0.0);
    }
    let open = |k: usize| match opens[k] {
        Some(open) => solution.0[open].clamp(0.0, 1.0),
        None => f64::from(u8::from(used(k))),
    };
    Some((multipliers, (0..texts.texts.len()).map(open).collect()))
}

/// Minimizes `costs x` over `x >= 0` with equal flows and limits from above: the point, and the duals of the limits.
fn solve(costs: &[f64], flows: &Rows, limits: &Rows) -> Option<(Vec<f64>, Vec<f64>)> {
    let (n, equal, below) = (costs.len(), flows.bound.len(), limits.bound.len());
    let rows = [
        &flows.row[..],
        &limits.row.iter().map(|row| row + equal).collect::<Vec<_>>(),
        &(equal + below..equal + below + n).collect::<Vec<_>>(),
    ]
    .concat();
    let columns = [
        &flows.column[..],
        &limits.column[..],
        &(0..n).collect::<Vec<_>>(),
    ]
    .concat();
    let values = [&flows.value[..], &limits.value[..], &vec![-1.0; n]].concat();
    let bounds = [&flows.bound[..], &limits.bound[..], &vec![0.0; n]].concat();
    let matrix = CscMatrix::new_from_triplets(equal + below + n, n, rows, columns, values);
    let nothing = CscMatrix::zeros((n, n));
    let cones = [
        SupportedConeT::ZeroConeT(equal),
        SupportedConeT::NonnegativeConeT(below + n),
    ];
    let settings = DefaultSettings {
        verbose: false,
        ..DefaultSettings::default()
    };
    let mut solver =
        DefaultSolver::new(&nothing, costs, &matrix, &bounds, &cones, settings).ok()?;
    solver.solve();
    let solved = matches!(
        solver.solution.status,
        SolverStatus::Solved | SolverStatus::AlmostSolved
    );
    let point = solver.solution.x.clone();
    let duals = solver.solution.z.get(equal..equal + below)?.to_vec();
    let finite = point.iter().chain(&duals).all(|v| v.is_finite());
    (solved && finite).then_some((point, duals))
}
