//! Eq. 5 for one facade piece: widths nearest to suggested ones with a given sum, each within bounds.

/// The `w` that minimises `sum (w_i - suggested_i)^2` with `sum w_i = total` and `lower_i <= w_i <= upper_i`: at the
/// optimum `w_i = clamp(suggested_i + l)` for one `l`, found exactly between the breakpoints where some `w_i` meets
/// a bound. `None` when no widths have that sum, or some bounds cross.
///
/// Complexity: `O(n^2)` for `n` widths.
pub fn widths(suggested: &[f64], lower: &[f64], upper: &[f64], total: f64) -> Option<Vec<f64>> {
    let bounds = || lower.iter().zip(upper);
    if bounds().any(|(l, u)| l > u) {
        return None;
    }
    let (least, most): (f64, f64) = (lower.iter().sum(), upper.iter().sum());
    let slack = 1e-9 * (1.0 + total.abs());
    if total < least - slack || total > most + slack {
        return None;
    }
    let at = |shift: f64| -> Vec<f64> {
        let each = suggested.iter().zip(bounds());
        each.map(|(w, (l, u))| (w + shift).clamp(*l, *u)).collect()
    };
    let sum = |shift: f64| at(shift).iter().sum::<f64>();
    let mut stops: Vec<f64> = suggested
        .iter()
        .zip(bounds())
        .flat_map(|(w, (l, u))| [l - w, u - w])
        .collect();
    stops.sort_by(f64::total_cmp);
    let Some(k) = stops.iter().position(|&s| sum(s) >= total) else {
        return Some(at(*stops.last()?));
    };
    if k == 0 {
        return Some(at(stops[0]));
    }
    // Between two stops the sum is linear.
    let (a, b) = (stops[k - 1], stops[k]);
    let (below, above) = (sum(a), sum(b));
    let share = if above > below {
        (total - below) / (above - below)
    } else {
        0.0
    };
    Some(at(a + share * (b - a)))
}

#[cfg(test)]
mod tests {
    use super::widths;
    use edifice_base::rng::stream;
    use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve};
    use rand::RngExt;

    #[test]
    fn agrees_with_the_interior_point_method() {
        for case in 0..300 {
            let mut rng = stream(5, "knapsack", case);
            let n = rng.random_range(1..8);
            let average: f64 = rng.random_range(0.5..2.0);
            let suggested: Vec<f64> = (0..n).map(|_| rng.random_range(0.3..2.5)).collect();
            let lower = vec![0.5 * average; n];
            let upper = vec![1.5 * average; n];
            let total = n as f64 * average * rng.random_range(0.5..1.5);
            let found = widths(&suggested, &lower, &upper, total).unwrap();
            let mut program = QuadraticProgram::new(n);
            for (i, w) in suggested.iter().enumerate() {
                program.pull(i, *w, 1.0);
            }
            program
                .equalities
                .push(Row::new((0..n).map(|i| (i, 1.0)), total));
            program.lower.copy_from_slice(&lower);
            program.upper.copy_from_slice(&upper);
            let oracle = solve(&program, QpOptions::default()).unwrap().best.unwrap();
            for (w, x) in found.iter().zip(&oracle) {
                assert!((w - x).abs() < 1e-5, "case {case}: {found:?}, {oracle:?}");
            }
        }
    }

    #[test]
    fn a_sum_out_of_reach_is_refused() {
        assert_eq!(widths(&[1.0], &[0.5], &[1.5], 2.0), None);
        assert_eq!(widths(&[1.0], &[1.5], &[0.5], 1.0), None);
        assert_eq!(
            widths(&[1.0, 1.0], &[0.5; 2], &[1.5; 2], 3.0),
            Some(vec![1.5, 1.5])
        );
    }
}
