//! Does what is stated about a variable fit its parents?

use super::super::conjugate::Linear;
use super::super::error::ModelError;
use super::variable::{Cpd, Stated, Variable};

/// The stated distribution of `v`, given the number of configurations of its discrete parents and `p` = 1 +
/// continuous coordinates, `None` beyond the range of numbers. Nothing is allocated for sizes that
/// the stated numbers do not have.
pub(super) fn check(
    v: &Variable,
    configurations: Option<usize>,
    p: Option<usize>,
) -> Result<Cpd, ModelError> {
    let (k, d) = (v.categories.len(), v.dimension);
    let sized = |got: usize, factors: &[usize]| {
        let needed = factors.iter().try_fold(1_usize, |n, &f| n.checked_mul(f));
        if needed == Some(got) {
            return Ok(());
        }
        let needed = needed.map_or("too many".into(), |n| n.to_string());
        let problem = format!("has {got} numbers, {needed} are needed");
        Err(ModelError::parameter(&v.name, problem))
    };
    let (Some(configurations), Some(p)) = (configurations, p) else {
        let problem = "has more configurations of its parents than can be counted";
        return Err(ModelError::parameter(&v.name, problem));
    };
    match (&v.stated, d > 0) {
        (Stated::Table(_), false) if p > 1 => Err(ModelError::Kind {
            column: v.name.clone(),
            got: "a table with a continuous parent",
            expected: "a softmax",
        }),
        (Stated::Table(table), false) => {
            sized(table.len(), &[configurations, k])?;
            for (i, row) in table.chunks(k).enumerate() {
                let sum: f64 = row.iter().sum();
                let fine = row.iter().all(|p| (0.0..=1.0).contains(p)) && (sum - 1.0).abs() < 1e-6;
                if !fine {
                    let problem = format!("configuration {i}: {row:?} is no distribution");
                    return Err(ModelError::parameter(&v.name, problem));
                }
            }
            Ok(Cpd::Table(table.clone()))
        }
        (Stated::Softmax(weights), false) => {
            sized(weights.len(), &[configurations, k, p])?;
            if !weights.iter().all(|w| w.is_finite()) {
                return Err(ModelError::parameter(
                    &v.name,
                    "has a weight that is not finite",
                ));
            }
            Ok(Cpd::Softmax(weights.clone()))
        }
        (Stated::Linear(states), true) => {
            sized(states.len(), &[configurations])?;
            let linear: Result<Vec<Linear>, ModelError> = states
                .iter()
                .map(|(b, s)| {
                    sized(b.len(), &[p, d])?;
                    sized(s.len(), &[d, d])?;
                    Linear::new(p, d, b.clone(), s.clone()).ok_or_else(|| ModelError::Singular {
                        variable: v.name.clone(),
                    })
                })
                .collect();
            Ok(Cpd::Linear(linear?))
        }
        (Stated::Open, false) if p > 1 => {
            let sizes = [configurations, k, p];
            let size = sizes.iter().try_fold(1_usize, |n, &f| n.checked_mul(f));
            let size =
                size.ok_or_else(|| ModelError::parameter(&v.name, "has too many weights"))?;
            Ok(Cpd::Softmax(vec![0.0; size]))
        }
        (Stated::Open, false) => Ok(Cpd::Table(vec![1.0 / k as f64; configurations * k])),
        (Stated::Open, true) => {
            let identity = (0..d * d)
                .map(|i| f64::from(u8::from(i % (d + 1) == 0)))
                .collect();
            let linear = Linear::new(p, d, vec![0.0; p * d], identity);
            let linear = linear.ok_or_else(|| ModelError::Singular {
                variable: v.name.clone(),
            })?;
            Ok(Cpd::Linear(vec![linear; configurations]))
        }
        _ => Err(ModelError::Kind {
            column: v.name.clone(),
            got: if d > 0 { "a real vector" } else { "discrete" },
            expected: "of the kind of its distribution",
        }),
    }
}
