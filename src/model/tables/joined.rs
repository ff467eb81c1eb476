//! Columns that share one hidden variable, all or in groups, or have each their own: the best of these.
//!
//! A schema of one attribute a column gives each real column a hidden variable of its own, so that columns depend on each other through the
//! style and lateral edges alone. Where they move together, on a curve say, one vector-valued attribute is far better: a mixture of full
//! Gaussians, of all real columns or of those of a group. Groupings from all in one to none are learned, each a
//! split of the one before (`grouping`), and the Cheeseman-Stutz score chooses, which is the logarithm of the evidence of the
//! same rows of the same standardised columns.
//!
//! # Deviations and readings
//! - Of large tables (more than 10,000 real values searched on) coarse groupings come first, 1, 2, 4, 8, .. groups, until one scores less than the
//!   one before: the coarser, the quicker. Of at most eight real groups both ends alone are learned: two groups of the four of the Ames
//!   houses took twice the time of all else and scored 0.05 nats a row less than the four. From `MANY` groups on the doubling has to gain 1 nat
//!   a row, or the search ends there. Else the groups as given come last.
//! - Of a large table of more than eight real groups most of whose rows lack a value, the groups as given are learned alone: each such row of
//!   a joined group asks for a factor of its own. Of the 28 real columns of the Ames houses without a schema one group was at -55.4 nats a row
//!   after 400 s, the groups as given at -45.6 after 250 s.
//! - Of small tables both ends are learned, then those next to the better end, until two in a row do not score more than the best.
//! - A search is given up where it stays far behind the best so far: of the groups as given 2 nats a row before any
//!   cardinality is raised, 1 nat a row when all |S| swept are done; of groupings between a quarter of that.
//! - A joined model without categories has one style: the one hidden variable is the whole mixture, and a style above it says
//!   nothing. Groupings between are searched from two |S| ([`Sweep::Few`]).

use std::ops::ControlFlow;

use super::grouping::{dear, levels};
use crate::hierarchy::{
    Group, Learned, Observer, Rival, SMALL, Settings, Sweep, learn_against, learn_observed,
};
use crate::{ModelError, Table};

/// Groups from which on a finer grouping of a large table has to be far better.
const MANY: usize = 16;
/// Real groups of a large table up to which no grouping between the ends is tried.
const FEW: usize = 8;
/// Nats a row that it has to gain.
const FAR: f64 = 1.0;
/// Groupings of a small table in a row that may score less than the best.
const MISSES: usize = 2;
/// Patience with groupings between the ends.
const BETWEEN: f64 = 0.25;

/// Result of [`learn_joined`].
#[derive(Debug, Clone)]
pub struct Joined {
    /// The model of the highest score.
    pub learned: Learned,
    /// Its groups of columns.
    pub groups: Vec<Group>,
    /// All groupings that were learned, in their order.
    pub tried: Vec<Tried>,
}

/// A grouping that [`learn_joined`] learned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Number of groups of real columns; 1 if all share one hidden variable.
    pub groups: usize,
    /// Score in nats a row, of one that was given up as far as it came.
    pub score: f64,
}

impl Joined {
    /// Number of groups of real columns.
    pub fn real_groups(&self) -> usize {
        self.learned.model.real_groups().len()
    }
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
            styles: *settings.styles.start()..=*settings.styles.start(),
            ..settings.clone()
        },
        _ => settings.clone(),
    };
    let learned = learn_observed(data, &together, &settings, seed, observer)?;
    Ok(Some((learned, together)))
}

/// A grouping whose model was learned.
struct Level {
    learned: Learned,
    groups: Vec<Group>,
    /// Highest score met on the rows searched.
    searched: f64,
}

/// The state of the search while groupings are tried.
struct Trial<'a> {
    data: &'a Table,
    settings: &'a Settings,
    seed: u64,
    observer: &'a Observer<'a>,
    best: Level,
    tried: Vec<Tried>,
}

impl Trial<'_> {
    /// The score of a row, on the rows searched where these are not all.
    fn of_a_row(&self, level: &Level) -> f64 {
        let rows = self.data.rows();
        match rows > self.settings.searched {
            true => level.searched / self.settings.searched as f64,
            // One that was ended may be of fewer rows.
            false => level.learned.score / level.learned.rows as f64,
        }
    }

    /// True if the search shall go on.
    fn goes_on(&self) -> bool {
        !self.best.learned.interrupted && (self.observer)(None) == ControlFlow::Continue(())
    }

    /// Learns a grouping beside the best so far; the nats a row that it gains.
    fn learn(&mut self, groups: &[Group], reals: usize, between: bool) -> Result<f64, ModelError> {
        let few = Settings {
            sweep: Sweep::Few,
            ..self.settings.clone()
        };
        let (settings, patience) = match between {
            true => (&few, BETWEEN),
            false => (self.settings, 1.0),
        };
        let rival = Rival {
            score: self.best.searched,
            patience,
        };
        let (seed, observer) = (self.seed, self.observer);
        let learned = learn_against(self.data, groups, settings, seed, Some(rival), observer)?;
        let level = Level {
            searched: searched(&learned),
            learned,
            groups: groups.to_vec(),
        };
        let gain = self.of_a_row(&level) - self.of_a_row(&self.best);
        self.tried.push(Tried {
            groups: reals,
            score: self.of_a_row(&level),
        });
        if gain > 0.0 {
            self.best = level;
        }
        Ok(gain)
    }
}

/// Highest score that a search met on the rows searched; its own where it noted none.
fn searched(learned: &Learned) -> f64 {
    let scores = learned.trace.iter().map(|step| step.score);
    scores.max_by(f64::total_cmp).unwrap_or(learned.score)
}

