//! Split grammars on the command line.

mod derive;
mod edit;
mod evaluate;
mod infer;
mod library;
mod merge;
mod show;
mod town;

use clap::Subcommand;
use edifice_grammar::Costs;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Infer the smallest split grammar of one or several facades.
    Infer(infer::Args),
    /// Derive a facade from a grammar, at its own or another size.
    Derive(derive::Args),
    /// Edit the rules of a grammar: sizes, symbols, parts, floors and columns, repeats.
    Edit(edit::Args),
    /// Merge the facades of a grammar and further ones into one joint grammar.
    Merge(merge::Args),
    /// Combine grammars of several facades into a stochastic one, part by part.
    Combine(library::Combine),
    /// Build a town of variations from grammars.
    Town(town::Args),
    /// Draw new facades from a library (`infer --sizes free`).
    Draw(library::Draw),
    /// Tell how many bits facades cost given a library: how like its facades they are.
    Score(library::Score),
    /// Write a facade with a library, as few bits as they are.
    Encode(library::Encode),
    /// Read a facade that was written with a library.
    Decode(library::Decode),
    /// Judge a grammar: does it derive the facades, at which cost, how far from a proven bound.
    Evaluate(evaluate::Args),
    /// Show the rules of a grammar or library, what it costs and what it derives.
    Show(show::Args),
}

/// Runs the command.
pub(crate) fn run(command: Command) -> edifice_base::Result<()> {
    match command {
        Command::Infer(args) => infer::run(&args),
        Command::Derive(args) => derive::run(&args),
        Command::Edit(args) => edit::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Combine(args) => library::combine(&args),
        Command::Town(args) => town::run(&args),
        Command::Draw(args) => library::draw(&args),
        Command::Score(args) => library::score(&args),
        Command::Encode(args) => library::encode(&args),
        Command::Decode(args) => library::decode(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Show(args) => show::run(&args),
    }
}

/// A size on the command line.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) && value > 0.0 => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// A cost on the command line.
fn cost(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if Costs::allows(value) => Ok(value),
        _ => Err(format!(
            "expected 0 or a number from {} to {}",
            Costs::LEAST,
            Costs::GREATEST
        )),
    }
}
