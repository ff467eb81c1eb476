//! The places of a rule's successors in its rectangle.

use super::limits::{REGION_LIMIT, TOLERANCE};
use super::{Grammar, GrammarError, Operation, Rule, Size, summable};
use edifice_shape::{Axis, Rect};

/// Absolute sizes keep what is written while they leave the relative ones beside them this share of the region, or
/// of what is written for them if that is less. Else all sizes of the rule, relative ones as they are written, divide the
/// region in proportion, so that parts of parts of parts never vanish.
pub const LEAST_SHARE: f64 = 0.5;

/// The treatment of regions in which absolute sizes leave nothing for the relative ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fit {
    /// The grammar is wrong.
    AsWritten,
    /// The absolute ones shrink ([`LEAST_SHARE`]).
    Shrink,
}

/// A part along one axis: index of the written successor, offset from the start, extent.
type Part = (usize, f64, f64);

/// Lays out the successors of a rule in `rect`: visits the index of each successor, in the order of
/// [`Operation::symbols`], with its rectangle, from left to right or bottom to top (a grid: row by
/// row from the bottom). Nothing is allocated for the periods of a repeat, whose number follows from
/// sizes that a file may state.
///
/// Absolute sizes must fill the rectangle up to `tolerance`. Where there are relative sizes they
/// share what the absolute ones leave, in proportion; a repeat then takes the whole number of
/// periods nearest to its nominal sizes, at least one (Wu et al. 2014, Sec. 5).
///
/// Returns the factor by which the absolute sizes shrank to leave something, 1 as a rule.
///
/// The mirror image of `sym_split` mirrors the *order* of the successors, not their contents: a
/// symbol means the same content wherever it stands.
pub(super) fn place(
    index: usize,
    rule: &Rule,
    rect: Rect,
    tolerance: f64,
    fit: Fit,
    mut visit: impl FnMut(usize, Rect),
) -> Result<f64, GrammarError> {
    let along = |axis: Axis| SplitAxis {
        index,
        rule,
        axis,
        extent: rect.extent(axis),
        tolerance,
        fit,
    };
    let mut strip = |axis: Axis, (i, at, extent): Part| {
        visit(i, rect.strip(axis, rect.start(axis) + at, extent));
    };
    Ok(match &rule.operation {
        Operation::Split { axis, successors } => {
            let sizes: Vec<Size> = successors.iter().map(|s| s.size).collect();
            along(*axis).fill(0..sizes.len(), &sizes, |part| strip(*axis, part))?
        }
        Operation::Repeat { axis, successors } => {
            let sizes: Vec<Size> = successors.iter().map(|s| s.size).collect();
            let times = along(*axis).periods(&sizes, &[], 2)?;
            let order = (0..times).flat_map(|_| 0..sizes.len());
            along(*axis).fill(order, &sizes, |part| strip(*axis, part))?
        }
        Operation::RepeatAba { axis, a, b } => {
            let sizes = [a.size, b.size];
            let times = along(*axis).periods(&sizes, &sizes[..1], 1)?;
            let order = (0..2 * times + 1).map(|i| i % 2);
            along(*axis).fill(order, &sizes, |part| strip(*axis, part))?
        }
        Operation::SymSplit {
            axis,
            successors,
            center,
        } => {
            let sizes: Vec<Size> = successors.iter().map(|s| s.size).collect();
            let mirrored = sizes.len() - usize::from(*center);
            let order = (0..sizes.len()).chain((0..mirrored).rev());
            along(*axis).fill(order, &sizes, |part| strip(*axis, part))?
        }
        Operation::GridSplit { columns, rows, .. } => {
            let (mut across, mut up) = (Vec::new(), Vec::new());
            let factor =
                along(Axis::X).fill(0..columns.len(), columns, |part| across.push(part))?;
            let other = along(Axis::Y).fill(0..rows.len(), rows, |part| up.push(part))?;
            for &(j, y, height) in &up {
                for &(i, x, width) in &across {
                    let cell = Rect::new(rect.x + x, rect.y + y, width, height);
                    visit(j * columns.len() + i, cell);
                }
            }
            factor.min(other)
        }
    })
}

/// The parts that a rule makes of a region, each with the index of the written successor, in the order in which they are laid out; and the
/// factor by which its absolute sizes shrank, 1 as a rule.
///
/// # Errors
/// [`GrammarError`] when the rule does not fit the region even so.
pub fn laid_out(
    grammar: &Grammar,
    rule: usize,
    rect: Rect,
) -> Result<(Vec<(usize, Rect)>, f64), GrammarError> {
    let tolerance = TOLERANCE * rect.width.max(rect.height);
    let written = &grammar.rules[rule];
    let tried = |fit| {
        let mut parts = Vec::new();
        let factor = place(rule, written, rect, tolerance, fit, |k, part| {
            parts.push((k, part));
        })?;
        Ok((parts, factor))
    };
    tried(Fit::AsWritten).or_else(|_: GrammarError| tried(Fit::Shrink))
}

