//! Variable fixing by reduced costs: what no grammar cheaper than the incumbent can use is taken out of the program.
//!
//! Let `V(p)` be the least cost of deriving occurrence `p` under the multipliers, and `O(p)` the least cost of the rest of a
//! derivation that splits `p` (inside and outside costs). A grammar of cost `c` has a derivation that costs `c` at most, so
//! that it splits no occurrence with `O(p) + V(p) > c`. The same holds of an item: the cheapest derivation that has it at
//! `p` consists of the rest, the cheapest path to its arc, the arc, and the cheapest path from it.

use super::derivation::Prices;
use super::dual::{Dual, prices};
use super::incumbent::Incumbent;
use super::program::{Occurrence, Program};
use super::region_type::{Operator, RegionType};

/// The occurrences and items that a grammar cheaper than the incumbent can use.
#[derive(Clone)]
pub(super) struct Live {
    occurrences: Vec<bool>,
    /// For each item of each region type, true if it can be used.
    items: Vec<bool>,
}

impl Live {
    /// The same without some items of rules.
    pub(super) fn without_items(&self, items: &[usize]) -> Self {
        let mut left = self.clone();
        for &item in items {
            left.items[item] = false;
        }
        left
    }

    /// The same without a type.
    pub(super) fn without_type(&self, region_type: &RegionType) -> Self {
        let mut left = self.clone();
        for &occurrence in &region_type.occurrences {
            left.occurrences[occurrence as usize] = false;
        }
        left
    }

    /// Items that a program of only these has, over all its occurrences.
    pub(super) fn items(&self, program: &Program) -> usize {
        let live = program.occurrences.iter().zip(&self.occurrences);
        let region_types = live
            .filter(|(_, live)| **live)
            .map(|(occurrence, _)| occurrence.region_type);
        let mut counts = vec![None; program.region_types.len()];
        let count = |region_type: u32| {
            let known = &program.region_types[region_type as usize];
            let items = &self.items[known.first..known.first + known.costs.len()];
            items.iter().filter(|live| **live).count()
        };
        region_types
            .map(|region_type| {
                *counts[region_type as usize].get_or_insert_with(|| count(region_type))
            })
            .sum()
    }
}

impl Dual<'_> {
    /// The occurrences and items that the reduced costs under the present multipliers leave.
    pub(super) fn live(&mut self, incumbent: &Incumbent) -> Live {
        let program = self.program;
        let total = self.bound();
        let mut live = Live {
            occurrences: vec![false; program.occurrences.len()],
            items: vec![false; program.type_items],
        };
        let mut outside = vec![f64::INFINITY; program.occurrences.len()];
        for &root in &program.roots {
            outside[root as usize] = total - self.values[root as usize];
        }
        let mut around = Around::default();
        for &occurrence in program.order.iter().rev() {
            let rest = outside[occurrence as usize];
            if incumbent.is_optimal(rest + self.values[occurrence as usize]) {
                continue;
            }
            live.occurrences[occurrence as usize] = true;
            let (region_type, known) = (
                program.region_type(occurrence),
                &program.occurrences[occurrence as usize],
            );
            let prices = prices(program, occurrence, &self.item_costs, &self.values);
            let first = self.program.region_types[known.region_type as usize].first;
            for operator in 0..region_type.operators.len() {
                around.measure(program, occurrence, operator, &prices);
                let mut used = false;
                for item in region_type.operators[operator].arcs.clone() {
                    let cost = rest + around.through(region_type, operator, item);
                    if incumbent.is_optimal(cost) {
                        continue;
                    }
                    used = true;
                    live.items[first + item] = true;
                    for part in program.parts(occurrence, region_type, item) {
                        if let Some(outside) = outside.get_mut(part as usize) {
                            *outside = outside.min(cost - self.values[part as usize]);
                        }
                    }
                }
                live.items[first + region_type.operation(operator)] |= used;
            }
        }
        live
    }
}

/// Shortest paths from the start of an operator and to its end.
#[derive(Default)]
struct Around {
    /// Cost of each arc of the operator, with the parts below it.
    costs: Vec<f64>,
    before: Vec<f64>,
    after: Vec<f64>,
}

