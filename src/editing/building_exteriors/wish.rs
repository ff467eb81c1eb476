//! Houses with wished attributes: what is wished is given and stays, the rest is the model's or that of the house before.

use std::sync::OnceLock;

use super::super::CommandError;
use super::super::work::{Stopped, Work};
use super::shipped_model;
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_building_exteriors::attributes::{AttributeError, AttributeRow, COLUMNS, attributes};
use edifice_building_exteriors::data::table;
use edifice_building_exteriors::design::wanted_rows;
use edifice_building_exteriors::house::{Database, GenerateError, Generated, Options, generate};
use edifice_building_exteriors::mass::contradiction::{Contradiction, check_given};
use edifice_building_exteriors::mass::target::PARTS;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_model::ModelError;
use edifice_shape::Building;

/// First column that is yes or no.
pub(super) const FIRST_FLAG: usize = 39;
/// Draws of the model for an answer, those of them that are built, and draws for the ranges.
const POOL: usize = 500;
const TRIES: usize = 4;
const DRAWS: usize = 2000;
/// A house within this distance of its row (standard deviations) is near enough.
const NEAR: f64 = 0.05;

/// The wishes for a house.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wishes {
    /// Columns that must have these values.
    pub given: AttributeRow,
    /// A style of the model, from 1.
    pub style: Option<usize>,
    /// True if all other columns stay as they are; otherwise they are the model's.
    pub keep: bool,
}

