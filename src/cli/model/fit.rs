//! `edifice model fit`, and `sample`, `score` and `complete` of Bayesian networks.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result, csv};
use edifice_io::building_csv::TextTable;
use edifice_model::network::{Evidence, FitSettings, Network};
use edifice_model::tables::categories::Meanings;
use edifice_model::tables::table_model::LogParts;
use edifice_model::{ModelError, Table};

use super::completed::Completed;
use super::data::{print_table, read_table, say_hidden};
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
    let hidden = hidden(&own, &table);
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
    let logs = Logs::new(&fitted.network, &table);
    let logs = logs.map_err(|e| Error::content(&args.table, e))?;
    network::write(&fitted.network, &args.output)?;
    let parts = match &logs {
        Logs::Parts(_) => format!(": {}", logs.means()),
        Logs::Whole(_) => String::new(),
    };
    print::message(&format!(
        "{} rows: log-likelihood {mean:.4} nats a row{parts}",
        table.rows()
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

/// The variables that a table has no column of, which is said.
fn hidden<'n>(network: &'n Network, table: &Table) -> Vec<&'n str> {
    let hidden = network
        .names()
        .filter(|name| !table.columns().iter().any(|c| covers(c.name(), name)));
    let hidden: Vec<&str> = hidden.collect();
    say_hidden(&hidden);
    hidden
}

/// The columns of a table that a network has, read by its categories.
fn table(network: &Network, text: &TextTable) -> Result<Table, ModelError> {
    let mut table = Table::new();
    for (name, categories) in network.table_columns() {
        let Some(c) = text.column(&name) else {
            continue;
        };
        table = match categories {
            Some(all) => {
                let meanings = Meanings::new(all);
                let mut codes = Vec::with_capacity(text.rows.len());
                for row in 0..text.rows.len() {
                    // Commas may be part of the name of a category.
                    let [written, cell] = [text.written(row, c), text.cell(row, c)].map(str::trim);
                    let code = meanings.code(written).or_else(|| meanings.code(cell));
                    if code.is_none() && !csv::MISSING.contains(&written) {
                        return Err(ModelError::UnseenCategory {
                            column: name,
                            row,
                            category: written.to_owned(),
                        });
                    }
                    codes.push(code);
                }
                let names: Vec<&str> = all.iter().map(String::as_str).collect();
                table.codes(&name, &names, codes)?
            }
            None => {
                let mut values = Vec::with_capacity(text.rows.len());
                for row in 0..text.rows.len() {
                    let cell = text.cell(row, c).trim();
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
    let table = table(network, &text).map_err(at)?;
    hidden(network, &table);
    let rows: Vec<usize> = (0..table.rows()).collect();
    Logs::new(network, &table).map_err(at)?.print(&rows, json)
}

/// The log-likelihood of every row, nats.
pub(super) enum Logs {
    /// `log P(c)` of the row's categories c, and `log p(x | c)` of its numbers.
    Parts(LogParts),
    /// `log p(c, x)` alone, where categories depend on numbers.
    Whole(Vec<f64>),
}

impl Logs {
    /// Those of a table under a network.
    fn new(network: &Network, table: &Table) -> std::result::Result<Self, ModelError> {
        let all = network.log_likelihood(table)?;
        let discrete = table.columns().iter().filter(|c| c.categories().is_some());
        let discrete: Vec<&str> = discrete.map(|c| c.name()).collect();
        let log_probability_mass = match discrete.len() {
            0 => vec![0.0; table.rows()],
            n if n == table.columns().len() => all.clone(),
            _ => {
                for name in &discrete {
                    if network.depends_on_numbers(name)? {
                        return Ok(Self::Whole(all));
                    }
                }
                network.log_likelihood(&table.only(&discrete)?)?
            }
        };
        let rest = all.iter().zip(&log_probability_mass);
        Ok(Self::Parts(LogParts {
            log_density: rest.map(|(all, mass)| all - mass).collect(),
            log_probability_mass,
        }))
    }

    /// Prints those of rows at these places of a table, as CSV or for programs, and their means.
    pub(super) fn print(&self, rows: &[usize], json: Json) -> Result<()> {
        let columns = self.columns();
        if json.is_asked() {
            let columns = columns.iter();
            let columns = columns.map(|(name, logs)| ((*name).to_owned(), (*logs).into()));
            let mut line: serde_json::Map<String, serde_json::Value> = columns.collect();
            line.insert("of".to_owned(), rows.into());
            return json.end(&line.into());
        }
        let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
        print::line(&format!("row,{}", names.join(",")))?;
        for (i, row) in rows.iter().enumerate() {
            let logs = columns.iter().map(|(_, logs)| logs[i].to_string());
            let logs: Vec<String> = logs.collect();
            print::line(&format!("{},{}", row + 1, logs.join(",")))?;
        }
        print::message(&format!("means, nats a row: {}", self.means()));
        Ok(())
    }

    /// Names and numbers.
    fn columns(&self) -> Vec<(&'static str, &[f64])> {
        match self {
            Self::Parts(parts) => vec![
                ("log_probability_mass", &parts.log_probability_mass),
                ("log_density", &parts.log_density),
            ],
            Self::Whole(logs) => vec![("log_likelihood", logs)],
        }
    }

    /// The means in words.
    fn means(&self) -> String {
        let columns = self.columns().into_iter().map(|(name, logs)| {
            let mean = logs.iter().sum::<f64>() / logs.len() as f64;
            format!("{name} {mean:.4}")
        });
        columns.collect::<Vec<_>>().join(", ")
    }
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
    hidden(network, &table);
    let mut rng = stream(seed, "model/complete", 0);
    let drawn = network.complete(&table, count, &mut rng).map_err(at)?;
    let rows: Vec<usize> = (0..table.rows()).collect();
    let mut completed = Completed::new(&text, &table, &rows, true, json);
    completed.header(&drawn)?;
    completed.add(&drawn, |row| row / count.max(1))?;
    completed.end()
}
