//! Pairs of a given and a whole lattice of windows as NumPy archives: the evaluation sets of Hensel et al. 2021, *Facade Layout
//! Completion with Long Short-Term Memory Networks*.
//!
//! `X` (given) and `Y` (whole) are arrays of truth values, pairs x rows x columns, the upper row first.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use npyz::{NpyFile, Order};
use zip::ZipArchive;

use edifice_base::{Error, Result};

/// A lattice of cells, each with or without a window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lattice {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Cells row by row, the upper row first.
    pub cells: Vec<bool>,
}

/// A lattice of which windows are missing, and the same one whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LatticePair {
    /// The cells that are given.
    pub given: Lattice,
    /// All cells.
    pub whole: Lattice,
}

/// Reasons why an archive holds no pairs of lattices.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// It cannot be unpacked, or has no array of this name.
    #[error("{0}")]
    Archive(#[from] zip::result::ZipError),
    /// An array that cannot be read.
    #[error("{0}")]
    Array(#[from] std::io::Error),
    /// An array of other values than truth values.
    #[error("{0}")]
    Values(#[from] npyz::DTypeError),
    /// An array in column-major order, or of a number of dimensions other than three.
    #[error("an array of shape {0:?}, expected pairs x rows x columns in row-major order")]
    Shape(Vec<u64>),
    /// Arrays of different shape.
    #[error("X has the shape {given:?}, Y {whole:?}")]
    Unequal {
        /// Shape of `X`.
        given: [usize; 3],
        /// Shape of `Y`.
        whole: [usize; 3],
    },
}

/// Reads all pairs of an archive.
///
/// # Errors
/// [`Error::Io`] when it cannot be opened, [`LatticeError`] with the name of the array otherwise.
pub fn read(path: &Path) -> Result<Vec<LatticePair>> {
    let file = File::open(path).map_err(|e| Error::io(path, "open", e))?;
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(|e| Error::content(path, e))?;
    let mut array = |name: &str| {
        lattices(&mut archive, name).map_err(|e| Error::input(path, format!("array {name}"), e))
    };
    let ((given_shape, given), (whole_shape, whole)) = (array("X")?, array("Y")?);
    if given_shape != whole_shape {
        let error = LatticeError::Unequal {
            given: given_shape,
            whole: whole_shape,
        };
        return Err(Error::content(path, error));
    }
    let pairs = given.into_iter().zip(whole);
    Ok(pairs
        .map(|(given, whole)| LatticePair { given, whole })
        .collect())
}

fn lattices(
    archive: &mut ZipArchive<BufReader<File>>,
    name: &str,
) -> std::result::Result<([usize; 3], Vec<Lattice>), LatticeError> {
    let file = NpyFile::new(archive.by_name(&format!("{name}.npy"))?)?;
    let &[pairs, rows, columns] = file.shape() else {
        return Err(LatticeError::Shape(file.shape().to_vec()));
    };
    if file.order() != Order::C || rows == 0 || columns == 0 {
        return Err(LatticeError::Shape(file.shape().to_vec()));
    }
    let (rows, columns) = (rows as usize, columns as usize);
    let mut cells = Vec::new();
    for cell in file.data::<bool>()? {
        cells.push(cell?);
    }
    let each = cells.chunks(rows * columns).map(|cells| Lattice {
        rows,
        columns,
        cells: cells.to_vec(),
    });
    Ok(([pairs as usize, rows, columns], each.collect()))
}
