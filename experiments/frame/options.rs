//! The options of every experiment.

use std::path::PathBuf;

use super::own::Own;
use edifice_base::{Error, Result};

/// The budget of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Budget {
    /// Seconds: a few instances, few iterations; what the tests run.
    Smoke,
    /// Minutes on two cores, on the data that ships with the project.
    Default,
    /// The paper's own budget, for example ten seeds.
    Paper,
}

impl Budget {
    /// The value of this budget.
    pub fn choose<T>(self, smoke: T, default: T, paper: T) -> T {
        match self {
            Budget::Smoke => smoke,
            Budget::Default => default,
            Budget::Paper => paper,
        }
    }
}

/// Command-line options of `edifice reproduce` and of each paper's binary.
#[derive(Debug, Clone, clap::Args)]
// The command that these are flattened into has a group of the default name, `Args`.
#[group(id = "experiment")]
pub struct Args {
    /// Run only these tables and figures, for example `table_1,figure_14`
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    pub only: Vec<String>,
    /// Folder with the real data sets; without it, the environment variable `EDIFICE_DATA`; without both, only what
    /// ships with the project is used
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Facades of your own, beside those that ship: label images, .facade.json or any other format that `facade convert` reads, with a label map
    /// where one is needed; repeatable
    #[arg(long, value_name = "NAME=GLOB[:MAP.json]")]
    pub dataset: Vec<String>,
    /// Seed of all random streams
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Budget of the run
    #[arg(long, value_enum, default_value_t = Budget::Default)]
    pub budget: Budget,
    /// Folder of the report
    #[arg(long, value_name = "DIR", default_value = "reports")]
    pub out: PathBuf,
    /// Threads to use; 0 for one per core
    #[arg(long, default_value_t = 0)]
    pub threads: usize,
}

/// Checked options.
#[derive(Debug, Clone)]
pub struct Options {
    /// Artefacts to run; all when empty.
    pub only: Vec<String>,
    /// Folder with the real data sets.
    pub data: Option<PathBuf>,
    /// Facades of one's own.
    pub own: Vec<Own>,
    /// Seed of all random streams.
    pub seed: u64,
    /// Budget of the run.
    pub budget: Budget,
    /// Folder of the report.
    pub out: PathBuf,
    /// Threads; 0 for one per core.
    pub threads: usize,
    /// The command as the user typed it, without the path of the program.
    pub command: String,
}

impl Args {
    /// Checks the options; `EDIFICE_DATA` stands in for a missing `--data`.
    ///
    /// # Errors
    /// [`Error::Option`] when the data folder is not a folder.
    pub fn check(self) -> Result<Options> {
        let named = |data: PathBuf, name: &str| match data.is_dir() {
            true => Ok(Some(data)),
            false => Err(Error::option(
                name,
                format!("{} is not a folder", data.display()),
            )),
        };
        let data = match (self.data, std::env::var_os("EDIFICE_DATA")) {
            (Some(data), _) => named(data, "--data")?,
            (None, Some(data)) if !data.is_empty() => named(data.into(), "EDIFICE_DATA")?,
            _ => None,
        };
        Ok(Options {
            only: self.only,
            data,
            own: self
                .dataset
                .iter()
                .map(|text| Own::parse(text))
                .collect::<Result<_>>()?,
            seed: self.seed,
            budget: self.budget,
            out: self.out,
            threads: self.threads,
            command: command_line(),
        })
    }
}

/// The command, with the program's folder left out: it says nothing that another machine shares.
fn command_line() -> String {
    let mut words = std::env::args();
    let program = words.next().unwrap_or_default();
    let program = std::path::Path::new(&program)
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    std::iter::once(program)
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}
