//! `edifice building sample` and `complete`.

use std::path::{Path, PathBuf};

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::coding::attribute_rows;
use edifice_building_exteriors::design::{completions, observed};
use edifice_building_exteriors::dress::Settings;
use edifice_building_exteriors::mass::contradiction::check_known;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_editing::building_exteriors::draws::{Draws, drawn_table, given_table, style_table};
use edifice_editing::building_exteriors::is_file_name;
use edifice_io::building_json;
use edifice_model::Table;

use super::data::{self, Input};
use super::facades;
use super::produce::Making;
use crate::model::data::{csv_lines, print_table};
use crate::print::{self, Json};

/// Houses drawn where no number is asked for, and houses completed.
const COUNT: usize = 10;
const COMPLETED: usize = 5;

/// The number of houses to draw, and the choice among them.
#[derive(clap::Args)]
pub(super) struct Draw {
    /// Houses to draw [default: 10; completed houses: 5]
    #[arg(short = 'n', long)]
    count: Option<usize>,
    /// Draw many and keep the most probable that differ.
    #[arg(long)]
    most_probable: bool,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl Draw {
    fn draws(&self) -> Draws {
        Draws {
            given: Vec::new(),
            style: None,
            count: self.count(),
            most_probable: self.most_probable,
            untruncated: true,
            seed: self.seed,
        }
    }

    fn count(&self) -> usize {
        self.count.unwrap_or(COUNT)
    }
}

/// Options of `sample`.
#[derive(clap::Args)]
pub(crate) struct SampleArgs {
    /// The model (`*.houses.json`).
    model: PathBuf,
    /// Evidence: COLUMN=VALUE, ATTRIBUTE=VALUE,VALUE,... or ATTRIBUTE=none (all zero); repeatable.
    #[arg(long)]
    given: Vec<String>,
    /// Sample from this style only (the first is 1).
    #[arg(long, conflicts_with_all = ["given", "most_probable"])]
    style: Option<usize>,
    #[command(flatten)]
    draw: Draw,
    #[command(flatten)]
    json: Json,
}

/// Options of `complete`.
#[derive(clap::Args)]
pub(crate) struct CompleteArgs {
    /// The model (`*.houses.json`).
    model: PathBuf,
    #[command(flatten)]
    input: Input,
    /// Attributes to take as observed; all others are completed. All by default; with --output those of a house that names
    /// its unobserved parts, as `building import` writes it. Of one that names none, only what cannot change when more of the
    /// house appears: sizes of garages and porches that are there, sides with facade pieces, and styles that are there.
    #[arg(long, value_delimiter = ',')]
    keep: Vec<String>,
    /// Build the completed houses into this folder: boxes and facade pieces of the partial houses stay as they are, the rest
    /// is that of the most probable answers of the model, the houses nearest to their answer come first.
    #[arg(short, long, value_name = "DIR", conflicts_with_all = ["schema", "groups", "most_probable"])]
    output: Option<PathBuf>,
    /// Give the buildings of a city model windows and doors, with a probability on each: INPUT is a city, in every format
    /// that `edifice city` reads, and --output a CityJSON file of level of detail 3 (`*.city.json`). Walls and roofs keep
    /// their corners.
    #[arg(long, requires = "output", conflicts_with_all = ["keep", "given", "schema", "groups", "format", "most_probable", "count"])]
    facades: bool,
    /// With --facades, draws for each building: one is shown, all are counted for the probabilities.
    #[arg(long, default_value_t = Settings::default().draws, requires = "facades")]
    draws: usize,
    /// With --output, further evidence as in `sample`; repeatable.
    #[arg(long, requires = "output")]
    given: Vec<String>,
    #[command(flatten)]
    making: Making,
    /// With --output, print a line of JSON for each house.
    #[arg(long, requires = "output")]
    json: bool,
    #[command(flatten)]
    draw: Draw,
}

/// Runs `sample`.
pub(super) fn sample(args: &SampleArgs) -> Result<()> {
    let file = data::model(&args.model)?;
    if args.draw.count() == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    if let Some(style) = args.style {
        let mut rng = stream(args.draw.seed, "building/sample", 0);
        let table = style_table(&file, style, args.draw.count(), &mut rng)?;
        return print_table(&table, args.json);
    }
    let given = given_table(&file, &args.given)?;
    print_table(
        &drawn_table(&file, &given, &args.draw.draws(), 0)?,
        args.json,
    )
}

/// Runs `complete`.
pub(super) fn complete(args: &CompleteArgs) -> Result<()> {
    let file = data::model(&args.model)?;
    if let (true, Some(output)) = (args.facades, &args.output) {
        let settings = Settings {
            draws: args.draws,
            seed: args.draw.seed,
        };
        return facades::run(&file, &args.input.input, output, &settings, args.json);
    }
    if let Some(folder) = &args.output {
        return complete_houses(args, &file, folder);
    }
    let mut table = args.input.read()?.table;
    if !args.keep.is_empty() {
        let known = file.attributes();
        let mut columns: Vec<&str> = Vec::new();
        for name in &args.keep {
            let group = known.iter().find(|g| &g.name == name);
            let group =
                group.ok_or_else(|| Error::option("--keep", format!("no attribute `{name}`")))?;
            columns.extend(group.columns.iter().map(String::as_str));
        }
        table = table.only(&columns).map_err(Error::method)?;
    }
    if args.input.is_table() {
        for (r, row) in attribute_rows(&table).iter().enumerate() {
            let path = &args.input.input;
            check_known(row).map_err(|e| Error::input(path, format!("row {}", r + 1), e))?;
        }
    }
    for row in 0..table.rows() {
        let lines = drawn(&file, &table.select(&[row]), &args.draw, row as u64)?;
        // The header stands once, before the first house.
        let first = usize::from(row > 0);
        print::line(&lines[first..].join("\n"))?;
    }
    Ok(())
}

/// Builds the completions of partial houses.
fn complete_houses(args: &CompleteArgs, file: &ModelFile, folder: &Path) -> Result<()> {
    let path = &args.input.input;
    let groups = file.attributes();
    if let Some(name) = args
        .keep
        .iter()
        .find(|k| groups.iter().all(|g| &g.name != *k))
    {
        return Err(Error::option("--keep", format!("no attribute `{name}`")));
    }
    let count = args.draw.count.unwrap_or(COMPLETED);
    if count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    let given = given_table(file, &args.given)?;
    let database = args.making.database()?;
    let options = args.making.options();
    let mut all = Vec::new();
    let mut names = std::collections::HashSet::new();
    for partial in building_json::read(path)? {
        let named = |e: String| Error::content(path, format!("{}: {e}", partial.name));
        if !is_file_name(&partial.name) {
            return Err(named("its name cannot name a file".into()));
        }
        if !names.insert(partial.name.clone()) {
            return Err(named("another house of the file has this name".into()));
        }
        let mut row = observed(&partial, &args.keep).map_err(|e| named(e.to_string()))?;
        for (value, name) in row.iter_mut().zip(COLUMNS) {
            if let Ok(column) = given.column(name) {
                *value = column.cell(0).number().or(*value);
            }
        }
        let seed = args.draw.seed;
        let houses = completions(&partial, file, &row, count, &database, &options, seed);
        let houses = houses.map_err(|e| named(e.to_string()))?;
        if houses.len() < count {
            print::message(&format!(
                "{}: {} of {count} houses; no other answer of the model could be built",
                partial.name,
                houses.len()
            ));
        }
        all.extend(houses);
    }
    args.making.write(&all, folder, args.json)?;
    print::message(&format!("{} houses in {}", all.len(), folder.display()));
    Ok(())
}

/// Completions of one row as CSV lines, the header first.
fn drawn(file: &ModelFile, given: &Table, draw: &Draw, row: u64) -> Result<Vec<String>> {
    Ok(csv_lines(&drawn_table(file, given, &draw.draws(), row)?))
}
