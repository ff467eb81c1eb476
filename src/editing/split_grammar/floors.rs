//! Floors and columns put in and taken out: the facade grows or shrinks by their length, where the other edits leave its size.

use super::edits::{GrammarEditError, parts};
use crate::grammar::{Grammar, Operation, Size, Start, derive_at};
use crate::rng;
use crate::shape::Axis;

/// Share of a facade by which it is made larger to see how regions grow with it.
const STEP: f64 = 1e-4;
/// A region that grows by less of what the facade grows by has a fixed length.
const LEAST_GROWTH: f64 = 1e-6;

/// Puts a copy of a part before it (`grows`), or takes the part out. In a repeat, a period comes or goes.
///
/// All facades of the grammar that the rule has a part in change with it, so that the rule's longest region in them changes by the
/// length of the part and its other parts keep theirs. What stands beside that region is stretched with it.
///
/// # Errors
/// [`GrammarEditError`].
pub(super) fn change(
    grammar: &mut Grammar,
    rule: usize,
    part: usize,
    grows: bool,
) -> Result<(), GrammarEditError> {
    let before = grammar.starts.clone();
    let extents = before
        .iter()
        .enumerate()
        .map(|(k, s)| reach(grammar, rule, k, s));
    let extents: Vec<Option<Reach>> = extents.collect::<Result<_, _>>()?;
    let operation = grammar.rules.get(rule).map(|r| &r.operation);
    let is_repeat = matches!(operation, Some(Operation::Repeat { .. }));
    // The length of what comes or goes, as a share of a region of this extent.
    let share: Box<dyn Fn(f64) -> f64> = if is_repeat {
        let list = parts(grammar, rule, part)?;
        let period: f64 = list.sizes().iter().sum();
        Box::new(move |extent| 1.0 / (extent / period).round().max(1.0))
    } else {
        let list = parts(grammar, rule, part)?;
        let own = list.successors[part].clone();
        if grows {
            list.successors.insert(part, own.clone());
        }
        let times = list.times(part);
        let sum = |relative: bool| -> f64 {
            let of_kind = list
                .successors
                .iter()
                .enumerate()
                .filter(|(_, s)| is_relative(s.size) == relative);
            of_kind.map(|(k, s)| list.times(k) * s.size.value()).sum()
        };
        let own_length = times * own.size.value();
        let without = |total: f64, counts: bool| {
            if grows && counts {
                total - own_length
            } else {
                total
            }
        };
        let relative = is_relative(own.size);
        let (shared, fixed) = (without(sum(true), relative), without(sum(false), !relative));
        if !grows {
            if list.successors.len() == 1 {
                return Err(list.error(part, 0.0, 0.0));
            }
            list.successors.remove(part);
        }
        Box::new(move |extent| match relative {
            true => own_length / shared * (extent - fixed) / extent,
            false => own_length / extent,
        })
    };
    for (start, found) in grammar.starts.iter_mut().zip(extents) {
        let Some(reach) = found else {
            continue;
        };
        if reach.growth < LEAST_GROWTH {
            return Err(GrammarEditError::Fixed { rule });
        }
        let side = match reach.axis {
            Axis::X => &mut start.width,
            Axis::Y => &mut start.height,
        };
        let by = share(reach.extent) * reach.extent / reach.growth;
        let by = if grows { by } else { -by };
        if !(by.is_finite() && *side + by > 1e-9 * *side) {
            let (size, room) = (by, *side);
            return Err(GrammarEditError::Size {
                rule,
                part,
                size,
                room,
            });
        }
        *side += by;
    }
    Ok(())
}

fn is_relative(size: Size) -> bool {
    matches!(size, Size::Relative(_))
}

/// The longest region of a rule in a facade.
struct Reach {
    axis: Axis,
    extent: f64,
    /// By how much it grows with the facade.
    growth: f64,
}

/// The longest region of a rule in a facade; `None` where it has none.
fn reach(
    grammar: &Grammar,
    rule: usize,
    index: usize,
    start: &Start,
) -> Result<Option<Reach>, GrammarEditError> {
    let operation = grammar.rules.get(rule).map(|r| &r.operation);
    let Some(
        Operation::Split { axis, .. }
        | Operation::Repeat { axis, .. }
        | Operation::SymSplit { axis, .. },
    ) = operation
    else {
        return Ok(None);
    };
    let axis = *axis;
    let extents = |width: f64, height: f64| -> Result<Vec<f64>, GrammarEditError> {
        // The same rules as those that are shown.
        let mut rng = rng::stream(0, "grammar derive", 0);
        let made = derive_at(grammar, index, width, height, &mut rng)?;
        let own = made.non_terminals.iter().filter(|n| n.rule == rule);
        Ok(own.map(|n| n.rect.extent(axis)).collect())
    };
    let now = extents(start.width, start.height)?;
    let Some(longest) = (0..now.len()).max_by(|a, b| now[*a].total_cmp(&now[*b])) else {
        return Ok(None);
    };
    let (extent, whole) = match axis {
        Axis::X => (now[longest], start.width),
        Axis::Y => (now[longest], start.height),
    };
    // Extents depend on the facade's own linearly, as long as no repeat takes another number of periods.
    let step = STEP * whole;
    let later = match axis {
        Axis::X => extents(start.width + step, start.height)?,
        Axis::Y => extents(start.width, start.height + step)?,
    };
    let growth = match later.len() == now.len() {
        true => (later[longest] - extent) / step,
        false => extent / whole,
    };
    Ok(Some(Reach {
        axis,
        extent,
        growth,
    }))
}
