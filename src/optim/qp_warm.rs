//! Solving a quadratic program from the solution of one that differs little.
//!
//! An interior-point method gains little from a solution as its start: that lies on the boundary, where its steps are short (Yildirim
//! and Wright 2002, *Warm-start strategies in interior-point methods for linear programming*). What carries over is the
//! set W of the constraints that are tight. With W fixed a program is one system of linear equations,
//!
//! ```text
//! P x + A_W' z = -q,    A_W x = b_W,    z = 0 outside of W
//! ```
//! and W is right when every multiplier of an inequality in W is at least 0 and every inequality outside of W holds. Else those of
//! negative multipliers leave W, those violated enter it, and the system is solved again. These are Newton steps on the optimality
//! conditions, a primal-dual active set method. It need not end: after [`MOST`] steps, after one that changes no fewer constraints than the step
//! before, or where a system has no solution, the interior-point method takes over. What it returns fulfils the optimality conditions, which suffice, the program being convex.
//!
//! Sources: Hintermüller, Ito and Kunisch 2002, *The primal-dual active set strategy as a semismooth Newton method*, Algorithm 2.1;
//! for the regularised system and its refinement, Stellato et al. 2020, *OSQP*, Sec. 4.

use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettingsBuilder};

use super::qp_form::Form;
use super::triplets::Triplets;

/// Systems solved at most.
const MOST: u32 = 8;
/// What is added to the diagonal, in units of the largest entry of P's or 1, so that the system has a factor.
const SHIFT: f64 = 1e-8;
/// Rounds of refinement, which take away what the shift did.
const REFINEMENTS: usize = 12;

/// Largest residual of a system that counts as solved, in units of its largest right-hand side or 1.
const SOLVED: f64 = 1e-6;

/// A point and the multipliers of all rows.
pub(super) struct Pair {
    /// n numbers.
    pub(super) x: Vec<f64>,
    /// m numbers.
    pub(super) z: Vec<f64>,
}

/// The solution from a pair near it, and the number of systems solved; `None` in place of the solution where the steps do not lead to it.
///
/// `goes_on` is asked before each step. A step costs one sparse factor of at most n + |W| rows.
pub(super) fn solve_near(
    form: &Form,
    linear: &[f64],
    near: &Pair,
    tolerance: f64,
    most: u32,
    goes_on: impl Fn() -> bool,
) -> (Option<Pair>, u32) {
    let slack = slacks(form, &near.x);
    let mut tight: Vec<bool> = (0..form.right.len())
        .map(|i| i < form.equalities || near.z[i] > slack[i])
        .collect();
    let (mut steps, mut changed) = (0, usize::MAX);
    while steps < most.min(MOST) && goes_on() {
        steps += 1;
        let Some(mut pair) = with_tight(form, linear, &tight) else {
            return (None, steps);
        };
        let scale = Scale::new(form, linear, &pair);
        let slack = slacks(form, &pair.x);
        let mut count = 0;
        for i in form.equalities..tight.len() {
            let stays = match tight[i] {
                true => pair.z[i] >= -tolerance * scale.dual,
                false => slack[i] < -tolerance * scale.primal,
            };
            count += usize::from(stays != tight[i]);
            tight[i] = stays;
        }
        if count == 0 {
            let holds = (0..tight.len())
                .all(|i| !tight[i] || slack[i].abs() <= tolerance * scale.primal)
                && gradient(form, linear, &pair)
                    .iter()
                    .all(|g| g.abs() <= tolerance * scale.dual);
            let signed = &mut pair.z[form.equalities..];
            signed.iter_mut().for_each(|z| *z = z.max(0.0));
            return (holds.then_some(pair), steps);
        }
        if count >= changed {
            break;
        }
        changed = count;
    }
    (None, steps)
}

/// The sizes by which residuals are measured.
struct Scale {
    primal: f64,
    dual: f64,
}

impl Scale {
    fn new(form: &Form, linear: &[f64], pair: &Pair) -> Self {
        let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let curved = largest(&half_times(&form.quadratic, &pair.x));
        Self {
            primal: 1.0 + largest(&form.right).max(largest(&pair.x)),
            dual: 1.0 + largest(linear).max(curved),
        }
    }
}

/// `b - A x`.
fn slacks(form: &Form, x: &[f64]) -> Vec<f64> {
    let mut out = form.right.clone();
    for (j, i, value) in entries(&form.rows) {
        out[i] -= value * x[j];
    }
    out
}

/// `P x + q + A' z`.
fn gradient(form: &Form, linear: &[f64], pair: &Pair) -> Vec<f64> {
    let mut out = half_times(&form.quadratic, &pair.x);
    out.iter_mut().zip(linear).for_each(|(g, q)| *g += q);
    for (j, i, value) in entries(&form.rows) {
        out[j] += value * pair.z[i];
    }
    out
}

/// The product of a symmetric matrix, of which the upper half is given, with a vector.
fn half_times(half: &CscMatrix<f64>, x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for (j, i, value) in entries(half) {
        out[i] += value * x[j];
        if i != j {
            out[j] += value * x[i];
        }
    }
    out
}

