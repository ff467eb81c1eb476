//! Facade files on the command line.

mod compare;
mod complete;
mod edit;
mod hide;
mod input;
mod mask;
mod overview;
mod score;
mod straighten;
mod train;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use edifice_base::{Error, Result};
use edifice_io as io;
use edifice_io::Source;
use edifice_layout::regularize::{RegularizeError, Report, regularize_facade, regularize_grid};
use edifice_shape as shape;
use edifice_shape::{Decomposition, Facade, LabelGrid};

use super::cleaning::Cleaning;
use super::print::{self, Json};
use super::reading::{self, Reading};
use super::tolerance;
use super::walls::Walls;

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Convert a facade to another format, told by the file names.
    ///
    /// Reads .facade.json, label images (.png), matrices of labels (.txt, .csv), rectangles of the CMP
    /// database, annotations of Pascal VOC and eTRIMS (.xml), and boxes drawn with LabelMe or kept as COCO (.json);
    /// all text files also as .gz.
    /// Writes .facade.json, .svg, .png and .txt. Label images become tilings of rectangles that full
    /// lines can split; boxes become element layouts, which are drawn on a wall.
    #[command(after_help = "Examples:
  edifice facade convert datasets/examples/facade.png -o facade.facade.json --regularize 2
  edifice facade convert datasets/examples/facade.png -o short.facade.json --tolerance 1%
  edifice facade convert datasets/examples/labels.txt.gz --label-map datasets/examples/map.json -o labels.svg
  edifice facade convert datasets/examples/facade.jpg --nearest-colour -o labels.png
  edifice facade convert datasets/examples/instances.json --image house_7 -o house_7.facade.json

A label map is a JSON file: {\"window\": [255, 0, 0], \"wall\": 2, \"unlabelled\": -1}
Without one, of images the colours of the ECP and Graz databases and the numbers of the CMP database are known.
A colour or number that the map does not name is an error. Numbers of text matrices are labels themselves
unless there is a map, with a warning where nothing else stands in the matrix. With --nearest-colour such a colour is
read as the nearest one of the map (without a map: of ECP and Graz), and the largest distance is told.")]
    Convert(Convert),
    /// Learn from whole facades how partial ones are completed (Fan et al. 2014).
    Train(train::Args),
    /// Complete a facade of which only a part is seen.
    Complete(complete::Args),
    /// Add, move, resize, relabel and remove elements of a layout.
    Edit(edit::Args),
    /// Begin a drawing with a photograph: its four corners become a rectangle of true proportions.
    Straighten(straighten::Args),
    /// Hide a part of a whole facade, to see how it is completed.
    #[command(
        after_help = "Example:\n  edifice facade hide datasets/facade_grammar/layouts/office_1.facade.json --task side50 --seed 1 -o partial.facade.json"
    )]
    Hide(hide::Args),
    /// Compare predicted layouts with the true one: agreement, areas, counts, regularity, probabilities.
    Compare(compare::Args),
    /// Score a facade by the statistical model of Fan et al. 2014, term by term.
    Score(score::Args),
}

/// Options of `facade convert`.
#[derive(Args)]
pub(crate) struct Convert {
    /// Facade to read.
    input: PathBuf,
    /// File to write.
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    walls: Walls,
    #[command(flatten)]
    cleaning: Cleaning,
    /// Keep only elements (windows, doors, ...), not the wall.
    #[arg(long, conflicts_with = "wall")]
    elements: bool,
    /// Make nearly equal sizes equal and nearly aligned edges aligned, moving no edge further than
    /// this, in the unit of the facade. What is equal stays equal; applied again it changes nothing more.
    #[arg(long, value_name = "TOLERANCE", allow_negative_numbers = true)]
    regularize: Option<f64>,
    /// Retile so that the grammar becomes shorter, with at most so many per cent of the area wrong: lines a few pixels
    /// apart are merged. The cost never rises with the tolerance; 0 changes nothing.
    #[arg(long, value_name = "P%", value_parser = tolerance::per_cent, conflicts_with_all = ["regularize", "elements"])]
    tolerance: Option<f64>,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::Convert(options) => convert(&options),
        Command::Train(args) => train::run(&args),
        Command::Complete(args) => complete::run(&args),
        Command::Edit(args) => edit::run(&args),
        Command::Straighten(args) => straighten::run(&args),
        Command::Hide(args) => hide::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Score(args) => score::run(&args),
    }
}

