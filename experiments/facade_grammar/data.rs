//! The facades that the experiments run on.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, file};
use edifice_frame::{Budget, Context, layouts};
use edifice_generators_facade_grammar as made;
use edifice_grammar::{Grammar, derive};
use edifice_io::{ReadOptions, facade_json, grammar_cga, grammar_json, read_label_grid};
use edifice_layout::regularize::regularize_grid;
use edifice_shape::{Facade, LabelGrid, decompose, splittable};

pub use edifice_frame::layouts::{FIGURE_9, files, folder};

/// Seed of the shipped layouts.
pub const LAYOUT_SEED: u64 = 1;

/// A facade and where it comes from.
#[derive(Debug, Clone)]
pub struct Instance {
    /// `shipped`, `ecp2011`, `graz50`, `cmp`, or the name of a set of one's own.
    pub dataset: &'static str,
    /// The facade.
    pub facade: Facade,
}

/// The facade of Fig. 9.
pub fn figure_9(ctx: &mut Context) -> Result<Facade> {
    facade_json::read(&folder(ctx)?.join(format!("{FIGURE_9}.facade.json")))
}

/// The shipped facades: that of Fig. 9 first, then the 34 made ones by name; few and small ones at
/// the smoke budget.
pub fn shipped(ctx: &mut Context) -> Result<Vec<Facade>> {
    let mut facades = layouts::read_all(&folder(ctx)?)?;
    if ctx.budget() == Budget::Smoke {
        facades.retain(|f| f.regions.len() < 80);
        facades.truncate(3);
    }
    Ok(facades)
}

/// The made facades with the grammars they were derived from.
pub fn known(ctx: &mut Context) -> Result<Vec<(Facade, Grammar)>> {
    let mut known = Vec::new();
    for path in layouts::made(&folder(ctx)?)? {
        let name = path.display().to_string();
        let grammar = PathBuf::from(name.replace(".facade.json", ".grammar.json"));
        known.push((facade_json::read(&path)?, grammar_json::read(&grammar)?));
    }
    if ctx.budget() == Budget::Smoke {
        known.retain(|(f, _)| f.regions.len() < 80);
        known.truncate(2);
    }
    Ok(known)
}

/// The real facades that the user has, regularized as the paper assumes its input to be (Sec. 3.3) and
/// decomposed into tilings; at most `limit` of each set, evenly spread. Facades that no full line can
/// split are left out and counted in a note (Sec. 6.3).
pub fn real(ctx: &mut Context, limit: usize) -> Result<Vec<Instance>> {
    let known = [
        ("ecp2011", "facades/ecp2011/labels", ".png"),
        ("graz50", "facades/graz50/labels", ".png"),
        ("cmp", "facades/cmp", ".xml"),
    ];
    let mut sets = Vec::new();
    for (dataset, place, ending) in known {
        let Some(folder) = ctx.real(place)? else {
            continue;
        };
        let all = files(&folder, ending)?;
        sets.push((dataset, all, ending, ReadOptions::default()));
    }
    for set in ctx.own()? {
        sets.push((set.name, set.files, "", set.options));
    }
    let mut instances = Vec::new();
    for (dataset, all, ending, options) in sets {
        let chosen = spread(all.len(), limit).map(|i| &all[i]);
        let mut unsplittable = Vec::new();
        for path in chosen {
            let grid = read_label_grid(path, &options)?;
            let (grid, _) =
                regularize_grid(&grid, tolerance(&grid)).map_err(|e| Error::content(path, e))?;
            let mut facade = decompose(&grid)
                .map_err(|e| Error::content(path, e))?
                .facade;
            facade.name = match ending {
                "" => grid.name,
                ending => stem(path, ending),
            };
            match splittable(&facade) {
                Ok(()) => instances.push(Instance { dataset, facade }),
                Err(_) => unsplittable.push(facade.name),
            }
        }
        ctx.note(format!(
            "{dataset}: regularized, no edge moved by more than {TOLERANCE} of the longer side (Sec. 3.3)."
        ));
        if !unsplittable.is_empty() {
            ctx.note(format!(
                "{dataset}: no full line splits some part of {} facades, which are left out (Sec. 6.3): {}.",
                unsplittable.len(),
                unsplittable.join(", ")
            ));
        }
    }
    Ok(instances)
}

/// Longest way that regularization may move an edge of a real facade, as a part of its longer side.
const TOLERANCE: f64 = 0.01;

/// The same in the unit of the grid: whole pixels.
fn tolerance(grid: &LabelGrid) -> f64 {
    let side = |cuts: &[f64]| cuts.last().copied().unwrap_or(0.0);
    (TOLERANCE * side(&grid.xs).max(side(&grid.ys)))
        .round()
        .max(1.0)
}

/// `limit` of `count` places, evenly spread.
fn spread(count: usize, limit: usize) -> impl Iterator<Item = usize> {
    let chosen = count.min(limit);
    (0..chosen).map(move |i| i * count / chosen)
}

/// Name of a file without its ending.
pub fn stem(path: &Path, ending: &str) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.trim_end_matches(ending).to_string()
}

/// Makes the shipped facades anew in a folder like `datasets/facade_grammar`, where the printed
/// grammar `wu2014_fig9.cga` already is.
///
/// # Errors
/// [`Error::Io`] when a file cannot be read or written, or what reading the printed grammar says.
pub fn write_layouts(folder: &Path, seed: u64) -> Result<()> {
    let layouts = folder.join("layouts");
    std::fs::create_dir_all(&layouts).map_err(|e| Error::io(&layouts, "create", e))?;
    for (name, bytes) in layout_files(seed)? {
        file::write_atomic(&layouts.join(name), &bytes)?;
    }
    let printed = grammar_cga::read(&folder.join(format!("{FIGURE_9}.cga")))?;
    let facade = derive(&printed, 0).map_err(Error::method)?;
    facade_json::write(&facade, &folder.join(format!("{FIGURE_9}.facade.json")))
}

/// Name and content of each file of the made layouts.
///
/// # Errors
/// [`Error::Method`] if a made grammar did not derive.
pub fn layout_files(seed: u64) -> Result<Vec<(String, Vec<u8>)>> {
    let layouts = made::layouts(seed).map_err(Error::method)?;
    let mut files = Vec::new();
    for one in &layouts {
        let name = &one.facade.name;
        let facade = facade_json::to_string(&one.facade);
        let grammar = grammar_json::to_string(&one.grammar);
        files.push((format!("{name}.facade.json"), facade.into_bytes()));
        files.push((format!("{name}.grammar.json"), grammar.into_bytes()));
    }
    Ok(files)
}