/// Why there is no such house.
#[derive(Debug, thiserror::Error)]
pub enum WishError {
    /// There is no such style.
    #[error("there is no style {wanted}: the model has {count}")]
    Style {
        /// The style, from 1.
        wanted: usize,
        /// Number of styles.
        count: usize,
    },
    /// Two wishes that no house can have together.
    #[error("these wishes contradict each other: {0}")]
    Contradiction(#[from] Contradiction),
    /// The house before has no attributes.
    #[error(transparent)]
    Attributes(#[from] AttributeError),
    /// The model refuses the wishes.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// No house was found.
    #[error(transparent)]
    Generate(#[from] GenerateError),
    /// The work was stopped.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Reads wishes, `COLUMN=VALUE` with numbers, `yes` or `no`.
///
/// # Errors
/// [`CommandError::Edit`] for an unknown column or a value that is none.
pub fn given(texts: &[String]) -> std::result::Result<AttributeRow, CommandError> {
    let mut row: AttributeRow = vec![None; COLUMNS.len()];
    for text in texts {
        let wrong = |message: String| CommandError::Edit {
            edit: text.clone(),
            message,
        };
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| wrong("expected COLUMN=VALUE".into()))?;
        let column = COLUMNS.iter().position(|c| *c == name);
        let column = column.ok_or_else(|| wrong(format!("there is no column {name:?}")))?;
        let number = match value {
            "yes" => Some(1.0),
            "no" => Some(0.0),
            value => value.parse().ok().filter(|v: &f64| v.is_finite()),
        };
        let usable = |v: &f64| column < FIRST_FLAG || *v == 0.0 || *v == 1.0;
        let number = number.filter(usable);
        row[column] =
            Some(number.ok_or_else(|| wrong(format!("{value:?} is no value of {name}")))?);
    }
    Ok(row)
}

/// A house of the same name with the wished attributes.
///
/// Of the most probable answers of the model to the wishes (of draws of a style: of those that come nearest to them), the
/// first that is built within 0.05 standard deviations, else the nearest.
///
/// # Errors
/// [`WishError`]; a contradiction names the columns.
pub fn wished(
    house: &Building,
    wishes: &Wishes,
    (model, database): (&ModelFile, &Database),
    options: &Options,
    seed: u64,
    work: &Work,
) -> std::result::Result<Generated, WishError> {
    let is_given: [bool; 49] =
        std::array::from_fn(|c| wishes.given.get(c).is_some_and(Option::is_some));
    let with_wishes = |mut row: [f64; 49]| {
        for (value, wish) in row.iter_mut().zip(&wishes.given) {
            *value = wish.unwrap_or(*value);
        }
        row
    };
    // A garage of which something is wished is there, whatever else is not said of it.
    check_given(&with_wishes([0.5; 49]), &is_given)?;
    let mut rng = stream(seed, "building/wish", 0);
    let rows = match (wishes.keep, wishes.style) {
        (true, _) => {
            let measured = attributes(house)?;
            let own = std::array::from_fn(|c| measured[c].unwrap_or(0.0));
            vec![with_parts(own, &wishes.given, database)]
        }
        (false, Some(style)) => {
            let count = model.styles();
            let index = style.checked_sub(1).filter(|s| *s < count);
            let wanted = style;
            let index = index.ok_or(WishError::Style { wanted, count })?;
            let mut rows = wanted_rows(&model.sample_style(index, POOL, &mut rng)?.table);
            let far = |row: &[f64; 49]| -> f64 {
                let away = |c: usize, v: f64| ((v - row[c]) / database.deviations[c]).powi(2);
                let given = wishes.given.iter().enumerate();
                given.filter_map(|(c, v)| Some(away(c, (*v)?))).sum()
            };
            rows.sort_by(|a, b| far(a).total_cmp(&far(b)));
            rows.truncate(TRIES);
            rows
        }
        (false, None) => {
            let evidence = table(std::slice::from_ref(&wishes.given))?;
            wanted_rows(
                &model
                    .most_probable(&evidence, TRIES, POOL, 0.0, &mut rng)?
                    .table,
            )
        }
    };
    let (mut best, mut failed): (Option<Generated>, Option<GenerateError>) = (None, None);
    for (k, row) in rows.iter().enumerate() {
        let part = k as f64 / rows.len() as f64;
        work.tell("building the answers of the model", Some(part))?;
        let wanted = with_wishes(*row);
        match generate(&house.name, &wanted, &is_given, database, options, &mut rng) {
            Ok(made) => {
                let z = made.report.repaired_z;
                if best.as_ref().is_none_or(|b| z < b.report.repaired_z) {
                    best = Some(made);
                }
                if z <= NEAR {
                    break;
                }
            }
            Err(e) => failed = failed.or(Some(e)),
        }
    }
    match (best, failed) {
        (Some(made), _) => Ok(made),
        (None, Some(e)) => Err(e.into()),
        (None, None) => Err(ModelError::Empty { what: "answers" }.into()),
    }
}

/// The row with a garage and porches of which something is wished, where the house has none: of the mean size and at the mean
/// place that they have in the database.
fn with_parts(mut row: [f64; 49], given: &AttributeRow, database: &Database) -> [f64; 49] {
    for (_, first, _) in PARTS {
        let wished = given[first..first + 6].iter().flatten().any(|v| *v > 0.0);
        if !wished || row[first + 2] > 0.0 {
            continue;
        }
        let there = database
            .rows
            .iter()
            .filter(|r| r[first + 2].is_some_and(|w| w > 0.0));
        let there: Vec<&AttributeRow> = there.collect();
        for c in first..first + 6 {
            let known = there.iter().filter_map(|r| r[c]);
            row[c] = known.sum::<f64>() / there.len().max(1) as f64;
        }
    }
    row
}

/// Between these values lie 98 of 100 draws of the shipped model, for each column.
///
/// # Errors
/// When the model cannot be read; a test keeps it readable.
pub fn ranges() -> Result<&'static [[f64; 2]; 49]> {
    static KNOWN: OnceLock<[[f64; 2]; 49]> = OnceLock::new();
    if let Some(known) = KNOWN.get() {
        return Ok(known);
    }
    let model = shipped_model()?;
    let draws = model.sample(DRAWS, &mut stream(0, "building/ranges", 0));
    let rows = wanted_rows(&draws.map_err(edifice_base::Error::method)?.table);
    let between = |c: usize| {
        let mut values: Vec<f64> = rows.iter().map(|r| r[c]).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        [values[last / 100], values[last - last / 100]]
    };
    Ok(KNOWN.get_or_init(|| std::array::from_fn(between)))
}