fn convert(options: &Convert) -> Result<()> {
    let path = &options.input;
    let source = reading::source(path, &options.reading.options()?)?;
    let source = match options.cleaning.is_asked() || options.tolerance.is_some() {
        true => options.walls.tiling(source, path)?,
        false => options.walls.source(source, path)?,
    };
    let source = options.cleaning.source(source, path)?;
    if let Some(share) = options.tolerance {
        let facade = tolerance::retiled(source, path, share, &Default::default())?;
        return written(&facade, options);
    }
    let source = match (source, options.regularize) {
        (source, None) => source,
        (Source::Layout(facade), Some(tolerance)) => {
            let moved = regularize_facade(&facade, tolerance);
            Source::Layout(moved.map_err(|e| regularize_error(path, e)).map(report)?)
        }
        (Source::Picture(grid), Some(tolerance)) => {
            let moved = regularize_grid(&grid, tolerance);
            Source::Picture(moved.map_err(|e| regularize_error(path, e)).map(report)?)
        }
        (Source::Cmp(cmp, width, height), Some(tolerance)) => {
            let moved = regularize_grid(&cmp.label_grid(width, height)?, tolerance);
            Source::Picture(moved.map_err(|e| regularize_error(path, e)).map(report)?)
        }
    };
    let facade = match (source, options.elements) {
        (Source::Layout(facade), false) => facade,
        (Source::Layout(facade), true) => shape::elements_of_facade(&facade),
        (Source::Cmp(cmp, width, height), true) => cmp.elements(width, height)?,
        (Source::Picture(grid), true) => {
            shape::elements_of_grid(&grid).map_err(|e| Error::content(path, e))?
        }
        (Source::Cmp(cmp, width, height), false) => tiling(path, &cmp.label_grid(width, height)?)?,
        (Source::Picture(grid), false) => tiling(path, &grid)?,
    };
    written(&facade, options)
}

/// Writes a facade, and tells what cannot be seen in a picture.
fn written(facade: &Facade, options: &Convert) -> Result<()> {
    let output = &options.output;
    io::write_facade(facade, output)?;
    if output
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"))
    {
        for labels in io::draw::shared_colours(facade) {
            print::message(&format!("note: drawn in one colour: {}", labels.join(", ")));
        }
    }
    let count = facade.regions.len();
    let text = format!("{}: {count} regions", output.display());
    let value = serde_json::json!({ "file": output, "regions": count });
    options.json.after(&text, &value)
}

/// Decomposes a picture and tells what had to be cut.
fn tiling(path: &Path, grid: &LabelGrid) -> Result<Facade> {
    let Decomposition {
        facade,
        cut_elements,
        ..
    } = shape::decompose(grid).map_err(|e| Error::content(path, e))?;
    for cut in &cut_elements {
        let r = cut.rect;
        print::message(&format!(
            "note: interlocked with its neighbours, cut into pieces: {} at ({}, {}), {} x {}",
            cut.label, r.x, r.y, r.width, r.height
        ));
    }
    Ok(facade)
}

/// Tells what regularization did, and passes its result on.
fn report<T>((value, report): (T, Report)) -> T {
    let sizes: Vec<String> = (report.sizes.iter())
        .map(|(label, (before, after))| format!("{label} {before} -> {after}"))
        .collect();
    print::message(&format!(
        "regularized: largest move {}, distinct sizes: {}",
        report.largest_move,
        sizes.join(", ")
    ));
    value
}

fn regularize_error(path: &Path, error: RegularizeError) -> Error {
    match error {
        RegularizeError::Tolerance(_) => Error::option("--regularize", error.to_string()),
        error => Error::content(path, error),
    }
}
