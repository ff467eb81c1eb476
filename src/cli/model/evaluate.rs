//! `edifice model evaluate`, and what `building evaluate` shares with it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use edifice_base::{Error, Result};
use edifice_experiments::Journal;
use edifice_model::ModelError;
use edifice_model::hierarchy::Settings;
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::{BACKGROUND, Contender, held_out, split, summary};
use sha2::{Digest, Sha256};

use super::data::TableInput;
use super::learning::{heed_interrupts, interrupted, seconds};
use super::search::SearchOptions;
use crate::print::{self, Json};

/// Time between two looks at the clock.
const ASKED: Duration = Duration::from_millis(100);

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    input: TableInput,
    #[command(flatten)]
    splits: Splits,
}

/// The models and the splits of an evaluation.
#[derive(clap::Args)]
pub(crate) struct Splits {
    /// Random splits.
    #[arg(long, default_value_t = 5)]
    splits: u64,
    /// Share of the rows that is learned from.
    #[arg(long, default_value_t = 0.8)]
    share: f64,
    /// Models to compare, separated by commas; differences are to the first. `ours` is what the command beside learns by default
    /// (`model learn`, `building learn`), `published` the hierarchical model of the paper, `model_1` to `model_3` and `gmm` its
    /// peers: these unless given. Further ones are `extended`, the hierarchical model of an encoded table whose real columns share
    /// hidden variables, all, in groups or none, by the highest score; `one_group`, the same where all share one; `apart`, where none
    /// do; `gaussian`, one Gaussian; `kde`, a kernel density. At values that many rows share the density of an encoded table is a probability: there its numbers are not to be
    /// compared with those of densities.
    #[arg(long, value_delimiter = ',')]
    models: Vec<String>,
    /// Seconds after which to end with the splits that are whole (as Ctrl-C does).
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<f64>,
    /// File of the losses found (made when missing): those that it has are not computed again, so that an evaluation that was
    /// ended goes on where it was. It may hold those of other data and settings too.
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    #[command(flatten)]
    search: SearchOptions,
    #[command(flatten)]
    json: Json,
}

/// The loss of the model at a place on a split.
type Told = (u64, usize, std::result::Result<f64, ModelError>);

/// The losses that former evaluations left, if they were to leave some.
struct Former {
    journal: Option<Journal>,
    /// Digest of all that losses depend on besides model and split.
    of: String,
    contenders: Vec<Contender>,
}

impl Former {
    fn key(&self, split: u64, which: usize) -> String {
        format!(
            "{} {:?} split {}",
            self.of,
            self.contenders[which],
            split + 1
        )
    }

    fn get(&self, split: u64, which: usize) -> Option<f64> {
        self.journal.as_ref()?.get(&self.key(split, which))
    }

    /// Keeps a loss that was not known.
    fn keep(&self, split: u64, which: usize, loss: f64) -> Result<()> {
        match &self.journal {
            Some(journal) if self.get(split, which).is_none() => {
                journal.put(&self.key(split, which), &loss)
            }
            _ => Ok(()),
        }
    }
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let begun = Instant::now();
    let (kept, _) = args.input.read_related(None)?;
    let (path, learned) = (&args.input.table, Contender::Extended);
    (args.splits).evaluate_rows(&kept.data, &kept.rows, path, learned, begun)
}

impl Splits {
    /// `learned` is the model that `ours` names. Prints the mean negative log-likelihood of unseen rows by model and split as CSV; means, standard errors and paired
    /// differences go to standard error. `path` names the data in errors; the limit of time counts from `begun`.
    pub(crate) fn evaluate(
        &self,
        data: &Dataset,
        path: &Path,
        learned: Contender,
        begun: Instant,
    ) -> Result<()> {
        let rows: Vec<usize> = (0..data.table.rows()).collect();
        self.evaluate_rows(data, &rows, path, learned, begun)
    }

