//! Variable fixing by reduced costs: what no grammar cheaper than the incumbent can use is taken out of the program.
//!
//! Let `V(p)` be the least cost of deriving place `p` under the shares, and `O(p)` the least cost of the rest of a
//! derivation that splits `p` (inside and outside costs). A grammar of cost `c` has a derivation that costs `c` at most, so
//! that it splits no place with `O(p) + V(p) > c`. The same holds of an item: the cheapest derivation that has it at
//! `p` consists of the rest, the cheapest path to its arc, the arc, and the cheapest path from it.

use super::derivation::Prices;
use super::kind::{Kind, Way};
use super::program::{Place, Program};
use super::{Incumbent, Shares, prices};

/// What a grammar cheaper than the incumbent can use.
#[derive(Clone)]
pub(super) struct Live {
    places: Vec<bool>,
    /// By kind and item.
    items: Vec<bool>,
}

impl Live {
    /// The same without some items of rules.
    pub fn without_items(&self, items: &[usize]) -> Self {
        let mut left = self.clone();
        for &item in items {
            left.items[item] = false;
        }
        left
    }

    /// The same without a type.
    pub fn without_kind(&self, kind: &Kind) -> Self {
        let mut left = self.clone();
        for &place in &kind.places {
            left.places[place as usize] = false;
        }
        left
    }

    /// Items that a program of only these has, over all its places.
    pub fn items(&self, program: &Program) -> usize {
        let live = program.places.iter().zip(&self.places);
        let kinds = live.filter(|(_, live)| **live).map(|(place, _)| place.kind);
        let mut counts = vec![None; program.kinds.len()];
        let count = |kind: u32| {
            let known = &program.kinds[kind as usize];
            let items = &self.items[known.first..known.first + known.costs.len()];
            items.iter().filter(|live| **live).count()
        };
        kinds
            .map(|kind| *counts[kind as usize].get_or_insert_with(|| count(kind)))
            .sum()
    }
}

impl Shares<'_> {
    /// What the reduced costs under the shares at hand leave.
    pub(super) fn live(&mut self, incumbent: &Incumbent) -> Live {
        let program = self.program;
        let total = self.bound();
        let mut live = Live {
            places: vec![false; program.places.len()],
            items: vec![false; program.kind_items],
        };
        let mut outside = vec![f64::INFINITY; program.places.len()];
        for &root in &program.roots {
            outside[root as usize] = total - self.values[root as usize];
        }
        let mut around = Around::default();
        for &place in program.order.iter().rev() {
            let rest = outside[place as usize];
            if incumbent.is_optimal(rest + self.values[place as usize]) {
                continue;
            }
            live.places[place as usize] = true;
            let (kind, known) = (program.kind(place), &program.places[place as usize]);
            let prices = prices(program, place, &self.paid, &self.values);
            let first = self.program.kinds[known.kind as usize].first;
            for way in 0..kind.ways.len() {
                around.measure(program, place, way, &prices);
                let mut used = false;
                for item in kind.ways[way].arcs.clone() {
                    let cost = rest + around.through(kind, way, item);
                    if incumbent.is_optimal(cost) {
                        continue;
                    }
                    used = true;
                    live.items[first + item] = true;
                    for part in program.parts(place, kind, item) {
                        if let Some(outside) = outside.get_mut(part as usize) {
                            *outside = outside.min(cost - self.values[part as usize]);
                        }
                    }
                }
                live.items[first + kind.operation(way)] |= used;
            }
        }
        live
    }
}

/// Shortest paths from the start of a way and to its end.
#[derive(Default)]
struct Around {
    /// By arc of the way.
    costs: Vec<f64>,
    before: Vec<f64>,
    after: Vec<f64>,
}

impl Around {
    fn measure(&mut self, program: &Program, place: u32, way: usize, prices: &Prices) {
        let kind = program.kind(place);
        let Way { last, arcs, .. } = &kind.ways[way];
        let cost =
            |item: usize| prices.items[item] + program.below(place, kind, item, prices.parts);
        self.costs.clear();
        self.costs.extend(arcs.clone().map(cost));
        let nodes = usize::from(*last) + 1;
        for distances in [&mut self.before, &mut self.after] {
            distances.clear();
            distances.resize(nodes, f64::INFINITY);
        }
        self.before[0] = prices.items[kind.operation(way)];
        self.after[nodes - 1] = 0.0;
        let ends = |item: usize| {
            let arc = &kind.arcs[item];
            (usize::from(arc.from), usize::from(arc.to))
        };
        // Arcs are sorted by where they lead.
        for (item, cost) in arcs.clone().zip(&self.costs) {
            let (from, to) = ends(item);
            self.before[to] = self.before[to].min(self.before[from] + cost);
        }
        for (item, cost) in arcs.clone().zip(&self.costs).rev() {
            let (from, to) = ends(item);
            self.after[from] = self.after[from].min(cost + self.after[to]);
        }
    }

    /// Cost of the cheapest rule along the way with an arc.
    fn through(&self, kind: &Kind, way: usize, item: usize) -> f64 {
        let arc = &kind.arcs[item];
        let (from, to) = (usize::from(arc.from), usize::from(arc.to));
        self.before[from] + self.costs[item - kind.ways[way].arcs.start] + self.after[to]
    }
}

