//! Size-independent grammars, for derivation at any size (Wu et al. 2014, Sec. 5), and changes of unit.

use super::{Grammar, Operation, Size};
use edifice_shape::Axis;

/// A part is thin when it takes at most this fraction of the facade along its axis ...
pub const THIN_OF_FACADE: f64 = 0.025;

/// ... and at most this fraction of each part beside it.
pub const THIN_OF_NEIGHBOUR: f64 = 0.5;

/// Makes a grammar size-independent: sizes become relative, so that they divide whatever space
/// there is in proportion, and a repeat puts as many periods as fit and rescales them slightly
/// (Wu et al. 2014, Sec. 5).
///
/// Thin structures (window frames, sills, cornices) keep their absolute size. The paper names no
/// test; here a part is thin when its size is at most [`THIN_OF_FACADE`] of the facade's extent
/// along the axis (the smallest over the starts) and at most [`THIN_OF_NEIGHBOUR`] of each part
/// beside it in its rule, periods counted as touching. Every rule gets a relative part, of a grid
/// its columns and its rows do. Where a rule already has one, its author has said what gives way, and
/// its sizes stay as they are.
pub fn size_independent(grammar: &Grammar) -> Grammar {
    let extent = |axis: Axis| {
        let extents = grammar.starts.iter().map(|s| match axis {
            Axis::X => s.width,
            Axis::Y => s.height,
        });
        extents.fold(f64::INFINITY, f64::min)
    };
    let mut out = grammar.clone();
    for rule in &mut out.rules {
        match &mut rule.operation {
            Operation::Split { axis, successors } => {
                let sizes = successors.iter_mut().map(|s| &mut s.size).collect();
                relax(sizes, extent(*axis), Ends::Open);
            }
            Operation::Repeat { axis, successors } => {
                let sizes = successors.iter_mut().map(|s| &mut s.size).collect();
                relax(sizes, extent(*axis), Ends::Cyclic);
            }
            Operation::RepeatAba { axis, a, b } => {
                relax(vec![&mut a.size, &mut b.size], extent(*axis), Ends::Cyclic);
            }
            Operation::SymSplit {
                axis, successors, ..
            } => {
                let sizes = successors.iter_mut().map(|s| &mut s.size).collect();
                relax(sizes, extent(*axis), Ends::Open);
            }
            Operation::GridSplit { columns, rows, .. } => {
                relax(columns.iter_mut().collect(), extent(Axis::X), Ends::Open);
                relax(rows.iter_mut().collect(), extent(Axis::Y), Ends::Open);
            }
        }
    }
    out
}

/// The ends of a list of parts: `Cyclic` if the first and the last touch.
#[derive(PartialEq)]
enum Ends {
    Open,
    Cyclic,
}

/// Makes sizes relative, except thin ones; none when one is relative already.
fn relax(sizes: Vec<&mut Size>, facade: f64, ends: Ends) {
    if sizes.iter().any(|size| matches!(size, Size::Relative(_))) {
        return;
    }
    let values: Vec<f64> = sizes.iter().map(|s| s.value()).collect();
    let n = values.len();
    let thin = |i: usize| {
        let before = match i {
            0 if ends == Ends::Cyclic => values[n - 1],
            0 => f64::INFINITY,
            _ => values[i - 1],
        };
        let after = match i + 1 {
            j if j < n => values[j],
            _ if ends == Ends::Cyclic => values[0],
            _ => f64::INFINITY,
        };
        values[i] <= THIN_OF_FACADE * facade && values[i] <= THIN_OF_NEIGHBOUR * before.min(after)
    };
    let keep: Vec<bool> = (0..n).map(|i| n > 1 && thin(i)).collect();
    for (size, keep) in sizes.into_iter().zip(keep) {
        if !keep {
            *size = Size::Relative(size.value());
        }
    }
}

/// The grammar in another unit: every size, relative ones too since a repeat counts its periods
/// with them, times `factor`.
pub fn scaled(grammar: &Grammar, factor: f64, unit: &str) -> Grammar {
    let mut out = grammar.clone();
    unit.clone_into(&mut out.unit);
    for start in &mut out.starts {
        start.width *= factor;
        start.height *= factor;
    }
    let scale = |size: &mut Size| match size {
        Size::Absolute(v) | Size::Relative(v) => *v *= factor,
    };
    for rule in &mut out.rules {
        match &mut rule.operation {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => {
                successors.iter_mut().for_each(|s| scale(&mut s.size));
            }
            Operation::RepeatAba { a, b, .. } => {
                scale(&mut a.size);
                scale(&mut b.size);
            }
            Operation::GridSplit { columns, rows, .. } => {
                columns.iter_mut().chain(rows).for_each(scale);
            }
        }
    }
    out
}
