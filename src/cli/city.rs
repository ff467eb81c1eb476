//! Cities on the command line.

mod colours;
mod compare;
mod convert;
mod data;
mod derive;
mod draw;
mod edit;
mod locate;
mod proceduralize;
mod residuals;
mod show;
mod synthesize;
mod tiles;

use clap::Subcommand;

/// Commands.
#[derive(Subcommand)]
pub enum Command {
    /// Make a grammar of a city.
    #[command(after_help = "Examples:
  edifice city proceduralize midtown.npz -o midtown.city-grammar.json
  edifice city proceduralize delft.city.json --templates 500 -o delft.city-grammar.json.gz --glb delft.glb
  edifice city proceduralize delft.npz --bytes 560000 --residuals drop --keep shape -o delft.city-grammar.bin
  edifice city proceduralize midtown.npz --mode paper --level 2 --weights height=3 -o paper.city-grammar.json
Reads .npz, .obj, .city.json, .city.jsonl (z up), .glb and .gltf (y up), in metres.")]
    Proceduralize(proceduralize::Args),
    /// Derive the city of a grammar.
    #[command(after_help = "Examples:
  edifice city derive midtown.city-grammar.json -o midtown.glb
  edifice city derive midtown.city-grammar.json -o midtown.obj
  edifice city derive midtown.city-grammar.json --rules-only -o rules.glb
OBJ and CityJSON are z up, in metres; glTF is y up.")]
    Derive(derive::Args),
    /// Change sizes of templates and weights of rules.
    #[command(after_help = "Examples:
  edifice city edit midtown.city-grammar.json 'scale B1=1,1,1.5' -o taller.city-grammar.json
  edifice city edit midtown.city-grammar.json 'scale B*=1,1,1.5' 'scale E*=1,1,1.5' -o taller.city-grammar.json
Edits, made in turn: scale NAME=FX,FY,FZ (factors of width, depth and height of a type of building, B1 or E1, or of a template,
T1, wherever it stands; NAME may end in * for all names that begin so); weight RULE=W, the rules counted from 0 as in the file.
Residuals are carried along, or left out with --residuals drop.")]
    Edit(edit::Args),
    /// Write a city in another format.
    #[command(after_help = "Examples:
  edifice city convert berlin.gml -o berlin.city.json
  edifice city convert midtown.npz -o midtown.obj
Reads .npz, .obj, .gml (CityGML 2 and 3), .city.json, .city.jsonl, .glb, .gltf and grammars; writes .obj and .city.json.")]
    Convert(convert::Args),
    /// Compare two cities, or a city and a grammar.
    #[command(after_help = "Examples:
  edifice city compare midtown.npz midtown.city-grammar.json --resolution 0.5")]
    Compare(compare::Args),
    /// Show rules, terminals and non-terminals of a grammar.
    #[command(after_help = "Examples:
  edifice city show midtown.city-grammar.json")]
    Show(show::Args),
    /// Fill a drawn shape with a new city of a grammar's buildings.
    #[command(after_help = "Examples:
  edifice city synthesize midtown.city-grammar.json --shape park.geojson --seed 7 -o new.city-grammar.json
  edifice city synthesize midtown.city-grammar.json --shape park.geojson -o new.glb
The shape is a polygon in metres. The output is a grammar, .glb, .obj or .city.json.")]
    Synthesize(synthesize::Args),
    /// Find where in a city a view was taken.
    #[command(after_help = "Examples:
  edifice city locate midtown.city-grammar.json --view seen.json --top 5
The view lists buildings near each other: { \"format\": \"edifice/city-view\", \"version\": 1, \"unit\": \"m\",
  \"buildings\": [ { \"width\": 31.5, \"depth\": 18, \"height\": 64, \"solid\": 0.8 } ] }")]
    Locate(locate::Args),
    /// Write 3D Tiles of a grammar's city.
    #[command(after_help = "Examples:
  edifice city tiles manhattan.city-grammar.json.gz -o manhattan-tiles")]
    Tiles(tiles::Args),
    /// Draw a city or a grammar.
    #[command(after_help = "Examples:
  edifice city draw midtown.city-grammar.json --beside midtown.npz -o midtown.png
  edifice city draw midtown.city-grammar.json --colour type --plan --at 300000,61000 --radius 400 --size 1600x1600 -o types.png")]
    Draw(draw::Args),
}

/// Runs the command.
pub fn run(command: Command) -> edifice_base::Result<()> {
    match command {
        Command::Proceduralize(args) => proceduralize::run(&args),
        Command::Derive(args) => derive::run(&args),
        Command::Edit(args) => edit::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Show(args) => show::run(&args),
        Command::Draw(args) => draw::run(&args),
        Command::Synthesize(args) => synthesize::run(&args),
        Command::Locate(args) => locate::run(&args),
        Command::Tiles(args) => tiles::run(&args),
    }
}
