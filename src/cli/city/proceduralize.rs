//! `edifice city proceduralize`.

use std::borrow::Cow;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use edifice_base::{Error, Progress, Result, unwatched};
use edifice_city_proceduralization as method;
use edifice_city_proceduralization::{
    Budget, Detection, Mode, PAPER_FEATURES, Precision, Proceduralized, Representative, Settings,
    Verdict, judge,
};
use edifice_grammar::instance::{InstanceGrammar, Kept};
use edifice_io_city::{self as city, glb, grammar_file};
use edifice_shape::triangles::{City, MeshFaults};

use super::residuals::Residuals;
use crate::choice::{Choice, one_of};
use crate::print;

#[rustfmt::skip]
const MODES: &[Choice<Mode>] = &[
    ("best", "Geometric features, Ward, medoids", Mode::Best),
    ("paper", "As the paper writes", Mode::Paper),
];

#[rustfmt::skip]
const PRECISIONS: &[Choice<Precision>] = &[
    ("mm", "Millimetres, ten-thousandths of degrees, templates on 16 bits", Precision::Millimetre),
    ("cm", "Centimetres, hundredths of degrees, templates on 12 bits", Precision::Centimetre),
    ("dm", "Decimetres, half degrees, templates on 7 bits", Precision::Decimetre),
];

#[rustfmt::skip]
const COMMUNITIES: &[Choice<Detection>] = &[
    ("girvan-newman", "As the paper does; slow on graphs of many thousand edges", Detection::GirvanNewman),
    ("louvain", "Blondel et al. 2008", Detection::Louvain),
];