/// Column, row and value of every entry.
fn entries(matrix: &CscMatrix<f64>) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    (0..matrix.n).flat_map(move |j| {
        let range = matrix.colptr[j]..matrix.colptr[j + 1];
        range.map(move |k| (j, matrix.rowval[k], matrix.nzval[k]))
    })
}

/// The solution of the system whose tight rows are these; `None` where it has none, or none that is found.
///
/// Variables at a tight bound are put in, so that the system is one of the other variables and of the tight equalities and inequalities.
fn with_tight(form: &Form, linear: &[f64], tight: &[bool]) -> Option<Pair> {
    let n = linear.len();
    let bound = |rows: &[Option<usize>], j: usize| rows[j].filter(|row| tight[*row]);
    let at = |j| (bound(&form.upper, j), bound(&form.lower, j));
    let mut pair = Pair {
        x: vec![0.0; n],
        z: vec![0.0; tight.len()],
    };
    let mut free = Vec::new();
    let mut seat = vec![None; n];
    for (j, seat) in seat.iter_mut().enumerate() {
        match at(j) {
            (Some(row), _) => pair.x[j] = form.right[row],
            (None, Some(row)) => pair.x[j] = -form.right[row],
            (None, None) => {
                *seat = Some(free.len());
                free.push(j);
            }
        }
    }
    let rows: Vec<usize> = (0..form.bounds).filter(|i| tight[*i]).collect();
    // More conditions than numbers hold by chance alone, and their factor fills up.
    if rows.len() > free.len() {
        return None;
    }
    let mut place = vec![None; tight.len()];
    (rows.iter().enumerate()).for_each(|(k, &i)| place[i] = Some(free.len() + k));
    // What the variables at bounds leave of the right-hand sides.
    let (rest, slack) = (gradient(form, linear, &pair), slacks(form, &pair.x));
    let wanted = free.iter().map(|&j| -rest[j]);
    let wanted: Vec<f64> = wanted.chain(rows.iter().map(|&i| slack[i])).collect();
    let mut own = Triplets::with_capacity(form.quadratic.nzval.len() + form.rows.nzval.len());
    for (j, i, value) in entries(&form.quadratic) {
        if let (Some(j), Some(i)) = (seat[j], seat[i]) {
            own.entry(i, j, value);
        }
    }
    for (j, i, value) in entries(&form.rows) {
        if let (Some(j), Some(i)) = (seat[j], place[i]) {
            own.entry(j, i, value);
        }
    }
    let own = own.matrix(wanted.len(), wanted.len());
    let found = saddle(&own, free.len(), &wanted)?;
    for (j, value) in free.iter().zip(&found) {
        pair.x[*j] = *value;
    }
    for (i, value) in rows.iter().zip(&found[free.len()..]) {
        pair.z[*i] = *value;
    }
    for (j, g) in gradient(form, linear, &pair).into_iter().enumerate() {
        match at(j) {
            (Some(row), None) => pair.z[row] = -g,
            (None, Some(row)) => pair.z[row] = g,
            // Equal bounds: the one against which the cost pushes.
            (Some(upper), Some(lower)) => {
                (pair.z[upper], pair.z[lower]) = ((-g).max(0.0), g.max(0.0))
            }
            (None, None) => {}
        }
    }
    Some(pair)
}

/// The solution of a symmetric system, of which the upper half is given: positive semidefinite in its first `n` rows, zero in the square of the
/// others. Solved with a shift of the diagonal, which refinement takes away; `None` where no numbers come of it.
fn saddle(own: &CscMatrix<f64>, n: usize, wanted: &[f64]) -> Option<Vec<f64>> {
    let size = wanted.len();
    if size == 0 {
        return Some(Vec::new());
    }
    let diagonal = entries(own).filter(|(j, i, _)| i == j);
    let shift = SHIFT * diagonal.fold(1.0_f64, |m, (_, _, value)| m.max(value.abs()));
    let mut shifted = Triplets::with_capacity(own.nzval.len() + size);
    entries(own).for_each(|(j, i, value)| shifted.entry(i, j, value));
    (0..size).for_each(|i| shifted.entry(i, i, if i < n { shift } else { -shift }));
    let signs = (0..size).map(|i| if i < n { 1 } else { -1 }).collect();
    let settings = QDLDLSettingsBuilder::default().Dsigns(signs).build().ok()?;
    let mut factor = QDLDLFactorisation::new(&shifted.matrix(size, size), Some(settings)).ok()?;
    let mut found = vec![0.0; size];
    let mut rest = wanted.to_vec();
    let mut before = f64::INFINITY;
    for _ in 0..REFINEMENTS {
        factor.solve(&mut rest);
        let better: Vec<f64> = found.iter().zip(&rest).map(|(f, r)| f + r).collect();
        let product = half_times(own, &better);
        rest = wanted.iter().zip(product).map(|(w, p)| w - p).collect();
        let size = rest.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        if size.is_nan() || size >= before {
            break;
        }
        (found, before) = (better, size);
    }
    let largest = wanted.iter().fold(1.0_f64, |m, w| m.max(w.abs()));
    (before <= SOLVED * largest).then_some(found)
}
