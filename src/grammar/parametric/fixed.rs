//! What one facade costs alone, sizes included: a quick bound from above on Wu's cost.

use edifice_shape::Facade;
use rustc_hash::{FxHashMap, FxHashSet};

use super::collapse::collapse;
use super::error::LibraryError;
use super::rules::{Item, Rules, Symbol};
use super::tree::{Parse, index, parse, slots};
use crate::Costs;

/// A region with everything in it: its extent, and the numbers of its parts with their sizes.
type Region = ([u32; 2], Vec<u32>);

/// The cost of the grammar that the parse tree of a tiling is, equal regions written once and runs of equal parts as
/// repeats: never less than that of the cheapest grammar, and quick to compute. `step` is the length of which all
/// lengths are multiples.
///
/// # Errors
/// [`LibraryError`] for a layout that full lines do not split, or with lengths that are no multiples of the step.
pub fn parse_cost(facade: &Facade, step: f64, costs: &Costs) -> Result<f64, LibraryError> {
    let mut rules = Rules::default();
    let parsed = parse(facade, step, &mut rules)?;
    let mut pricer = Pricer {
        parse: &parsed,
        rules: &rules,
        count: 0,
        size: 0,
        regions: FxHashMap::default(),
        repeats: FxHashSet::default(),
        parts: FxHashMap::default(),
        costs,
        cost: 0.0,
    };
    pricer.region(parsed.root, parsed.extent);
    Ok(pricer.cost)
}

struct Pricer<'a> {
    parse: &'a Parse,
    rules: &'a Rules,
    count: usize,
    size: usize,
    /// Number of each distinct region.
    regions: FxHashMap<(Symbol, Region), u32>,
    /// Repeats that are written already.
    repeats: FxHashSet<(usize, u32, Vec<Symbol>)>,
    /// Number of each distinct part with its size along the split.
    parts: FxHashMap<(u32, u32), u32>,
    costs: &'a Costs,
    cost: f64,
}

impl Pricer<'_> {
    /// The number of a region; its rule is paid where it is new.
    fn region(&mut self, symbol: Symbol, extent: [u32; 2]) -> u32 {
        let next = self.regions.len() as u32;
        let Symbol::Rule(rule) = symbol else {
            // The extent of a terminal across the split is that of its region.
            return *self
                .regions
                .entry((symbol, ([0, 0], Vec::new())))
                .or_insert(next);
        };
        let written = self.rules.rule(rule);
        let along = index(written.axis);
        let repeats = written.items.iter().filter(|item| item.is_repeat()).count();
        let slots = slots(
            written,
            &self.parse.counts[self.count..self.count + repeats],
        );
        self.count += repeats;
        let mut left = extent[along];
        let sizes: Vec<u32> = (0..slots.len())
            .map(|k| {
                let own = if k + 1 < slots.len() {
                    self.parse.sizes[self.size + k]
                } else {
                    left
                };
                left -= own;
                own
            })
            .collect();
        self.size += slots.len() - 1;
        let mut parts = Vec::with_capacity(slots.len());
        for (slot, &size) in slots.iter().zip(&sizes) {
            let mut inner = extent;
            inner[along] = size;
            let region = self.region(slot.symbol, inner);
            let new = self.parts.len() as u32;
            parts.push(*self.parts.entry((region, size)).or_insert(new));
        }
        let next = self.regions.len() as u32;
        let key = (symbol, (extent, parts.clone()));
        if let Some(&known) = self.regions.get(&key) {
            return known;
        }
        self.regions.insert(key, next);
        let letters: Vec<Symbol> = parts.into_iter().map(Symbol::Terminal).collect();
        let (items, _) = collapse(&letters);
        for item in &items {
            if let Item::Repeat(period) = item
                && self
                    .repeats
                    .insert((along, extent[1 - along], period.clone()))
            {
                self.cost += self.costs.repeat + self.costs.successor * period.len() as f64;
            }
        }
        if items.len() > 1 || !items[0].is_repeat() {
            self.cost += self.costs.split + self.costs.successor * items.len() as f64;
        }
        next
    }
}
