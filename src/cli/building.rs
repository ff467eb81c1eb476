//! Houses on the command line.

mod attributes;
mod build;
mod check;
mod compare;
mod data;
mod design;
mod draw;
mod evaluate;
mod facades;
mod from_facades;
mod import;
mod learn;
mod origin;
mod output;
mod produce;
mod show;

use clap::Subcommand;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Measure the houses of city models (`LoD2`): detached buildings as boxes with roofs.
    #[command(after_help = "Examples:
  edifice building import datasets/building_exteriors/village.city.json -o village.buildings.jsonl --report village.csv
  edifice building learn village.buildings.jsonl -o village.houses.json
A city model shows no windows, porches and chimneys: they are left unobserved, for models to fill in. The report has a line for
each building: why it is no house, or intersection over union of the plans, volume over volume, mean error of the heights.")]
    Import(import::Args),
    /// Measure the 49 attributes of buildings; prints CSV.
    #[command(after_help = "Examples:
  edifice building attributes datasets/building_exteriors/houses.buildings.jsonl > houses.csv")]
    Attributes(attributes::Args),
    /// Learn the hierarchical model from a database of buildings or a CSV with a schema.
    #[command(after_help = "Examples:
  edifice building learn datasets/building_exteriors/houses.buildings.jsonl -o made.houses.json
  edifice building learn datasets/building_exteriors/real.houses.csv --max-styles 3 --max-kinds 3 -o real.houses.json
  edifice building learn datasets/building_exteriors/delft.buildings.jsonl --groups bbox,bcr,arf,roof --max-styles 3 -o plain.houses.json
A CSV of other columns needs a schema: --schema datasets/building_exteriors/h2k.schema.json.")]
    Learn(learn::Args),
    /// Show styles, cardinalities and lateral edges of a model, and draw its network.
    #[command(after_help = "Examples:
  edifice building show datasets/building_exteriors/real.houses.json --svg network.svg")]
    Show(show::Args),
    /// Sample houses, as attributes; prints CSV.
    #[command(after_help = "Examples:
  edifice building sample datasets/building_exteriors/real.houses.json -n 5
  edifice building sample datasets/building_exteriors/real.houses.json --given garage=none --given bbox.w=14 --given roof.hip=yes
  edifice building sample datasets/building_exteriors/real.houses.json --given wwr=0.2,0.2,0.1,0.1 --most-probable")]
    Sample(draw::SampleArgs),
    /// Complete houses whose attributes are partly missing; prints CSV.
    #[command(after_help = "Examples:
  edifice building complete datasets/building_exteriors/real.houses.json village.buildings.jsonl -n 2 --most-probable
  edifice building complete datasets/building_exteriors/real.houses.json village.buildings.jsonl -n 1 -o completed --format json,glb
  edifice building complete datasets/building_exteriors/real.houses.json datasets/building_exteriors/village.city.json --facades -o village3.city.json
A side without facade pieces, and an empty cell of a CSV, is missing. --keep observes only some attributes.")]
    Complete(draw::CompleteArgs),
    /// Compare houses with the true ones: attributes, soundness, closed surfaces.
    Compare(compare::Args),
    /// Compare models by the negative log-likelihood of houses they have not seen.
    #[command(after_help = "Examples:
  edifice building evaluate datasets/building_exteriors/houses.buildings.jsonl --splits 2 --models ours,gmm")]
    Evaluate(evaluate::Args),
    /// Build houses that have given attributes.
    #[command(after_help = "Examples:
  edifice building attributes datasets/building_exteriors/houses.buildings.jsonl > houses.csv
  head -n 4 houses.csv > few.csv && edifice building build few.csv -o houses --format json,obj,glb,png
  edifice building sample datasets/building_exteriors/real.houses.json -n 5 > sampled.csv && edifice building build sampled.csv --repair -o sampled")]
    Build(build::BuildArgs),
    /// Sample attributes from a model and build the houses.
    #[command(after_help = "Examples:
  edifice building generate -n 3 -o generated --format json,obj,glb,svg,png
  edifice building generate -n 3 --given garage=none --given roof.hip=yes -o without_garage --json
  edifice building generate -n 4 --footprint datasets/building_exteriors/plot.geojson -o plot
  edifice building generate made -n 6 --most-probable -o made
  edifice building generate -n 12 -o town --street
