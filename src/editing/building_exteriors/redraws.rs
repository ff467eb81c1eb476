//! Houses that are built from drawn rows, and other rows for houses that miss theirs or that one would not believe.
//!
//! Each house has random streams of its own for the rows that are tried in the place of its first one, so that it does not
//! depend on how many other houses are made, or were made before.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::draws::{Draws, Order, sampler, whole};
use edifice_base::rng::stream;
use edifice_base::{Error, Progress, Result, Watch};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::design::{MOVED, possible_rows};
use edifice_building_exteriors::house::inspect::implausible;
use edifice_building_exteriors::house::{Database, Generated, Options};
use edifice_building_exteriors::model_file::ModelFile;

/// Rows drawn at most in the place of one whose house is not believable.
const ATTEMPTS: u64 = 12;
/// Samples drawn at a time for one row.
const BATCH: usize = 8;

/// The source of other rows.
pub struct Redraws<'a> {
    file: &'a ModelFile,
    draws: Draws,
    database: &'a Database,
}

impl<'a> Redraws<'a> {
    /// Rows as `draws` draws them; `None` where it says which rows are built, and on a footprint, where a house is as near to
    /// its row as it can be.
    pub fn new(
        file: &'a ModelFile,
        draws: &Draws,
        database: &'a Database,
        on_footprint: bool,
    ) -> Option<Self> {
        let free = !on_footprint && !draws.most_probable && !draws.untruncated;
        free.then(|| Self {
            file,
            draws: Draws {
                count: BATCH,
                ..draws.clone()
            },
            database,
        })
    }

    /// All that other rows follow from, as text: the model and the question to it.
    ///
    /// # Errors
    /// Those of writing the model.
    pub fn text(&self) -> Result<String> {
        let model = self.file.to_json().map_err(Error::method)?;
        Ok(format!("{:?} {model}", self.draws))
    }

    /// The row of an attempt, from 1, in the place of that of a house; `None` where the model gives none.
    fn row(&self, house: usize, attempt: u64) -> Result<Option<[f64; 49]>> {
        let part = house as u64 * (ATTEMPTS + 1) + attempt;
        let (mut draw, given) = sampler(self.file, &self.draws, None, part)?;
        let is_given: [bool; 49] = std::array::from_fn(|c| given.column(COLUMNS[c]).is_ok());
        let mut rng = stream(self.draws.seed, "building/fill", part);
        let rows = || whole(draw()?, &given, &mut rng);
        let deviations = &self.database.deviations;
        let found = possible_rows(1, &is_given, deviations, |_| 0.0, rows)?;
        Ok(found.rows.into_iter().next())
    }
}

/// Makes a house, the `number`th from 0; while it misses its row, or has what one would not believe, of other rows. Of none
/// that is believable the first is kept. Returns true beside it where it has another row.
///
/// # Errors
/// The problem, with the name of the house, where no row gives a house.
pub fn believable(
    order: &Order,
    number: usize,
    database: &Database,
    options: &Options,
    seed: u64,
    redraws: Option<&Redraws>,
) -> std::result::Result<(Generated, bool), String> {
    let named = |e: String| format!("{}: {e}", order.name);
    let made = |order: &Order, attempt: u64| {
        let made = order.made(database, options, seed, attempt);
        made.map_err(|e| named(e.to_string()))
    };
    let mut first = made(order, 0).map(|house| (house, false));
    let Some(redraws) = redraws else { return first };
    if first.as_ref().is_ok_and(|(house, _)| is_believable(house)) {
        return first;
    }
    for attempt in 1..=ATTEMPTS {
        let row = redraws
            .row(number, attempt)
            .map_err(|e| named(e.to_string()))?;
        let Some(wanted) = row else { break };
        let other = Order {
            wanted,
            ..order.clone()
        };
        let Ok(house) = made(&other, attempt) else {
            continue;
        };
        if is_believable(&house) {
            return Ok((house, true));
        }
        if first.is_err() {
            first = Ok((house, true));
        }
    }
    first
}

/// True if a house has its attributes and nothing that one would not believe.
fn is_believable(house: &Generated) -> bool {
    let report = &house.report;
    report.max_z <= MOVED && report.styles && implausible(&house.building).is_empty()
}

/// Makes houses in parallel, in their order. Nothing is made where a row contradicts itself. The watch is told of each house;
/// where it breaks, only those are returned that were made before. With `redraws`, a house that is not believable gives way to
/// one of another row.
///
/// # Errors
/// The contradiction, or that of [`Order::made`], with the name of the house.
pub fn houses(
    orders: &[Order],
    database: &Database,
    options: &Options,
    seed: u64,
    redraws: Option<&Redraws>,
    watch: &Watch,
) -> Result<Vec<Generated>> {
    for order in orders {
        order.check(options).map_err(Error::method)?;
    }
    let (all, done) = (orders.len() as u64, AtomicU64::new(0));
    let made = orders.par_iter().enumerate().map(|(number, order)| {
        let before = done.fetch_add(1, Ordering::Relaxed);
        if watch(Progress::of("houses", before, all)).is_break() {
            return Ok(None);
        }
        let house = believable(order, number, database, options, seed, redraws);
        Ok(Some(house.map_err(Error::method)?.0))
    });
    let made: Result<Vec<Option<Generated>>> = made.collect();
    Ok(made?.into_iter().flatten().collect())
}
