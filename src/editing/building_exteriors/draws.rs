//! Rows of attributes drawn from a model of houses, for `edifice building generate` and for Python: drawn anew until a house can
//! have them.

use super::shipped_model;
use edifice_base::rng::{Stream, stream};
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::coding::attribute_rows;
use edifice_building_exteriors::data::table;
use edifice_building_exteriors::design::{Possible, possible_rows, wanted_rows};
use edifice_building_exteriors::house::{Database, GenerateError, Generated, Options, generate};
use edifice_building_exteriors::mass::contradiction::{check_given, check_known};
use edifice_building_exteriors::mass::footprint::{decided, distance, reconcile};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_model::Table;
use edifice_model::tables::given::evidence;
use edifice_shape::Rect;

/// Samples among which the most probable are sought.
const POOL: usize = 2000;
/// Root mean square distance, in standard deviations, below which two houses are the same.
const APART: f64 = 0.05;

/// A question to a model of houses.
#[derive(Debug, Clone, PartialEq)]
pub struct Draws {
    /// Evidence: COLUMN=VALUE, ATTRIBUTE=VALUE,VALUE,... or ATTRIBUTE=none.
    pub given: Vec<String>,
    /// Draw from this style only (the first is 1), without evidence.
    pub style: Option<usize>,
    /// Houses.
    pub count: usize,
    /// Draw many, and keep the most probable that differ.
    pub most_probable: bool,
    /// Take every sample, also those that no house can have.
    pub untruncated: bool,
    /// Seed of all random streams.
    pub seed: u64,
}

/// A house to make.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// Its name, and that of its files.
    pub name: String,
    /// The 49 columns.
    pub wanted: [f64; 49],
    /// Columns that must stay.
    pub given: [bool; 49],
}

/// Houses to make, drawn from a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Ordered {
    /// One for each house, named `house_0001`, ...
    pub orders: Vec<Order>,
    /// Rows drawn in all.
    pub drawn: usize,
    /// Those of `orders` that no house can have, the last ones: nothing better was drawn.
    pub impossible: usize,
}

impl Order {
    /// Checks that nothing that is given contradicts itself or the footprint of `options`.
    ///
    /// # Errors
    /// The contradiction, with the name of the house.
    pub fn check(&self, options: &Options) -> std::result::Result<(), String> {
        check_given(&self.wanted, &self.given).map_err(|e| format!("{}: {e}", self.name))?;
        match &options.footprint {
            Some(plan) => reconcile(&mut self.wanted.clone(), &self.given, plan)
                .map_err(|e| format!("{}: {e}", self.name)),
            None => Ok(()),
        }
    }

    /// Makes the house. It depends on its name, its row, the seed and the attempt (0 for its own row), and not on other houses.
    ///
    /// # Errors
    /// [`GenerateError`].
    pub fn made(
        &self,
        database: &Database,
        options: &Options,
        seed: u64,
        attempt: u64,
    ) -> std::result::Result<Generated, GenerateError> {
        let mut rng = stream(seed, &format!("building/generate/{}", self.name), attempt);
        let (wanted, given) = (&self.wanted, &self.given);
        generate(&self.name, wanted, given, database, options, &mut rng)
    }
}

/// Draws rows for houses. What the model does not know is said by the one that ships; on a footprint (`plan`), rows that
/// cannot stand on it are drawn anew.
///
/// # Errors
/// [`Error::Option`] for a count of 0, evidence that the model does not know and a style that it does not have; those of
/// sampling.
pub fn ordered(
    file: &ModelFile,
    draws: &Draws,
    plan: Option<&[Rect]>,
    database: &Database,
) -> Result<Ordered> {
    if draws.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let (mut draw, given) = sampler(file, draws, plan, 0)?;
    let is_given: [bool; 49] = std::array::from_fn(|c| given.column(COLUMNS[c]).is_ok());
    let mut rng = stream(draws.seed, "building/fill", 0);
    let mut whole = || whole(draw()?, &given, &mut rng);
    let possible = match draws.most_probable || draws.untruncated {
        true => {
            let rows = wanted_rows(&whole()?);
            let drawn = rows.len();
            Possible {
                rows,
                drawn,
                impossible: 0,
            }
        }
        false => {
            let deviations = &database.deviations;
            let reach = |row: &[f64; 49]| match plan {
                Some(plan) => distance(row, &is_given, plan, deviations),
                None => 0.0,
            };
            possible_rows(draws.count, &is_given, deviations, reach, whole)?
        }
    };
    let rows = possible.rows.iter().enumerate();
    let orders = rows.map(|(row, wanted)| Order {
        name: format!("house_{:04}", row + 1),
        wanted: *wanted,
        given: is_given,
    });
    Ok(Ordered {
        orders: orders.collect(),
        drawn: possible.drawn,
        impossible: possible.impossible,
    })
}

