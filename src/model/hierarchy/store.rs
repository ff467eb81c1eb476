//! A learned model as JSON, and back with every invariant checked.

use super::super::conjugate::Linear;
use super::super::error::ModelError;
use super::Variant;
use super::params::{Params, Shape};
use super::query::Hierarchy;
use super::schema::Schema;
use super::structure::{Selector, Structure};

/// Format of the text; raised when its meaning changes.
const FORMAT: &str = "edifice-hierarchy-1";

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    format: String,
    variant: Variant,
    schema: Schema,
    structure: Structure,
    style: Vec<f64>,
    tables: Vec<Vec<f64>>,
    codes: Vec<Vec<f64>>,
    linear: Vec<Vec<StoredLinear>>,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredLinear {
    /// B, row-major, parents (with the leading 1) x own columns.
    coefficients: Vec<f64>,
    /// Σ, row-major.
    covariance: Vec<f64>,
}

impl Hierarchy {
    /// The model as JSON: names and categories, means and deviations of columns, structure, tables and regressions on
    /// standardised columns. Numbers are written so that they are read back exactly; the example of [`Hierarchy`] does so.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] should a parameter not be finite.
    pub fn to_json(&self) -> Result<String, ModelError> {
        let stored = Stored {
            format: FORMAT.to_owned(),
            variant: self.variant,
            schema: self.schema.clone(),
            structure: self.shape.structure.clone(),
            style: self.params.style.clone(),
            tables: self.params.tables.clone(),
            codes: self.params.codes.clone(),
            linear: self
                .params
                .linear
                .iter()
                .map(|states| states.iter().map(StoredLinear::of).collect())
                .collect(),
        };
        serde_json::to_string_pretty(&stored).map_err(|e| corrupt("the model", e.to_string()))
    }

    /// A model from its JSON. Sizes are compared with what the text holds before anything is allocated by a number in it, and
    /// tables must sum to 1 within 1e-9.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the place, [`ModelError::Cycle`].
    pub fn from_json(text: &str) -> Result<Self, ModelError> {
        let mut stored: Stored = serde_json::from_str(text)
            .map_err(|e| corrupt(&format!("line {}, column {}", e.line(), e.column()), e))?;
        if stored.format != FORMAT {
            return Err(corrupt(
                "format",
                format!("`{}` is not `{FORMAT}`", stored.format),
            ));
        }
        check_schema(&stored.schema)?;
        if stored.structure.shifts.is_empty() {
            stored.structure.shifts = vec![Vec::new(); stored.schema.groups.len()];
        }
        check_structure(&stored.schema, &stored.structure)?;
        stored.structure.order(&stored.schema.groups)?;
        check_sizes(&stored)?;
        let shape = Shape::new(&stored.schema, stored.structure)?;
        let mut linear = Vec::new();
        for (g, states) in stored.linear.into_iter().enumerate() {
            let place = format!("linear[{g}] ({})", stored.schema.groups[g]);
            let states: Option<Vec<Linear>> = states
                .into_iter()
                .map(|l| Linear::new(shape.p[g], shape.d[g], l.coefficients, l.covariance))
                .collect();
            linear.push(states.ok_or_else(|| {
                corrupt(
                    &place,
                    "sizes must fit and covariances be positive definite",
                )
            })?);
        }
        let params = Params {
            style: stored.style,
            tables: stored.tables,
            linear,
            codes: stored.codes,
        };
        Ok(Self::new(stored.schema, shape, params, stored.variant))
    }
}

impl StoredLinear {
    fn of(linear: &Linear) -> Self {
        Self {
            coefficients: linear.coefficients.clone(),
            covariance: linear.covariance.clone(),
        }
    }
}

fn corrupt(place: &str, problem: impl ToString) -> ModelError {
    ModelError::corrupt(place, problem.to_string())
}

fn check_schema(schema: &Schema) -> Result<(), ModelError> {
    let rising = schema.offsets.windows(2).all(|w| w[0] < w[1]);
    let whole = schema.offsets.first() == Some(&0)
        && schema.offsets.last() == Some(&schema.reals.len())
        && schema.offsets.len() == schema.groups.len() + 1;
    if !(rising && whole) {
        return Err(corrupt(
            "schema.offsets",
            "must rise from 0 to the number of real columns",
        ));
    }
    for c in &schema.reals {
        if !(c.mean.is_finite() && c.scale.is_finite() && c.scale > 0.0) {
            return Err(corrupt(
                "schema.reals",
                format!("`{}` has no positive scale", c.name),
            ));
        }
    }
    match schema.codes.iter().find(|c| c.categories.is_empty()) {
        Some(c) => Err(corrupt(
            "schema.codes",
            format!("`{}` has no categories", c.name),
        )),
        None => Ok(()),
    }
}