impl Around {
    fn measure(&mut self, program: &Program, occurrence: u32, operator: usize, prices: &Prices) {
        let region_type = program.region_type(occurrence);
        let Operator { last, arcs, .. } = &region_type.operators[operator];
        let cost = |item: usize| {
            prices.items[item] + program.below(occurrence, region_type, item, prices.parts)
        };
        self.costs.clear();
        self.costs.extend(arcs.clone().map(cost));
        let nodes = usize::from(*last) + 1;
        for distances in [&mut self.before, &mut self.after] {
            distances.clear();
            distances.resize(nodes, f64::INFINITY);
        }
        self.before[0] = prices.items[region_type.operation(operator)];
        self.after[nodes - 1] = 0.0;
        let ends = |item: usize| {
            let arc = &region_type.arcs[item];
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

    /// Cost of the cheapest rule along the operator with an arc.
    fn through(&self, region_type: &RegionType, operator: usize, item: usize) -> f64 {
        let arc = &region_type.arcs[item];
        let (from, to) = (usize::from(arc.from), usize::from(arc.to));
        self.before[from]
            + self.costs[item - region_type.operators[operator].arcs.start]
            + self.after[to]
    }
}

impl Program {
    /// The program of what is left, and its multipliers; `None` when a facade as a whole is not left.
    pub(super) fn reduced(&self, live: &Live, multipliers: &[f64]) -> Option<(Program, Vec<f64>)> {
        let mut reduced = Program {
            region_types: Vec::new(),
            occurrences: Vec::new(),
            parts: Vec::new(),
            order: Vec::new(),
            roots: Vec::new(),
            constant: self.constant,
            items: 0,
            type_items: 0,
            multipliers: 0,
        };
        // Items that are kept, by new region type.
        let mut kept: Vec<Vec<usize>> = Vec::new();
        let mut region_types: Vec<Option<u32>> = Vec::new();
        for region_type in &self.region_types {
            let used = region_type
                .occurrences
                .iter()
                .any(|&occurrence| live.occurrences[occurrence as usize]);
            region_types.push(used.then_some(reduced.region_types.len() as u32));
            if used {
                let items =
                    &live.items[region_type.first..region_type.first + region_type.costs.len()];
                let (new, from) = reduced_type(region_type, items, reduced.type_items);
                reduced.type_items += new.costs.len();
                reduced.region_types.push(new);
                kept.push(from);
            }
        }
        let mut numbers: Vec<Option<u32>> = vec![None; self.occurrences.len()];
        for (occurrence, old) in self.occurrences.iter().enumerate() {
            let Some(region_type) =
                region_types[old.region_type as usize].filter(|_| live.occurrences[occurrence])
            else {
                continue;
            };
            let number = reduced.occurrences.len() as u32;
            numbers[occurrence] = Some(number);
            let known = &mut reduced.region_types[region_type as usize];
            reduced.occurrences.push(Occurrence {
                region: old.region,
                region_type,
                index: known.occurrences.len() as u32,
                first: reduced.items,
                parts: old.parts,
            });
            known.occurrences.push(number);
            reduced.items += known.costs.len();
        }
        let number = |part: u32| match numbers.get(part as usize) {
            Some(Some(number)) => *number,
            _ if self.is_terminal(part) => reduced.occurrences.len() as u32,
            _ if part == self.removed_types() => reduced.removed_types(),
            _ => match region_types[self.region_type_of(part) as usize] {
                Some(region_type) => reduced.removed(region_type),
                None => reduced.removed_types(),
            },
        };
        let ends = self
            .occurrences
            .iter()
            .skip(1)
            .map(|occurrence| occurrence.parts);
        let ends = ends.chain([self.parts.len()]);
        let mut parts = Vec::new();
        let mut firsts = Vec::new();
        for ((old, end), new) in self.occurrences.iter().zip(ends).zip(&numbers) {
            if new.is_some() {
                firsts.push(parts.len());
                parts.extend(self.parts[old.parts..end].iter().map(|&part| number(part)));
            }
        }
        for (occurrence, first) in reduced.occurrences.iter_mut().zip(firsts) {
            occurrence.parts = first;
        }
        reduced.parts = parts;
        let renumbered = |occurrence: &u32| numbers[*occurrence as usize];
        reduced.order = self.order.iter().filter_map(renumbered).collect();
        reduced.roots = self.roots.iter().map(renumbered).collect::<Option<_>>()?;
        reduced.fill_cliques();
        let multipliers =
            self.reduced_multipliers(&reduced, &region_types, &kept, &numbers, multipliers);
        Some((reduced, multipliers))
    }

    /// Adds the multipliers of every old clique to those of a new one that has all its occurrences which are left, or of any one
    /// if none is left. At no occurrence does an item then cost less than before.
    fn reduced_multipliers(
        &self,
        reduced: &Program,
        region_types: &[Option<u32>],
        kept: &[Vec<usize>],
        numbers: &[Option<u32>],
        multipliers: &[f64],
    ) -> Vec<f64> {
        let mut left = vec![0.0; reduced.multipliers];
        for (old, new) in self.region_types.iter().zip(region_types) {
            let Some(new) = *new else {
                continue;
            };
            let (known, kept) = (&reduced.region_types[new as usize], &kept[new as usize]);
            for (clique, members) in old.cliques.iter().enumerate() {
                let index = |&member: &u32| {
                    let number = numbers[old.occurrences[member as usize] as usize]?;
                    Some(reduced.occurrences[number as usize].index)
                };
                let members: Vec<u32> = members.iter().filter_map(index).collect();
                let all = |group: &Vec<u32>| members.iter().all(|m| group.binary_search(m).is_ok());
                let heir = known.cliques.iter().position(all).unwrap_or(0);
                for (item, &from) in kept.iter().enumerate() {
                    left[known.first_multiplier + heir * known.costs.len() + item] +=
                        multipliers[old.first_multiplier + clique * old.costs.len() + from];
                }
            }
        }
        left
    }
}

/// A region type with only its live items and no occurrences, and which items those were.
fn reduced_type(region_type: &RegionType, live: &[bool], first: usize) -> (RegionType, Vec<usize>) {
    let mut new = RegionType {
        region: region_type.region,
        operators: Vec::new(),
        arcs: Vec::new(),
        slots: Vec::new(),
        full_costs: Vec::new(),
        costs: Vec::new(),
        required: region_type.required,
        first,
        occurrences: Vec::new(),
        cliques: Vec::new(),
        cliques_of: Vec::new(),
        first_multiplier: 0,
    };
    let (mut kept, mut operations) = (Vec::new(), Vec::new());
    for (index, operator) in region_type.operators.iter().enumerate() {
        let operation = region_type.operation(index);
        if !live[operation] {
            continue;
        }
        operations.push(operation);
        let start = new.arcs.len();
        for item in operator.arcs.clone().filter(|&item| live[item]) {
            let mut arc = region_type.arcs[item].clone();
            if arc.copies != 1 {
                let slots = &region_type.slots[arc.slot as usize..][..arc.copies as usize];
                arc.slot = new.slots.len() as u32;
                new.slots.extend(slots);
            }
            kept.push(item);
            new.arcs.push(arc);
        }
        new.operators.push(Operator {
            arcs: start..new.arcs.len(),
            ..operator.clone()
        });
    }
    kept.extend(operations);
    new.full_costs = kept
        .iter()
        .map(|&item| region_type.full_costs[item])
        .collect();
    new.costs = kept.iter().map(|&item| region_type.costs[item]).collect();
    (new, kept)
}

#[cfg(test)]
mod tests {
    use super::super::derivation::Paths;
    use super::super::tests::programs_of_small_facades;
    use super::{Around, Dual, prices};

    /// The cheapest rule of an occurrence is the cheapest through one of its items, and goes through an arc that leaves the start and
    /// one that reaches the end.
    #[test]
    fn the_cheapest_rule_is_the_cheapest_through_an_item() {
        // An operator whose arcs lead nowhere has no rule.
        let is_close = |a: f64, b: f64| a == b || (a - b).abs() < 1e-9;
        let mut compared = 0;
        for program in &programs_of_small_facades() {
            let mut dual = Dual::new(program);
            dual.bound();
            let (mut around, mut paths) = (Around::default(), Paths::default());
            for &occurrence in &program.order {
                let region_type = program.region_type(occurrence);
                let prices = prices(program, occurrence, &dual.item_costs, &dual.values);
                let (cheapest, _) = paths.cheapest(program, occurrence, &prices);
                let mut least = f64::INFINITY;
                for (k, operator) in region_type.operators.iter().enumerate() {
                    around.measure(program, occurrence, k, &prices);
                    let through = |is_of: &dyn Fn(usize) -> bool| {
                        let arcs = operator.arcs.clone().filter(|&item| is_of(item));
                        let costs = arcs.map(|item| around.through(region_type, k, item));
                        costs.fold(f64::INFINITY, f64::min)
                    };
                    let all = through(&|_| true);
                    let first = through(&|item| region_type.arcs[item].from == 0);
                    let last = through(&|item| region_type.arcs[item].to == operator.last);
                    assert!(
                        is_close(first, all) && is_close(last, all),
                        "{first} {all} {last}"
                    );
                    least = least.min(all);
                }
                assert!(is_close(least, cheapest), "{least} {cheapest}");
                compared += 1;
            }
        }
        assert!(compared > 20, "{compared}");
    }
}
