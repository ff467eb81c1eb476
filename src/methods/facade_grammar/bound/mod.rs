//! A lower bound on the cost of every grammar of a facade, and proofs of optimality.
//!
//! # The program
//! Let `T` be the closure of the facade's type under strips. With `y_t = 1` when a grammar has a
//! rule for `t`, and `f_p = 1` when the rule of `t` writes the strip at position `p` of `t` (an
//! axis and two cuts; each rule is a path over such arcs),
//!
//! ```text
//! min  sum_t y_t (cost_op + c_1 |path_t|),   y_root = 1,
//!      f_p <= y_u               for every arc p to a non-terminal type u,
//!      sum_t sum_cuts f >= 1    for every class of seams.
//! ```
//!
//! The last line is implied for whole numbers and strengthens the relaxation: a *seam* is a contact
//! of two terminals (axis, labels, sizes, offset). Exactly one rule of a derivation parts the two,
//! by a line along the contact, so that some rule must have such a line for every class of seams.
//!
//! # The bound
//! With multipliers `lambda_p, mu_s >= 0` the types become independent,
//!
//! ```text
//! L = sum_s mu_s + R_root - in_root + sum_{t != root} min(0, R_t - in_t),
//! in_t = sum of lambda_p over arcs into t,
//! R_t = min over rules of cost + sum of lambda_p of its arcs - sum of mu_s of its lines,
//! ```
//!
//! and every `R_t` is a shortest path. `L` bounds the optimum from below for all multipliers;
//! subgradient steps of Polyak's length raise it. When all costs are multiples of a power of ten,
//! so are all grammars' costs, and the bound is rounded up to the next multiple.
//!
//! Best-first branch and bound decides whether types have rules. In each branch a type is decided
//! at once when the other way cannot beat the best grammar known (`|R_t - in_t|` is what the bound
//! gains), or when no rule over the types left reaches it.
//!
//! # What is bounded
//! Grammars with one symbol per region type, the ones that [`infer`] searches; grid splits, which
//! it never writes, are left out. Beyond [`BoundLimits::types`] the bound is the weak one that every
//! label is written once, and [`Bound::weak`] says so. Multipliers found in one branch start the
//! next, so the work is the same in every run.

mod program;
mod relaxation;

use crate::grammar::Costs;
use crate::shape::Facade;

use super::infer::{InferError, Method, Settings, infer};
use super::operations::Operations;
use super::regions::Types;
use program::{Program, TERMINAL};
use relaxation::{Fixed, Relaxation, Relaxed};

/// How much work a bound may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundLimits {
    /// Non-terminal types of the closure beyond which only the weak bound is given.
    pub types: usize,
    /// Subgradient steps at the root.
    pub root_steps: u64,
    /// Subgradient steps in every other branch.
    pub branch_steps: u64,
    /// Branches examined.
    pub nodes: u64,
}

impl Default for BoundLimits {
    fn default() -> Self {
        Self {
            types: 5_000,
            root_steps: 1_000,
            branch_steps: 40,
            nodes: 5_000,
        }
    }
}

/// What is known of the least cost of a facade's grammars.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// No grammar costs less.
    pub lower: f64,
    /// Cost of the best grammar known.
    pub upper: f64,
    /// Whether the two meet: the best grammar known is optimal.
    pub proven: bool,
    /// Branches examined.
    pub nodes: u64,
    /// Non-terminal types of the closure; 0 when it was not completed.
    pub types: usize,
    /// Whether the closure was too large, so that `lower` only counts labels.
    pub weak: bool,
}

/// Bounds the cost of the grammars of a facade from below; the upper bound starts from what
/// [`Method::AdpBest`] finds with the other `settings`.
///
/// # Errors
/// [`InferError`], as of [`infer`].
pub fn lower_bound(
    facade: &Facade,
    settings: &Settings,
    limits: &BoundLimits,
) -> Result<Bound, InferError> {
    let settings = Settings {
        method: Method::AdpBest,
        ..settings.clone()
    };
    let facades = std::slice::from_ref(facade);
    let upper = settings.costs.grammar(&infer(facades, &settings)?.grammar);
    let mut types = Types::new(facades);
    let done = |lower: f64, types, weak| Bound {
        lower,
        upper,
        proven: lower >= upper - TOLERANCE,
        nodes: 0,
        types,
        weak,
    };
    if types.is_terminal(types.roots[0]) {
        return Ok(done(upper, 0, false));
    }
    let Some(program) = Program::new(&mut types, settings.operations, limits.types) else {
        let lower = labels_once(&settings.costs, settings.operations, types.label_count());
        return Ok(done(lower, 0, true));
    };
    let mut search = Search {
        relaxation: Relaxation::new(&program, settings.costs),
        quantum: quantum(&settings.costs),
        upper,
        limits: *limits,
    };
    let (lower, nodes) = search.run();
    let upper = search.upper;
    Ok(Bound {
        lower: lower.min(upper),
        upper,
        proven: lower >= upper - TOLERANCE,
        nodes,
        types: program.types(),
        weak: false,
    })
}

/// Noise of sums of costs.
const TOLERANCE: f64 = 1e-6;

/// One rule at least, and every label written once.
fn labels_once(costs: &Costs, operations: Operations, labels: u32) -> f64 {
    let mut operation = costs.split;
    for (allowed, cost) in [
        (operations.repeat, costs.repeat),
        (operations.repeat_aba, costs.repeat_aba),
        (operations.sym_split, costs.sym_split),
        (operations.grid_split, costs.grid_split),
    ] {
        if allowed {
            operation = operation.min(cost);
        }
    }
    operation + costs.successor * f64::from(labels)
}

