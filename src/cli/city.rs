//! Cities on the command line.

mod colours;
mod compare;
mod convert;
mod data;
mod derive;
mod draw;
mod edit;
mod locate;
mod morphology;
mod plan;
mod proceduralize;
mod residuals;
mod show;
mod submit;
mod synthesize;
mod tiles;
mod work;

use clap::Subcommand;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Make a grammar of a city.
    #[command(after_help = "Examples:
  edifice city derive datasets/city_proceduralization/town.city-grammar.json -o town.obj
  edifice city proceduralize town.obj -o town.city-grammar.json
  edifice city proceduralize town.obj --templates 5 -o five.city-grammar.json.gz --glb five.glb
  edifice city proceduralize town.obj --bytes 5000 --residuals drop --keep shape -o small.city-grammar.bin
  edifice city proceduralize town.obj --mode paper --level 2 --weights height=3 -o paper.city-grammar.json
Reads .npz, .obj, .city.json, .city.jsonl (z up), .glb and .gltf (y up), in metres.")]
    Proceduralize(proceduralize::Args),
    /// Derive the city of a grammar.
    #[command(after_help = "Examples:
  edifice city derive town.city-grammar.json -o town.glb
  edifice city derive town.city-grammar.json -o again.obj
  edifice city derive town.city-grammar.json --rules-only -o rules.glb
  edifice city derive town.city-grammar.json -o town.cga
  edifice city convert town.cga -o evaluated.obj
OBJ and CityJSON are z up, in metres; glTF is y up.")]
    Derive(derive::Args),
    /// Change sizes of types of buildings, places of blocks and rows, and weights of rules.
    #[command(after_help = "Examples:
  edifice city edit town.city-grammar.json 'scale B1=1,1,1.5' -o taller.city-grammar.json
  edifice city edit town.city-grammar.json 'move K1=0,-4,0' 'turn K2=3' 'remove K3' -o moved.city-grammar.json
  edifice city edit town.city-grammar.json 'scale B*=1,1,1.5' 'scale T1=1,1,1.5' -o taller.city-grammar.json
Edits, made in turn: scale NAME=FX,FY,FZ (factors of width, depth and height of a type of building, B1 or E1, or of a template,
T1, wherever it stands; NAME may end in * for all names that begin so); move NAME=DX,DY,DZ and turn NAME=DEGREES (districts D1, blocks
K1 and rows R1; in metres, and about the place of its first building); remove NAME (a row closes up, and a
building that nothing is left of goes); weight RULE=W, the rules counted from 0 as in the file.
Residuals are carried along, or left out with --residuals drop.")]
    Edit(edit::Args),
    /// Write a city in another format.
    #[command(after_help = "Examples:
  edifice city convert datasets/building_exteriors/village.city.json -o village.obj
  edifice city convert town.obj -o town.city.json
Reads .npz, .obj, .gml (CityGML 2 and 3), .city.json, .city.jsonl, .glb, .gltf, .cga (as `city derive` writes it) and
grammars; writes .obj and .city.json.")]
    Convert(convert::Args),
    /// Compare two cities, or a city and a grammar.
    #[command(after_help = "Examples:
  edifice city compare town.obj town.city-grammar.json --resolution 0.5")]
    Compare(compare::Args),
    /// Show rules, terminals and non-terminals of a grammar.
    #[command(after_help = "Examples:
  edifice city show town.city-grammar.json")]
    Show(show::Args),
    /// Fill a drawn shape with a new city of a grammar's buildings.
    #[command(after_help = "Examples:
  edifice city synthesize town.city-grammar.json --shape datasets/examples/park.geojson --seed 7 -o new.city-grammar.json
  edifice city synthesize town.city-grammar.json --shape datasets/examples/park.geojson -o new.glb
The shape is a polygon in metres. The output is a grammar, .glb, .obj or .city.json.")]
    Synthesize(synthesize::Args),
    /// Measure the plan of a city: blocks, attached and parallel buildings, gaps, covered ground.
    #[command(after_help = "Examples:
  edifice city morphology town.city-grammar.json --side 200
  edifice city morphology town.city-grammar.json --side 60 --at 0,0 --json
Buildings are attached where walls are at most 0.5 m apart; a block is a set of attached buildings; a building's four nearest
within 40 m are its neighbours, parallel within 5 degrees; the gap is to the nearest building of another block. Measures are
pooled over squares of --side that overlap by half and are town: nine tenths within 100 m of a building.")]
    Morphology(morphology::Args),
    /// Find where in a city a view was taken.
    #[command(after_help = "Examples:
  edifice city locate datasets/examples/street.obj --view datasets/examples/seen.json --top 2
  edifice city locate datasets/examples/street.obj --view datasets/examples/photo_1.jpg datasets/examples/photo_2.jpg
The view lists buildings near each other: { \"format\": \"edifice/city-view\", \"version\": 1, \"unit\": \"m\",
  \"buildings\": [ { \"width\": 31.5, \"depth\": 18, \"height\": 64, \"solid\": 0.8 } ] }")]
    Locate(locate::Args),
    /// Write 3D Tiles of a grammar's city.
    #[command(after_help = "Examples:
  edifice city tiles town.city-grammar.json -o town-tiles")]
    Tiles(tiles::Args),
    /// Plan the work on a country: tiles that share a dictionary of types.
    #[command(after_help = "Examples:
  edifice city plan town.obj --tile 150 --scenes -o country
A country is more buildings than fit into one machine's memory. Each tile becomes a grammar over one dictionary, without
textures; see
`edifice city work`.")]
    Plan(plan::Args),
    /// Work through a plan; any number of workers, also on several machines that share the folder.
    #[command(after_help = "Examples:
  edifice city work country --workers 2
A worker that is killed loses its task alone; started again it goes on. `edifice city submit` starts workers on a cluster. The grammars
in DIR/city-KEY are read by all commands of `edifice city`.")]
    Work(work::Args),
    /// Write the script that starts the workers of a plan on a cluster, and submit it.
    #[command(after_help = "Examples:
  edifice city submit country --engine slurm --workers 4 --dry-run
The memory that a job asks for is that of the plan's arithmetic (`edifice city plan` prints it). Jobs that were killed or ran out of time
are submitted again by the same command.")]
    Submit(submit::Args),
    /// Draw a city or a grammar.
    #[command(after_help = "Examples:
  edifice city draw town.city-grammar.json --beside town.obj -o town.png
  edifice city draw town.city-grammar.json --colour row --plan -o rows.png
  edifice city draw town.city-grammar.json --colour type --plan --at 40,40 --radius 60 --size 800x800 -o types.png")]
    Draw(draw::Args),
}

/// Runs the command.
pub(crate) fn run(command: Command) -> edifice_base::Result<()> {
    match command {
        Command::Proceduralize(args) => proceduralize::run(&args),
        Command::Derive(args) => derive::run(&args),
        Command::Edit(args) => edit::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Show(args) => show::run(&args),
        Command::Draw(args) => draw::run(&args),
        Command::Synthesize(args) => synthesize::run(&args),
        Command::Morphology(args) => morphology::run(&args),
        Command::Locate(args) => locate::run(&args),
        Command::Tiles(args) => tiles::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Work(args) => work::run(&args),
        Command::Submit(args) => submit::run(&args),
    }
}
