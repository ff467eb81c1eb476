//! Performance profiles, and how soon targets are reached.

/// Dolan and More: for each arm the sorted ratios of its values to the best arm's, `values[instance][arm]`, smaller being better and
/// `None` a failure, which counts as infinite. Values are positive; where the best is 0, arms that reach it have ratio 1 and others
/// an infinite one.
pub fn profile(values: &[Vec<Option<f64>>]) -> Vec<Vec<f64>> {
    let arms = values.first().map_or(0, Vec::len);
    let mut ratios = vec![Vec::with_capacity(values.len()); arms];
    for row in values {
        let best = row.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        for (arm, value) in row.iter().enumerate() {
            ratios[arm].push(match value {
                Some(value) if *value <= best => 1.0,
                Some(value) if best > 0.0 => value / best,
                _ => f64::INFINITY,
            });
        }
    }
    for arm in &mut ratios {
        arm.sort_by(f64::total_cmp);
    }
    ratios
}

/// Evaluations after which each run reached its target, sorted; infinite for those that did not. A run is its trace
/// `[evaluations, value]`, smaller values being better, and the value that it should reach.
pub fn reached<'a>(runs: impl Iterator<Item = (&'a [[f64; 2]], f64)>) -> Vec<f64> {
    let first = |(trace, target): (&[[f64; 2]], f64)| {
        let hit = trace.iter().find(|[_, value]| *value <= target);
        hit.map_or(f64::INFINITY, |[evaluations, _]| *evaluations)
    };
    let mut times: Vec<f64> = runs.map(first).collect();
    times.sort_by(f64::total_cmp);
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_and_failures() {
        let values = vec![
            vec![Some(2.0), Some(1.0)],
            vec![Some(3.0), None],
            vec![Some(0.0), Some(1.0)],
        ];
        assert_eq!(
            profile(&values),
            [vec![1.0, 1.0, 2.0], vec![1.0, f64::INFINITY, f64::INFINITY]]
        );
        assert!(profile(&[]).is_empty());
    }

    #[test]
    fn the_first_value_at_the_target_counts() {
        let trace = [[1.0, 9.0], [5.0, 4.0], [8.0, 2.0]];
        let times = reached([(&trace[..], 4.0), (&trace[..], 1.0), (&trace[..], 9.5)].into_iter());
        assert_eq!(times, [1.0, 5.0, f64::INFINITY]);
    }
}
