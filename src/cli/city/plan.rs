//! `edifice city plan`.

use std::path::PathBuf;

use edifice_base::Result;
use edifice_experiments::city_proceduralization::country::{Options, PLAN, Plan};

use crate::print::Json;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Cities, each a tile.
    #[arg(required = true)]
    tiles: Vec<PathBuf>,
    /// Split each city into squares with sides of so many metres; a building is in the square of its middle.
    #[arg(long, value_name = "METRES")]
    tile: Option<f64>,
    /// Halvings of the number of components that give the number of types.
    #[arg(long, value_name = "L", default_value_t = Options::default().level)]
    level: u32,
    /// Represent a type by members of few polygons.
    #[arg(long)]
    poly: bool,
    /// Step of the numbers written: mm, cm or dm.
    #[arg(long, default_value_t = Options::default().precision)]
    precision: String,
    /// Share of the types that are not in the dictionary but in the grammar of one tile, 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = Options::default().local)]
    local: f64,
    /// Most templates, and most rules, of the dictionary.
    #[arg(long, value_name = "N", default_value_t = Options::default().most)]
    dictionary: usize,
    /// Leave out the attributes of buildings.
    #[arg(long)]
    no_attributes: bool,
    /// Also write 3D Tiles.
    #[arg(long)]
    scenes: bool,
    /// The folder of plan and results.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let options = Options {
        level: args.level,
        poly: args.poly,
        precision: args.precision.clone(),
        local: args.local,
        most: args.dictionary,
        attributes: !args.no_attributes,
        scenes: args.scenes,
    };
    let plan = Plan::make(&args.tiles, args.tile, &args.output, options)?;
    let (tiles, buildings, memory) = (plan.tiles.len(), plan.buildings(), plan.memory()?);
    let megabytes = |bytes: u64| bytes.div_ceil(1_000_000);
    let text = format!(
        "{buildings} buildings in {tiles} tiles; about {} MB for a worker on the largest, {} MB to merge; plan in {}",
        megabytes(memory.tile),
        megabytes(memory.merge),
        args.output.join(PLAN).display()
    );
    let value = serde_json::json!({
        "folder": args.output, "key": plan.key, "tiles": tiles, "buildings": buildings,
        "tile_bytes": memory.tile, "merge_bytes": memory.merge,
    });
    args.json.after(&text, &value)
}
