//! Cities on the command line.

mod compare;
mod data;
mod derive;
mod draw;
mod proceduralize;
mod show;

use clap::Subcommand;

/// Commands.
#[derive(Subcommand)]
pub enum Command {
    /// Make a grammar of a city.
    #[command(after_help = "Examples:
  edifice city proceduralize midtown.npz -o midtown.city-grammar.json
  edifice city proceduralize delft.city.json --templates 500 -o delft.city-grammar.json.gz --glb delft.glb
  edifice city proceduralize midtown.npz --mode paper --level 2 --weights height=3 -o paper.city-grammar.json
Reads .npz, .obj, .city.json, .city.jsonl; z up, metres.")]
    Proceduralize(proceduralize::Args),
    /// Derive the city of a grammar.
    #[command(after_help = "Examples:
  edifice city derive midtown.city-grammar.json -o midtown.glb
  edifice city derive midtown.city-grammar.json -o midtown.obj
OBJ and CityJSON are z up, in metres; glTF is y up.")]
    Derive(derive::Args),
    /// Compare two cities, or a city and a grammar.
    #[command(after_help = "Examples:
  edifice city compare midtown.npz midtown.city-grammar.json --resolution 0.5")]
    Compare(compare::Args),
    /// Show rules, terminals and non-terminals of a grammar.
    #[command(after_help = "Examples:
  edifice city show midtown.city-grammar.json")]
    Show(show::Args),
    /// Draw a city or a grammar.
    #[command(after_help = "Examples:
  edifice city draw midtown.city-grammar.json --beside midtown.npz -o midtown.png")]
    Draw(draw::Args),
}

/// Runs the command.
pub fn run(command: Command) -> edifice::Result<()> {
    match command {
        Command::Proceduralize(args) => proceduralize::run(&args),
        Command::Derive(args) => derive::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Show(args) => show::run(&args),
        Command::Draw(args) => draw::run(&args),
    }
}