#[rustfmt::skip]
const KEEPS: &[Choice<Kept>] = &[
    ("all", "Everything", Kept::All),
    ("ids", "Identifiers, no attributes", Kept::Identifiers),
    ("buildings", "Identifiers, and neither textures nor patterns for synthesis", Kept::Buildings),
    ("shape", "No attributes, identifiers, textures or patterns for synthesis; buildings are named by numbers", Kept::Shape),
];

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Cities; buildings of several files are put together.
    #[arg(required = true)]
    input: Vec<PathBuf>,
    /// Method that finds types.
    #[arg(long, value_parser = one_of(MODES), default_value = "best")]
    mode: Mode,
    /// Number of templates, or `all`.
    #[arg(long, value_name = "K", group = "budget")]
    templates: Option<String>,
    /// Most bytes of the grammar's file, without textures; of the numbers of templates tried, the most that fits.
    #[arg(long, value_name = "N", group = "budget")]
    bytes: Option<usize>,
    /// Least volumetric intersection over union with the input; of the numbers of templates tried, the one of fewest bytes.
    #[arg(long, value_name = "X", group = "budget")]
    iou: Option<f64>,
    /// Halvings of the number of components [default: 4].
    #[arg(long, value_name = "L", group = "budget")]
    level: Option<u32>,
    /// Weights of the paper's features, `F=W,...`; others are 1.
    #[arg(long, value_name = "F=W,...")]
    weights: Option<String>,
    /// Method that finds communities, with `--mode paper`.
    #[arg(long, value_parser = one_of(COMMUNITIES), default_value = "girvan-newman")]
    communities: Detection,
    /// Represent a type by its member of fewest polygons; with `--mode best`, weigh triangles against volume: half as many, fewer bytes,
    /// a lower intersection over union.
    #[arg(long)]
    poly: bool,
    /// Seed of k-means.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Step of the numbers written, with `--mode best` [default: mm with `--templates all`, dm in `.city-grammar.bin`,
    /// cm otherwise].
    #[arg(long, value_parser = one_of(PRECISIONS))]
    precision: Option<Precision>,
    /// Most pixels along a side of a template's textures; 0 for no textures.
    #[arg(long, value_name = "N", default_value_t = 128)]
    texture_pixels: usize,
    /// Part of the buildings that is kept.
    #[arg(long, value_parser = one_of(KEEPS), default_value = "all")]
    keep: Kept,
    /// Treatment of parts that the rules do not put exactly: keep where they stand, or let the rules alone say.
    #[arg(long, value_enum, default_value = "keep")]
    residuals: Residuals,
    /// The grammar to write: text (`*.city-grammar.json`, also with `.gz`), or few bytes (`*.city-grammar.bin`).
    #[arg(short, long)]
    output: PathBuf,
    /// Also write the derived city as binary glTF.
    #[arg(long)]
    glb: Option<PathBuf>,
    /// End with a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let settings = settings(args)?;
    let start = Instant::now();
    print::message("reading");
    let input = read(&args.input)?;
    print::message(&format!(
        "{} buildings, {} triangles",
        input.buildings.len(),
        input.triangles()
    ));
    // The nearest to what is asked for, of those tried: how much it has of it, and its templates.
    let nearest: Cell<Option<(f64, usize)>> = Cell::new(None);
    let note = |value: f64, templates: usize, better: fn(f64, f64) -> bool| {
        if nearest.get().is_none_or(|(known, _)| better(value, known)) {
            nearest.set(Some((value, templates)));
        }
    };
    let made = match (args.bytes, args.iou) {
        (Some(most), _) => {
            let small = |g: &InstanceGrammar| {
                let bytes = args.bytes_of(g)?.len();
                let templates = g.templates.len();
                print::message(&format!("{templates} templates: {bytes} bytes"));
                note(bytes as f64, templates, |a, b| a < b);
                let fits = bytes <= most;
                Ok(Verdict { fits, bytes })
            };
            method::largest(&input, &settings, small, &unwatched).map_err(|e| failure(e, args))?
        }
        (_, Some(least)) => {
            let good = |g: &InstanceGrammar| {
                let iou = judge::iou(&input, &args.said(g))?;
                let (bytes, templates) = (args.bytes_of(g)?.len(), g.templates.len());
                print::message(&format!(
                    "{templates} templates: {bytes} bytes, IoU {iou:.4}"
                ));
                note(iou, templates, |a, b| a > b);
                let fits = iou >= least;
                Ok(Verdict { fits, bytes })
            };
            method::smallest(&input, &settings, good, &unwatched).map_err(|e| failure(e, args))?
        }
        _ => {
            // Each stage once; buildings are cut by many threads.
            let stage = Mutex::new("");
            let tell = |progress: Progress| {
                let mut last = stage.lock().unwrap_or_else(PoisonError::into_inner);
                if *last != progress.stage {
                    *last = progress.stage;
                    print::message(progress.stage);
                }
                ControlFlow::Continue(())
            };
            let made = method::proceduralize(&input, &settings, &tell);
            Some(made.map_err(|e| failure(e.into(), args))?)
        }
    };
    let missed = || {
        let (value, templates) = nearest.get().unwrap_or_default();
        match args.bytes {
            Some(_) => Error::option(
                "--bytes",
                format!("the smallest found is {value} bytes, with {templates} templates"),
            ),
            None => Error::option(
                "--iou",
                format!("the highest found is {value:.4}, with {templates} templates"),
            ),
        }
    };
    let mut made = made.ok_or_else(missed)?;
    if args.residuals == Residuals::Drop {
        made.grammar = made.grammar.rules_only();
    }
    match args.texture_pixels {
        0 => made
            .grammar
            .templates
            .iter_mut()
            .for_each(|t| t.texture = None),
        pixels => {
            let textures = made.box_textures(&input, pixels);
            city::add_textures(&mut made.grammar, &textures).map_err(Error::method)?;
        }
    }
    warn(&input, &made);
    let seconds = start.elapsed().as_secs_f64();
    let derivation = made.grammar.derive().map_err(Error::method)?;
    if let Some(path) = &args.glb {
        let bytes = glb::to_bytes(&made.grammar, &derivation, true);
        let bytes = bytes.map_err(|e| Error::content(path, e))?;
        edifice_io::write_atomic(path, &bytes)?;
    }
    let bytes = args.bytes_of(&made.grammar)?;
    edifice_io::write_atomic(&args.output, &bytes)?;
    let bytes = bytes.len();
    print::message("measuring");
    let iou = judge::iou(&input, &made.grammar).map_err(|e| failure(e.into(), args))?;
    // What is counted is what is written.
    let written = args.kept(&made.grammar);
    let rules = written.rules.len();
    let (escapes, residuals) = (written.escapes(), written.residuals());
    let non_terminals = written.non_terminals();
    let (components, templates) = (made.decomposition.components.len(), written.templates.len());
    if args.json {
        let summary = serde_json::json!({
            "buildings": input.buildings.len(), "components": components, "templates": templates,
            "rules": rules, "terminals": templates, "non_terminals": non_terminals,
            "escapes": escapes, "residuals": residuals, "bytes": bytes, "iou": iou, "seconds": seconds, "seed": args.seed,
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!(
        "{} buildings, {components} components -> {templates} templates, {rules} rules, {escapes} escapes, {residuals} residuals\n\
         {bytes} bytes, volumetric IoU {iou:.4}, {seconds:.1} s",
        input.buildings.len()
    ))
}

impl Args {
    /// The bytes of the file that a grammar is written to.
    fn bytes_of(&self, grammar: &InstanceGrammar) -> Result<Vec<u8>> {
        grammar_file::to_bytes(&self.kept(grammar), &self.output)
    }

    /// A grammar as it is written: with residuals or without, and with the part of it that is kept.
    fn kept<'g>(&self, grammar: &'g InstanceGrammar) -> Cow<'g, InstanceGrammar> {
        match self.keep {
            Kept::All => self.said(grammar),
            kept => Cow::Owned(self.said(grammar).keeping(kept)),
        }
    }

    /// A grammar with residuals, or without.
    fn said<'g>(&self, grammar: &'g InstanceGrammar) -> Cow<'g, InstanceGrammar> {
        match self.residuals {
            Residuals::Keep => Cow::Borrowed(grammar),
            Residuals::Drop => Cow::Owned(grammar.rules_only()),
        }
    }

    fn precision(&self) -> Option<Precision> {
        match self.precision {
            Some(precision) => Some(precision),
            None if self.templates.as_deref() == Some("all") => None,
            None => grammar_file::is_compact(&self.output).then_some(Precision::Decimetre),
        }
    }
}

