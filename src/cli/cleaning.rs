//! `--clean`: label pictures as a segmentation gives them, made regular before anything else is done with them.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_io::Source;
use edifice_shape::{LabelGrid, clean, on_lattice};

/// The option.
#[derive(clap::Args)]
pub(crate) struct Cleaning {
    /// Make label pictures regular: windows and balconies on common rows and columns, straight bands behind them (exact labels
    /// stay as they are). With =PX, absorb specks and straighten edges that waver by up to PX instead (in the unit of the facade)
    #[arg(
        long,
        value_name = "PX",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "lattice",
        value_parser = how,
        allow_negative_numbers = true
    )]
    clean: Option<How>,
}

/// The two ways to clean.
#[derive(Debug, Clone, Copy, PartialEq)]
enum How {
    /// Rows and columns from element boxes.
    Lattice,
    /// Specks and edges up to a length.
    Pixels(f64),
}

fn how(text: &str) -> std::result::Result<How, String> {
    match text.parse() {
        _ if text == "lattice" => Ok(How::Lattice),
        Ok(value) => Ok(How::Pixels(value)),
        Err(_) => Err("expected a length".to_owned()),
    }
}

impl Cleaning {
    /// True if pictures are cleaned.
    pub(crate) fn is_asked(&self) -> bool {
        self.clean.is_some()
    }

    /// The way to clean, for messages.
    pub(crate) fn name(&self) -> String {
        match self.clean {
            Some(How::Pixels(tolerance)) => format!("with tolerance {tolerance}"),
            _ => "by rows and columns".to_owned(),
        }
    }

    /// A picture, cleaned if that was asked for.
    pub(crate) fn picture(&self, grid: LabelGrid) -> Result<LabelGrid> {
        match self.clean {
            None => Ok(grid),
            Some(How::Lattice) => Ok(on_lattice(&grid)),
            Some(How::Pixels(tolerance)) => {
                clean(&grid, tolerance).map_err(|e| Error::option("--clean", e.to_string()))
            }
        }
    }

    /// A file's content as a cleaned picture, if that was asked for; else as it is.
    pub(crate) fn source(&self, source: Source, path: &Path) -> Result<Source> {
        match self.clean {
            None => Ok(source),
            Some(_) => Ok(Source::Picture(self.picture(source.label_grid(path)?)?)),
        }
    }
}
