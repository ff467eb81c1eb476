//! The splitting operations that a grammar may use.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Operations besides the split, which every grammar may use (Sec. 3.1 and 4.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Operations {
    /// Repeats of one period.
    pub repeat: bool,
    /// Repeats of the form A B A B A.
    pub repeat_aba: bool,
    /// Mirrored splits.
    pub sym_split: bool,
    /// Splits along both axes at once.
    pub grid_split: bool,
}

impl Default for Operations {
    /// Split and repeat: the rules of Sec. 3.1.
    fn default() -> Self {
        Self {
            repeat: true,
            repeat_aba: false,
            sym_split: false,
            grid_split: false,
        }
    }
}

/// A name in a list of operations that is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown operation `{name}`, expected some of split, repeat, repeat_aba, sym_split, grid_split"
)]
pub struct UnknownOperation {
    /// The name that was given.
    pub name: String,
}

impl Operations {
    /// Only splits, as in Table 2.
    pub fn split_only() -> Self {
        Self {
            repeat: false,
            ..Self::default()
        }
    }

    /// The same without grid splits, whose rules are no shortest paths.
    pub(crate) fn without_grids(self) -> Self {
        Self {
            grid_split: false,
            ..self
        }
    }

    /// Split, repeat, and the extensions of Sec. 4.7.
    pub fn all() -> Self {
        Self {
            repeat: true,
            repeat_aba: true,
            sym_split: true,
            grid_split: true,
        }
    }
}

impl FromStr for Operations {
    type Err = UnknownOperation;

    /// Reads a comma-separated list, for example `split,repeat`; the split is always allowed.
    fn from_str(text: &str) -> Result<Self, UnknownOperation> {
        let mut operations = Self::split_only();
        for name in text.split(',').map(str::trim) {
            match name {
                "split" => {}
                "repeat" => operations.repeat = true,
                "repeat_aba" => operations.repeat_aba = true,
                "sym_split" => operations.sym_split = true,
                "grid_split" => operations.grid_split = true,
                _ => {
                    return Err(UnknownOperation {
                        name: name.to_owned(),
                    });
                }
            }
        }
        Ok(operations)
    }
}

impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("split")?;
        let named = [
            (self.repeat, "repeat"),
            (self.repeat_aba, "repeat_aba"),
            (self.sym_split, "sym_split"),
            (self.grid_split, "grid_split"),
        ];
        for (_, name) in named.iter().filter(|(on, _)| *on) {
            write!(f, ",{name}")?;
        }
        Ok(())
    }
}
