//! `edifice model fit`, and `sample`, `score` and `complete` of Bayesian networks.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result, csv};
use edifice_io::building_csv::TextTable;
use edifice_model::network::{Evidence, FitSettings, Network};
use edifice_model::tables::table_model::LogParts;
use edifice_model::{ModelError, Table};

use super::data::{Completed, csv_lines, print_table, read_table};
use super::{network, query};
use crate::print::{self, Json};

/// Options of `fit`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The network (`*.bif`, `*.xmlbif`, or as JSON): its structure, and its categories.
    network: PathBuf,
    /// The table (`*.csv`, `*.csv.gz`), columns named as the variables; a variable without a column is hidden, empty cells are
    /// missing.
    table: PathBuf,
    /// The file to write: `*.bif`, `*.xmlbif`, `*.json`, `*.dot` or `*.svg`.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Go on from the network's own parameters instead of random starts.
    #[arg(long)]
    from: bool,
    /// Random starts of EM.
    #[arg(long, default_value_t = FitSettings::default().restarts)]
    restarts: usize,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs `fit`.
pub(super) fn run(args: &Args) -> Result<()> {
    let own = network::network(&args.network)?;
    let text = read_table(&args.table)?;
    let table = table(&own, &text).map_err(|e| Error::content(&args.table, e))?;
    let hidden: Vec<&str> = own
        .names()
        .filter(|name| !table.columns().iter().any(|c| covers(c.name(), name)))
        .collect();
    if !hidden.is_empty() {
        print::message(&format!("hidden: {}", hidden.join(", ")));
    }
    let settings = FitSettings {
        restarts: args.restarts,
        ..FitSettings::default()
    };
    let fitted = match args.from {
        true => own.fit_from(&table, &settings),
        false => own.fit(&table, &settings, &mut stream(args.seed, "model/fit", 0)),
    };
    let fitted = fitted.map_err(|e| Error::content(&args.table, e))?;
    let logs = fitted.network.log_likelihood(&table);
    let logs = logs.map_err(|e| Error::content(&args.table, e))?;
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    network::write(&fitted.network, &args.output)?;
    print::message(&format!(
        "{} rows: log-likelihood {mean:.4} nats a row: {}",
        table.rows(),
        means(&parts(&fitted.network, &table).map_err(|e| Error::content(&args.table, e))?)
    ));
    match args.json {
        true => print::line(
            &serde_json::json!({
                "rows": table.rows(), "log_likelihood": mean, "hidden": hidden, "seed": args.seed, "file": args.output,
            })
            .to_string(),
        ),
        false => Ok(()),
    }
}

/// True for a column of the variable, or of one of its coordinates.
fn covers(column: &str, variable: &str) -> bool {
    column == variable
        || column
            .strip_prefix(variable)
            .is_some_and(|rest| rest.starts_with('['))
}

/// The columns of a table that a network has, read by its categories.
fn table(network: &Network, text: &TextTable) -> Result<Table, ModelError> {
    let mut table = Table::new();
    for (name, categories) in network.table_columns() {
        let Some(c) = text.header.iter().position(|h| *h == name) else {
            continue;
        };
        let cells = text
            .rows
            .iter()
            .map(|row| row.get(c).map_or("", |t| t.trim()));
        table = match categories {
            Some(all) => {
                let names: Vec<&str> = all.iter().map(String::as_str).collect();
                let known = |t: &&str| names.contains(t) || !csv::MISSING.contains(t);
                table.categorical(&name, &names, cells.map(|t| Some(t).filter(known)))?
            }
            None => {
                let mut values = Vec::with_capacity(text.rows.len());
                for (row, cell) in cells.enumerate() {
                    let number = match csv::MISSING.contains(&cell) {
                        true => None,
                        false => Some(cell.parse::<f64>().map_err(|_| {
                            let problem = format!("row {}: {cell:?} is not a number", row + 1);
                            ModelError::parameter(&name, problem)
                        })?),
                    };
                    values.push(number);
                }
                table.real(&name, values)?
            }
        };
    }
    match table.columns().is_empty() {
        true => Err(ModelError::Empty {
            what: "columns of the network's variables",
        }),
        false => Ok(table),
    }
}

/// Runs `sample` of a network.
pub(super) fn sample(
    network: &Network,
    given: &[String],
    count: usize,
    seed: u64,
    json: Json,
) -> Result<()> {
    let evidence = query::hard(network, given, Evidence::new())?;
    let mut rng = stream(seed, "model/sample", 0);
    let drawn = network.sample(&evidence, count, &mut rng);
    let drawn = drawn.map_err(|e| Error::option("--given", e.to_string()))?;
    print_table(&drawn, json)
}

