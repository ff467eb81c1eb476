//! One facade as rules: its choices, counts and sizes given.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::{Attribute, Named, NamedItem, NamedPart, NamedRule, Names, count, extent};
use crate::Start;
use crate::parametric::error::LibraryError;
use crate::parametric::library::Library;
use crate::parametric::names::{Kind, Namer};
use crate::parametric::rules::{Item, Rules, Symbol};
use crate::parametric::tree::{Parse, index, slots};
use edifice_shape::{Axis, Facade};

/// A part: the library's symbol, the number of its region where it is split, and its size in steps.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Part {
    symbol: Symbol,
    region: Option<usize>,
    size: u32,
}

#[derive(PartialEq, Eq, Hash)]
enum Entry {
    Part(Part),
    Repeat(u32, Vec<Part>),
}

/// A region with everything in it.
type Region = (Axis, Vec<Entry>);

impl Library {
    /// A facade, of the library or not, as rules with a named size for each extent of a symbol and a named count for each
    /// number of floors or columns: equal ones share a name. Regions that are equal in everything share a rule. A repeat
    /// whose periods differ in sizes or content is written out.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn named_facade(&self, facade: &Facade) -> Result<Named, LibraryError> {
        let (parse, rules) = self.parse(facade)?;
        let mut regions = Regions {
            parse: &parse,
            rules: &rules,
            count: 0,
            size: 0,
            numbers: FxHashMap::default(),
        };
        let root = regions.number(parse.root, parse.extent);
        let mut all: Vec<(usize, Region)> =
            regions.numbers.into_iter().map(|(r, k)| (k, r)).collect();
        all.sort_by_key(|region| region.0);
        let all: Vec<Region> = all.into_iter().map(|region| region.1).collect();
        let mut writer = Writer {
            rules: &rules,
            symbols: symbols(&all, root, rules.labels()),
            names: Names(rules.labels().iter().cloned().collect()),
            step: self.step(),
            sizes: BTreeMap::new(),
            counts: BTreeMap::new(),
            attributes: Vec::new(),
        };
        writer.names.0.extend(writer.symbols.iter().cloned());
        let written = all.iter().enumerate().rev();
        let written = written.map(|(k, region)| writer.rule(k, region)).collect();
        let [width, height] = parse.extent.map(|steps| f64::from(steps) * self.step());
        let symbol = writer.symbol(parse.root, root);
        Ok(Named {
            unit: self.unit().to_owned(),
            start: Start {
                name: facade.name.clone(),
                symbol,
                width,
                height,
            },
            choices: Vec::new(),
            attributes: writer.attributes,
            rules: written,
            labels: rules.labels().to_vec(),
        })
    }
}

/// The symbols of all regions, outer ones numbered first.
fn symbols(all: &[Region], root: Option<usize>, labels: &[String]) -> Vec<String> {
    let mut namer = Namer::new(labels);
    let mut symbols = vec![String::new(); all.len()];
    for (k, (axis, _)) in all.iter().enumerate().rev() {
        symbols[k] = namer.next(match Some(k) == root {
            true => Kind::Facade,
            false => Kind::Split(*axis),
        });
    }
    symbols
}

/// Finds regions that are equal in everything.
struct Regions<'p> {
    parse: &'p Parse,
    rules: &'p Rules,
    /// Counts and sizes that were taken so far.
    count: usize,
    size: usize,
    numbers: FxHashMap<Region, usize>,
}

impl Regions<'_> {
    /// The number of a region, inner ones first; none for a label.
    fn number(&mut self, symbol: Symbol, extent: [u32; 2]) -> Option<usize> {
        let Symbol::Rule(rule) = symbol else {
            return None;
        };
        let (parse, rules) = (self.parse, self.rules);
        let written = rules.rule(rule);
        let along = index(written.axis);
        let repeats = written.items.iter().filter(|item| item.is_repeat()).count();
        let counts = &parse.counts[self.count..self.count + repeats];
        self.count += repeats;
        let slots = slots(written, counts);
        let mut sizes = parse.sizes[self.size..self.size + slots.len() - 1].to_vec();
        self.size += slots.len() - 1;
        sizes.push(extent[along] - sizes.iter().sum::<u32>());
        let parts: Vec<Part> = slots
            .iter()
            .zip(sizes)
            .map(|(slot, size)| {
                let mut inner = extent;
                inner[along] = size;
                Part {
                    symbol: slot.symbol,
                    region: self.number(slot.symbol, inner),
                    size,
                }
            })
            .collect();
        let (mut counts, mut rest) = (counts.iter(), &parts[..]);
        let mut entries = Vec::new();
        for item in &written.items {
            let times = match item {
                Item::Part(_) => 1,
                Item::Repeat(_) => counts.next().copied().unwrap_or(1),
            };
            let length = item.symbols().len();
            let (own, after) = rest.split_at(length * times as usize);
            rest = after;
            let period = &own[..length];
            match item.is_repeat() && own.chunks(length).all(|other| other == period) {
                true => entries.push(Entry::Repeat(times, period.to_vec())),
                false => entries.extend(own.iter().cloned().map(Entry::Part)),
            }
        }
        let next = self.numbers.len();
        Some(*self.numbers.entry((written.axis, entries)).or_insert(next))
    }
}

/// Gives names to sizes and counts.
struct Writer<'r> {
    rules: &'r Rules,
    symbols: Vec<String>,
    names: Names,
    step: f64,
    sizes: BTreeMap<(Symbol, usize, u32), String>,
    counts: BTreeMap<(usize, u32), String>,
    attributes: Vec<Attribute>,
}

impl Writer<'_> {
    fn symbol(&self, symbol: Symbol, region: Option<usize>) -> String {
        match (symbol, region) {
            (Symbol::Terminal(label), _) => self.rules.labels()[label as usize].clone(),
            (Symbol::Rule(_), region) => {
                region.map_or_else(String::new, |region| self.symbols[region].clone())
            }
        }
    }

    fn rule(&mut self, number: usize, (axis, entries): &Region) -> NamedRule {
        let items = entries.iter().map(|entry| match entry {
            Entry::Part(part) => NamedItem::Part(self.part(*axis, part)),
            Entry::Repeat(times, period) => NamedItem::Repeat {
                count: self.count(*axis, *times),
                period: period.iter().map(|part| self.part(*axis, part)).collect(),
            },
        });
        let items = items.collect();
        NamedRule {
            symbol: self.symbols[number].clone(),
            parameters: Vec::new(),
            axis: *axis,
            items,
        }
    }

    fn count(&mut self, axis: Axis, times: u32) -> String {
        if let Some(known) = self.counts.get(&(index(axis), times)) {
            return known.clone();
        }
        let name = self.attribute(count(axis), f64::from(times));
        self.counts.insert((index(axis), times), name.clone());
        name
    }

    fn part(&mut self, axis: Axis, part: &Part) -> NamedPart {
        let symbol = self.symbol(part.symbol, part.region);
        let key = (part.symbol, index(axis), part.size);
        let size = match self.sizes.get(&key) {
            Some(known) => known.clone(),
            None => {
                let stem = format!("{symbol}_{}", extent(axis));
                let name = self.attribute(&stem, f64::from(part.size) * self.step);
                self.sizes.insert(key, name.clone());
                name
            }
        };
        NamedPart {
            size,
            symbol,
            arguments: Vec::new(),
        }
    }

    fn attribute(&mut self, stem: &str, value: f64) -> String {
        let name = self.names.free(stem);
        self.attributes.push(Attribute {
            name: name.clone(),
            value,
            spread: None,
        });
        name
    }
}
