//! Quadratic programs of the families on which OSQP is judged (Stellato et al. 2020, Appendix A), beside Clarabel called directly with the same numbers.
//! Times are printed; run with `--release --nocapture` to compare them.

use cpu_time::ThreadTime;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SupportedConeT};
use edifice_base::rng::{Stream, stream};
use edifice_optim::Outcome;
use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve};
use rand::RngExt;

/// A normal number.
pub(crate) fn normal(rng: &mut Stream) -> f64 {
    let (u, v): (f64, f64) = (1.0 - rng.random::<f64>(), rng.random());
    (-2.0 * u.ln()).sqrt() * (2.0 * std::f64::consts::PI * v).cos()
}

/// Entries of a sparse random matrix, row by row.
fn sparse(rows: usize, columns: usize, density: f64, rng: &mut Stream) -> Vec<Vec<(usize, f64)>> {
    let mut all = Vec::new();
    for _ in 0..rows {
        let mut row = Vec::new();
        for c in 0..columns {
            if rng.random::<f64>() < density {
                row.push((c, normal(rng)));
            }
        }
        all.push(row);
    }
    all
}

/// Returns of assets explained by k factors y = F' x: weights x of sum 1, none negative.
pub(crate) fn portfolio(k: usize, rng: &mut Stream) -> QuadraticProgram {
    let n = 20 * k;
    let mut program = QuadraticProgram::new(n + k);
    for i in 0..n {
        program
            .quadratic
            .push((i, i, 2.0 * rng.random::<f64>() * (k as f64).sqrt()));
        program.linear[i] = -normal(rng);
        program.lower[i] = 0.0;
    }
    let factors = sparse(k, n, 0.5, rng);
    for (j, row) in factors.into_iter().enumerate() {
        program.quadratic.push((n + j, n + j, 2.0));
        let terms = row.into_iter().chain([(n + j, -1.0)]);
        program.equalities.push(Row::new(terms, 0.0));
    }
    program
        .equalities
        .push(Row::new((0..n).map(|i| (i, 1.0)), 1.0));
    program
}

/// Least squares with a bound on absolute values: x, residuals y, and t at least |x|.
pub(crate) fn lasso(n: usize, rng: &mut Stream) -> QuadraticProgram {
    let m = 5 * n;
    let mut program = QuadraticProgram::new(2 * n + m);
    for (j, row) in sparse(m, n, 0.15, rng).into_iter().enumerate() {
        program.quadratic.push((2 * n + j, 2 * n + j, 1.0));
        let right = row
            .iter()
            .map(|(i, a)| if i % 2 == 0 { *a } else { 0.0 })
            .sum::<f64>()
            + 0.1 * normal(rng);
        let terms = row.into_iter().chain([(2 * n + j, -1.0)]);
        program.equalities.push(Row::new(terms, right));
    }
    for i in 0..n {
        program.linear[n + i] = 1.0;
        program
            .inequalities
            .push(Row::new([(i, 1.0), (n + i, -1.0)], 0.0));
        program
            .inequalities
            .push(Row::new([(i, -1.0), (n + i, -1.0)], 0.0));
    }
    program
}

/// Robust regression: residual u + r - s, quadratic in u and linear in r and s.
pub(crate) fn huber(n: usize, rng: &mut Stream) -> QuadraticProgram {
    let m = 5 * n;
    let mut program = QuadraticProgram::new(n + 3 * m);
    for (j, row) in sparse(m, n, 0.15, rng).into_iter().enumerate() {
        let (u, r, s) = (n + j, n + m + j, n + 2 * m + j);
        program.quadratic.push((u, u, 2.0));
        for v in [r, s] {
            program.linear[v] = 2.0;
            program.lower[v] = 0.0;
        }
        let right = row.iter().map(|(_, a)| a).sum::<f64>()
            + if j % 20 == 0 {
                10.0 * rng.random::<f64>()
            } else {
                0.25 * normal(rng)
            };
        let terms = row.into_iter().chain([(u, -1.0), (r, -1.0), (s, 1.0)]);
        program.equalities.push(Row::new(terms, right));
    }
    program
}

/// A support vector machine: x and slacks t.
pub(crate) fn svm(n: usize, rng: &mut Stream) -> QuadraticProgram {
    let m = 10 * n;
    let mut program = QuadraticProgram::new(n + m);
    (0..n).for_each(|i| program.quadratic.push((i, i, 1.0)));
    for (j, row) in sparse(m, n, 0.15, rng).into_iter().enumerate() {
        let label = if j % 2 == 0 { 1.0 } else { -1.0 };
        program.linear[n + j] = 1.0;
        program.lower[n + j] = 0.0;
        let terms = row
            .into_iter()
            .map(|(i, a)| (i, label * (a + label / n as f64)));
        program
            .inequalities
            .push(Row::new(terms.chain([(n + j, -1.0)]), -1.0));
    }
    program
}

