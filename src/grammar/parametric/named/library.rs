//! All facades of a library as one stochastic rule set.

use std::collections::{BTreeMap, BTreeSet};

use super::ties::{AGREED, Ties, Values, spread};
use super::{Attribute, Choice, Named, NamedItem, NamedPart, NamedRule, Names, count, extent};
use crate::Start;
use crate::parametric::library::Library;
use crate::parametric::regions::regions;
use crate::parametric::rules::{Item, Symbol};

/// The symbol of all facades together.
const FACADE: &str = "Facade";

/// A repeat: rule and item.
type Repeat = (u32, u32);

/// A slot: rule, item and place.
type Place = (u32, u32, u32);

/// The counts of each repeat and the sizes of each slot, by facade.
#[derive(Default)]
struct Chosen {
    counts: BTreeMap<Repeat, BTreeMap<usize, Vec<u32>>>,
    sizes: BTreeMap<Place, BTreeMap<usize, Vec<u32>>>,
}

impl Library {
    /// The library as rules with named sizes and counts; the start is one of the facades' roots with its counts, by
    /// chance, as often as facades have it.
    pub fn named(&self) -> Named {
        let chosen = self.chosen_by_facade();
        // Counts are told exactly; sizes of different symbols may be equal in one facade by accident.
        let least = 2.min(self.members().len());
        let (mut counts, mut sizes) = (Ties::new(1.0, 0), Ties::new(AGREED, least));
        let names = self.rule_names();
        let labels = self.rules().labels();
        let mut taken = Names(names.iter().chain(labels).cloned().collect());
        let symbol = taken.free(FACADE);
        let name = |symbol: Symbol| match symbol {
            Symbol::Terminal(label) => labels[label as usize].clone(),
            Symbol::Rule(rule) => names[rule as usize].clone(),
        };
        let used: Vec<u32> = (0..names.len() as u32)
            .rev()
            .filter(|&rule| chosen.sizes.contains_key(&(rule, 0, 0)))
            .collect();
        let (mut count_names, mut size_names) = (Vec::new(), Vec::new());
        for &rule in &used {
            let written = self.rules().rule(rule);
            for (item, parts) in written.items.iter().enumerate() {
                let at = (rule, item as u32);
                if let Some(own) = chosen.counts.get(&at)
                    && counts
                        .add(at, (written.axis, None), commonest(own))
                        .is_some()
                {
                    count_names.push(taken.free(count(written.axis)));
                }
                for (place, &part) in parts.symbols().iter().enumerate() {
                    let at = (rule, item as u32, place as u32);
                    let own = self.means(&chosen.sizes[&at]);
                    if sizes.add(at, (written.axis, Some(part)), own).is_some() {
                        let stem = format!("{}_{}", name(part), extent(written.axis));
                        size_names.push(taken.free(&stem));
                    }
                }
            }
        }
        let parameters = self.parameters(&counts);
        let arguments = |symbol: Symbol| -> &BTreeSet<usize> {
            match symbol {
                Symbol::Rule(rule) => &parameters[rule as usize],
                Symbol::Terminal(_) => const { &BTreeSet::new() },
            }
        };
        let told = |groups: &BTreeSet<usize>| -> Vec<String> {
            groups.iter().map(|&g| count_names[g].clone()).collect()
        };
        let rules = used.iter().map(|&rule| {
            let written = self.rules().rule(rule);
            let part = |item: usize, place: usize, part: Symbol| NamedPart {
                size: sizes
                    .group(&(rule, item as u32, place as u32))
                    .map_or_else(String::new, |g| size_names[g].clone()),
                symbol: name(part),
                arguments: told(arguments(part)),
            };
            let item = |(item, written): (usize, &Item)| match written {
                Item::Part(symbol) => NamedItem::Part(part(item, 0, *symbol)),
                Item::Repeat(period) => NamedItem::Repeat {
                    count: counts
                        .group(&(rule, item as u32))
                        .map_or_else(String::new, |g| count_names[g].clone()),
                    period: period
                        .iter()
                        .enumerate()
                        .map(|(place, &symbol)| part(item, place, symbol))
                        .collect(),
                },
            };
            NamedRule {
                symbol: names[rule as usize].clone(),
                parameters: told(&parameters[rule as usize]),
                axis: written.axis,
                items: written.items.iter().enumerate().map(item).collect(),
            }
        });
        let attributes = size_names.iter().enumerate().map(|(group, name)| {
            let (mean, spread) = spread(sizes.values(group));
            Attribute {
                name: name.clone(),
                value: (mean * 1e3).round() / 1e3,
                spread: Some(spread),
            }
        });
        let mut choices: Vec<Choice> = Vec::new();
        for (facade, member) in self.members().iter().enumerate() {
            let root = member.parse.root;
            let own = arguments(root).iter();
            let own = own.filter_map(|&g| counts.values(g).get(&facade));
            let (symbol, counts) = (name(root), own.map(|&c| c as u32).collect());
            match choices
                .iter_mut()
                .find(|known| known.symbol == symbol && known.counts == counts)
            {
                Some(known) => known.facades += 1,
                None => choices.push(Choice {
                    facades: 1,
                    symbol,
                    counts,
                }),
            }
        }
        choices.sort_by_key(|choice| std::cmp::Reverse(choice.facades));
        let mean = |axis: usize| {
            let steps = self
                .members()
                .iter()
                .map(|m| f64::from(m.parse.extent[axis]));
            let mean = steps.sum::<f64>() / self.members().len() as f64;
            mean.round().max(1.0) * self.step()
        };
        Named {
            unit: self.unit().to_owned(),
            start: Start {
                name: symbol.clone(),
                symbol,
                width: mean(0),
                height: mean(1),
            },
            choices,
            attributes: attributes.collect(),
            rules: rules.collect(),
            labels: labels.to_vec(),
        }
    }

