//! Procedural logic on the command line.

mod cluster;
mod compare;
mod evaluate;
mod fit;
mod input;
mod parse;
mod show;
mod synthesize;

use clap::Subcommand;
pub(crate) use show::LOGIC;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Learn rules from facades, or add facades to rules learned before.
    Fit(fit::Args),
    /// Parse facades into split grammars.
    Parse(parse::Args),
    /// Rank facades by structural distance.
    Compare(compare::Args),
    /// Judge distances between facades by the architecture of the facades.
    Evaluate(evaluate::Args),
    /// Cluster facades by structural distance.
    Cluster(cluster::Args),
    /// Draw new facades from learned rules.
    Synthesize(synthesize::Args),
}

/// Runs the command.
pub(crate) fn run(command: Command) -> edifice_base::Result<()> {
    match command {
        Command::Fit(args) => fit::run(&args),
        Command::Parse(args) => parse::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Cluster(args) => cluster::run(&args),
        Command::Synthesize(args) => synthesize::run(&args),
    }
}
