//! Convex quadratic programming: element widths near the wanted ones that fill a wall.
//! `cargo run --example optim_qp --no-default-features`

use edifice::optim::Outcome;
use edifice::optim::qp::{QpError, QpOptions, QuadraticProgram, Row, solve};

fn main() -> Result<(), QpError> {
    // Four windows with gaps between and beside them: widths w1..w4, gaps g1..g5, together 12.
    let (windows, gaps) = (0..4, 4..9);
    let mut program = QuadraticProgram::new(9);
    for i in windows.clone() {
        program.pull(i, 1.5, 1.0);
        (program.lower[i], program.upper[i]) = (0.75, 2.25);
    }
    for i in gaps.clone() {
        program.pull(i, 1.0, 0.2);
        program.lower[i] = 0.3;
    }
    let all = windows.clone().chain(gaps).map(|i| (i, 1.0));
    program.equalities.push(Row::new(all, 12.0));
    // The first and the last gap are equal, and the windows all of one width.
    program
        .equalities
        .push(Row::new([(4, 1.0), (8, -1.0)], 0.0));
    for i in 1..4 {
        program
            .equalities
            .push(Row::new([(i, 1.0), (0, -1.0)], 0.0));
    }
    let found = solve(&program, QpOptions::default())?;
    assert_eq!(found.outcome, Outcome::Converged);
    let widths = found.best.unwrap_or_default();
    println!("windows {:.3}, gaps {:.3?}", widths[0], &widths[4..]);
    assert!((widths.iter().sum::<f64>() - 12.0).abs() < 1e-6);
    if let Some(duals) = found.duals {
        println!("a wider wall would cost {:.3} a unit", -duals.equalities[0]);
    }
    Ok(())
}
