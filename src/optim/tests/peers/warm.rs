//! Sequences of programs that differ a little, each solved from the solution before, beside solving each anew.

use cpu_time::ThreadTime;
use edifice_base::rng::{Stream, stream};
use edifice_optim::Outcome;
use edifice_optim::qp::{QpError, QpOptions, QuadraticProgram, Row, Solution, solve, solve_from};
use rand::RngExt;

use super::families::{control, huber, lasso, normal, portfolio, svm};
use super::programs::smoothing;

/// The largest violation of the optimality conditions, computed from the program itself.
fn violation(program: &QuadraticProgram, found: &Solution) -> f64 {
    let (Some(x), Some(duals)) = (&found.best, &found.duals) else {
        return f64::INFINITY;
    };
    let mut gradient = program.linear.clone();
    for &(i, j, v) in &program.quadratic {
        gradient[i] += v * x[j];
        if i != j {
            gradient[j] += v * x[i];
        }
    }
    let at = |row: &Row| row.terms.iter().map(|(i, v)| v * x[*i]).sum::<f64>();
    let mut worst = 0.0_f64;
    for (row, y) in program.equalities.iter().zip(&duals.equalities) {
        worst = worst.max((row.right - at(row)).abs());
        row.terms.iter().for_each(|(i, v)| gradient[*i] += v * y);
    }
    // A multiplier of at least 0, a slack of at least 0, and one of them 0.
    let pair = |z: f64, slack: f64| (-z).max(-slack).max(z.min(slack));
    for (row, z) in program.inequalities.iter().zip(&duals.inequalities) {
        worst = worst.max(pair(*z, row.right - at(row)));
        row.terms.iter().for_each(|(i, v)| gradient[*i] += v * z);
    }
    for (i, g) in gradient.iter_mut().enumerate() {
        *g += duals.upper[i] - duals.lower[i];
        worst = worst.max(pair(duals.upper[i], program.upper[i] - x[i]));
        worst = worst.max(pair(duals.lower[i], x[i] - program.lower[i]));
    }
    gradient.iter().fold(worst, |m, g| m.max(g.abs()))
}

/// A change of the numbers of a program.
type Change = fn(&mut QuadraticProgram, &mut Stream);

/// Another cost of each variable that has one, by so many percent.
fn costs(program: &mut QuadraticProgram, rng: &mut Stream) {
    let change = |q: &mut f64| *q *= 1.0 + 0.01 * normal(rng);
    program.linear.iter_mut().for_each(change);
}

/// One factor for all costs: another weight of a penalty.
fn penalty(program: &mut QuadraticProgram, _: &mut Stream) {
    program.linear.iter_mut().for_each(|q| *q *= 1.02);
}

/// Other right-hand sides of equalities.
fn data(program: &mut QuadraticProgram, rng: &mut Stream) {
    let change = |row: &mut Row| row.right += 0.01 * normal(rng);
    program.equalities.iter_mut().for_each(change);
}

/// Another state in which control starts: the equalities of the first step.
fn state(program: &mut QuadraticProgram, rng: &mut Stream) {
    let change = |row: &mut Row| row.right += 0.01 * normal(rng);
    program.equalities.iter_mut().take(12).for_each(change);
}

#[test]
fn a_solution_shortens_the_next() {
    let mut rng = stream(2, "families", 0);
    let sequences: [(&str, QuadraticProgram, Change); 6] = [
        ("portfolio, returns", portfolio(20, &mut rng), costs),
        ("lasso, penalty", lasso(40, &mut rng), penalty),
        ("Huber, data", huber(40, &mut rng), data),
        ("SVM, penalty", svm(40, &mut rng), penalty),
        ("control, state", control(12, &mut rng), state),
        ("smoothing, data", smoothing(4000), costs),
    ];
    let options = QpOptions::default();
    for (name, mut program, change) in sequences {
        let mut previous = solve(&program, options).unwrap();
        let (mut cold, mut warm, mut times, mut led) = (0, 0, [0.0, 0.0], 0);
        for _ in 0..20 {
            change(&mut program, &mut rng);
            let start = ThreadTime::now();
            let anew = solve(&program, options).unwrap();
            times[0] += start.elapsed().as_secs_f64();
            let start = ThreadTime::now();
            previous = solve_from(&program, options, &previous).unwrap();
            times[1] += start.elapsed().as_secs_f64();
            assert_eq!(previous.outcome, Outcome::Converged, "{name}");
            let off = (previous.cost - anew.cost).abs();
            assert!(off < 1e-6 * (1.0 + anew.cost.abs()), "{name}: {off}");
            let [ours, theirs] = [&previous, &anew].map(|s| violation(&program, s));
            assert!(ours < 1e-6 || ours < 10.0 * theirs, "{name}: {ours}");
            cold += anew.iterations;
            warm += previous.iterations;
            led += u32::from(previous.warm);
        }
        println!(
            "{name}: 20 programs anew {cold} iterations in {:.4} s, from the one before {warm} in {:.4} s, {led} without interior points",
            times[0], times[1]
        );
        assert!(2 * warm < cold, "{name}: {warm} of {cold}");
    }
}

/// Programs of which little is left: other costs and right-hand sides altogether, of the size that they had.
fn everything(program: &mut QuadraticProgram, rng: &mut Stream) {
    for q in &mut program.linear {
        *q += 2.0 * q.abs() * normal(rng);
    }
    let change = |row: &mut Row| row.right += 0.5 * row.right.abs() * normal(rng);
    program.inequalities.iter_mut().for_each(change);
}

