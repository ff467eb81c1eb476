//! `edifice facade complete`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice_base::{Error, Result};
use edifice_editing::structure_completion::{Wanted, complete, file, shipped_model};
use edifice_io::{facade_json, read_bytes, write_atomic, write_facade};
use edifice_shape::{AnnotatedFacade, Rect};
use edifice_structure_completion::method::Method;
use edifice_structure_completion::model::Model;

use super::{input, mask, overview};
use crate::print;
use crate::reading::Reading;

/// Options of `facade complete`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice facade hide datasets/facade_grammar/layouts/office_1.facade.json --task side50 --seed 1 -o partial.facade.json
  edifice facade complete partial.facade.json -o whole.facade.json
  edifice facade complete partial.facade.json --unknown 0,0,200,150 --count 5 -o answers --svg answers.svg
  edifice facade complete partial.facade.json --model mine.completion.json --method mirror -o mirrored.facade.json

Everything that is not observed is unknown, unless the file (key \"unknown\"), --unknown or --mask says what is. Elements
of an earlier completion (\"observed\": false) are dropped, but for those that --pin names.")]
pub(crate) struct Args {
    /// Partial layout: .facade.json, or any other format that `facade convert` reads
    #[arg(value_name = "PARTIAL")]
    input: PathBuf,
    /// Model of `facade train`; the default one was learnt from the shipped layouts
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Method of completion
    #[arg(long, default_value = "best", value_parser = Method::ALL.map(Method::option))]
    method: String,
    /// Number of different completions
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=100))]
    count: u16,
    /// Rectangle whose content is not known; may be given several times
    #[arg(long, value_name = "X,Y,W,H", value_parser = input::rect, allow_hyphen_values = true)]
    unknown: Vec<Rect>,
    /// Image laid over the outline: what is light is not known
    #[arg(long, value_name = "PNG")]
    mask: Option<PathBuf>,
    /// Width of the outline, if other than the input's; new parts are unknown
    #[arg(long)]
    width: Option<f64>,
    /// Height of the outline, if other than the input's; new parts are unknown
    #[arg(long)]
    height: Option<f64>,
    /// Keep this element of an earlier completion, by its id; may be given several times
    #[arg(long, value_name = "ID")]
    pin: Vec<String>,
    /// Rectangle that no added element may enter; may be given several times
    #[arg(long, value_name = "X,Y,W,H", value_parser = input::rect, allow_hyphen_values = true)]
    forbid: Vec<Rect>,
    /// Seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// File for the best completion, or folder for all
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Also draw the input and all completions on one sheet
    #[arg(long, value_name = "OVERVIEW")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// End standard output with one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let start = Instant::now();
    let Some(method) = Method::of_option(&args.method) else {
        return Err(Error::option("--method", "unknown method"));
    };
    let own = args.model.as_deref().map(read_model).transpose()?;
    let model = match &own {
        Some(model) => model,
        None => shipped_model()?,
    };
    let mut annotated = input::annotated(&args.input, &args.reading)?;
    add_unknown(args, &mut annotated)?;
    let wanted = Wanted {
        width: args.width,
        height: args.height,
        pins: &args.pin,
        forbidden: &args.forbid,
    };
    let answers = complete(
        annotated,
        &wanted,
        method,
        model,
        args.count.into(),
        args.seed,
        &args.input,
    )?;
    for warning in &answers.warnings {
        print::message(&format!("warning: {warning}"));
    }
    let whole = answers.whole();
    let (given, completions) = (answers.given, answers.completions);
    let files = write(args, &whole)?;
    if let Some(sheet) = &args.svg {
        let name = |k: usize| format!("{} (mass {:.2})", k + 1, completions[k].mass);
        let mut panels = vec![("input".to_string(), &given.shown)];
        panels.extend(whole.iter().enumerate().map(|(k, w)| (name(k), w)));
        write_atomic(sheet, overview::svg(&panels).as_bytes())?;
    }
    if args.json {
        let each = completions
            .iter()
            .zip(&whole)
            .zip(&files)
            .map(|((c, w), file)| {
                serde_json::json!({
                    "score": c.score, "mass": c.mass, "elements": w.facade.regions.len(),
                    "added": c.added.len(), "file": file.as_ref().map(|f| f.display().to_string()),
                })
            });
        let each: Vec<_> = each.collect();
        let about = serde_json::json!({
            "completions": each, "seconds": start.elapsed().as_secs_f64(), "seed": args.seed,
        });
        return print::line(&about.to_string());
    }
    for (c, file) in completions.iter().zip(&files) {
        let place = file
            .as_ref()
            .map_or("not written".into(), |f| f.display().to_string());
        let (added, score, mass) = (c.added.len(), c.score, c.mass);
        print::line(&format!(
            "{place}: {added} elements added, score {score:.3}, mass {mass:.3}"
        ))?;
    }
    Ok(())
}

pub(super) fn read_model(path: &Path) -> Result<Model> {
    let bytes = read_bytes(path)?;
    let text = String::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    Model::from_json(&text).map_err(|e| Error::content(path, e))
}

/// Adds the unknown parts of the options to those of the file.
fn add_unknown(args: &Args, annotated: &mut AnnotatedFacade) -> Result<()> {
    let mut rects = args.unknown.clone();
    if let Some(path) = &args.mask {
        rects.extend(mask::unknown(
            path,
            annotated.facade.width,
            annotated.facade.height,
        )?);
    }
    if !rects.is_empty() || args.mask.is_some() {
        annotated.unknown.get_or_insert_default().extend(rects);
    }
    Ok(())
}

/// Writes the best completion to a file, or all of them to a folder; the file of each.
fn write(args: &Args, whole: &[AnnotatedFacade]) -> Result<Vec<Option<PathBuf>>> {
    let out = &args.output;
    let name = out.to_string_lossy().to_lowercase();
    let endings = [".json", ".svg", ".png", ".txt"];
    let is_file = !out.is_dir() && endings.iter().any(|ending| name.ends_with(ending));
    if !is_file {
        std::fs::create_dir_all(out).map_err(|e| Error::io(out, "create", e))?;
    }
    let mut files = Vec::new();
    for (k, completion) in whole.iter().enumerate() {
        let path = match (is_file, k) {
            (true, 0) => out.clone(),
            (true, _) => {
                files.push(None);
                continue;
            }
            (false, _) => out.join(file(k + 1)),
        };
        if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("json"))
        {
            let text = facade_json::annotated_to_string(completion);
            write_atomic(&path, text.as_bytes())?;
        } else {
            write_facade(&completion.facade, &path)?;
        }
        files.push(Some(path));
    }
    Ok(files)
}
