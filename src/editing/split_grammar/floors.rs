//! Floors and columns put in and taken out: the facade grows or shrinks by their length, where the other edits leave its size.

use super::edits::{GrammarEditError, parts};
use crate::grammar::{Grammar, Operation, Size, Start, derive_at};
use crate::rng;
use crate::shape::Axis;

/// Puts a copy of a part before it (`grows`), or takes the part out. In a repeat, a period comes or goes.
///
/// All facades of the grammar that the rule has a part in change with it: where the rule's region spans the facade, by the
/// length of the part, so that all others keep theirs; else by the same share of the region's extent.
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
        .map(|(k, s)| extent(grammar, rule, k, s));
    let extents: Vec<Option<(Axis, f64)>> = extents.collect::<Result<_, _>>()?;
    let operation = grammar.rules.get(rule).map(|r| &r.operation);
    let is_repeat = matches!(operation, Some(Operation::Repeat { .. }));
    // The length of what comes or goes, as a share of a region of this extent.
    let share: Box<dyn Fn(f64) -> f64> = if is_repeat {
        let list = parts(grammar, rule, part)?;
        let period: f64 = list.sizes().iter().sum();
        Box::new(move |extent| 1.0 / (extent / period).round().max(1.0))
    } else {
        let mut list = parts(grammar, rule, part)?;
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
        let Some((axis, extent)) = found else {
            continue;
        };
        let side = match axis {
            Axis::X => &mut start.width,
            Axis::Y => &mut start.height,
        };
        let by = share(extent);
        let by = if grows { by } else { -by };
        if !(by.is_finite() && by > -1.0 + 1e-9) {
            let (size, room) = (*side * by, *side);
            return Err(GrammarEditError::Size {
                rule,
                part,
                size,
                room,
            });
        }
        *side += *side * by;
    }
    Ok(())
}

fn is_relative(size: Size) -> bool {
    matches!(size, Size::Relative(_))
}

/// Axis and greatest extent of a rule's regions in a facade; `None` where it has none.
fn extent(
    grammar: &Grammar,
    rule: usize,
    index: usize,
    start: &Start,
) -> Result<Option<(Axis, f64)>, GrammarEditError> {
    let operation = grammar.rules.get(rule).map(|r| &r.operation);
    let Some(
        Operation::Split { axis, .. }
        | Operation::Repeat { axis, .. }
        | Operation::SymSplit { axis, .. },
    ) = operation
    else {
        return Ok(None);
    };
    // The same rules as those that are shown.
    let mut rng = rng::stream(0, "grammar derive", 0);
    let made = derive_at(grammar, index, start.width, start.height, &mut rng)?;
    let own = made.non_terminals.iter().filter(|n| n.rule == rule);
    let longest = own.map(|n| n.rect.extent(*axis)).max_by(f64::total_cmp);
    Ok(longest.map(|extent| (*axis, extent)))
}
