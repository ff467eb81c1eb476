//! `edifice building evaluate`.

use edifice::Error;
use edifice::methods::building_exteriors::compare::{Contender, held_out, split};

use super::data::Input;
use super::learn::Search;
use crate::cli::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: Input,
    /// Random splits.
    #[arg(long, default_value_t = 5)]
    splits: u64,
    /// Share of the houses that is learned from.
    #[arg(long, default_value_t = 0.8)]
    share: f64,
    /// Models to compare.
    #[arg(long, value_delimiter = ',', default_values_t = Contender::ALL.map(|c| c.name().to_owned()))]
    models: Vec<String>,
    #[command(flatten)]
    search: Search,
}

/// Runs the command.
pub fn run(args: &Args) -> edifice::Result<()> {
    if !(args.share > 0.0 && args.share < 1.0) {
        return Err(Error::option("--share", "must lie between 0 and 1"));
    }
    let mut contenders = Vec::new();
    for name in &args.models {
        let known = Contender::ALL.into_iter().find(|c| c.name() == name);
        contenders.push(known.ok_or_else(|| {
            let names = Contender::ALL.map(Contender::name).join(", ");
            Error::option("--models", format!("{name:?} is none of {names}"))
        })?);
    }
    let data = args.input.read()?;
    let settings = args.search.settings()?;
    print::line("model,split,nll")?;
    for index in 0..args.splits {
        let (train, test) = split(data.table.rows(), args.share, args.search.seed, index);
        if train.is_empty() || test.is_empty() {
            return Err(Error::option("--share", "leaves no house on one side"));
        }
        let (train, test) = (data.select(&train), data.select(&test));
        for contender in &contenders {
            let losses = held_out(*contender, &train, &test, &settings, args.search.seed)
                .map_err(|e| Error::content(&args.input.input, e))?;
            let mean = losses.iter().sum::<f64>() / losses.len() as f64;
            print::line(&format!("{},{},{mean:.4}", contender.name(), index + 1))?;
        }
    }
    Ok(())
}
