//! Columns that share one hidden variable, or have each their own: the better of both.
//!
//! A schema of one attribute a column gives each real column a hidden variable of its own, so that columns depend on each other through the
//! style and lateral edges alone. Where they move together, on a curve say, one vector-valued attribute of all real columns is far
//! better: a mixture of full Gaussians. Both are learned, and the Cheeseman-Stutz score chooses, which is the logarithm of the evidence of the
//! same rows of the same standardised columns.
//!
//! # Deviations and readings
//! - Only the two ends are tried, all joined and none, not the groupings between. The joined model is learned first: it is the
//!   quicker one where columns are many. The search of the other is given up where it stays far behind: 2 nats a row before any
//!   cardinality is raised, 1 nat a row when all |S| swept are done.
//! - A joined model without categories has one style: the one hidden variable is the whole mixture, and a style above it says
//!   nothing.

use std::ops::ControlFlow;

use crate::hierarchy::{Group, Learned, Observer, Settings, learn_against, learn_observed};
use crate::{ModelError, Table};

/// Result of [`learn_joined`].
#[derive(Debug, Clone)]
pub struct Joined {
    /// The model of the higher score.
    pub learned: Learned,
    /// Its groups of columns.
    pub groups: Vec<Group>,
    /// True if the real columns share one hidden variable.
    pub joined: bool,
    /// Score of the other grouping; `None` where there is no other, or the search ended before it was tried.
    pub other_score: Option<f64>,
}

/// The same groups with all real columns in one, the first of all; `None` where fewer than two groups are of real columns.
///
/// # Errors
/// [`ModelError::Unknown`] for a group of a column that `data` lacks.
pub fn one_group(data: &Table, groups: &[Group]) -> Result<Option<Vec<Group>>, ModelError> {
    let mut columns = Vec::new();
    let mut rest = Vec::new();
    let mut real = 0;
    for group in groups {
        let Some(first) = group.columns.first() else {
            continue;
        };
        match data.column(first)?.categories() {
            None => {
                columns.extend(group.columns.iter().map(String::as_str));
                real += 1;
            }
            Some(_) => rest.push(group.clone()),
        }
    }
    if real < 2 {
        return Ok(None);
    }
    // A name that no other group has.
    let mut name = "numbers".to_owned();
    while rest.iter().any(|g| g.name == name) {
        name.push('_');
    }
    let mut all = vec![Group::new(&name, &columns)];
    all.append(&mut rest);
    Ok(Some(all))
}

/// Learns the model of the groups of [`one_group`], with these groups; `None` where there are none.
///
/// # Errors
/// As [`learn`](crate::hierarchy::learn).
pub fn learn_one_group(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Option<(Learned, Vec<Group>)>, ModelError> {
    let Some(together) = one_group(data, groups)? else {
        return Ok(None);
    };
    let settings = match together.len() {
        1 => Settings {
            styles: 1..=1,
            ..settings.clone()
        },
        _ => settings.clone(),
    };
    let learned = learn_observed(data, &together, &settings, seed, observer)?;
    Ok(Some((learned, together)))
}

/// Learns the model of both groupings and keeps the one of the higher score. A search that the observer ends in the first grouping does not come to the
/// second.
///
/// # Errors
/// As [`learn`](crate::hierarchy::learn).
///
/// # Examples
/// Two columns along a line:
/// ```
/// use std::ops::ControlFlow;
/// use edifice_model::Table;
/// use edifice_model::hierarchy::{Group, Settings};
/// use edifice_model::tables::joined::learn_joined;
/// let noise = |i: usize| ((i * 7919) % 101) as f64 / 101.0;
/// let x: Vec<f64> = (0..200).map(|i| i as f64 / 20.0).collect();
/// let table = Table::new()
///     .real("x", x.iter().map(|&x| Some(x)))?
///     .real("y", x.iter().enumerate().map(|(i, x)| Some(2.0 * x + noise(i))))?;
/// let groups = [Group::new("x", &["x"]), Group::new("y", &["y"])];
/// let settings = Settings { styles: 1..=4, ..Settings::default() };
/// let found = learn_joined(&table, &groups, &settings, 1, &|_| ControlFlow::Continue(()))?;
/// assert!(found.joined && found.learned.score > found.other_score.unwrap());
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn learn_joined(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Joined, ModelError> {
    let apart = |other_score, rival| -> Result<Joined, ModelError> {
        Ok(Joined {
            learned: learn_against(data, groups, settings, seed, rival, observer)?,
            groups: groups.to_vec(),
            joined: false,
            other_score,
        })
    };
    let Some((learned, together)) = learn_one_group(data, groups, settings, seed, observer)? else {
        return apart(None, None);
    };
    // On the rows searched.
    let scores = learned.trace.iter().map(|step| step.score);
    let rival = scores.max_by(f64::total_cmp);
    let first = Joined {
        learned,
        groups: together,
        joined: true,
        other_score: None,
    };
    if first.learned.interrupted || observer(None) == ControlFlow::Break(()) {
        return Ok(first);
    }
    let second = apart(Some(first.learned.score), rival)?;
    // One that was ended may be of fewer rows.
    let of_a_row = |learned: &Learned| learned.score / learned.rows as f64;
    Ok(match of_a_row(&second.learned) > of_a_row(&first.learned) {
        true => second,
        false => Joined {
            other_score: Some(second.learned.score),
            ..first
        },
    })
}