/// One axis of the region that a rule splits.
struct SplitAxis<'a> {
    index: usize,
    rule: &'a Rule,
    axis: Axis,
    extent: f64,
    tolerance: f64,
    fit: Fit,
}

impl SplitAxis<'_> {
    /// The number of periods of `sizes` that fit beside `fixed` (the closing A of `repeat_aba`).
    fn periods(&self, sizes: &[Size], fixed: &[Size], least: u32) -> Result<usize, GrammarError> {
        let period: f64 = sizes.iter().map(|s| s.value()).sum();
        let room = self.extent - fixed.iter().map(|s| s.value()).sum::<f64>();
        let exact = sizes.iter().all(|s| matches!(s, Size::Absolute(_)));
        let mut times = (room / period).round();
        if exact {
            let fits = (times * period - room).abs() <= self.tolerance;
            if times < f64::from(least) || !fits {
                return Err(GrammarError::RepeatDoesNotFit {
                    rule: self.index,
                    symbol: self.rule.symbol.clone(),
                    axis: self.axis,
                    period,
                    extent: room,
                    times: room / period,
                    least,
                });
            }
        } else {
            // Never so many that the absolute parts alone overflow the region.
            let absolute = absolute_sum(sizes);
            if absolute > 0.0 {
                let free = self.extent - absolute_sum(fixed);
                times = times.min((free / absolute).ceil() - 1.0);
            }
            times = times.max(1.0);
        }
        if times * sizes.len() as f64 > REGION_LIMIT as f64 {
            return Err(GrammarError::TooManyRegions {
                limit: REGION_LIMIT,
            });
        }
        Ok(times as usize)
    }

    /// Visits the offsets and extents of the parts `order`, whose sizes are `sizes[order[..]]`; returns the factor by which
    /// their absolute sizes shrank.
    fn fill(
        &self,
        order: impl Iterator<Item = usize> + Clone,
        sizes: &[Size],
        mut visit: impl FnMut(Part),
    ) -> Result<f64, GrammarError> {
        let weights = relative_summable(sizes);
        let sizes = weights.as_deref().unwrap_or(sizes);
        let (mut absolute, mut relative) = (0.0, 0.0);
        for i in order.clone() {
            match sizes[i] {
                Size::Absolute(v) => absolute += v,
                Size::Relative(v) => relative += v,
            }
        }
        let least = LEAST_SHARE * self.extent.min(relative);
        let shrink = self.fit == Fit::Shrink && self.extent - absolute < least;
        let (factor, scale) = if relative > 0.0 && shrink {
            let factor = self.extent / (absolute + relative);
            (factor, factor)
        } else if relative > 0.0 {
            (1.0, (self.extent - absolute) / relative)
        } else if (absolute - self.extent).abs() <= self.tolerance {
            (1.0, 1.0)
        } else {
            return Err(GrammarError::SizesDoNotAddUp {
                rule: self.index,
                symbol: self.rule.symbol.clone(),
                axis: self.axis,
                sum: absolute,
                extent: self.extent,
            });
        };
        let mut at = 0.0;
        for i in order {
            let extent = match sizes[i] {
                Size::Absolute(v) => v * factor,
                Size::Relative(v) => v * scale,
            };
            if extent.is_nan() || extent <= 0.0 {
                return Err(GrammarError::TooSmall {
                    rule: self.index,
                    symbol: self.rule.symbol.clone(),
                    axis: self.axis,
                    needed: absolute,
                    extent: self.extent,
                });
            }
            visit((i, at, extent));
            at += extent;
        }
        Ok(factor)
    }
}

/// The sizes with smaller weights in the same proportions, where the sum of the weights is not finite.
fn relative_summable(sizes: &[Size]) -> Option<Vec<Size>> {
    let weight = |size: &Size| match size {
        Size::Absolute(_) => 0.0,
        Size::Relative(v) => *v,
    };
    let weights: Vec<f64> = sizes.iter().map(weight).collect();
    let smaller = summable(&weights);
    (smaller != weights).then(|| {
        let pairs = sizes.iter().zip(smaller);
        pairs
            .map(|(size, weight)| match size {
                Size::Absolute(_) => *size,
                Size::Relative(_) => Size::Relative(weight),
            })
            .collect()
    })
}

/// Sum of the absolute ones of `sizes`.
fn absolute_sum(sizes: &[Size]) -> f64 {
    let absolute = |s: &Size| match s {
        Size::Absolute(v) => *v,
        Size::Relative(_) => 0.0,
    };
    sizes.iter().map(absolute).sum()
}
