//! The walk that counts, writes, reads and draws a facade: root, extents, then region by region counts and sizes.

use super::coder::Coder;
use super::counts::{self, CountTable, CountTrust};
use super::extents::ExtentTable;
use super::rules::{Rules, Symbol};
use super::sizes::{self, Question, SizeMemory, SizeTable, Trust};
use super::structure::{Speller, StructureTable};
use super::tree::{Parse, index, slots};
use edifice_shape::Axis;

/// Most regions of a facade that is read from a code.
const REGION_LIMIT: usize = 1 << 22;

/// Everything that a library knows about its facades, and how far it is to be trusted.
#[derive(Debug, Clone, Default)]
pub struct Tables {
    /// Roots and rules.
    pub structure: StructureTable,
    /// Width and height.
    pub extents: [ExtentTable; 2],
    /// Counts of repeats.
    pub counts: CountTable,
    /// Sizes of parts.
    pub sizes: SizeTable,
    /// Which predictors of counts are right.
    pub count_trust: CountTrust,
    /// Which predictors of sizes are right.
    pub trust: Trust,
}

impl Tables {
    /// Adds what a facade shows, or takes it away; rules and trust stay.
    pub fn change(&mut self, parse: &Parse, rules: &Rules, more: bool) {
        self.structure.change_root(parse.root, more);
        for (table, &extent) in self.extents.iter_mut().zip(&parse.extent) {
            table.change(extent, more);
        }
        let (counts, sizes) = (&mut self.counts, &mut self.sizes);
        questions(
            parse,
            rules,
            |repeat, axis, count| counts.change(repeat, axis, count, more),
            |at, size| {
                sizes.change(at, size, more);
            },
        );
    }
}

/// Walks a parse; tells each count and each size with the question it answers.
pub(super) fn questions(
    parse: &Parse,
    rules: &Rules,
    mut tell_count: impl FnMut(counts::Repeat, Axis, u32),
    mut tell_size: impl FnMut(&Question, u32),
) {
    let (mut counts, mut sizes) = (parse.counts.iter().copied(), parse.sizes.iter().copied());
    let mut stack = vec![(parse.root, [0, 0], parse.extent)];
    while let Some((symbol, corner, extent)) = stack.pop() {
        let Symbol::Rule(rule) = symbol else { continue };
        let written = rules.rule(rule);
        let along = index(written.axis);
        let mut own_counts = Vec::new();
        for (item, _) in written
            .items
            .iter()
            .enumerate()
            .filter(|(_, item)| item.is_repeat())
        {
            let count = counts.next().unwrap_or(2);
            tell_count((rule, item as u32), written.axis, count);
            own_counts.push(count);
        }
        let slots = slots(written, &own_counts);
        let first = stack.len();
        let (mut at, mut left) = (corner, extent[along]);
        for (k, slot) in slots.iter().enumerate() {
            let size = if k + 1 < slots.len() {
                sizes.next().unwrap_or(1)
            } else {
                left
            };
            if k + 1 < slots.len() {
                let question = Question {
                    rule,
                    axis: written.axis,
                    extent: extent[along],
                    slot: *slot,
                    start: at[along],
                    max: left,
                    mirrored: None,
                };
                tell_size(&question, size);
            }
            let mut part = extent;
            part[along] = size;
            stack.push((slot.symbol, at, part));
            at[along] += size;
            left = left.saturating_sub(size);
        }
        stack[first..].reverse();
    }
}

/// Walks one facade with a coder: `rules` are those of the library and grow by new ones; `known` is the facade
/// that is written, with its own rules. `trust` is learnt from as the walk goes. None where the coder has no
/// choice, or a code is not one of a facade.
pub(super) fn walk<C: Coder>(
    coder: &mut C,
    tables: &Tables,
    (trust, count_trust): (&mut Trust, &mut CountTrust),
    rules: &mut Rules,
    known: Option<(&Parse, &Rules)>,
) -> Option<Parse> {
    let library = (rules.labels().len(), rules.rules().len());
    let mut speller = Speller {
        coder: &mut *coder,
        table: &tables.structure,
        rules,
        known: known.map(|known| known.1),
        library,
    };
    let root = speller.root(known.map(|known| known.0.root))?;
    let mut extent = [0, 0];
    for (k, table) in tables.extents.iter().enumerate() {
        extent[k] = table.choose(coder, known.map(|known| known.0.extent[k]))?;
    }
    let mut parse = Parse {
        root,
        extent,
        counts: Vec::new(),
        sizes: Vec::new(),
    };
    let (mut seen_counts, mut memory) = (CountTable::default(), SizeMemory::default());
    let mut stack = vec![(root, [0, 0], extent)];
    let mut regions = 0;
    while let Some((symbol, corner, extent)) = stack.pop() {
        let Symbol::Rule(rule) = symbol else { continue };
        let written = rules.rule(rule);
        let axis = written.axis;
        let along = index(axis);
        let mut own_counts = Vec::new();
        for (item, _) in written
            .items
            .iter()
            .enumerate()
            .filter(|(_, item)| item.is_repeat())
        {
            let value = known.map(|known| known.0.counts[parse.counts.len()]);
            let asked = ((rule, item as u32), axis, extent[along]);
            let count = counts::choose(
                coder,
                &tables.counts,
                &mut seen_counts,
                count_trust,
                asked,
                value,
            )?;
            own_counts.push(count);
            parse.counts.push(count);
        }
        let slots = slots(written, &own_counts);
        regions += slots.len();
        if slots.len() > extent[along] as usize || regions > REGION_LIMIT {
            return None;
        }
        let first = stack.len();
        let (mut at, mut left) = (corner, extent[along]);
        let mut own_sizes: Vec<u32> = Vec::with_capacity(slots.len());
        for (k, slot) in slots.iter().enumerate() {
            let after = (slots.len() - 1 - k) as u32;
            let size = if after == 0 {
                left
            } else {
                let mirror = slots.len() - 1 - k;
                let mirrored =
                    (mirror < k && slots[mirror].symbol == slot.symbol).then(|| own_sizes[mirror]);
                let question = Question {
                    rule,
                    axis,
                    extent: extent[along],
                    slot: *slot,
                    start: at[along],
                    max: left - after,
                    mirrored,
                };
                let value = known.map(|known| known.0.sizes[parse.sizes.len()]);
                let size =
                    sizes::choose(coder, &tables.sizes, &mut memory, trust, &question, value)?;
                parse.sizes.push(size);
                size
            };
            own_sizes.push(size);
            let mut part = extent;
            part[along] = size;
            stack.push((slot.symbol, at, part));
            at[along] += size;
            left -= size;
        }
        stack[first..].reverse();
    }
    Some(parse)
}
