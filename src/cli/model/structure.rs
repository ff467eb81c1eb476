//! `edifice model structure`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice_base::{Error, Result};
use edifice_model::network::structure::{Score, SearchSettings, search_incomplete};
use edifice_model::tables::bins::binned;

use super::data::TableInput;
use super::learning::{heed_interrupts, interrupted, seconds};
use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    input: TableInput,
    /// The file to write: `*.bif`, `*.xmlbif`, `*.json`, `*.dot` or `*.svg`.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Score to maximise.
    #[arg(long, value_enum, default_value_t = Kind::Bdeu)]
    score: Kind,
    /// Rows that the prior of BDeu is worth.
    #[arg(long, default_value_t = 1.0)]
    ess: f64,
    /// Most parents of one variable.
    #[arg(long, default_value_t = SearchSettings::default().most_parents)]
    max_parents: usize,
    /// An edge that must be there: PARENT>CHILD; repeatable.
    #[arg(long, value_name = "EDGE")]
    require: Vec<String>,
    /// An edge that must not be there: PARENT>CHILD; repeatable.
    #[arg(long, value_name = "EDGE")]
    forbid: Vec<String>,
    /// Variables of one tier, separated by commas; repeated from the earliest tier: none has a parent in a later one.
    #[arg(long)]
    tier: Vec<String>,
    /// New climbs from the best after random moves.
    #[arg(long, default_value_t = SearchSettings::default().restarts)]
    restarts: usize,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seconds after which to end with the best structure so far (as Ctrl-C does).
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<f64>,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

/// The score to maximise.
#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Kind {
    /// Log marginal likelihood (Bayesian Dirichlet, equivalent and uniform).
    Bdeu,
    /// Log likelihood less half the logarithm of the rows for each free parameter.
    Bic,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    if let Some(limit) = args.time_limit.filter(|l| l.is_nan() || *l <= 0.0) {
        let problem = format!("{limit} is not a positive number of seconds");
        return Err(Error::option("--time-limit", problem));
    }
    let start = Instant::now();
    let limit = args.time_limit.map(seconds);
    let goes_on = || !interrupted() && limit.is_none_or(|limit| start.elapsed() < limit);
    let (kept, _) = args.input.read()?;
    let data = &kept.data;
    // While the table was read, an interrupt ended the process.
    heed_interrupts();
    let settings = SearchSettings {
        score: match args.score {
            Kind::Bdeu => Score::Bdeu(args.ess),
            Kind::Bic => Score::Bic,
        },
        most_parents: args.max_parents,
        required: edges("--require", &args.require)?,
        forbidden: edges("--forbid", &args.forbid)?,
        tiers: args.tier.iter().map(|t| words(t)).collect(),
        restarts: args.restarts,
        ..SearchSettings::default()
    };
    let at = kept.at(&args.input.table);
    let (table, cut) = binned(&data.table).map_err(&at)?;
    for own in &cut {
        print::message(&format!(
            "{}: numbers as {} categories by description length: {}",
            own.column,
            own.cuts.len() + 1,
            own.names().join(", ")
        ));
    }
    let incomplete = table.has_missing();
    if incomplete {
        print::message("cells are missing: structural EM; the score is BIC of the known cells");
    }
    let found = search_incomplete(&table, &settings, args.seed, &goes_on);
    let found = found.map_err(at)?;
    let taken = start.elapsed().as_secs_f64();
    super::network::write(&found.network, &args.output)?;
    if found.interrupted {
        print::message(&format!(
            "ended after {taken:.1} s: this is the best structure so far"
        ));
    }
    for (parent, child) in &found.edges {
        print::message(&format!("{parent} -> {child}"));
    }
    print::message(&format!(
        "{} variables, {} rows: {} edges, score {:.2}, {} moves, {} families, {taken:.2} s",
        data.table.columns().len(),
        data.table.rows(),
        found.edges.len(),
        found.score,
        found.moves,
        found.families
    ));
    match args.json {
        true => print::line(&summary(
            &found.edges,
            found.score,
            taken,
            args.seed,
            &args.output,
        )),
        false => Ok(()),
    }
}

fn summary(edges: &[(String, String)], score: f64, seconds: f64, seed: u64, file: &Path) -> String {
    serde_json::json!({
        "edges": edges, "score": score, "seconds": seconds, "seed": seed, "file": file,
    })
    .to_string()
}

fn words(list: &str) -> Vec<String> {
    list.split(',').map(|w| w.trim().to_owned()).collect()
}

fn edges(option: &str, texts: &[String]) -> Result<Vec<(String, String)>> {
    let edge = |text: &String| match text.split_once('>') {
        Some((parent, child)) => Ok((parent.trim().to_owned(), child.trim().to_owned())),
        None => Err(Error::option(
            option,
            format!("{text:?}: expected PARENT>CHILD"),
        )),
    };
    texts.iter().map(edge).collect()
}