/// Runs `score` of a network.
pub(super) fn score(network: &Network, path: &Path, json: Json) -> Result<()> {
    let text = read_table(path)?;
    let at = |e| Error::content(path, e);
    let parts = parts(network, &table(network, &text).map_err(at)?).map_err(at)?;
    print_parts(&parts, json)
}

/// `log P(c)` of the categories c of every row, and `log p(x | c)` of its numbers.
fn parts(network: &Network, table: &Table) -> std::result::Result<LogParts, ModelError> {
    let all = network.log_likelihood(table)?;
    let discrete = table.columns().iter().filter(|c| c.categories().is_some());
    let discrete: Vec<&str> = discrete.map(|c| c.name()).collect();
    let log_probability_mass = match discrete.len() {
        0 => vec![0.0; table.rows()],
        n if n == table.columns().len() => all.clone(),
        _ => network.log_likelihood(&table.only(&discrete)?)?,
    };
    let rest = all.iter().zip(&log_probability_mass);
    Ok(LogParts {
        log_density: rest.map(|(all, mass)| all - mass).collect(),
        log_probability_mass,
    })
}

/// Prints the parts of every row, as CSV or for programs, and their means.
pub(super) fn print_parts(parts: &LogParts, json: Json) -> Result<()> {
    if json.is_asked() {
        return json.end(&serde_json::json!({
            "log_probability_mass": parts.log_probability_mass, "log_density": parts.log_density,
        }));
    }
    print::line("row,log_probability_mass,log_density")?;
    let both = parts.log_probability_mass.iter().zip(&parts.log_density);
    for (row, (mass, density)) in both.enumerate() {
        print::line(&format!("{},{mass},{density}", row + 1))?;
    }
    print::message(&format!("means, nats a row: {}", means(parts)));
    Ok(())
}

/// The means of both parts in words.
fn means(parts: &LogParts) -> String {
    let mean = |logs: &[f64]| logs.iter().sum::<f64>() / logs.len() as f64;
    format!(
        "log_probability_mass {:.4}, log_density {:.4}",
        mean(&parts.log_probability_mass),
        mean(&parts.log_density)
    )
}

/// Runs `complete` of a network: other columns of the table pass through, before its own.
pub(super) fn complete(
    network: &Network,
    path: &Path,
    count: usize,
    seed: u64,
    json: Json,
) -> Result<()> {
    let text = read_table(path)?;
    let at = |e| Error::content(path, e);
    let table = table(network, &text).map_err(at)?;
    let mut rng = stream(seed, "model/complete", 0);
    let drawn = network.complete(&table, count, &mut rng).map_err(at)?;
    if json.is_asked() {
        let mut completed = Completed::default();
        completed.add(&drawn, |i| i / count.max(1));
        return completed.end(json);
    }
    let own: Vec<String> = drawn
        .columns()
        .iter()
        .map(|c| c.name().to_owned())
        .collect();
    let kept = Passed::new(&text, &own);
    let mut lines = csv_lines(&drawn).into_iter();
    if let Some(header) = lines.next() {
        print::line(&kept.header(&header))?;
    }
    for (i, line) in lines.enumerate() {
        print::line(&kept.line(i / count.max(1), &line))?;
    }
    Ok(())
}

/// Columns of a table that a model does not know, as CSV.
pub(super) struct Passed<'t> {
    text: &'t TextTable,
    columns: Vec<usize>,
}

impl<'t> Passed<'t> {
    /// Those that are not among `known`.
    pub(super) fn new(text: &'t TextTable, known: &[String]) -> Self {
        let columns = (0..text.header.len()).filter(|&c| !known.contains(&text.header[c]));
        Self {
            text,
            columns: columns.collect(),
        }
    }

    /// Their names before a header.
    pub(super) fn header(&self, line: &str) -> String {
        self.before(&self.text.header, line)
    }

    /// Their cells in a row before a line.
    pub(super) fn line(&self, row: usize, line: &str) -> String {
        match self.text.rows.get(row) {
            Some(cells) => self.before(cells, line),
            None => line.to_owned(),
        }
    }

    fn before(&self, cells: &[String], line: &str) -> String {
        let own = self
            .columns
            .iter()
            .filter_map(|&c| cells.get(c))
            .map(|text| csv::cell(text).into_owned());
        own.chain([line.to_owned()]).collect::<Vec<_>>().join(",")
    }
}
