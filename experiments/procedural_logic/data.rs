//! The facades that the experiments run on.

use std::path::Path;

use super::gold::{Annotations, Architecture};
use super::{outline, shipped};
use edifice_base::{Error, Result};
use edifice_frame::{Budget, Context, layouts};
use edifice_io::{ReadOptions, read_label_grid};
use edifice_shape::{Facade, LabelGrid};

/// Sizes at which each shipped house stands: as shipped, and others.
const SIZES: u64 = 5;

/// Facades of one style with their architecture, and facades of another style.
pub struct Source {
    /// `shipped_houses`, `ecp2011`, or the name of a set of one's own.
    pub dataset: &'static str,
    /// Facades of the style that is studied.
    pub grids: Vec<LabelGrid>,
    /// Their architecture, in the same order.
    pub architecture: Vec<Architecture>,
    /// The architecture by hand annotation alone; empty without one.
    pub by_hand: Vec<Architecture>,
    /// `shipped_blocks` or `graz50`.
    pub other_dataset: &'static str,
    /// Facades of another style; empty when the user has none.
    pub other: Vec<LabelGrid>,
    /// True if pictures of it are drawn: of the shipped layouts only where there is no other set.
    pub pictured: bool,
}

impl Source {
    /// The sets of facades that there are, by name.
    pub fn sets(&self) -> impl Iterator<Item = (&'static str, &[LabelGrid])> {
        let sets = [
            (self.dataset, self.grids.as_slice()),
            (self.other_dataset, self.other.as_slice()),
        ];
        sets.into_iter().filter(|(_, grids)| !grids.is_empty())
    }

    /// True if it is the set that the paper reports on.
    pub fn is_paper(&self) -> bool {
        self.dataset == "ecp2011"
    }

    /// Name of this set's picture of an artefact: the paper's set has the plain name.
    pub fn figure(&self, artefact: &str) -> String {
        match self.dataset {
            "ecp2011" => artefact.to_owned(),
            "shipped_houses" => format!("{artefact}_shipped"),
            own => format!("{artefact}_{own}"),
        }
    }
}

/// The shipped layouts, and ECP2011 with Graz2012 when the user has them; fewer of each at the smoke
/// budget.
pub fn sources(ctx: &mut Context) -> Result<Vec<Source>> {
    let mut sources = vec![shipped_source(&shipped_layouts(ctx)?)?];
    if let Some(mut source) = ecp(ctx)? {
        if ctx.budget() == Budget::Smoke {
            source.grids.truncate(24);
            source.architecture.truncate(24);
            source.by_hand.truncate(24);
            source.other.truncate(8);
        }
        sources.push(source);
    }
    for set in ctx.own()? {
        let read = |path: &std::path::PathBuf| read_label_grid(path, &set.options);
        let grids = set.files.iter().map(read).collect::<Result<Vec<_>>>()?;
        sources.push(Source {
            dataset: set.name,
            architecture: grids.iter().map(outline::architecture).collect(),
            grids,
            by_hand: Vec::new(),
            other_dataset: "none",
            other: Vec::new(),
            pictured: true,
        });
    }
    sources[0].pictured = sources.len() == 1;
    Ok(sources)
}

/// The shipped layouts as they are; a few small ones at the smoke budget.
pub fn shipped_layouts(ctx: &mut Context) -> Result<Vec<Facade>> {
    let mut layouts = layouts::read_all(&layouts::folder(ctx)?)?;
    if ctx.budget() == Budget::Smoke {
        let (mut houses, mut blocks): (Vec<_>, Vec<_>) =
            layouts.into_iter().partition(shipped::is_house);
        houses.truncate(4);
        blocks.retain(|facade| facade.regions.len() < 550);
        blocks.truncate(4);
        houses.append(&mut blocks);
        layouts = houses;
    }
    Ok(layouts)
}

/// Houses at several sizes, first all as shipped, and blocks.
///
/// # Errors
/// [`Error::Method`] for a layout that is no tiling.
pub fn shipped_source(layouts: &[Facade]) -> Result<Source> {
    let picture = |facade| shipped::picture(facade).map_err(Error::method);
    let (houses, blocks): (Vec<_>, Vec<_>) = layouts.iter().partition(|f| shipped::is_house(f));
    let houses: Vec<LabelGrid> = houses.into_iter().map(picture).collect::<Result<_>>()?;
    let mut architecture: Vec<Architecture> = houses.iter().map(outline::architecture).collect();
    let mut grids = houses.clone();
    for copy in 2..=SIZES {
        for (index, house) in houses.iter().enumerate() {
            let grid = shipped::resized(house, copy);
            // Only where along the facade a door stands depends on sizes.
            let doors = outline::architecture(&grid).doors;
            let original = architecture[index].clone();
            architecture.push(Architecture { doors, ..original });
            grids.push(grid);
        }
    }
    Ok(Source {
        dataset: "shipped_houses",
        grids,
        architecture,
        by_hand: Vec::new(),
        other_dataset: "shipped_blocks",
        other: blocks.into_iter().map(picture).collect::<Result<_>>()?,
        pictured: true,
    })
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
    let annotated = grids.iter().filter(|_| annotations.has_balconies());
    let by_hand = annotated
        .map(|grid| annotations.by_hand(&grid.name))
        .collect::<Result<_>>()?;
    let other = match ctx.real("facades/graz50/labels")? {
        Some(folder) => label_images(&folder)?,
        None => Vec::new(),
    };
    Ok(Some(Source {
        dataset: "ecp2011",
        grids,
        architecture,
        by_hand,
        other_dataset: "graz50",
        other,
        pictured: true,
    }))
}

/// All label images of a folder, in the order of their file names.
///
/// # Errors
/// [`Error::Io`] and the readers' errors.
pub fn label_images(folder: &Path) -> Result<Vec<LabelGrid>> {
    layouts::files(folder, ".png")?
        .iter()
        .map(|path| read_label_grid(path, &ReadOptions::default()))
        .collect()
}
