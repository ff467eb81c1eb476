//! Floors and columns put in and taken out: the facade grows or shrinks by their length, where the other edits leave its size.
//!
//! A region of the rule has the length `e = a A + r R`: `A` and `R` are the sums of the absolute and the relative sizes in
//! it, `a` (as a rule 1) and `r` the lengths of sizes of 1. With the new sums at the same `a` and `r` it would have the length
//! `e'`: its other parts stay as they are. While every repeat around it keeps its number of periods, `e` depends linearly on
//! the length `w` of the facade, `de / dw = g`, so that the facade becomes `w' = w + (e' - e) / g` long. None of `a`, `r` and `g` changes by
//! that, so that what is put in and taken out again leaves the outline as it was; and the facade, unless a repeat had to get other sizes
//! for its number of periods ([`settle`]), which may be another one in another region of its rule.

use super::error::GrammarEditError;
use super::place::Place;
use super::reach::{LEAST_GROWTH, Laid, Reach, periods, reach};
use super::rule_axis::{RuleAxis, along_mut, repeats, totals};
use edifice_grammar::{Grammar, GrammarError, Size};
use edifice_shape::Axis;

/// Puts a copy of a part, or of a column or row of a grid, before it (`grows`), or takes it out. In a repeat, a period comes or goes.
///
/// All facades of the grammar that the rule has a region in change with it, so that one region of it ([`Reach`]) changes by
/// the length of what comes or goes and its other parts keep theirs. What stands beside that region is stretched
/// with it; repeats around it keep their numbers of periods.
///
/// # Errors
/// [`GrammarEditError`].
pub(super) fn change(
    grammar: &mut Grammar,
    rule: usize,
    place: Place,
    grows: bool,
) -> Result<(), GrammarEditError> {
    let axis = RuleAxis::of(grammar, rule, place)?.axis;
    let found = (0..grammar.starts.len()).map(|k| reach(grammar, rule, axis, k));
    let found: Vec<Option<Reach>> = found.collect::<Result<_, _>>()?;
    let before = grammar.rules[rule].operation.clone();
    let index = place.index();
    let mut along = RuleAxis::of(grammar, rule, place)?;
    let size = along.sizes()[index];
    let counted = repeats(along.operation);
    match (counted, grows) {
        (true, _) => {}
        (false, true) => along.insert(index, None, size)?,
        (false, false) => along.remove(index)?,
    }
    let after = grammar.rules[rule].operation.clone();
    let mut first = true;
    for (index, found) in found.iter().enumerate() {
        let Some(Reach { own, around }) = found else {
            continue;
        };
        if own.growth < LEAST_GROWTH {
            return Err(GrammarEditError::Fixed { rule });
        }
        let count = match (counted, grows) {
            (false, _) => 1,
            (true, true) => own.periods + 1,
            (true, false) => own.periods - 1,
        };
        let refused = |size, room| GrammarEditError::Size {
            rule,
            part: place,
            size,
            room,
        };
        if count == 0 {
            return Err(refused(0.0, 0.0));
        }
        let [a, b] = [(&before, own.periods), (&after, count)];
        let came = own.length(totals(b.0, axis, b.1)) - own.length(totals(a.0, axis, a.1));
        let by = came / own.growth;
        let start = &mut grammar.starts[index];
        let side = match axis {
            Axis::X => &mut start.width,
            Axis::Y => &mut start.height,
        };
        if !(by.is_finite() && *side + by > 1e-9 * *side) {
            return Err(refused(came, own.extent));
        }
        *side += by;
        // The rules are shared: they follow the first facade.
        if std::mem::take(&mut first) {
            if counted {
                settle(grammar, axis, own, own.extent + came, count)?;
            }
            for repeat in around {
                let extent = repeat.extent + by * repeat.growth;
                settle(grammar, axis, repeat, extent, repeat.periods)?;
            }
        }
    }
    Ok(())
}

/// Changes the relative sizes of a repeat with the length of its region, so that it takes that number of periods there.
fn settle(
    grammar: &mut Grammar,
    axis: Axis,
    laid: &Laid,
    extent: f64,
    count: usize,
) -> Result<(), GrammarError> {
    let [absolute, relative] = totals(&grammar.rules[laid.rule].operation, axis, count);
    let unit = (extent - laid.units[0] * absolute) / relative;
    if !(unit.is_finite() && unit > 0.0) {
        return Ok(());
    }
    // In proportion to the region; a repeat that itself gets a period stays as it is.
    let factor = match count == laid.periods {
        true => unit / laid.units[1],
        false => 1.0,
    };
    scale(grammar, laid.rule, axis, factor);
    if periods(grammar, laid.rule, axis, extent)? != count {
        // Where that is not enough they become the lengths that they have.
        scale(grammar, laid.rule, axis, unit / factor);
    }
    Ok(())
}

/// Multiplies the relative sizes of a rule along an axis.
fn scale(grammar: &mut Grammar, rule: usize, axis: Axis, factor: f64) {
    for size in along_mut(&mut grammar.rules[rule].operation, axis) {
        if let Size::Relative(v) = size {
            *v *= factor;
        }
    }
}
