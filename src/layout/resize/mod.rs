//! Derivation at another size with aligned edges and equal terminals (Wu et al. 2014, Sec. 5, Fig. 12).

mod apply;
mod bands;
mod bands_error;
mod contacts;
mod in_line;
mod pitch;
mod runs;
mod terminals;
#[cfg(test)]
mod tests;
mod view;

pub use bands::{Banded, resized};
pub use bands_error::{BandsError, MOST_TIMES};
pub use terminals::terminal_classes;

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use crate::regularize::{RegularizeError, align_resized};
use edifice_grammar::Derivation;
use edifice_shape::{Axis, Facade, Rect, is_background};

/// The longest way that an edge may move so that equal terminals stay equal, as a share of the facade's longer side.
pub const ALIGN_REACH: f64 = 0.25;

/// The greatest distance of edges that become one line, as a share of the facade's longer side.
pub const ALIGN_TOLERANCE: f64 = 0.004;

/// Sizes are equal up to this part of the facade's longer side, the precision of the solver.
const NOISE: f64 = 1e-6;

/// A resized facade, aligned.
#[derive(Debug, Clone, PartialEq)]
pub struct Aligned {
    /// The facade; its regions are those of the derivation, in their order.
    pub facade: Facade,
    /// Labels of elements that are equal at the grammar's own size and could not be here.
    pub unequal: Vec<String>,
    /// Longest way that an edge moved, in the facade's unit.
    pub largest_move: f64,
}

/// Why a resized facade cannot be aligned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlignError {
    /// More kinds of terminals than can be told apart.
    #[error("the grammar writes {count} kinds of terminals, at most 65536 can be aligned")]
    TooManyKinds {
        /// Their number.
        count: usize,
    },
    /// The quadratic program, or a derivation that is no tiling.
    #[error(transparent)]
    Regularize(#[from] RegularizeError),
}

/// Aligns the edges of `resized`, so that terminals that are equal in `own`, a derivation by the same rules at
/// the grammar's own size, are equal again. Along an axis whose extent is the own one nothing moves.
///
/// # Errors
/// [`AlignError`].
pub fn align(own: &Derivation, resized: &Derivation) -> Result<Aligned, AlignError> {
    let facade = &resized.facade;
    let kinds = terminal_classes(own, resized);
    let numbers: Option<Vec<u16>> = kinds.iter().map(|&kind| u16::try_from(kind).ok()).collect();
    let numbers = numbers.ok_or_else(|| AlignError::TooManyKinds {
        count: kinds.iter().max().map_or(0, |most| most + 1),
    })?;
    let side = facade.width.max(facade.height);
    let (mut moved, _) =
        align_resized(facade, &numbers, ALIGN_REACH * side, ALIGN_TOLERANCE * side)?;
    // Sums of coordinates may be off in the last digit.
    (moved.width, moved.height) = (facade.width, facade.height);
    let still = (
        facade.width == own.facade.width,
        facade.height == own.facade.height,
    );
    for (region, derived) in moved.regions.iter_mut().zip(&facade.regions) {
        let (new, old) = (region.rect, derived.rect);
        let (x, width) = if still.0 {
            (old.x, old.width)
        } else {
            (new.x, new.width)
        };
        let (y, height) = if still.1 {
            (old.y, old.height)
        } else {
            (new.y, new.height)
        };
        region.rect = Rect::new(x, y, width, height);
    }
    let edges = |rect: &Rect| [rect.x, rect.right(), rect.y, rect.top()];
    let pairs = moved.regions.iter().zip(&facade.regions);
    let moves = pairs.flat_map(|(new, old)| {
        let pairs = edges(&new.rect).into_iter().zip(edges(&old.rect));
        pairs.map(|(new, old)| (new - old).abs())
    });
    Ok(Aligned {
        largest_move: moves.fold(0.0, f64::max),
        unequal: unequal(&moved, &kinds),
        facade: moved,
    })
}

/// Labels of elements of one kind that have several sizes; the background has no size of its own.
fn unequal(facade: &Facade, kinds: &[usize]) -> Vec<String> {
    let noise = NOISE * facade.width.max(facade.height);
    let mut first: FxHashMap<usize, Rect> = FxHashMap::default();
    let mut labels = BTreeSet::new();
    for (region, kind) in facade.regions.iter().zip(kinds) {
        let rect = first.entry(*kind).or_insert(region.rect);
        let differs = |axis| (rect.extent(axis) - region.rect.extent(axis)).abs() > noise;
        if !is_background(&region.label) && Axis::BOTH.into_iter().any(differs) {
            labels.insert(region.label.clone());
        }
    }
    labels.into_iter().collect()
}