/// A solution and the least processor seconds of three runs.
fn timed(run: impl Fn() -> Solution) -> (Solution, f64) {
    let runs = (0..3).map(|_| {
        let start = ThreadTime::now();
        (run(), start.elapsed().as_secs_f64())
    });
    let least = runs.min_by(|a, b| a.1.total_cmp(&b.1));
    least.unwrap()
}

#[test]
fn a_solution_far_away_costs_little() {
    let mut rng = stream(4, "families", 0);
    let programs = [
        ("portfolio", portfolio(20, &mut rng)),
        ("lasso", lasso(40, &mut rng)),
        ("Huber", huber(40, &mut rng)),
        ("SVM", svm(40, &mut rng)),
        ("control", control(12, &mut rng)),
        ("smoothing", smoothing(4000)),
    ];
    let options = QpOptions::default();
    for (name, program) in programs {
        let first = solve(&program, options).unwrap();
        let (mut ratios, mut counts, mut led) = (Vec::new(), [0, 0], 0);
        for _ in 0..15 {
            let mut next = program.clone();
            everything(&mut next, &mut rng);
            let (anew, cold) = timed(|| solve(&next, options).unwrap());
            let (found, warm) = timed(|| solve_from(&next, options, &first).unwrap());
            ratios.push(warm / cold);
            assert_eq!(found.outcome, anew.outcome, "{name}");
            if anew.best.is_some() {
                let off = (found.cost - anew.cost).abs();
                assert!(off < 1e-6 * (1.0 + anew.cost.abs()), "{name}: {off}");
            }
            assert!(found.iterations <= anew.iterations + 8, "{name}");
            counts = [counts[0] + anew.iterations, counts[1] + found.iterations];
            led += u32::from(found.warm);
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        println!(
            "{name}: {} iterations anew, {} from far away, {led} of 15 without interior points, median ratio of times {median:.2}, most {:.2}",
            counts[0],
            counts[1],
            ratios[ratios.len() - 1]
        );
        assert!(median < 2.0, "{name}: {median}");
    }
}

/// A program with small whole numbers, so that ties, equal rows and flat directions occur.
fn whole(rng: &mut Stream) -> QuadraticProgram {
    let n = rng.random_range(1..6);
    let mut program = QuadraticProgram::new(n);
    let number = |rng: &mut Stream| f64::from(rng.random_range(-2..=2));
    for _ in 0..rng.random_range(0..=n) {
        let m: Vec<f64> = (0..n).map(|_| number(rng)).collect();
        for i in 0..n {
            (i..n).for_each(|j| program.quadratic.push((i, j, m[i] * m[j])));
        }
    }
    for i in 0..n {
        program.linear[i] = number(rng);
        (program.lower[i], program.upper[i]) = (-2.0, f64::from(rng.random_range(-2..3)));
    }
    let row = |rng: &mut Stream| {
        let terms: Vec<(usize, f64)> = (0..n).map(|i| (i, number(rng))).collect();
        Row::new(terms, number(rng))
    };
    for _ in 0..rng.random_range(0..3) {
        program.inequalities.push(row(rng));
        if rng.random_range(0..3) == 0 {
            program.inequalities.push(program.inequalities[0].clone());
        }
    }
    if rng.random_range(0..3) == 0 {
        program.equalities.push(row(rng));
    }
    program
}

#[test]
fn any_start_leads_to_the_same_cost() {
    let mut rng = stream(3, "starts", 0);
    let (mut solved, mut led) = (0, 0);
    for round in 0..3000 {
        let program = whole(&mut rng);
        let first = solve(&program, QpOptions::default()).unwrap();
        let mut next = program.clone();
        for q in &mut next.linear {
            *q += f64::from(rng.random_range(-1..=1));
        }
        for row in &mut next.inequalities {
            row.right += 0.3 * normal(&mut rng);
        }
        let anew = solve(&next, QpOptions::default()).unwrap();
        let found = solve_from(&next, QpOptions::default(), &first).unwrap();
        assert_eq!(
            found.best.is_some(),
            anew.best.is_some(),
            "{round}: {next:?}"
        );
        if found.best.is_some() {
            solved += 1;
            led += u32::from(found.warm);
            let off = (found.cost - anew.cost).abs();
            assert!(off < 1e-5, "{round}: {} is not {}", found.cost, anew.cost);
            let worst = violation(&next, &found);
            assert!(!found.warm || worst < 1e-6, "{round}: {worst}");
        }
    }
    println!("{led} of {solved} small programs without interior points");
    assert!(solved > 1500 && 2 * led > solved);
}

#[test]
fn starts_of_another_program_are_refused_and_none_is_no_harm() {
    let program = smoothing(20);
    let other = solve(&smoothing(30), QpOptions::default()).unwrap();
    let found = solve_from(&program, QpOptions::default(), &other);
    assert_eq!(found, Err(QpError::Start));
    let mut more = program.clone();
    more.inequalities.push(Row::new([(0, 1.0)], 5.0));
    let own = solve(&program, QpOptions::default()).unwrap();
    let found = solve_from(&more, QpOptions::default(), &own);
    assert_eq!(found, Err(QpError::Start));
    // An infeasible program has no point to start from.
    let mut none = program.clone();
    none.lower = vec![2.0; 20];
    none.upper = vec![3.0; 20];
    let nothing = solve(&none, QpOptions::default()).unwrap();
    assert_eq!(nothing.outcome, Outcome::Infeasible);
    let found = solve_from(&program, QpOptions::default(), &nothing).unwrap();
    assert!(!found.warm && (found.cost - own.cost).abs() < 1e-6);
}