Without a model houses are drawn from the one that ships, learnt from real houses; `made` is that of the made houses.")]
    Generate(build::GenerateArgs),
    /// Make a house of its footprint and of facades with marked windows and doors, as drawn over photographs.
    #[command(
        name = "from-facades",
        after_help = "Examples:
  edifice building from-facades --front datasets/examples/front.facade.json --footprint datasets/examples/lot.geojson --height 6 -o photographed
  edifice building from-facades --front datasets/examples/front.facade.json --right datasets/examples/right.facade.json --footprint datasets/examples/lot.geojson --height 6 -n 2 --format json,png -o photographed --json
What is marked stays to the centimetre, or the report says why not; roof, other sides and styles are the model's. Facades are read in every
format of `facade convert`, and drawn over photographs by `facade straighten`, `facade edit` or the studio. Regions of other labels than window,
door and the styles of windows (sash, sliding, casement, bay, fixed) are left out."
    )]
    FromFacades(from_facades::Args),
    /// Make other houses with the attributes of a house, their plans at least 5 % apart.
    #[command(after_help = "Examples:
  edifice building variations houses/house_0001.building.json -n 4 -o variations --format json,png")]
    Variations(design::VariationsArgs),
    /// Add, move, resize and remove boxes of a house; with a model, a house around the edited boxes is suggested.
    #[command(after_help = "Examples:
  edifice building edit houses/house_0001.building.json --resize 0=9,7,2.9 -o edited --format json,png
  edifice building edit houses/house_0001.building.json --add garage@2,3,3.5,6,2.5 --suggest -o edited")]
    Edit(design::EditArgs),
    /// Make a house of wished attributes, the rest as it is or as the model that ships has it.
    #[command(after_help = "Examples:
  edifice building wish houses/house_0001.building.json --given bbox.w=14 --given roof.hip=yes --keep -o wished
  edifice building wish houses/house_0001.building.json --style 2 --given garage.w=6 -o wished --format json,png
Columns are those of `building attributes`. Wishes that no house can have together are named.")]
    Wish(design::WishArgs),
    /// Check that houses are closed, in one shell, and that nothing overlaps or is hidden; exit code 1 names what is wrong.
    #[command(after_help = "Examples:
  edifice building check houses/*.building.json
  edifice building check houses/house_0001.obj
  edifice building check --plausible datasets/examples/cottage.building.json")]
    Check(check::CheckArgs),
    /// Draw houses: a view (PNG), elevations and plan (SVG), a scene (GLB).
    #[command(after_help = "Examples:
  edifice building draw houses/house_0001.building.json -o house.png
  edifice building draw houses/*.building.json -o street.glb")]
    Draw(check::DrawArgs),
}

/// Runs the command.
pub(crate) fn run(command: Command) -> edifice_base::Result<()> {
    match command {
        Command::Import(args) => import::run(&args),
        Command::Attributes(args) => attributes::run(&args),
        Command::Learn(args) => learn::run(&args),
        Command::Show(args) => show::run(&args),
        Command::Sample(args) => draw::sample(&args),
        Command::Complete(args) => draw::complete(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Build(args) => build::build(&args),
        Command::Generate(args) => build::generate(&args),
        Command::FromFacades(args) => from_facades::run(&args),
        Command::Variations(args) => design::variations(&args),
        Command::Edit(args) => design::edit(&args),
        Command::Wish(args) => design::wish(&args),
        Command::Check(args) => check::check(&args),
        Command::Draw(args) => check::draw(&args),
    }
}
