//! Size-independent grammars: derive at any size (Wu et al. 2014, Sec. 5).

use rand::{Rng, RngExt};
use rustc_hash::FxHashMap;

use super::check::check_structure;
use super::derive::walk;
use super::table::Table;
use super::{Derivation, Grammar, GrammarError, Operation, Size};
use crate::shape::Axis;

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
/// beside it in its rule, periods counted as touching. A rule always keeps a relative part. Sizes
/// that are already relative stay as they are.
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

/// Whether the first and last of a list of parts touch.
#[derive(PartialEq)]
enum Ends {
    Open,
    Cyclic,
}

/// Makes sizes relative, except thin ones.
fn relax(sizes: Vec<&mut Size>, facade: f64, ends: Ends) {
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
        if let Size::Absolute(value) = *size
            && !keep
        {
            *size = Size::Relative(value);
        }
    }
}

/// Whether some size is relative, so that the grammar can be derived at other sizes than its own.
pub fn is_size_independent(grammar: &Grammar) -> bool {
    grammar.rules.iter().any(|rule| {
        let relative = |size: &Size| matches!(size, Size::Relative(_));
        match &rule.operation {
            Operation::Split { successors, .. }
            | Operation::Repeat { successors, .. }
            | Operation::SymSplit { successors, .. } => {
                successors.iter().any(|s| relative(&s.size))
            }
            Operation::RepeatAba { a, b, .. } => relative(&a.size) || relative(&b.size),
            Operation::GridSplit { columns, rows, .. } => columns.iter().chain(rows).any(relative),
        }
    })
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

/// Derives a grammar in a region of `width` x `height`, in the grammar's unit.
///
/// In a stochastic grammar `rng` picks one rule for each symbol, with probability proportional to
/// the weights, at the first region of that symbol; the same rule then serves all its regions, so
/// that equal symbols stay equal within one facade (an inconsistent choice is what makes variations
/// look wrong: Wu et al. 2014, Sec. 1). A deterministic grammar takes nothing from `rng`.
///
/// # Errors
/// [`GrammarError`] for an invalid grammar, a size that is not positive, or sizes that do not fit:
/// absolute sizes that do not fill a region, or leave nothing for the relative ones.
pub fn derive_at<R: Rng>(
    grammar: &Grammar,
    start_index: usize,
    width: f64,
    height: f64,
    rng: &mut R,
) -> Result<Derivation, GrammarError> {
    let sampler = Sampler::new(grammar)?;
    sampler.derive(start_index, width, height, rng)
}

/// A grammar checked once, to be derived many times.
pub struct Sampler<'g> {
    grammar: &'g Grammar,
    table: Table<'g>,
}

impl<'g> Sampler<'g> {
    /// Checks the grammar, except that sizes fit, which depends on the size asked for.
    ///
    /// # Errors
    /// [`GrammarError`] for an invalid grammar.
    pub fn new(grammar: &'g Grammar) -> Result<Self, GrammarError> {
        let table = check_structure(grammar)?;
        Ok(Self { grammar, table })
    }

    /// As [`derive_at`].
    ///
    /// # Errors
    /// As [`derive_at`].
    pub fn derive<R: Rng>(
        &self,
        start_index: usize,
        width: f64,
        height: f64,
        rng: &mut R,
    ) -> Result<Derivation, GrammarError> {
        let count = self.grammar.starts.len();
        if start_index >= count {
            return Err(GrammarError::StartIndex {
                index: start_index,
                count,
            });
        }
        for (dimension, value) in [("width", width), ("height", height)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(GrammarError::AskedSize { dimension, value });
            }
        }
        let mut chosen: FxHashMap<usize, usize> = FxHashMap::default();
        let choose = |symbol: usize, rules: &[usize]| match rules {
            &[only] => only,
            _ => *chosen
                .entry(symbol)
                .or_insert_with(|| self.pick(rules, rng)),
        };
        walk(
            self.grammar,
            &self.table,
            start_index,
            (width, height),
            choose,
        )
    }

    /// How far the splits of a derivation are from the sizes that the grammar writes for their parts: the
    /// largest factor between the two, at least 1. Repeats fill any extent with parts of about their own
    /// size; but rules drawn for two floors, in the space of three, stretch their windows by 1.5.
    pub fn stretch(&self, derivation: &Derivation) -> f64 {
        let factors = derivation.non_terminals.iter().filter_map(|region| {
            let rule = &self.grammar.rules[region.rule];
            let Operation::Split { axis, successors } = &rule.operation else {
                return None;
            };
            let written: f64 = successors.iter().map(|s| s.size.value()).sum();
            let factor = region.rect.extent(*axis) / written;
            Some(factor.max(1.0 / factor))
        });
        factors.fold(1.0, f64::max)
    }

    /// One of the rules, with probability proportional to its weight.
    fn pick<R: Rng>(&self, rules: &[usize], rng: &mut R) -> usize {
        let weight = |rule: usize| self.grammar.rules[rule].weight.unwrap_or(1.0);
        let total: f64 = rules.iter().map(|&r| weight(r)).sum();
        let mut rest = rng.random::<f64>() * total;
        for &rule in rules {
            rest -= weight(rule);
            if rest < 0.0 {
                return rule;
            }
        }
        rules[rules.len() - 1]
    }
}