    /// As [`Self::evaluate`], of rows that are at these places of the table at `path`.
    fn evaluate_rows(
        &self,
        data: &Dataset,
        rows: &[usize],
        path: &Path,
        learned: Contender,
        begun: Instant,
    ) -> Result<()> {
        if !(self.share > 0.0 && self.share < 1.0) {
            return Err(Error::option("--share", "must lie between 0 and 1"));
        }
        if let Some(limit) = self.time_limit.filter(|l| l.is_nan() || *l <= 0.0) {
            let problem = format!("{limit} is not a positive number of seconds");
            return Err(Error::option("--time-limit", problem));
        }
        if self.splits == 0 {
            return Err(Error::option("--splits", "must be at least 1"));
        }
        let settings = self.search.settings(BACKGROUND)?;
        let contenders = self.contenders(learned)?;
        let (train, test) = split(data.table.rows(), self.share, self.search.seed, 0);
        if train.is_empty() || test.is_empty() {
            return Err(Error::option("--share", "leaves no row on one side"));
        }
        let json = self.json;
        if !json.is_asked() {
            print::line("model,split,nll")?;
        }
        let mut losses = vec![Vec::new(); contenders.len()];
        heed_interrupts();
        let limit = self.time_limit.map(seconds);
        let former = Arc::new(Former {
            journal: self.resume.as_deref().map(Journal::open).transpose()?,
            of: match self.resume {
                Some(_) => self.digest(data, &settings),
                None => String::new(),
            },
            contenders: contenders.iter().map(|(_, c)| *c).collect(),
        });
        let told = self.judged(data, &former, settings);
        loop {
            let (index, which, found) = match told.recv_timeout(ASKED) {
                Ok(one) => one,
                Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) => {
                    if interrupted() || limit.is_some_and(|limit| begun.elapsed() >= limit) {
                        break;
                    }
                    continue;
                }
            };
            let mean = found.map_err(|e| {
                let parts = split(data.table.rows(), self.share, self.search.seed, index);
                Error::content(path, within(e, &parts, rows, index))
            })?;
            former.keep(index, which, mean)?;
            if !json.is_asked() {
                print::line(&format!("{},{},{mean:.4}", contenders[which].0, index + 1))?;
            }
            losses[which].push(mean);
        }
        let whole = losses.iter().map(Vec::len).min().unwrap_or(0);
        if whole < self.splits as usize {
            print::message(&format!(
                "ended after {:.1} s: {whole} of {} splits are whole",
                begun.elapsed().as_secs_f64(),
                self.splits
            ));
        }
        if whole == 0 {
            return json.end(&serde_json::json!({ "splits": 0, "models": [] }));
        }
        losses.iter_mut().for_each(|own| own.truncate(whole));
        let reference = &losses[0];
        let mut models = Vec::new();
        for ((name, _), own) in contenders.iter().zip(&losses) {
            let s = summary(own, reference);
            // One split has no standard error.
            let error = |error: f64| match error.is_nan() {
                true => String::new(),
                false => format!(" +- {error:.3}"),
            };
            print::message(&format!(
                "{name}: {:.3}{} nats a row, {:+.3}{} beside {}",
                s.mean,
                error(s.error),
                s.difference,
                error(s.difference_error),
                contenders[0].0
            ));
            models.push(serde_json::json!({
                "model": name, "nll": own, "mean": s.mean, "error": s.error, "difference": s.difference,
                "difference_error": s.difference_error,
            }));
        }
        json.end(&serde_json::json!({ "splits": whole, "models": models }))
    }

    /// Digest of the version, the table, the settings, the share and the seed.
    fn digest(&self, data: &Dataset, settings: &Settings) -> String {
        let (version, share, seed) = (env!("CARGO_PKG_VERSION"), self.share, self.search.seed);
        let of = format!("{version} {data:?} {settings:?} {share} {seed}");
        let digest = Sha256::digest(of.as_bytes());
        digest[..16]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }

    /// The mean loss of every model on every split, in order, the known ones as they are, from a thread of its own: one that is in the midst of a
    /// model when nobody waits any more ends with the process.
    fn judged(&self, data: &Dataset, former: &Arc<Former>, settings: Settings) -> Receiver<Told> {
        let (tell, told) = channel();
        let (data, former) = (data.clone(), Arc::clone(former));
        let (splits, share, seed) = (self.splits, self.share, self.search.seed);
        std::thread::spawn(move || {
            for index in 0..splits {
                let (train, test) = split(data.table.rows(), share, seed, index);
                let (train, test) = (data.select(&train), data.select(&test));
                for (which, contender) in former.contenders.iter().enumerate() {
                    let computed = || {
                        let found = held_out(*contender, &train, &test, &settings, seed);
                        found.map(|all| all.iter().sum::<f64>() / all.len() as f64)
                    };
                    let mean = former.get(index, which).map_or_else(computed, Ok);
                    if tell.send((index, which, mean)).is_err() {
                        return;
                    }
                }
            }
        });
        told
    }

    /// The models by name.
    fn contenders(&self, learned: Contender) -> Result<Vec<(String, Contender)>> {
        let mut all = vec![("ours", learned), ("published", Contender::Ours)];
        let peers = Contender::ALL.into_iter().filter(|c| *c != Contender::Ours);
        all.extend(peers.map(|c| (c.name(), c)));
        if self.models.is_empty() {
            // Each model once.
            all.retain(|(name, c)| *name != "published" || *c != learned);
            return Ok(all
                .iter()
                .map(|(name, c)| ((*name).to_owned(), *c))
                .collect());
        }
        let further = Contender::EVERY
            .into_iter()
            .filter(|c| !Contender::ALL.contains(c));
        all.extend(further.map(|c| (c.name(), c)));
        let known = |name: &String| {
            let found = all.iter().find(|(known, _)| known == name);
            let found = found.map(|(_, contender)| (name.clone(), *contender));
            found.ok_or_else(|| {
                let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
                let names = names.join(", ");
                Error::option("--models", format!("{name:?} is none of {names}"))
            })
        };
        self.models.iter().map(known).collect()
    }
}

/// An error of a split, whose rows are those of the data in another order; `rows` has their places in the table.
fn within(
    error: ModelError,
    (train, test): &(Vec<usize>, Vec<usize>),
    rows: &[usize],
    split: u64,
) -> String {
    let split = split + 1;
    let error = match error {
        ModelError::UnseenCategory { .. } | ModelError::Contradiction { .. } => {
            error.among(test).among(rows)
        }
        other => other,
    };
    match error {
        ModelError::UnseenCategory {
            column,
            row,
            category,
        } => format!(
            "split {split}, row {}, column `{column}`: category `{category}` is not among the rows learned from (it is too rare \
             to be split)",
            row + 1
        ),
        error @ (ModelError::Constant { .. } | ModelError::AllMissing { .. }) => {
            format!(
                "split {split}, in its {} rows learned from: {error}",
                train.len()
            )
        }
        other => format!("split {split}: {other}"),
    }
}
