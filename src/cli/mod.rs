//! Commands of the contract. Results go to standard output, progress and messages to standard
//! error; exit code 0 on success, 2 for bad usage, 1 for bad input or failure.

mod building;
mod choice;
mod city;
mod cleaning;
mod data;
mod documents;
mod facade;
mod given;
mod grammar;
mod logic;
mod model;
mod print;
mod reading;
mod reproduce;
#[cfg(feature = "studio")]
mod studio;
mod sweep;
mod tolerance;
mod walls;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

/// Probabilistic programming and optimization for buildings.
#[derive(Parser)]
#[command(name = "edifice", version, arg_required_else_help = true)]
struct Cli {
    /// No progress and no notes on standard error: only results, warnings and errors.
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Infer, derive and show split grammars (Wu et al. 2014).
    #[command(subcommand)]
    Grammar(grammar::Command),
    /// Convert facades between formats.
    #[command(subcommand)]
    Facade(facade::Command),
    /// Rules, retrieval and new facades from labelled images (Weissenberg et al. 2013).
    #[command(subcommand)]
    Logic(logic::Command),
    /// Learn how houses look (Fan and Wonka 2016).
    #[command(subcommand)]
    Building(building::Command),
    /// Cities as grammars of instances (Demir et al. 2014).
    #[command(subcommand)]
    City(city::Command),
    /// Learn, ask, show and convert models: of any table, Bayesian networks, logic models.
    #[command(subcommand)]
    Model(model::Command),
    /// Ablations and comparisons from one file, on this machine or a cluster.
    #[command(subcommand)]
    Sweep(sweep::Command),
    /// Edit facades, grammars, houses and cities by hand, in the browser.
    #[cfg(feature = "studio")]
    Studio(studio::Args),
    /// Run the experiments of the papers and write the report.
    Reproduce(reproduce::Args),
    /// Describe data sets of your own, check and list them.
    #[command(subcommand)]
    Data(data::Command),
    /// Print the completions of a shell.
    Completions(documents::Completions),
    /// Write the manual pages.
    Man(documents::Man),
}

/// Kinds of models that `model show` knows besides Bayesian networks.
const MODELS: &[model::Shown] = &[
    model::TABLE_MODEL,
    logic::LOGIC, // one line each
];

/// Parses the arguments and runs the command.
pub fn run() -> ExitCode {
    let asked = Cli::parse();
    if asked.quiet {
        print::quiet();
    }
    let outcome = match asked.command {
        Command::Grammar(command) => grammar::run(command),
        Command::Facade(command) => facade::run(command),
        Command::Logic(command) => logic::run(command),
        Command::Building(command) => building::run(command),
        Command::City(command) => city::run(command),
        Command::Model(command) => model::run(command),
        Command::Sweep(command) => sweep::run(command),
        #[cfg(feature = "studio")]
        Command::Studio(args) => studio::run(args),
        Command::Reproduce(args) => reproduce::run(args),
        Command::Data(command) => data::run(command),
        Command::Completions(args) => documents::completions(&args, Cli::command()),
        Command::Man(args) => documents::man(&args, Cli::command()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print::error(&error);
            ExitCode::FAILURE
        }
    }
}