/// The coarsest power of ten, down to a thousandth, that divides all costs.
fn quantum(costs: &Costs) -> Option<f64> {
    let all = [
        costs.split,
        costs.repeat,
        costs.repeat_aba,
        costs.sym_split,
        costs.successor,
    ];
    (0..=3)
        .map(|digits| 10f64.powi(-digits))
        .find(|q| all.iter().all(|c| ((c / q).round() * q - c).abs() < 1e-12))
}

/// A branch: decisions, and the bound inherited from where it branched off.
struct Branch {
    lower: f64,
    fixed: Vec<Fixed>,
}

struct Search<'a> {
    relaxation: Relaxation<'a>,
    quantum: Option<f64>,
    upper: f64,
    limits: BoundLimits,
}

impl Search<'_> {
    /// The lower bound of all branches, and how many were examined.
    fn run(&mut self) -> (f64, u64) {
        let mut fixed = vec![Fixed::Free; self.relaxation.program.types()];
        fixed[0] = Fixed::In;
        let lower = 0.0;
        let mut open = vec![Branch { lower, fixed }];
        let mut nodes = 0;
        while let Some(branch) = pop_least(&mut open) {
            if branch.lower >= self.upper - TOLERANCE {
                return (self.upper, nodes);
            }
            if nodes == self.limits.nodes {
                return (branch.lower, nodes);
            }
            nodes += 1;
            self.expand(branch, nodes == 1, &mut open);
        }
        (self.upper, nodes)
    }

    fn expand(&mut self, mut branch: Branch, root: bool, open: &mut Vec<Branch>) {
        let steps = if root {
            self.limits.root_steps
        } else {
            self.limits.branch_steps
        };
        let (upper, quantum) = (self.upper, self.quantum);
        let Some(relaxed) = self
            .relaxation
            .ascend(&branch.fixed, upper, steps, |value| {
                attainable(value, quantum) >= upper - TOLERANCE
            })
        else {
            return;
        };
        branch.lower = branch.lower.max(self.round(relaxed.value));
        self.improve(&branch.fixed, &relaxed);
        if branch.lower >= self.upper - TOLERANCE {
            return;
        }
        self.decide(&mut branch.fixed, &relaxed);
        let Some(t) = self.undecided(&branch.fixed, &relaxed) else {
            // All types are decided: what the set can do is known exactly.
            if let Some(cost) = self.relaxation.exact(&branch.fixed) {
                self.upper = self.upper.min(cost);
            }
            return;
        };
        for decision in [Fixed::Out, Fixed::In] {
            let mut fixed = branch.fixed.clone();
            fixed[t] = decision;
            let lower = branch.lower;
            open.push(Branch { lower, fixed });
        }
    }

    fn round(&self, value: f64) -> f64 {
        attainable(value, self.quantum)
    }

    /// The types that the relaxed solution opens may make a better grammar.
    fn improve(&mut self, fixed: &[Fixed], relaxed: &Relaxed) {
        let set: Vec<Fixed> = fixed
            .iter()
            .zip(&relaxed.rules)
            .map(|(f, rule)| match (f, rule) {
                (Fixed::Out, _) | (Fixed::Free, None) => Fixed::Out,
                _ => Fixed::In,
            })
            .collect();
        if let Some(cost) = self.relaxation.exact(&set) {
            self.upper = self.upper.min(cost);
        }
    }

    /// Decides types by their reduced cost, and drops those out of reach.
    fn decide(&self, fixed: &mut [Fixed], relaxed: &Relaxed) {
        for (f, &reduced) in fixed.iter_mut().zip(&relaxed.reduced) {
            let beaten = self.round(relaxed.value + reduced.abs()) >= self.upper - TOLERANCE;
            if *f == Fixed::Free && beaten {
                *f = if reduced < 0.0 { Fixed::In } else { Fixed::Out };
            }
        }
        let reachable = self
            .relaxation
            .program
            .reachable(|t| fixed[t] != Fixed::Out);
        for (f, reachable) in fixed.iter_mut().zip(reachable) {
            if *f == Fixed::Free && !reachable {
                *f = Fixed::Out;
            }
        }
    }

    /// The free type to branch on: the one that most rules of the relaxed solution name without
    /// having it, else the one whose reduced cost says least; `None` when none is free.
    fn undecided(&self, fixed: &[Fixed], relaxed: &Relaxed) -> Option<usize> {
        let mut named = vec![0u32; fixed.len()];
        for (t, rule) in relaxed.rules.iter().enumerate() {
            for &arc in rule.iter().flat_map(|r| &r.arcs) {
                let u = self.relaxation.target(t, arc);
                if u != TERMINAL && relaxed.rules[u as usize].is_none() {
                    named[u as usize] += 1;
                }
            }
        }
        (0..fixed.len())
            .filter(|&t| fixed[t] == Fixed::Free)
            .min_by(|&a, &b| {
                let says = |t: usize| relaxed.reduced[t].abs();
                named[b].cmp(&named[a]).then(says(a).total_cmp(&says(b)))
            })
    }
}

/// The least cost not below a bound that a grammar can have.
fn attainable(value: f64, quantum: Option<f64>) -> f64 {
    quantum.map_or(value, |q| ((value - TOLERANCE) / q).ceil() * q)
}

/// The branch with the least bound, the youngest of equals.
fn pop_least(open: &mut Vec<Branch>) -> Option<Branch> {
    let mut least = open.len().checked_sub(1)?;
    for i in (0..least).rev() {
        if open[i].lower < open[least].lower {
            least = i;
        }
    }
    Some(open.remove(least))
}
