//! A library as a split grammar, with its shared phrases as rules and the mean sizes of its facades.
//!
//! Sizes are relative: they share out whatever region a rule is derived in, as they do on average in the
//! facades of the library. The grammar has one start for each facade, so that the cost of its rules is
//! that of [`Sharing`], computed by other code.

use std::collections::BTreeSet;

use super::bodies::{Bodies, Letter};
use super::library::Library;
use super::names::{Kind, Namer};
use super::phrases::{Part, Sharing, Written};
use super::regions::regions;
use super::rules::Symbol;
use edifice_shape::Axis;

use crate::{Grammar, Operation, Rule, Size, Start, Successor};

/// Sums of sizes at the letters of a string.
#[derive(Clone, Default)]
struct Sums {
    sum: Vec<f64>,
    count: f64,
}

impl Library {
    /// The deterministic rules, with one start for each facade.
    pub fn grammar(&self, sharing: &Sharing) -> Grammar {
        let bodies = Bodies::new(self.rules());
        let roots: BTreeSet<u32> = self
            .members()
            .iter()
            .filter_map(|member| match member.parse.root {
                Symbol::Rule(rule) => Some(bodies.of_rule[rule as usize]),
                Symbol::Terminal(_) => None,
            })
            .collect();
        let mut namer = Namer::new(self.rules().labels());
        let kind = |(k, rule): (usize, &Written)| match (k < sharing.bodies, rule.repeat) {
            (false, _) => Kind::Phrase,
            (true, _) if roots.contains(&(k as u32)) => Kind::Facade,
            (true, true) => Kind::Repeat(rule.axis),
            (true, false) => Kind::Split(rule.axis),
        };
        let names: Vec<String> = sharing
            .rules
            .iter()
            .enumerate()
            .map(|r| namer.next(kind(r)))
            .collect();
        let sizes = self.letter_sizes(&bodies, sharing);
        let name = |part: Part| match part {
            Part::Label(label) => self.rules().labels()[label as usize].clone(),
            Part::Rule(rule) => names[rule as usize].clone(),
        };
        let rules = sharing
            .rules
            .iter()
            .zip(&sizes)
            .zip(&names)
            .map(|((rule, sizes), own)| {
                let mut at = 0;
                let successors = rule.parts.iter().map(|&part| {
                    let letters = letters(sharing, rule.axis, part);
                    let size: f64 = sizes[at..at + letters].iter().sum();
                    at += letters;
                    Successor {
                        symbol: name(part),
                        size: Size::Relative(size),
                    }
                });
                let successors = successors.collect();
                let operation = match rule.repeat {
                    true => Operation::Repeat {
                        axis: rule.axis,
                        successors,
                    },
                    false => Operation::Split {
                        axis: rule.axis,
                        successors,
                    },
                };
                Rule {
                    symbol: own.clone(),
                    weight: None,
                    operation,
                }
            });
        let starts = self.members().iter().map(|member| {
            let [width, height] = member
                .parse
                .extent
                .map(|steps| f64::from(steps) * self.step());
            let symbol = match bodies.letter(member.parse.root) {
                Letter::Label(label) => Part::Label(label),
                Letter::Body(body) => Part::Rule(body),
            };
            Start {
                name: member.name.clone(),
                symbol: name(symbol),
                width,
                height,
            }
        });
        Grammar {
            unit: self.unit().to_owned(),
            rules: rules.collect(),
            starts: starts.collect(),
        }
    }

    /// The mean size of each letter of each rule.
    fn letter_sizes(&self, bodies: &Bodies, sharing: &Sharing) -> Vec<Vec<f64>> {
        let mut sums: Vec<Sums> = vec![Sums::default(); sharing.rules.len()];
        for (sums, body) in sums.iter_mut().zip(&bodies.bodies) {
            sums.sum = vec![0.0; body.letters.len()];
        }
        for member in self.members() {
            self.add_sizes(member, bodies, &mut sums);
        }
        // Phrases come after the rules that use them: bodies first, then from long to short.
        for rule in 0..sharing.rules.len() {
            let mut at = 0;
            for &part in &sharing.rules[rule].parts {
                let letters = letters(sharing, sharing.rules[rule].axis, part);
                if let Part::Rule(phrase) = part
                    && phrase as usize >= sharing.bodies
                {
                    let count = sums[rule].count;
                    let own = sums[rule].sum[at..at + letters].to_vec();
                    let used = &mut sums[phrase as usize];
                    used.sum.resize(letters, 0.0);
                    used.sum
                        .iter_mut()
                        .zip(own)
                        .for_each(|(sum, own)| *sum += own);
                    used.count += count;
                }
                at += letters;
            }
        }
        let mean = |sums: Sums| {
            let count = sums.count.max(1.0);
            sums.sum
                .iter()
                .map(|s| (s / count * 1e3).round().max(1.0) / 1e3)
                .collect()
        };
        sums.into_iter().map(mean).collect()
    }

    /// Adds the sizes of one facade.
    fn add_sizes(&self, member: &super::library::Member, bodies: &Bodies, sums: &mut [Sums]) {
        regions(&member.parse, self.rules(), |region| {
            let written = self.rules().rule(region.rule);
            let body = bodies.of_rule[region.rule as usize] as usize;
            for (slot, &size) in region.slots.iter().zip(region.sizes) {
                let length = f64::from(size) * self.step();
                if !bodies.bodies[body].repeat {
                    sums[body].sum[slot.item as usize] += length;
                }
                if written.items[slot.item as usize].is_repeat() {
                    let repeat = bodies.repeat_of(region.rule, slot.item as usize) as usize;
                    sums[repeat].sum[slot.place as usize] += length;
                    if slot.place == 0 {
                        sums[repeat].count += 1.0;
                    }
                }
            }
            if !bodies.bodies[body].repeat {
                sums[body].count += 1.0;
            }
        });
    }
}

/// Number of letters that a part of a string of direction `axis` stands for: splits of that direction are strings
/// that it shares.
fn letters(sharing: &Sharing, axis: Axis, part: Part) -> usize {
    match part {
        Part::Rule(rule) => match &sharing.rules[rule as usize] {
            shared if shared.axis == axis && !shared.repeat => shared
                .parts
                .iter()
                .map(|&part| letters(sharing, axis, part))
                .sum(),
            _ => 1,
        },
        Part::Label(_) => 1,
    }
}