/// Control of a linear system over ten steps, states and inputs bounded.
pub(crate) fn control(n: usize, rng: &mut Stream) -> QuadraticProgram {
    let (inputs, steps) = (n / 2, 10);
    let width = n + inputs;
    let mut program = QuadraticProgram::new(steps * width);
    let dynamics: Vec<Vec<(usize, f64)>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| (j, if i == j { 1.0 } else { 0.0 } + 0.01 * normal(rng)))
                .collect()
        })
        .collect();
    let effect = sparse(n, inputs, 0.5, rng);
    let start: Vec<f64> = (0..n).map(|_| rng.random::<f64>() - 0.5).collect();
    for t in 0..steps {
        for i in 0..n {
            let x = t * width + i;
            program
                .quadratic
                .push((x, x, 10.0 * f64::from(u8::from(i % 3 == 0))));
            (program.lower[x], program.upper[x]) = (-2.0, 2.0);
            let mut terms = vec![(x, 1.0)];
            let mut right = 0.0;
            for &(j, a) in &dynamics[i] {
                match t {
                    0 => right += a * start[j],
                    _ => terms.push(((t - 1) * width + j, -a)),
                }
            }
            terms.extend(effect[i].iter().map(|&(j, b)| (t * width + n + j, -b)));
            program.equalities.push(Row::new(terms, right));
        }
        for j in 0..inputs {
            let u = t * width + n + j;
            program.quadratic.push((u, u, 0.1));
            (program.lower[u], program.upper[u]) = (-1.0, 1.0);
        }
    }
    program
}

/// Clarabel's cost and processor seconds, the matrices made here. Times of this thread alone: programs that run beside take none of it.
fn direct(program: &QuadraticProgram) -> (f64, f64) {
    let n = program.dimension();
    let (mut rows, mut columns, mut values, mut right) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut push = |terms: &[(usize, f64)], b: f64| {
        for (i, v) in terms {
            rows.push(right.len());
            columns.push(*i);
            values.push(*v);
        }
        right.push(b);
    };
    program
        .equalities
        .iter()
        .for_each(|r| push(&r.terms, r.right));
    program
        .inequalities
        .iter()
        .for_each(|r| push(&r.terms, r.right));
    for i in 0..n {
        if program.upper[i].is_finite() {
            push(&[(i, 1.0)], program.upper[i]);
        }
        if program.lower[i].is_finite() {
            push(&[(i, -1.0)], -program.lower[i]);
        }
    }
    let e = program.equalities.len();
    let cones = [
        SupportedConeT::ZeroConeT(e),
        SupportedConeT::NonnegativeConeT(right.len() - e),
    ];
    let a = CscMatrix::new_from_triplets(right.len(), n, rows, columns, values);
    let q = &program.quadratic;
    let p = CscMatrix::new_from_triplets(
        n,
        n,
        q.iter().map(|t| t.0.min(t.1)).collect(),
        q.iter().map(|t| t.0.max(t.1)).collect(),
        q.iter().map(|t| t.2).collect(),
    );
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-9)
        .tol_gap_rel(1e-9)
        .tol_feas(1e-9)
        .build()
        .unwrap();
    let start = ThreadTime::now();
    let mut solver = DefaultSolver::new(&p, &program.linear, &a, &right, &cones, settings).unwrap();
    solver.solve();
    (solver.solution.obj_val, start.elapsed().as_secs_f64())
}

#[test]
fn families_are_solved_as_fast_as_by_clarabel_itself() {
    let mut rng = stream(1, "families", 0);
    let programs = [
        ("portfolio", portfolio(20, &mut rng)),
        ("lasso", lasso(40, &mut rng)),
        ("Huber", huber(40, &mut rng)),
        ("SVM", svm(40, &mut rng)),
        ("control", control(12, &mut rng)),
        ("smoothing", super::programs::smoothing(4000)),
    ];
    for (name, program) in &programs {
        let mut times = Vec::new();
        for _ in 0..31 {
            let start = ThreadTime::now();
            let found = solve(program, QpOptions::default()).unwrap();
            let ours = start.elapsed().as_secs_f64();
            let (cost, theirs) = direct(program);
            times.push((ours / theirs, ours, theirs));
            assert_eq!(found.outcome, Outcome::Converged, "{name}");
            assert!(
                (found.cost - cost).abs() < 1e-6 * (1.0 + cost.abs()),
                "{name}: {} is not {cost}",
                found.cost
            );
        }
        // Of pairs of runs one after the other, so that what else runs bears on both.
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (ratio, ours, theirs) = times[times.len() / 2];
        let (low, high) = (times[times.len() / 4].0, times[3 * times.len() / 4].0);
        println!(
            "{name}, {} variables: {ours:.4} s, Clarabel {theirs:.4} s, median ratio {ratio:.2}, quartiles {low:.2} and {high:.2}",
            program.dimension()
        );
        assert!(ratio < 1.5, "{name}");
    }
}
