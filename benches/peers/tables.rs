//! Densities of tables: `cargo bench --bench table_peers -- FOLDER [SPLITS [MODELS]]` learns every `NAME.csv` (or `NAME.csv.gz`)
//! of a folder that has a `NAME.schema.json`, on the same random splits for all models, and writes rows, splits and the
//! losses of our models to `NAME.ours.json`, which `tables.py` reads to score its own models on the same cells.
//!
//! A real cell x counts with the probability of its interval `[x - a/2, x + b/2]`, where a and b are the gaps to the
//! neighbouring values of the column, at most the column's median gap: so that intervals do not overlap, and no model gains
//! from a spike on a value that occurs again. The probability is the mean density over 32 points drawn in the box of all of
//! a row's intervals, times its size. The size is taken out again but where a value has at least 5 % of the known cells
//! learned from and its neighbours do not explain it (an atom): losses are then densities, in the columns' own units, and probabilities at atoms.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice::io::{building_csv, json, read_bytes};
use edifice::model::hierarchy::{Constant, Settings, Sweep};
use edifice::model::tables::Dataset;
use edifice::model::tables::compare::{BACKGROUND, Contender, held_out, split};
use edifice::model::tables::encoding::Encoding;
use edifice::model::tables::schema::Schema;
use edifice::model::{Cell, Table};
use edifice::rng::stream;
use rand::{Rng, RngExt};

/// Points drawn in the box of a row.
const DRAWS: usize = 32;
/// Share of the rows that is learned from.
const SHARE: f64 = 0.8;
/// Rows of a table at most; of more, so many are drawn.
const ROWS: usize = 500;
/// Seed of splits, draws and models.
const SEED: u64 = 1;

/// A real column's intervals by row; NaN where the cell is missing.
struct Intervals {
    low: Vec<f64>,
    high: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let Some(folder) = arguments.next() else {
        println!("no folder of tables given: nothing to do");
        return Ok(());
    };
    let splits: u64 = arguments.next().map_or(Ok(20), |text| text.parse())?;
    let all = "extended,ours,model_1,model_2,model_3";
    let models = arguments.next().unwrap_or_else(|| all.to_owned());
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(&folder)? {
        files.push(entry?.path());
    }
    files.sort();
    println!("table,model,split,nats,seconds");
    for path in files {
        let name = path
            .file_name()
            .and_then(|n| n.to_str())
            .unwrap_or_default();
        let stem = name.strip_suffix(".gz").unwrap_or(name);
        let Some(stem) = stem.strip_suffix(".csv") else {
            continue;
        };
        let schema = path.with_file_name(format!("{stem}.schema.json"));
        if schema.exists() {
            let out = path.with_file_name(format!("{stem}.ours.json"));
            compare(stem, &path, &schema, &out, splits, &models)?;
        }
    }
    Ok(())
}

fn compare(
    name: &str,
    table: &Path,
    schema: &Path,
    out: &Path,
    splits: u64,
    models: &str,
) -> Result<(), Box<dyn Error>> {
    let schema: Schema = json::parse_json(&read_bytes(schema)?, schema)?;
    let text = building_csv::read(table)?;
    let data = schema.read(&text.header, &text.rows)?;
    let (mut chosen, _) = split(data.table.rows(), 1.0, SEED, 999);
    chosen.truncate(ROWS);
    let data = data.select(&chosen);
    let intervals = intervals(&data.table);
    let settings = Settings {
        constant: Constant::Keep,
        styles: 2..=8,
        sweep: Sweep::Few,
        background: BACKGROUND,
        ..Settings::default()
    };
    let mut tests = Vec::new();
    let mut atoms = Vec::new();
    let mut losses: BTreeMap<String, Vec<Vec<f64>>> = BTreeMap::new();
    for index in 0..splits {
        let (train, test) = split(data.table.rows(), SHARE, SEED, index);
        let learned = data.select(&train);
        let encoding = Encoding::learn(&learned, &settings.priors.linear, SEED)?;
        let spread = spread(&data, &test, &intervals, &encoding, index)?;
        for contender in models.split(',') {
            let found = Contender::EVERY.into_iter().find(|c| c.name() == contender);
            let Some(model) = found else {
                return Err(format!("there is no model `{contender}`").into());
            };
            let start = Instant::now();
            let encoded = matches!(
                model,
                Contender::Extended | Contender::OneGroup | Contender::Apart
            );
            let drawn = match encoded {
                true => &spread.but_atoms,
                false => &spread.all,
            };
            let rows = held_out(model, &learned, drawn, &settings, SEED)?;
            let seconds = start.elapsed().as_secs_f64();
            let at_atoms = match encoded {
                true => &vec![0.0; test.len()],
                false => &spread.log_sizes,
            };
            let own: Vec<f64> = rows
                .chunks(DRAWS)
                .zip(at_atoms)
                .map(|(rows, size)| -log_mean(rows) - size)
                .collect();
            let mean = own.iter().sum::<f64>() / own.len() as f64;
            println!("{name},{contender},{index},{mean:.4},{seconds:.2}");
            losses.entry(contender.to_owned()).or_default().push(own);
        }
        tests.push(test);
        atoms.push(
            (encoding.columns().iter())
                .map(|c| (c.column.clone(), c.atoms.clone()))
                .collect::<BTreeMap<_, _>>(),
        );
        // After each split, so that a run that is cut short leaves what it has.
        let written = serde_json::json!({
            "columns": columns(&data.table, &intervals), "tests": tests, "atoms": atoms, "losses": losses,
        });
        std::fs::write(out, written.to_string())?;
    }
    Ok(())
}