    fn chosen_by_facade(&self) -> Chosen {
        let mut chosen = Chosen::default();
        for (facade, member) in self.members().iter().enumerate() {
            regions(&member.parse, self.rules(), |region| {
                let items = self.rules().rule(region.rule).items.iter().enumerate();
                let repeats = items.filter(|(_, item)| item.is_repeat());
                for ((item, _), &count) in repeats.zip(region.counts) {
                    let of = chosen.counts.entry((region.rule, item as u32)).or_default();
                    of.entry(facade).or_default().push(count);
                }
                for (slot, &size) in region.slots.iter().zip(region.sizes) {
                    let at = (region.rule, slot.item, slot.place);
                    let of = chosen.sizes.entry(at).or_default();
                    of.entry(facade).or_default().push(size);
                }
            });
        }
        chosen
    }

    /// The counts that each rule takes: its own and those of the rules that it uses, by their groups.
    fn parameters(&self, counts: &Ties<Repeat>) -> Vec<BTreeSet<usize>> {
        let mut parameters: Vec<BTreeSet<usize>> = Vec::new();
        for (rule, written) in self.rules().rules().iter().enumerate() {
            let mut own = BTreeSet::new();
            for (item, parts) in written.items.iter().enumerate() {
                own.extend(counts.group(&(rule as u32, item as u32)));
                for symbol in parts.symbols() {
                    if let Symbol::Rule(used) = *symbol {
                        own.extend(&parameters[used as usize]);
                    }
                }
            }
            parameters.push(own);
        }
        parameters
    }

    /// The mean size of each facade, in the unit.
    fn means(&self, sizes: &BTreeMap<usize, Vec<u32>>) -> Values {
        let mean = |sizes: &Vec<u32>| {
            let sum: f64 = sizes.iter().map(|&size| f64::from(size)).sum();
            sum / sizes.len() as f64 * self.step()
        };
        sizes.iter().map(|(&k, sizes)| (k, mean(sizes))).collect()
    }
}

/// The commonest count of each facade, of equally common ones the least.
fn commonest(counts: &BTreeMap<usize, Vec<u32>>) -> Values {
    let most = |counts: &Vec<u32>| {
        let often = |&count: &u32| counts.iter().filter(|&&c| c == count).count();
        let best = counts
            .iter()
            .max_by_key(|&count| (often(count), std::cmp::Reverse(*count)));
        f64::from(best.copied().unwrap_or(2))
    };
    counts
        .iter()
        .map(|(&k, counts)| (k, most(counts)))
        .collect()
}