impl Program {
    /// The program of what is left, and its shares; `None` when a facade as a whole is not left.
    pub(super) fn reduced(&self, live: &Live, shares: &[f64]) -> Option<(Program, Vec<f64>)> {
        let mut reduced = Program {
            kinds: Vec::new(),
            places: Vec::new(),
            parts: Vec::new(),
            order: Vec::new(),
            roots: Vec::new(),
            constant: self.constant,
            items: 0,
            kind_items: 0,
            shares: 0,
        };
        // Items that are kept, by new kind.
        let mut kept: Vec<Vec<usize>> = Vec::new();
        let mut kinds: Vec<Option<u32>> = Vec::new();
        for kind in &self.kinds {
            let used = kind.places.iter().any(|&place| live.places[place as usize]);
            kinds.push(used.then_some(reduced.kinds.len() as u32));
            if used {
                let items = &live.items[kind.first..kind.first + kind.costs.len()];
                let (new, from) = reduced_kind(kind, items, reduced.kind_items);
                reduced.kind_items += new.costs.len();
                reduced.kinds.push(new);
                kept.push(from);
            }
        }
        let mut numbers: Vec<Option<u32>> = vec![None; self.places.len()];
        for (place, old) in self.places.iter().enumerate() {
            let Some(kind) = kinds[old.kind as usize].filter(|_| live.places[place]) else {
                continue;
            };
            let number = reduced.places.len() as u32;
            numbers[place] = Some(number);
            let known = &mut reduced.kinds[kind as usize];
            reduced.places.push(Place {
                region: old.region,
                kind,
                index: known.places.len() as u32,
                first: reduced.items,
                parts: old.parts,
            });
            known.places.push(number);
            reduced.items += known.costs.len();
        }
        let number = |part: u32| match numbers.get(part as usize) {
            Some(Some(number)) => *number,
            _ if self.is_terminal(part) => reduced.places.len() as u32,
            _ if part == self.removed_kinds() => reduced.removed_kinds(),
            _ => match kinds[self.kind_of(part) as usize] {
                Some(kind) => reduced.removed(kind),
                None => reduced.removed_kinds(),
            },
        };
        let ends = self.places.iter().skip(1).map(|place| place.parts);
        let ends = ends.chain([self.parts.len()]);
        let mut parts = Vec::new();
        let mut firsts = Vec::new();
        for ((old, end), new) in self.places.iter().zip(ends).zip(&numbers) {
            if new.is_some() {
                firsts.push(parts.len());
                parts.extend(self.parts[old.parts..end].iter().map(|&part| number(part)));
            }
        }
        for (place, first) in reduced.places.iter_mut().zip(firsts) {
            place.parts = first;
        }
        reduced.parts = parts;
        let renumbered = |place: &u32| numbers[*place as usize];
        reduced.order = self.order.iter().filter_map(renumbered).collect();
        reduced.roots = self.roots.iter().map(renumbered).collect::<Option<_>>()?;
        reduced.fill_purses();
        let shares = self.reduced_shares(&reduced, &kinds, &kept, &numbers, shares);
        Some((reduced, shares))
    }

    /// Every purse leaves its shares to one that has all its places which are left, or any if none is. No place pays less
    /// than before.
    fn reduced_shares(
        &self,
        reduced: &Program,
        kinds: &[Option<u32>],
        kept: &[Vec<usize>],
        numbers: &[Option<u32>],
        shares: &[f64],
    ) -> Vec<f64> {
        let mut left = vec![0.0; reduced.shares];
        for (old, new) in self.kinds.iter().zip(kinds) {
            let Some(new) = *new else {
                continue;
            };
            let (known, kept) = (&reduced.kinds[new as usize], &kept[new as usize]);
            for (purse, members) in old.purses.iter().enumerate() {
                let index = |&member: &u32| {
                    let number = numbers[old.places[member as usize] as usize]?;
                    Some(reduced.places[number as usize].index)
                };
                let members: Vec<u32> = members.iter().filter_map(index).collect();
                let all = |group: &Vec<u32>| members.iter().all(|m| group.binary_search(m).is_ok());
                let heir = known.purses.iter().position(all).unwrap_or(0);
                for (item, &from) in kept.iter().enumerate() {
                    left[known.first_share + heir * known.costs.len() + item] +=
                        shares[old.first_share + purse * old.costs.len() + from];
                }
            }
        }
        left
    }
}

/// A kind with only its live items and no places, and which items those were.
fn reduced_kind(kind: &Kind, live: &[bool], first: usize) -> (Kind, Vec<usize>) {
    let mut new = Kind {
        region: kind.region,
        ways: Vec::new(),
        arcs: Vec::new(),
        slots: Vec::new(),
        full_costs: Vec::new(),
        costs: Vec::new(),
        required: kind.required,
        first,
        places: Vec::new(),
        purses: Vec::new(),
        purses_of: Vec::new(),
        first_share: 0,
    };
    let (mut kept, mut operations) = (Vec::new(), Vec::new());
    for (index, way) in kind.ways.iter().enumerate() {
        let operation = kind.operation(index);
        if !live[operation] {
            continue;
        }
        operations.push(operation);
        let start = new.arcs.len();
        for item in way.arcs.clone().filter(|&item| live[item]) {
            let mut arc = kind.arcs[item].clone();
            if arc.copies != 1 {
                let slots = &kind.slots[arc.slot as usize..][..arc.copies as usize];
                arc.slot = new.slots.len() as u32;
                new.slots.extend(slots);
            }
            kept.push(item);
            new.arcs.push(arc);
        }
        new.ways.push(Way {
            arcs: start..new.arcs.len(),
            ..way.clone()
        });
    }
    kept.extend(operations);
    new.full_costs = kept.iter().map(|&item| kind.full_costs[item]).collect();
    new.costs = kept.iter().map(|&item| kind.costs[item]).collect();
    (new, kept)
}