fn check_structure(schema: &Schema, structure: &Structure) -> Result<(), ModelError> {
    let (groups, codes) = (schema.groups.len(), schema.codes.len());
    let below = |lists: &[Vec<usize>], limit: usize| {
        lists
            .iter()
            .all(|list| list.is_sorted_by(|a, b| a < b) && list.last().is_none_or(|&p| p < limit))
    };
    let selectors = structure.selectors.iter().all(|s| match s {
        Selector::Hidden(k) => *k >= 1,
        Selector::Style => true,
        Selector::Codes(list) => list.iter().all(|&c| c < codes),
    });
    let sized = structure.styles >= 1
        && structure.selectors.len() == groups
        && structure.parents.len() == groups
        && structure.code_parents.len() == codes
        && structure.shifts.len() == groups;
    if !(sized
        && selectors
        && below(&structure.parents, groups)
        && below(&structure.code_parents, codes)
        && below(&structure.shifts, codes)
        && (0.0..1.0).contains(&structure.background))
    {
        return Err(corrupt("structure", "does not fit the schema"));
    }
    Ok(())
}

/// Compares every length that the structure asks for with what the file holds, before anything is
/// allocated by a number in it.
fn check_sizes(stored: &Stored) -> Result<(), ModelError> {
    let (schema, structure) = (&stored.schema, &stored.structure);
    let (styles, sizes) = (structure.styles, schema.sizes());
    let product = |columns: &[usize]| {
        columns
            .iter()
            .try_fold(1_usize, |n, &c| n.checked_mul(sizes[c]))
    };
    distributions("style", &stored.style, styles, 1, Some(1))?;
    for (name, found, expected) in [
        ("tables", stored.tables.len(), schema.groups.len()),
        ("codes", stored.codes.len(), sizes.len()),
        ("linear", stored.linear.len(), schema.groups.len()),
    ] {
        if found != expected {
            return Err(corrupt(name, format!("{expected} entries are needed")));
        }
    }
    for (c, table) in stored.codes.iter().enumerate() {
        let rows = product(&structure.code_parents[c]);
        distributions(&format!("codes[{c}]"), table, sizes[c], styles, rows)?;
    }
    for (g, (table, states)) in stored.tables.iter().zip(&stored.linear).enumerate() {
        let place = format!("tables[{g}]");
        let count = match &structure.selectors[g] {
            Selector::Hidden(k) => {
                distributions(&place, table, *k, styles, Some(1))?;
                Some(*k)
            }
            _ if !table.is_empty() => {
                return Err(corrupt(&place, "only a hidden variable has a table"));
            }
            Selector::Style => Some(styles),
            Selector::Codes(columns) => product(columns),
        };
        let place = format!("linear[{g}] ({})", schema.groups[g]);
        if count != Some(states.len()) {
            return Err(corrupt(&place, "one entry per state is needed"));
        }
        let own = schema.columns(g).len();
        let parents = structure.parents[g]
            .iter()
            .map(|&p| schema.columns(p).len());
        let shifts = structure.shifts[g].iter().map(|&c| sizes[c]);
        let inputs = 1 + parents.sum::<usize>() + shifts.sum::<usize>();
        let coefficients = inputs.checked_mul(own);
        let fits = |l: &StoredLinear| Some(l.coefficients.len()) == coefficients;
        if !states.iter().all(fits) {
            return Err(corrupt(
                &place,
                "coefficients must fit the parents and columns",
            ));
        }
    }
    Ok(())
}

/// Checks a table of `rows` distributions over `values` values, with `styles` fastest.
fn distributions(
    place: &str,
    table: &[f64],
    values: usize,
    styles: usize,
    rows: Option<usize>,
) -> Result<(), ModelError> {
    let block = values.checked_mul(styles);
    let size = block.zip(rows).and_then(|(b, r)| b.checked_mul(r));
    if size != Some(table.len()) || table.iter().any(|p| !(0.0..=1.0).contains(p)) {
        let needed = size.map_or("too many".into(), |size| size.to_string());
        return Err(corrupt(place, format!("{needed} probabilities are needed")));
    }
    for block in table.chunks(values * styles) {
        for s in 0..styles {
            let sum: f64 = (0..values).map(|v| block[v * styles + s]).sum();
            if (sum - 1.0).abs() > 1e-9 {
                return Err(corrupt(place, format!("probabilities sum to {sum}, not 1")));
            }
        }
    }
    Ok(())
}
