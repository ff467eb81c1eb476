//! The region of a rule that floors and columns are put into, and what is around it.

use super::rule_axis::{along, index_along, repeats, totals};
use edifice_base::rng;
use edifice_grammar::{Derivation, Grammar, GrammarError, Operation, Size, derive_at, laid_out};
use edifice_shape::{Axis, Rect};

/// Growths that differ by less of the larger one are the same.
const SAME: f64 = 1e-6;

/// A region that grows by less of what the facade grows by has a fixed length.
pub(super) const LEAST_GROWTH: f64 = 1e-6;

/// The layout of a rule along an axis in a region.
#[derive(Debug, Clone)]
pub(super) struct Laid {
    /// The rule.
    pub rule: usize,
    /// Length of the region.
    pub extent: f64,
    /// The growth of the region for a growth of 1 of the facade, while all repeats around it keep their numbers of
    /// periods.
    pub growth: f64,
    /// Periods of a repeat; 1 of other rules.
    pub periods: usize,
    /// Lengths of an absolute and of a relative size of 1.
    pub units: [f64; 2],
}

impl Laid {
    /// The layout of the rule in a region, with the parts that it makes of it.
    fn new(
        grammar: &Grammar,
        rule: usize,
        rect: Rect,
        axis: Axis,
        growth: f64,
    ) -> Result<(Self, Vec<(usize, Rect)>), GrammarError> {
        let (parts, factor) = laid_out(grammar, rule, rect)?;
        let operation = &grammar.rules[rule].operation;
        let periods = match operation {
            Operation::Repeat { successors, .. } => parts.len() / successors.len(),
            Operation::RepeatAba { .. } => parts.len() / 2,
            _ => 1,
        };
        let extent = rect.extent(axis);
        let [absolute, relative] = totals(operation, axis, periods);
        let units = match (factor < 1.0, relative > 0.0) {
            (true, _) => [factor, factor],
            (_, true) => [1.0, (extent - absolute) / relative],
            _ => [1.0, 1.0],
        };
        let laid = Self {
            rule,
            extent,
            growth,
            periods,
            units,
        };
        Ok((laid, parts))
    }

    /// The length of the region that these sizes would fill, at the present units.
    pub(super) fn length(&self, [absolute, relative]: [f64; 2]) -> f64 {
        self.units[0] * absolute + self.units[1] * relative
    }

    /// The share of the region's growth that a part of it gets.
    fn passed_on(&self, grammar: &Grammar, axis: Axis, successor: usize, length: f64) -> f64 {
        let operation = &grammar.rules[self.rule].operation;
        let index = index_along(operation, axis, successor);
        let [_, relative] = totals(operation, axis, self.periods);
        match along(operation, axis).get(index) {
            // It lies along the other axis.
            None => 1.0,
            // All sizes are proportions.
            Some(_) if self.units[0] < 1.0 => length / self.extent,
            Some(Size::Absolute(_)) => 0.0,
            Some(Size::Relative(size)) => size / relative,
        }
    }
}

/// The region of a rule that changes by the length of what comes or goes: the first, from left to right and from bottom to top, that
/// grows with the facade at all; of a repeat, where it matters how many periods there are, the one that grows most. Which one that is
/// does not depend on the lengths of the regions, so that it is the same before and after an edit.
pub(super) struct Reach {
    /// The region itself.
    pub own: Laid,
    /// The repeats around it along the axis.
    pub around: Vec<Laid>,
}

/// Finds it in a start of the grammar; `None` where the rule has no region.
///
/// # Errors
/// When the start cannot be derived.
pub(super) fn reach(
    grammar: &Grammar,
    rule: usize,
    axis: Axis,
    index: usize,
) -> Result<Option<Reach>, GrammarError> {
    let start = &grammar.starts[index];
    // The same rules as those that are shown.
    let mut rng = rng::stream(0, "grammar derive", 0);
    let made = derive_at(grammar, index, start.width, start.height, &mut rng)?;
    let counted = repeats(&grammar.rules[rule].operation);
    let mut best: Option<Reach> = None;
    regions(grammar, axis, &made, |own, stack| {
        let known = best.as_ref().map_or(-1.0, |b| b.own.growth);
        let better = match counted {
            true => own.growth > known * (1.0 + SAME),
            false => known < LEAST_GROWTH,
        };
        if own.rule != rule || !(known < 0.0 || better) {
            return;
        }
        let along_axis = |l: &&Laid| {
            let operation = &grammar.rules[l.rule].operation;
            repeats(operation) && !along(operation, axis).is_empty()
        };
        let around = stack.iter().map(|(l, _)| l).filter(along_axis);
        best = Some(Reach {
            own: own.clone(),
            around: around.cloned().collect(),
        });
    })?;
    Ok(best)
}

/// A region with its parts that are still to come.
type Open = (Laid, std::vec::IntoIter<(usize, Rect)>);

/// Visits all non-terminal regions with those around them.
fn regions(
    grammar: &Grammar,
    axis: Axis,
    made: &Derivation,
    mut visit: impl FnMut(&Laid, &[Open]),
) -> Result<(), GrammarError> {
    let mut stack: Vec<Open> = Vec::new();
    for region in &made.non_terminals {
        stack.truncate(region.depth);
        let growth = stack.last_mut().map_or(1.0, |(outer, parts)| {
            // Regions come in the order of the parts.
            let found = parts.find(|(_, rect)| *rect == region.rect);
            let length = region.rect.extent(axis);
            let passed = match found {
                Some((successor, _)) => outer.passed_on(grammar, axis, successor, length),
                None => length / outer.extent,
            };
            outer.growth * passed
        });
        let (laid, parts) = Laid::new(grammar, region.rule, region.rect, axis, growth)?;
        visit(&laid, &stack);
        stack.push((laid, parts.into_iter()));
    }
    Ok(())
}

/// The number of periods that a repeat puts into a region of this length.
///
/// # Errors
/// When it does not fit at all.
pub(super) fn periods(
    grammar: &Grammar,
    rule: usize,
    axis: Axis,
    extent: f64,
) -> Result<usize, GrammarError> {
    let rect = match axis {
        Axis::X => Rect::new(0.0, 0.0, extent, 1.0),
        Axis::Y => Rect::new(0.0, 0.0, 1.0, extent),
    };
    let (laid, _) = Laid::new(grammar, rule, rect, axis, 1.0)?;
    Ok(laid.periods)
}