/// Draws a batch of samples at each call.
pub(super) type Sampler<'a> = Box<dyn FnMut() -> Result<Table> + 'a>;

/// The source of the samples, and the values that are given; `part` numbers the random streams.
pub(super) fn sampler<'a>(
    file: &'a ModelFile,
    draws: &'a Draws,
    plan: Option<&[Rect]>,
    part: u64,
) -> Result<(Sampler<'a>, Table)> {
    if let Some(style) = draws.style {
        let mut rng = stream(draws.seed, "building/sample", part);
        let batch = move || style_table(file, style, draws.count, &mut rng);
        return Ok((Box::new(batch), Table::new()));
    }
    let mut given = given_table(file, &draws.given)?;
    if let Some(plan) = plan {
        // What is wished of the plan is checked before the rest of the plan is taken for given too.
        let wished: [bool; 49] = std::array::from_fn(|c| given.column(COLUMNS[c]).is_ok());
        let own = wanted_rows(&given).pop().unwrap_or([0.0; 49]);
        let agrees = reconcile(&mut own.clone(), &wished, plan);
        agrees.map_err(|e| Error::option("--given", e.to_string()))?;
    }
    for (c, value) in plan.into_iter().flat_map(decided) {
        if given.column(COLUMNS[c]).is_err() {
            let more = given.real(COLUMNS[c], [Some(value)]);
            given = more.map_err(Error::method)?;
        }
    }
    let (evidence, mut batches) = (given.clone(), part << 32..);
    let batch = move || drawn_table(file, &evidence, draws, batches.next().unwrap_or(part << 32));
    Ok((Box::new(batch), given))
}

/// Samples of one style, the first is 1.
///
/// # Errors
/// [`Error::Option`] for a style that the model does not have.
pub fn style_table(
    file: &ModelFile,
    style: usize,
    count: usize,
    rng: &mut Stream,
) -> Result<Table> {
    let wrong = |message: String| Error::option("--style", message);
    let index = style.checked_sub(1);
    let index = index.ok_or_else(|| wrong("the first style is 1".into()))?;
    let draws = file.sample_style(index, count, rng);
    Ok(draws.map_err(|e| wrong(e.to_string()))?.table)
}

/// Evidence as a table of one row.
///
/// # Errors
/// [`Error::Option`] for evidence that the model does not know, and for such as no house can have.
pub fn given_table(file: &ModelFile, given: &[String]) -> Result<Table> {
    let wrong = |message: String| Error::option("--given", message);
    let columns = file.columns().map_err(Error::method)?;
    let table = evidence(&file.attributes(), &columns, given).map_err(|e| wrong(e.to_string()))?;
    for row in attribute_rows(&table) {
        check_known(&row).map_err(|e| wrong(e.to_string()))?;
    }
    Ok(table)
}

/// Completions of one row; `row` names their random stream, and the row in errors. Of `draws`, the number, the choice among
/// them and the seed are heeded.
///
/// # Errors
/// Those of the model.
pub fn drawn_table(file: &ModelFile, given: &Table, draws: &Draws, row: u64) -> Result<Table> {
    let mut rng = stream(draws.seed, "building/draw", row);
    let count = draws.count;
    let found = if draws.most_probable {
        file.most_probable(given, count, POOL.max(count), APART, &mut rng)
    } else if given.columns().is_empty() {
        file.sample(count, &mut rng)
    } else {
        file.complete(given, count, &mut rng)
    };
    // Each row was asked about on its own; the message names its place in the input.
    let found = found.map_err(|e| Error::method(e.in_row(row as usize)))?;
    Ok(found.table)
}

/// A table of draws that has all columns: what the model does not know is completed by the one that ships, what is given
/// counting too.
pub(super) fn whole(drawn: Table, given: &Table, rng: &mut Stream) -> Result<Table> {
    if COLUMNS.iter().all(|name| drawn.column(name).is_ok()) {
        return Ok(drawn);
    }
    let known = attribute_rows(given).pop();
    let mut rows = attribute_rows(&drawn);
    for row in &mut rows {
        for (value, known) in row.iter_mut().zip(known.iter().flatten()) {
            *value = known.or(*value);
        }
    }
    let rows = shipped_model()?.filled(rows, rng).map_err(Error::method)?;
    table(&rows).map_err(Error::method)
}
