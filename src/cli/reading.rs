//! The reading of facades, for every command that reads them.

use std::path::{Path, PathBuf};

use edifice_base::Result;
use edifice_io as io;
use edifice_io::{LabelMap, ReadOptions, Source};

use super::print;

/// Options of reading.
#[derive(clap::Args)]
pub(crate) struct Reading {
    /// Meaning of the colours or numbers of label images and text matrices, as JSON
    #[arg(long, value_name = "FILE")]
    label_map: Option<PathBuf>,
    /// Read a colour that the label map does not name as the nearest one (blended colours, JPEG)
    #[arg(long)]
    nearest_colour: bool,
    /// Image of a COCO file that has several: its file name, or its number
    #[arg(long, value_name = "NAME")]
    image: Option<String>,
}

impl Reading {
    /// The options of the library; reads the label map.
    pub(crate) fn options(&self) -> Result<ReadOptions> {
        Ok(ReadOptions {
            label_map: self.label_map.as_deref().map(LabelMap::read).transpose()?,
            nearest_colour: self.nearest_colour,
            image: self.image.clone(),
            size: None,
        })
    }
}

/// Reads a facade file and tells what was not read exactly.
pub(crate) fn source(path: &Path, options: &ReadOptions) -> Result<Source> {
    let (source, nearest) = io::read_noted(path, options)?;
    if let Some(nearest) = nearest {
        print::message(&format!("note: {}: {nearest}", path.display()));
    }
    if let (Source::Picture(grid), None) = (&source, &options.label_map)
        && grid.labels.iter().all(|label| label.parse::<f64>().is_ok())
    {
        let numbers = grid.labels.join(", ");
        print::message(&format!(
            "warning: {}: the labels are numbers ({numbers}); --label-map says what they mean",
            path.display()
        ));
    }
    Ok(source)
}
