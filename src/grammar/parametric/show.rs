//! A library as text for a person.
//!
//! `Row3(w1, w2, w3; n) → split(x){w1: wall | (w2: window | w3: wall)*n}`: parts of one name have one size in (nearly) all
//! regions of the rule. Below stands what the facades chose: how many have it, its counts, and mean and standard
//! deviation of its sizes.

use std::collections::BTreeMap;

use edifice_shape::Axis;

use super::codec::questions;
use super::library::Library;
use super::rules::{Item, Symbol};

/// Sizes are one parameter when they agree in this share of the regions.
const TIED: f64 = 0.95;

/// The sizes of a region by item and place.
type PartSizes = BTreeMap<(u32, u32), Vec<u32>>;

/// The parameters that the facades chose for one rule.
#[derive(Default)]
struct Chosen {
    /// Number of regions.
    regions: usize,
    /// Number of facades.
    facades: usize,
    /// Counts of each repeat, by item.
    counts: BTreeMap<u32, Vec<u32>>,
    /// Sizes of each part by item and place: one entry a region, none where its repetitions differ.
    sizes: BTreeMap<(u32, u32), Vec<Option<u32>>>,
    /// All sizes of each part.
    all: BTreeMap<(u32, u32), Vec<u32>>,
}

impl Library {
    /// One rule after another, outer ones first, each with a line on what the facades chose.
    pub fn listing(&self) -> Vec<String> {
        let chosen = self.chosen();
        let rules = self.rules();
        let names = self.rule_names();
        let name = |symbol: Symbol| match symbol {
            Symbol::Terminal(label) => rules.labels()[label as usize].as_str(),
            Symbol::Rule(rule) => names[rule as usize].as_str(),
        };
        let mut lines = Vec::new();
        for k in (0..names.len()).rev() {
            let rule = &rules.rules()[k];
            let own = &chosen[k];
            let parameters = own.parameters(rule.axis);
            let repeats: Vec<u32> = own.counts.keys().copied().collect();
            let count_name = |item: u32| match repeats.len() {
                1 => "n".to_owned(),
                _ => format!(
                    "n{}",
                    repeats
                        .iter()
                        .position(|&r| r == item)
                        .map_or(0, |at| at + 1)
                ),
            };
            let part = |item: usize, place: usize, symbol: Symbol| {
                let size = parameters.get(&(item as u32, place as u32));
                let size = size.map(|s| format!("{s}: ")).unwrap_or_default();
                format!("{size}{}", name(symbol))
            };
            let items: Vec<String> = rule
                .items
                .iter()
                .enumerate()
                .map(|(item, written)| match written {
                    Item::Part(symbol) => part(item, 0, *symbol),
                    Item::Repeat(period) => {
                        let parts: Vec<String> = period
                            .iter()
                            .enumerate()
                            .map(|(place, &s)| part(item, place, s))
                            .collect();
                        format!("({})*{}", parts.join(" | "), count_name(item as u32))
                    }
                })
                .collect();
            let mut sizes: Vec<&str> = Vec::new();
            for size in parameters.values() {
                if !sizes.contains(&size.as_str()) {
                    sizes.push(size);
                }
            }
            let counts: Vec<String> = repeats.iter().map(|&item| count_name(item)).collect();
            let split = if counts.is_empty() {
                String::new()
            } else {
                format!("; {}", counts.join(", "))
            };
            lines.push(format!(
                "{}({}{split}) → split({}){{{}}}",
                names[k],
                sizes.join(", "),
                rule.axis.name(),
                items.join(" | ")
            ));
            lines.push(format!(
                "    {}",
                own.summary(&parameters, self.step(), count_name)
            ));
        }
        lines
    }

    /// The parameters that the facades chose for each rule.
    fn chosen(&self) -> Vec<Chosen> {
        let mut all: Vec<Chosen> = self
            .rules()
            .rules()
            .iter()
            .map(|_| Chosen::default())
            .collect();
        for member in self.members() {
            let mut counts: Vec<(u32, u32, u32)> = Vec::new();
            let mut regions: Vec<(u32, PartSizes)> = Vec::new();
            questions(
                &member.parse,
                self.rules(),
                |(rule, item), _, count| counts.push((rule, item, count)),
                |at, size| {
                    if at.max == at.extent {
                        regions.push((at.rule, BTreeMap::new()));
                    }
                    if let Some(region) = regions.last_mut() {
                        region
                            .1
                            .entry((at.slot.item, at.slot.place))
                            .or_default()
                            .push(size);
                    }
                },
            );
            for (rule, item, count) in counts {
                all[rule as usize]
                    .counts
                    .entry(item)
                    .or_default()
                    .push(count);
            }
            let mut met: Vec<u32> = regions.iter().map(|region| region.0).collect();
            for (rule, sizes) in regions {
                let own = &mut all[rule as usize];
                own.regions += 1;
                for (place, sizes) in sizes {
                    let one = sizes
                        .iter()
                        .all(|size| *size == sizes[0])
                        .then_some(sizes[0]);
                    own.sizes.entry(place).or_default().push(one);
                    own.all.entry(place).or_default().extend(sizes);
                }
            }
            met.sort_unstable();
            met.dedup();
            for rule in met {
                all[rule as usize].facades += 1;
            }
        }
        all
    }
}

impl Chosen {
    /// The name of each part's size, equal ones sharing a name; the part that fills what is left has none.
    fn parameters(&self, axis: Axis) -> BTreeMap<(u32, u32), String> {
        let letter = if axis == Axis::X { 'w' } else { 'h' };
        let mut given: Vec<((u32, u32), String)> = Vec::new();
        let mut next = 1;
        for (&place, sizes) in &self.sizes {
            let tied = given.iter().find(|(other, _)| {
                let others = &self.sizes[other];
                let agree = sizes
                    .iter()
                    .zip(others)
                    .filter(|(a, b)| a.is_some() && a == b)
                    .count();
                sizes.len() == others.len() && agree as f64 >= TIED * sizes.len() as f64
            });
            let name = match tied {
                Some((_, name)) => name.clone(),
                None => {
                    next += 1;
                    format!("{letter}{}", next - 1)
                }
            };
            given.push((place, name));
        }
        given.into_iter().collect()
    }

    fn summary(
        &self,
        parameters: &BTreeMap<(u32, u32), String>,
        step: f64,
        count_name: impl Fn(u32) -> String,
    ) -> String {
        let mut parts = vec![format!(
            "{} facades, {} regions",
            self.facades, self.regions
        )];
        for (&item, counts) in &self.counts {
            let mut seen: BTreeMap<u32, usize> = BTreeMap::new();
            counts
                .iter()
                .for_each(|&count| *seen.entry(count).or_default() += 1);
            let list: Vec<String> = seen
                .iter()
                .map(|(count, times)| format!("{count} ({times})"))
                .collect();
            parts.push(format!("{} = {}", count_name(item), list.join(", ")));
        }
        let mut said: Vec<&str> = Vec::new();
        for (place, name) in parameters {
            if said.contains(&name.as_str()) {
                continue;
            }
            said.push(name);
            let sizes = &self.all[place];
            let count = sizes.len() as f64;
            let mean = sizes.iter().map(|&s| f64::from(s)).sum::<f64>() / count;
            let square = sizes
                .iter()
                .map(|&s| (f64::from(s) - mean).powi(2))
                .sum::<f64>()
                / count;
            parts.push(format!(
                "{name} {:.1} ± {:.1}",
                mean * step,
                square.sqrt() * step
            ));
        }
        parts.join("; ")
    }
}
