//! `edifice model evaluate`, and what `building evaluate` shares with it.

use std::path::Path;

use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_model::ModelError;
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::{BACKGROUND, Contender, held_out, split, summary};

use super::data::TableInput;
use super::search::Search;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: TableInput,
    #[command(flatten)]
    splits: Splits,
}

/// The models and the splits of an evaluation.
#[derive(clap::Args)]
pub struct Splits {
    /// Random splits.
    #[arg(long, default_value_t = 5)]
    splits: u64,
    /// Share of the rows that is learned from.
    #[arg(long, default_value_t = 0.8)]
    share: f64,
    /// Models to compare; differences are to the first. Besides the five of the paper there is `extended`, which `model
    /// learn` learns; at values that many rows share its density is a probability, so that its numbers are to be compared
    /// with those of others only where there are none such.
    #[arg(long, value_delimiter = ',', default_values_t = Contender::ALL.map(|c| c.name().to_owned()))]
    models: Vec<String>,
    #[command(flatten)]
    search: Search,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let (data, _) = args.input.read()?;
    args.splits.evaluate(&data, &args.input.table)
}

impl Splits {
    /// Prints the mean negative log-likelihood of unseen rows by model and split as CSV; means, standard errors and paired
    /// differences go to standard error. `path` names the data in errors.
    pub fn evaluate(&self, data: &Dataset, path: &Path) -> Result<()> {
        if !(self.share > 0.0 && self.share < 1.0) {
            return Err(Error::option("--share", "must lie between 0 and 1"));
        }
        let settings = self.search.settings(BACKGROUND)?;
        let contenders = self.contenders()?;
        print::line("model,split,nll")?;
        let mut losses = vec![Vec::new(); contenders.len()];
        for index in 0..self.splits {
            let (train, test) = split(data.table.rows(), self.share, self.search.seed, index);
            if train.is_empty() || test.is_empty() {
                return Err(Error::option("--share", "leaves no row on one side"));
            }
            let rows = (train.clone(), test.clone());
            let (train, test) = (data.select(&train), data.select(&test));
            for (contender, losses) in contenders.iter().zip(&mut losses) {
                let found = held_out(
                    *contender,
                    &train,
                    &test,
                    &settings,
                    self.search.seed,
                    &unwatched,
                );
                let found = found.map_err(|e| Error::content(path, within(&e, &rows, index)))?;
                let mean = found.iter().sum::<f64>() / found.len() as f64;
                print::line(&format!("{},{},{mean:.4}", contender.name(), index + 1))?;
                losses.push(mean);
            }
        }
        let reference = &losses[0];
        for (contender, own) in contenders.iter().zip(&losses) {
            let s = summary(own, reference);
            print::message(&format!(
                "{}: {:.3} +- {:.3} nats a row, {:+.3} +- {:.3} beside {}",
                contender.name(),
                s.mean,
                s.error,
                s.difference,
                s.difference_error,
                contenders[0].name()
            ));
        }
        Ok(())
    }

    fn contenders(&self) -> Result<Vec<Contender>> {
        let known = |name: &String| {
            let all = || Contender::ALL.into_iter().chain([Contender::Extended]);
            all().find(|c| c.name() == name).ok_or_else(|| {
                let names: Vec<&str> = all().map(Contender::name).collect();
                let names = names.join(", ");
                Error::option("--models", format!("{name:?} is none of {names}"))
            })
        };
        self.models.iter().map(known).collect()
    }
}

/// An error of a split, whose rows are those of the data in another order.
fn within(error: &ModelError, (train, test): &(Vec<usize>, Vec<usize>), split: u64) -> String {
    let rows = |rows: &[usize], row: usize| rows.get(row).map_or(0, |r| r + 1);
    let split = split + 1;
    match error {
        ModelError::UnseenCategory {
            column,
            row,
            category,
        } => format!(
            "split {split}, row {}, column `{column}`: category `{category}` is not among the rows learned from (it is too rare \
             to be split)",
            rows(test, *row)
        ),
        ModelError::Contradiction { row, variable } => format!(
            "split {split}, row {}: probability zero (first contradiction at `{variable}`)",
            rows(test, *row)
        ),
        ModelError::Constant { .. } | ModelError::AllMissing { .. } => {
            format!(
                "split {split}, in its {} rows learned from: {error}",
                train.len()
            )
        }
        other => format!("split {split}: {other}"),
    }
}
