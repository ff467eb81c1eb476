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
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        self.choose("smoke", "default", "paper")
    }

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
    /// Make nothing: say which artefacts of the report are older than the code or the data that they show
    #[arg(long)]
    pub verify: bool,
    /// Print one line of JSON, for programs
    #[arg(long)]
    pub json: bool,
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
    /// Say which artefacts are older than the code or the data, and make none.
    pub verify: bool,
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
            verify: self.verify,
        })
    }
}

impl Options {
    /// The command that makes one artefact again with these options: one that can be typed, whatever the program that ran was called
    /// and whatever else it made. `DATA` stands for the folder of the real data, and the threads are left out, since results do not
    /// depend on them.
    pub fn command(&self, slug: &str, artefact: &str) -> String {
        let mut words = format!("edifice reproduce {slug} --only {artefact}");
        if self.data.is_some() {
            words.push_str(" --data DATA");
        }
        for own in &self.own {
            words.push_str(&format!(" --dataset {}=FILES", own.name));
        }
        if self.seed != 1 {
            words.push_str(&format!(" --seed {}", self.seed));
        }
        if self.budget != Budget::Default {
            words.push_str(&format!(" --budget {}", self.budget.name()));
        }
        words
    }
}
