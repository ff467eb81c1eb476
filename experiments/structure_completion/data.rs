//! The element layouts that the experiments run on.

use std::path::PathBuf;

use edifice_frame::{Budget, Context, layouts};
use edifice_io::{ReadOptions, Source, read_source};
use edifice_structure_completion::layout::{Layout, extract, scope};

use edifice_base::{Error, Result};

/// A facade of a data set.
#[derive(Debug, Clone)]
pub struct Item {
    /// `shipped`, `ecp2011`, `graz50`, `cmp`, `paris_art_deco`, or the name of a set of one's own.
    pub dataset: &'static str,
    /// Its elements.
    pub layout: Layout,
    /// True if it has a lattice of windows, and is one facade.
    pub in_scope: bool,
}

/// The real facades of ECP, Graz, CMP and Art Deco that the user has; without them the shipped layouts. Fewer at the smoke
/// budget.
pub fn items(ctx: &mut Context) -> Result<Vec<Item>> {
    let mut items = Vec::new();
    for (dataset, folder, ending) in [
        ("ecp2011", "facades/ecp2011/labels", ".png"),
        ("graz50", "facades/graz50/labels", ".png"),
        ("cmp", "facades/cmp", ".xml"),
    ] {
        if let Some(folder) = ctx.real(folder)? {
            items.extend(read(
                dataset,
                &layouts::files(&folder, ending)?,
                &ReadOptions::default(),
            )?);
        }
    }
    if let Some(folder) = ctx.real("facades/paris_art_deco")? {
        let options = ReadOptions {
            label_map: Some(layouts::art_deco()?),
            ..ReadOptions::default()
        };
        let files = layouts::files(&folder, ".txt.gz")?;
        items.extend(read("paris_art_deco", &files, &options)?);
    }
    for set in ctx.own()? {
        items.extend(read(set.name, &set.files, &set.options)?);
    }
    if items.is_empty() {
        items = shipped(ctx)?;
    }
    if ctx.budget() == Budget::Smoke {
        let every = items.len().div_ceil(SMOKE);
        items = items.into_iter().step_by(every.max(1)).collect();
    }
    Ok(items)
}

/// Facades at the smoke budget.
const SMOKE: usize = 6;

/// The shipped layouts.
pub fn shipped(ctx: &mut Context) -> Result<Vec<Item>> {
    let folder = layouts::folder(ctx)?;
    read("shipped", &layouts::made(&folder)?, &ReadOptions::default())
}

fn read(dataset: &'static str, files: &[PathBuf], options: &ReadOptions) -> Result<Vec<Item>> {
    let item = |path: &PathBuf| {
        let source = read_source(path, options)?;
        let one = match &source {
            // A photograph of several facades has no outline to complete.
            Source::Cmp(cmp, ..) => cmp.objects.iter().filter(|o| o.label == "facade").count() == 1,
            _ => true,
        };
        let layout = extract::elements(&source.labelled()?).map_err(|e| Error::content(path, e))?;
        let in_scope = one && scope::in_scope(&layout);
        Ok(Item {
            dataset,
            layout,
            in_scope,
        })
    };
    files.iter().map(item).collect()
}