/// `log mean exp(-loss)`.
fn log_mean(losses: &[f64]) -> f64 {
    let least = losses.iter().copied().fold(f64::INFINITY, f64::min);
    let sum: f64 = losses.iter().map(|l| (least - l).exp()).sum();
    (sum / losses.len() as f64).ln() - least
}

fn real(table: &Table, column: usize, row: usize) -> f64 {
    match table.columns()[column].cell(row) {
        Cell::Real(value) => value,
        _ => f64::NAN,
    }
}

/// The interval of every cell of every column; none for categorical columns.
fn intervals(table: &Table) -> Vec<Option<Intervals>> {
    let mut all = Vec::new();
    for (c, column) in table.columns().iter().enumerate() {
        if column.categories().is_some() {
            all.push(None);
            continue;
        }
        let cells: Vec<f64> = (0..table.rows()).map(|row| real(table, c, row)).collect();
        let mut values: Vec<f64> = cells.iter().copied().filter(|v| !v.is_nan()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let mut gaps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
        gaps.sort_by(f64::total_cmp);
        let most = gaps.get(gaps.len() / 2).copied().unwrap_or(1.0);
        let gap = |at: usize| match at {
            0 => most,
            at if at == values.len() => most,
            at => (values[at] - values[at - 1]).min(most),
        };
        let place = |v: f64| values.partition_point(|other| *other < v);
        all.push(Some(Intervals {
            low: (cells.iter().map(|&v| v - gap(place(v)) / 2.0)).collect(),
            high: (cells
                .iter()
                .map(|&v| v + gap((place(v) + 1).min(values.len())) / 2.0))
            .collect(),
        }));
    }
    all
}

/// The rows of a test, each drawn [`DRAWS`] times.
struct Spread {
    /// Every real cell drawn in its interval.
    all: Dataset,
    /// Atoms as they are.
    but_atoms: Dataset,
    /// Per row, `Σ log(b - a)` over its atoms.
    log_sizes: Vec<f64>,
}

fn spread(
    data: &Dataset,
    test: &[usize],
    intervals: &[Option<Intervals>],
    encoding: &Encoding,
    index: u64,
) -> Result<Spread, Box<dyn Error>> {
    let repeated: Vec<usize> = test.iter().flat_map(|&row| [row; DRAWS]).collect();
    let mut rng = stream(SEED, "spread", index);
    let (mut all, mut but_atoms) = (Table::new(), Table::new());
    let mut log_sizes = vec![0.0; test.len()];
    for (c, column) in data.table.columns().iter().enumerate() {
        let Some(own) = &intervals[c] else {
            all = copy(all, &data.table, c, &repeated)?;
            but_atoms = copy(but_atoms, &data.table, c, &repeated)?;
            continue;
        };
        let encoded = encoding
            .columns()
            .iter()
            .find(|e| e.column == column.name());
        let atoms = encoded.map_or(&[][..], |e| &e.atoms);
        let drawn = |row: usize, rng: &mut dyn Rng| {
            let value = own.low[row] + rng.random::<f64>() * (own.high[row] - own.low[row]);
            (!value.is_nan()).then_some(value)
        };
        let cells: Vec<Option<f64>> = repeated.iter().map(|&row| drawn(row, &mut rng)).collect();
        let at = |row: usize| atoms.contains(&real(&data.table, c, row));
        let kept = cells
            .iter()
            .zip(&repeated)
            .map(|(cell, &row)| match at(row) {
                true => Some(real(&data.table, c, row)),
                false => *cell,
            });
        but_atoms = but_atoms.real(column.name(), kept.collect::<Vec<_>>())?;
        all = all.real(column.name(), cells)?;
        for (size, &row) in log_sizes.iter_mut().zip(test) {
            if at(row) {
                *size += (own.high[row] - own.low[row]).ln();
            }
        }
    }
    let dataset = |table| Dataset {
        table,
        groups: data.groups.clone(),
    };
    Ok(Spread {
        all: dataset(all),
        but_atoms: dataset(but_atoms),
        log_sizes,
    })
}

/// Adds rows of a categorical column.
fn copy(to: Table, from: &Table, c: usize, rows: &[usize]) -> Result<Table, Box<dyn Error>> {
    let column = &from.columns()[c];
    let names: Vec<&str> = column
        .categories()
        .unwrap_or_default()
        .iter()
        .map(|n| &n[..])
        .collect();
    let codes = rows.iter().map(|&row| match column.cell(row) {
        Cell::Code(code) => Some(code),
        _ => None,
    });
    Ok(to.codes(column.name(), &names, codes)?)
}

fn columns(table: &Table, intervals: &[Option<Intervals>]) -> Vec<serde_json::Value> {
    let rows = 0..table.rows();
    let each = table.columns().iter().zip(intervals).enumerate();
    each.map(|(c, (column, own))| match own {
        Some(own) => serde_json::json!({
            "name": column.name(),
            "values": rows.clone().map(|r| Some(real(table, c, r)).filter(|v| !v.is_nan())).collect::<Vec<_>>(),
            "low": own.low.iter().map(|v| Some(*v).filter(|v| !v.is_nan())).collect::<Vec<_>>(),
            "high": own.high.iter().map(|v| Some(*v).filter(|v| !v.is_nan())).collect::<Vec<_>>(),
        }),
        None => serde_json::json!({
            "name": column.name(),
            "categories": column.categories(),
            "codes": rows.clone().map(|r| match column.cell(r) { Cell::Code(code) => Some(code), _ => None })
                .collect::<Vec<_>>(),
        }),
    })
    .collect()
}
