//! `--wall`: boxes of elements become tilings, for what needs one.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_io::Source;
use edifice_shape::LabelGrid;

/// The label of what no box covers.
const WALL: &str = "wall";

/// The option.
#[derive(clap::Args)]
pub(crate) struct Walls {
    /// Fill what the boxes of an annotation or of an element layout leave free with `wall`, so that they are a tiling. Later
    /// boxes lie over earlier ones
    #[arg(long)]
    wall: bool,
}

impl Walls {
    /// A layout with gaps or overlaps as the picture that its regions paint on a wall, if that was asked for; anything else
    /// as it is.
    pub(crate) fn source(&self, source: Source, path: &Path) -> Result<Source> {
        match source {
            Source::Layout(facade) if self.wall && facade.check_tiling().is_err() => {
                let grid = LabelGrid::from_facade(&facade, Some(WALL));
                Ok(Source::Picture(grid.map_err(|e| Error::content(path, e))?))
            }
            source => Ok(source),
        }
    }

    /// As [`Walls::source`], for what needs a tiling.
    pub(crate) fn tiling(&self, source: Source, path: &Path) -> Result<Source> {
        let source = self.source(source, path)?;
        if let Source::Layout(facade) = &source
            && let Err(error) = facade.check_tiling()
        {
            let message = format!("{error}; --wall makes a tiling of boxes");
            return Err(Error::content(path, message));
        }
        Ok(source)
    }
}