fn settings(args: &Args) -> Result<Settings> {
    let mut settings = Settings {
        mode: args.mode,
        representative: match args.poly {
            true => Representative::FewestPolygons,
            false => Representative::Nearest,
        },
        seed: args.seed,
        detection: args.communities,
        precision: args.precision(),
        ..Settings::default()
    };
    if let Some(level) = args.level {
        settings.budget = Budget::Level(level);
    }
    match args.templates.as_deref() {
        Some("all") => settings.budget = Budget::All,
        Some(text) => match text.parse() {
            Ok(k) if k > 0 => settings.budget = Budget::Templates(k),
            _ => {
                return Err(Error::option(
                    "--templates",
                    format!("{text:?} is no number above 0, nor `all`"),
                ));
            }
        },
        None => {}
    }
    if let Some(x) = args.iou
        && !(0.0..=1.0).contains(&x)
    {
        return Err(Error::option(
            "--iou",
            format!("{x} is not between 0 and 1"),
        ));
    }
    for pair in args.weights.iter().flat_map(|text| text.split(',')) {
        let known = pair.split_once('=').and_then(|(name, weight)| {
            let at = PAPER_FEATURES.iter().position(|f| *f == name.trim())?;
            let weight: f64 = weight.trim().parse().ok()?;
            (weight.is_finite() && weight >= 0.0).then_some((at, weight))
        });
        let Some((at, weight)) = known else {
            let message = format!(
                "{pair:?} is not F=W with F of {}",
                PAPER_FEATURES.join(", ")
            );
            return Err(Error::option("--weights", message));
        };
        settings.weights[at] = weight;
    }
    Ok(settings)
}

/// Reads all inputs; an identifier that occurs again gets a number.
fn read(paths: &[PathBuf]) -> Result<City> {
    let mut all: Option<City> = None;
    for path in paths {
        let next = city::read(path)?;
        next.notes.iter().for_each(|note| print::message(note));
        match &mut all {
            None => all = Some(next),
            Some(city) => city.merge(next),
        }
    }
    let mut all = all.unwrap_or_default();
    all.number_duplicates();
    Ok(all)
}

fn failure(error: edifice_base::error::Cause, args: &Args) -> Error {
    match args.input.first() {
        Some(path) => Error::content(path, error),
        None => Error::method(error),
    }
}

/// Buildings named in a warning.
const NAMED: usize = 3;

/// A test of a mesh for a fault: true if it has it.
type HasFault = fn(&MeshFaults) -> bool;

/// Tells what is wrong with the meshes.
fn warn(input: &City, made: &Proceduralized) {
    let faults = &made.decomposition.faults;
    let names = |indices: &[usize]| {
        let named = indices
            .iter()
            .take(NAMED)
            .map(|&b| input.buildings[b].id.as_str());
        let more = if indices.len() > NAMED { ", ..." } else { "" };
        format!("{}{more}", named.collect::<Vec<_>>().join(", "))
    };
    let kinds: [(&str, HasFault); 5] = [
        ("are open", |f| f.open_edges > 0),
        ("have edges of more than two triangles", |f| {
            f.non_manifold_edges > 0
        }),
        ("have triangles without area", |f| f.degenerate > 0),
        ("have triangles more than once", |f| f.duplicated > 0),
        ("were inside out", |f| f.inverted),
    ];
    let all = input.buildings.len();
    for (what, has) in kinds {
        let found: Vec<usize> = (0..faults.len()).filter(|&b| has(&faults[b])).collect();
        if !found.is_empty() {
            let n = found.len();
            print::message(&format!(
                "warning: {n} of {all} buildings {what}: {}",
                names(&found)
            ));
        }
    }
    let empty = &made.decomposition.empty;
    if !empty.is_empty() {
        let n = empty.len();
        print::message(&format!(
            "warning: {n} of {all} buildings left out, without area: {}",
            names(empty)
        ));
    }
}
