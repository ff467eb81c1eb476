//! Quadratic programs of bands: their duals, and what is not convex.

use edifice_base::rng::stream;
use edifice_optim::Outcome;
use edifice_optim::qp::{QpError, QpOptions, QuadraticProgram, Row, solve};
use rand::RngExt;

/// A smoothing program: points near data whose second differences are small.
pub(crate) fn smoothing(n: usize) -> QuadraticProgram {
    let mut program = QuadraticProgram::new(n);
    let mut rng = stream(5, "smoothing", 0);
    for i in 0..n {
        program.pull(
            i,
            (i as f64 / 50.0).sin() + 0.3 * (rng.random::<f64>() - 0.5),
            1.0,
        );
    }
    for i in 1..n - 1 {
        // 10 (x_(i-1) - 2 x_i + x_(i+1))².
        let terms = [(i - 1, 1.0), (i, -2.0), (i + 1, 1.0)];
        for (a, (i, u)) in terms.iter().enumerate() {
            for (j, v) in &terms[a..] {
                program.quadratic.push((*i, *j, 20.0 * u * v));
            }
        }
        program.inequalities.push(Row::new([(i, 1.0)], 0.9));
    }
    program
}

#[test]
fn a_banded_program_of_four_thousand_is_solved_at_once_and_its_duals_are_right() {
    let n = 4000;
    let program = smoothing(n);
    let start = std::time::Instant::now();
    let found = solve(&program, QpOptions::default()).unwrap();
    println!(
        "{n} variables: {:?}, {} iterations, {:.3} s",
        found.outcome,
        found.iterations,
        start.elapsed().as_secs_f64()
    );
    assert_eq!(found.outcome, Outcome::Converged);
    let (x, duals) = (found.best.unwrap(), found.duals.unwrap());
    let mut gradient = program.linear.clone();
    for &(i, j, v) in &program.quadratic {
        gradient[i] += v * x[j];
        if i != j {
            gradient[j] += v * x[i];
        }
    }
    for (row, z) in program.inequalities.iter().zip(&duals.inequalities) {
        let at: f64 = row.terms.iter().map(|(i, v)| v * x[*i]).sum();
        assert!(*z >= 0.0 && z * (row.right - at).abs() < 1e-5);
        row.terms.iter().for_each(|(i, v)| gradient[*i] += v * z);
    }
    assert!(gradient.iter().all(|g| g.abs() < 1e-4));
}

#[test]
fn programs_that_are_not_convex_are_refused_by_their_eigenvalue() {
    // Bands with one negative eigenvalue, few and many variables.
    for n in [5, 1000] {
        let mut program = smoothing(n.max(3));
        assert_eq!(program.check(), Ok(()));
        program.quadratic.push((n / 2, n / 2, -400.0));
        match program.check() {
            Err(QpError::NotConvex(least)) => assert!(least < -1.0, "{least}"),
            other => panic!("{n}: {other:?}"),
        }
    }
    // A form of rank one is convex.
    let mut program = QuadraticProgram::new(400);
    for i in 0..400 {
        for j in i..400 {
            program
                .quadratic
                .push((i, j, (i as f64).sin() * (j as f64).sin()));
        }
    }
    assert_eq!(program.check(), Ok(()));
}