/// Learns the models of several groupings of the real columns, from all in one to the groups given, and keeps the one of the highest score.
/// A search that the observer ends comes to no further grouping.
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
/// let [together, apart] = found.tried[..] else { panic!("{:?}", found.tried) };
/// assert_eq!((together.groups, apart.groups, found.groups.len()), (1, 2, 1));
/// assert!(together.score > apart.score);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn learn_joined(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Joined, ModelError> {
    let coarse = match dear(data, groups, SMALL, FEW)? {
        true => None,
        false => learn_one_group(data, groups, settings, seed, observer)?,
    };
    let Some((learned, together)) = coarse else {
        return Ok(Joined {
            learned: learn_observed(data, groups, settings, seed, observer)?,
            groups: groups.to_vec(),
            tried: Vec::new(),
        });
    };
    let reals = groups.len() + 1 - together.len();
    let mut trial = Trial {
        data,
        settings,
        seed,
        observer,
        best: Level {
            searched: searched(&learned),
            learned,
            groups: together,
        },
        tried: Vec::new(),
    };
    let score = trial.of_a_row(&trial.best);
    trial.tried.push(Tried { groups: 1, score });
    if trial.goes_on() {
        let rows = data.rows().min(settings.searched);
        let between = levels(data, groups, rows, observer)?;
        match rows * trial.best.groups[0].columns.len() > SMALL {
            true => coarse_to_fine(&mut trial, groups, reals, &between)?,
            false => from_the_better_end(&mut trial, groups, reals, between)?,
        }
    }
    Ok(Joined {
        learned: trial.best.learned,
        groups: trial.best.groups,
        tried: trial.tried,
    })
}

/// Groupings of a large table.
fn coarse_to_fine(
    trial: &mut Trial,
    groups: &[Group],
    reals: usize,
    between: &[Vec<Group>],
) -> Result<(), ModelError> {
    let between = if reals > FEW { between } else { &[] };
    let mut count = 1;
    for level in between {
        if !trial.goes_on() {
            return Ok(());
        }
        count *= 2;
        let gain = trial.learn(level, count, true)?;
        if count >= MANY && gain < FAR {
            return Ok(());
        }
        if gain <= 0.0 {
            break;
        }
    }
    if trial.goes_on() {
        trial.learn(groups, reals, false)?;
    }
    Ok(())
}

/// Groupings of a small table.
fn from_the_better_end(
    trial: &mut Trial,
    groups: &[Group],
    reals: usize,
    between: Vec<Vec<Group>>,
) -> Result<(), ModelError> {
    let apart = trial.learn(groups, reals, false)? > 0.0;
    let mut order: Vec<(usize, Vec<Group>)> = between
        .into_iter()
        .enumerate()
        .map(|(i, level)| (2 << i, level))
        .collect();
    if apart {
        order.reverse();
    }
    let mut without_gain = 0;
    for (count, level) in order {
        if !trial.goes_on() || without_gain == MISSES {
            break;
        }
        let gained = trial.learn(&level, count, true)? > 0.0;
        without_gain = if gained { 0 } else { without_gain + 1 };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::RngExt;

    /// Blocks of three columns along a curve each, one row of columns after the other.
    fn blocks(count: usize, rows: usize) -> (Table, Vec<Group>) {
        let mut rng = stream(1, "blocks", 0);
        let hidden: Vec<Vec<f64>> = (0..count)
            .map(|_| (0..rows).map(|_| rng.random_range(-2.0..2.0)).collect())
            .collect();
        let curves: [fn(f64) -> f64; 3] = [|t| t, |t| t + 0.5 * t * t, |t| (1.5 * t).sin()];
        let (mut data, mut groups) = (Table::new(), Vec::new());
        for (c, curve) in curves.iter().enumerate() {
            for (b, t) in hidden.iter().enumerate() {
                let name = format!("b{b}_{c}");
                let cells = t
                    .iter()
                    .map(|t| Some(curve(*t) + 0.1 * rng.random::<f64>()));
                let cells: Vec<Option<f64>> = cells.collect();
                data = data.real(&name, cells).unwrap();
                groups.push(Group::new(&name, &[&name]));
            }
        }
        (data, groups)
    }

    fn learned(rows: usize, most: usize) -> Joined {
        let (data, groups) = blocks(4, rows);
        let settings = Settings {
            styles: 1..=2,
            most_states: most,
            restarts: 2,
            ..Settings::default()
        };
        let go_on = |_: Option<&crate::hierarchy::SearchStep>| ControlFlow::Continue(());
        learn_joined(&data, &groups, &settings, 1, &go_on).unwrap()
    }

    #[test]
    fn independent_curves_are_found_between_the_ends() {
        // 2,400 values, and 12,000: a small table and a large one.
        for (rows, most) in [(200, 5), (1000, 3)] {
            let found = learned(rows, most);
            assert_eq!(found.real_groups(), 4, "{:?}", found.tried);
            for group in &found.groups {
                let first = &group.columns[0][..2];
                assert!(group.columns.iter().all(|name| &name[..2] == first));
                assert_eq!(group.columns.len(), 3);
            }
            let four = found.tried.iter().find(|t| t.groups == 4).unwrap().score;
            let others = found.tried.iter().filter(|t| t.groups != 4);
            assert!(others.map(|t| t.score).all(|score| score < four));
        }
    }

    #[test]
    fn an_ended_search_tries_no_further_grouping() {
        let (data, groups) = blocks(4, 60);
        let settings = Settings {
            styles: 1..=2,
            ..Settings::default()
        };
        let stop = |step: Option<&crate::hierarchy::SearchStep>| match step {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        };
        let found = learn_joined(&data, &groups, &settings, 1, &stop).unwrap();
        assert!(found.learned.interrupted && found.tried.len() == 1);
    }
}
