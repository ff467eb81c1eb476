//! The regions of a parse that rules split, one after another.

use super::rules::{Rules, Symbol};
use super::tree::{Parse, Slot, index, slots};

/// A region that a rule splits.
pub(super) struct Split<'r> {
    /// The rule.
    pub rule: u32,
    /// The counts of its repeats, in order.
    pub counts: &'r [u32],
    /// Its parts in order.
    pub slots: &'r [Slot],
    /// Their sizes in steps, the last one's too.
    pub sizes: &'r [u32],
}

/// Walks a parse that fits the rules, a region before what is inside it, in the order of its parameters.
pub(super) fn regions(parse: &Parse, rules: &Rules, mut visit: impl FnMut(&Split<'_>)) {
    let (mut counts, mut sizes) = (parse.counts.iter().copied(), parse.sizes.iter().copied());
    let mut stack = vec![(parse.root, parse.extent)];
    while let Some((symbol, extent)) = stack.pop() {
        let Symbol::Rule(rule) = symbol else { continue };
        let written = rules.rule(rule);
        let repeats = written.items.iter().filter(|item| item.is_repeat()).count();
        let own_counts: Vec<u32> = counts.by_ref().take(repeats).collect();
        let slots = slots(written, &own_counts);
        let along = index(written.axis);
        let mut own_sizes: Vec<u32> = sizes.by_ref().take(slots.len() - 1).collect();
        own_sizes.push(extent[along].saturating_sub(own_sizes.iter().sum()));
        visit(&Split {
            rule,
            counts: &own_counts,
            slots: &slots,
            sizes: &own_sizes,
        });
        for (slot, &size) in slots.iter().zip(&own_sizes).rev() {
            let mut part = extent;
            part[along] = size;
            stack.push((slot.symbol, part));
        }
    }
}
