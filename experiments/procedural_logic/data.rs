//! The facades that the experiments run on.

use std::path::Path;

use super::gold::{Annotations, Architecture};
use super::made;
use crate::experiments::{Budget, Context};
use crate::io::{ReadOptions, read_label_grid};
use crate::shape::LabelGrid;
use crate::{Error, Result};

/// Seed of the made facades.
const MADE_SEED: u64 = 1;

/// Facades of one style with their architecture, and facades of another style.
pub struct Source {
    /// `shipped` or `ecp2011`.
    pub dataset: &'static str,
    /// Facades of the style that is studied.
    pub grids: Vec<LabelGrid>,
    /// Their architecture, in the same order.
    pub architecture: Vec<Architecture>,
    /// `shipped_plain` or `graz50`.
    pub other_dataset: &'static str,
    /// Facades of another style; empty when the user has none.
    pub other: Vec<LabelGrid>,
}

/// The made facades, and ECP2011 with Graz2012 when the user has them; fewer of each at the smoke
/// budget.
pub fn sources(ctx: &mut Context) -> Result<Vec<Source>> {
    let mut sources = vec![made(ctx.budget())];
    if let Some(mut source) = ecp(ctx)? {
        if ctx.budget() == Budget::Smoke {
            source.grids.truncate(24);
            source.architecture.truncate(24);
            source.other.truncate(8);
        }
        sources.push(source);
    }
    Ok(sources)
}

fn made(budget: Budget) -> Source {
    let (count, others) = budget.choose((16, 6), (60, 30), (60, 30));
    let (grids, architecture) = (0..count).map(|i| made::boulevard(MADE_SEED, i)).unzip();
    Source {
        dataset: "shipped",
        grids,
        architecture,
        other_dataset: "shipped_plain",
        other: (0..others).map(|i| made::plain(MADE_SEED, i)).collect(),
    }
}

fn ecp(ctx: &mut Context) -> Result<Option<Source>> {
    let Some(labels) = ctx.real("facades/ecp2011/labels")? else {
        return Ok(None);
    };
    let Some(lines) = ctx.real("facades/ecp2011/floor_column_lines")? else {
        return Ok(None);
    };
    let grids = label_images(&labels)?;
    let annotations = Annotations::read(&lines)?;
    let architecture = grids
        .iter()
        .map(|grid| annotations.architecture(grid))
        .collect::<Result<_>>()?;
    let other = match ctx.real("facades/graz50/labels")? {
        Some(folder) => label_images(&folder)?,
        None => Vec::new(),
    };
    Ok(Some(Source {
        dataset: "ecp2011",
        grids,
        architecture,
        other_dataset: "graz50",
        other,
    }))
}

/// All label images of a folder, in the order of their file names.
///
/// # Errors
/// [`Error::Io`] and the readers' errors.
pub fn label_images(folder: &Path) -> Result<Vec<LabelGrid>> {
    let entries = std::fs::read_dir(folder).map_err(|e| Error::io(folder, "read", e))?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| Error::io(folder, "read", e))?.path();
        if path.extension().is_some_and(|ending| ending == "png") {
            paths.push(path);
        }
    }
    paths.sort();
    paths
        .iter()
        .map(|path| read_label_grid(path, &ReadOptions::default()))
        .collect()
}
