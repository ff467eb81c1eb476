//! Options of learning a hierarchical model, and what to warn of.

use edifice_base::Error;
use edifice_model::hierarchy::{Constant, Settings, Variant};
use edifice_model::{Cell, Table};

/// The options of learning.
#[derive(clap::Args)]
pub(crate) struct SearchOptions {
    /// Fewest styles tried.
    #[arg(long, default_value_t = 2)]
    min_styles: usize,
    /// Most styles tried.
    #[arg(long, default_value_t = 25)]
    max_styles: usize,
    /// Most kinds of one attribute.
    #[arg(long, default_value_t = 25)]
    max_kinds: usize,
    /// Leave out lateral edges (the paper's Model 1).
    #[arg(long)]
    no_lateral_edges: bool,
    /// Refuse columns that are constant, instead of keeping them.
    #[arg(long)]
    refuse_constant: bool,
    /// Most rows that the structure is searched on; the parameters are fitted to all.
    #[arg(long, default_value_t = Settings::default().searched)]
    searched_rows: usize,
    /// Share of a wide background in every Gaussian, 0 for none (as published): a row of an unforeseen kind then costs some
    /// nats instead of hundreds. 0.002 by default, and 0 for a model that houses are drawn from (`building learn`) and
    /// with `--as-published`.
    #[arg(long, value_name = "SHARE")]
    background: Option<f64>,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl SearchOptions {
    /// The settings of the model layer; `background` is the share that is meant where none is given.
    pub(crate) fn settings(&self, background: f64) -> edifice_base::Result<Settings> {
        let background = self.background.unwrap_or(background);
        if !(0.0..1.0).contains(&background) {
            return Err(Error::option(
                "--background",
                "must be at least 0 and below 1",
            ));
        }
        if self.min_styles < 1 || self.min_styles > self.max_styles {
            return Err(Error::option(
                "--min-styles",
                "must be from 1 to --max-styles",
            ));
        }
        if self.max_kinds < 2 {
            return Err(Error::option("--max-kinds", "must be at least 2"));
        }
        if self.searched_rows == 0 {
            return Err(Error::option("--searched-rows", "must be at least 1"));
        }
        let variant = if self.no_lateral_edges {
            Variant::NoLateral
        } else {
            Variant::Full
        };
        let constant = if self.refuse_constant {
            Constant::Refuse
        } else {
            Constant::Keep
        };
        Ok(Settings {
            variant,
            styles: self.min_styles..=self.max_styles,
            most_states: self.max_kinds,
            constant,
            searched: self.searched_rows,
            background,
            ..Settings::default()
        })
    }
}

/// Warnings of parts of the data that were learned but say little: constant columns, fewer rows than parameters.
pub(crate) fn warnings(table: &Table, parameters: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    for column in table.columns() {
        let cells = (0..table.rows()).map(|row| column.cell(row));
        let mut seen = cells.filter(|cell| *cell != Cell::Missing);
        let first = seen.next();
        if seen.all(|cell| Some(cell) == first) {
            let name = column.name();
            warnings.push(format!(
                "column `{name}` is constant: it is kept with unit scale"
            ));
        }
    }
    let rows = table.rows();
    if rows < parameters {
        warnings.push(format!(
            "{rows} rows for {parameters} free parameters: where rows do not tell, the prior decides"
        ));
    }
    warnings
}
