//! Subgradient steps that raise the bound.

use std::collections::BTreeMap;

use super::derivation::Rule;
use super::dual::Dual;
use super::incumbent::Incumbent;

/// An item of a region type.
pub(crate) type Item = (u32, usize);

/// Result of some subgradient steps.
#[derive(Debug)]
pub(crate) struct Ascent {
    /// The greatest `L` of all steps: a lower bound of the cost of every grammar.
    pub bound: f64,
    /// Share of the steps, 0 to 1, in which an occurrence used the item, of the occurrence that used it most; for items of region
    /// types with several occurrences. From this a branch can be chosen.
    pub usage: BTreeMap<Item, f64>,
    /// The items of the last cheapest derivation.
    pub items: Vec<Item>,
}

/// Steps without progress after which the step length shrinks.
const PATIENCE: u32 = 20;
/// Factor by which it shrinks.
const SHRINK: f64 = 0.7;
/// Share of the direction of one step that is kept for the next.
const MOMENTUM: f64 = 0.7;

/// Directions of the multipliers of an item, by clique of its region type; each sums to 0.
type Direction = BTreeMap<Item, Vec<f64>>;

impl Dual<'_> {
    /// Raises `L`, up to so many steps and so much work, one step at least, until it shows that the incumbent is
    /// optimal or the search is stopped; offers it the grammars on the way. Keeps the multipliers of the greatest `L`.
    pub(super) fn ascend(
        &mut self,
        incumbent: &mut Incumbent,
        steps: u64,
        work: &mut u64,
    ) -> Ascent {
        let mut found = Ascent {
            bound: f64::NEG_INFINITY,
            usage: BTreeMap::new(),
            items: Vec::new(),
        };
        let mut made: u32 = 0;
        let mut uses: BTreeMap<(Item, u32), u32> = BTreeMap::new();
        let mut kept = self.multipliers.clone();
        let mut direction = Direction::new();
        let (mut scale, mut stalled) = (1.0, 0);
        // One step at least: a branch is closed only by what a derivation shows.
        for _ in 0..steps.max(1) {
            *work = work.saturating_sub(self.program.items as u64);
            if !incumbent.goes_on() && found.bound > f64::NEG_INFINITY {
                break;
            }
            let bound = self.bound();
            if bound > found.bound + 1e-6 {
                found.bound = bound;
                kept.copy_from_slice(&self.multipliers);
                stalled = 0;
            } else {
                stalled += 1;
            }
            if bound == f64::INFINITY || incumbent.is_optimal(found.bound) {
                break;
            }
            if stalled > PATIENCE {
                (scale, stalled) = (scale * SHRINK, 0);
                self.multipliers.copy_from_slice(&kept);
                self.update_all_costs();
                direction.clear();
                continue;
            }
            let derivation = self.derivation();
            self.offer(&derivation, incumbent);
            if incumbent.is_optimal(found.bound) {
                break;
            }
            found.items.clear();
            for (occurrence, rule) in &derivation {
                for item in rule.items(self.program.region_type(*occurrence)) {
                    found.items.push((rule.region_type, item));
                    *uses
                        .entry(((rule.region_type, item), *occurrence))
                        .or_insert(0) += 1;
                }
            }
            made += 1;
            self.turn(&mut direction, &derivation);
            let norm: f64 = direction.values().flatten().map(|d| d * d).sum();
            if norm < 1e-12 {
                break;
            }
            let above = (incumbent.cost - bound).max(1e-2);
            self.shift(&direction, scale * above / norm);
            if *work < self.program.items as u64 {
                break;
            }
        }
        self.multipliers = kept;
        self.update_all_costs();
        for ((item, _), count) in uses {
            let usage = found.usage.entry(item).or_insert(0.0);
            *usage = usage.max(f64::from(count) / f64::from(made));
        }
        found
    }

    /// Offers the incumbent the best grammar over the region types of a derivation.
    fn offer(&mut self, derivation: &[(u32, Rule)], incumbent: &mut Incumbent) {
        let mut members: Vec<u32> = derivation
            .iter()
            .map(|(_, rule)| rule.region_type)
            .collect();
        members.sort_unstable();
        members.dedup();
        let (cost, rules) = self.restricted.cheapest(self.program, &members);
        incumbent.offer(self.program, cost, &rules);
    }

    /// The direction of the next step: the multipliers of cliques whose occurrences use an item rise, the others fall.
    fn turn(&self, direction: &mut Direction, derivation: &[(u32, Rule)]) {
        direction.retain(|_, along| {
            along.iter_mut().for_each(|d| *d *= MOMENTUM);
            along.iter().any(|d| d.abs() > 1e-6)
        });
        for (occurrence, rule) in derivation {
            let region_type = &self.program.region_types[rule.region_type as usize];
            let count = region_type.cliques.len();
            if count == 1 {
                continue;
            }
            let index = self.program.occurrences[*occurrence as usize].index as usize;
            let paying = &region_type.cliques_of[index];
            let mean = paying.len() as f64 / count as f64;
            // An item that costs nothing has nothing to be split by multipliers.
            for item in rule
                .items(region_type)
                .filter(|&item| region_type.costs[item] > 0.0)
            {
                let along = direction
                    .entry((rule.region_type, item))
                    .or_insert_with(|| vec![0.0; count]);
                along.iter_mut().for_each(|d| *d -= mean);
                for &clique in paying {
                    along[clique as usize] += 1.0;
                }
            }
        }
    }

    /// Moves the multipliers of each item along its direction, and back to where none is negative and they sum to the item's cost.
    fn shift(&mut self, direction: &Direction, step: f64) {
        for (&(region_type, item), along) in direction {
            let region_type = &self.program.region_types[region_type as usize];
            let slot = |clique: usize| {
                region_type.first_multiplier + clique * region_type.costs.len() + item
            };
            let wanted = along.iter().enumerate();
            let mut moved: Vec<f64> = wanted
                .map(|(clique, d)| self.multipliers[slot(clique)] + step * d)
                .collect();
            onto_simplex(&mut moved, region_type.costs[item]);
            for (clique, multiplier) in moved.into_iter().enumerate() {
                self.multipliers[slot(clique)] = multiplier;
            }
            self.update_costs(region_type, item);
        }
    }
}

/// The nearest point whose coordinates are not negative and sum to `total`.
fn onto_simplex(point: &mut [f64], total: f64) {
    let mut falling = point.to_vec();
    falling.sort_by(|a, b| b.total_cmp(a));
    let (mut sum, mut shift) = (0.0, 0.0);
    for (i, x) in falling.iter().enumerate() {
        sum += x;
        let even = (sum - total) / (i + 1) as f64;
        // Not `<=`: where the total is 0 the largest coordinate itself is the shift.
        if *x < even {
            break;
        }
        shift = even;
    }
    for x in point {
        *x = (*x - shift).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{program_of_many_steps, programs_of_small_facades};
    use super::{Direction, Dual, Incumbent, onto_simplex};
    use crate::operations::Operations;
    use edifice_grammar::Costs;

    /// Each step looks at the items of all occurrences; steps end before one would look at more than is allowed, but
    /// for the first.
    #[test]
    fn steps_look_at_no_more_items_than_they_may() {
        let program = &program_of_many_steps();
        let items = program.items as u64;
        // Nothing divides these costs, so that no bound is rounded up and all steps are made.
        let costs = Costs {
            split: 2f64.sqrt(),
            ..Costs::default()
        };
        for (allowed, left) in [
            (0, 0),
            (items, 0),
            (3 * items, 0),
            (3 * items + 1, 1),
            (4 * items - 1, items - 1),
        ] {
            let mut incumbent = Incumbent::new(f64::INFINITY, &costs, Operations::default());
            let mut work = allowed;
            Dual::new(program).ascend(&mut incumbent, 1_000, &mut work);
            assert_eq!(work, left, "of {allowed}");
        }
    }

    /// Seven tenths of a direction are kept at each turn, until nothing worth a step is left.
    #[test]
    fn a_direction_fades_and_is_forgotten() {
        let programs = programs_of_small_facades();
        let dual = Dual::new(&programs[0]);
        let mut direction = Direction::from([((0, 0), vec![0.5, -0.5]), ((0, 1), vec![0.0, 0.0])]);
        dual.turn(&mut direction, &[]);
        assert_eq!(direction, Direction::from([((0, 0), vec![0.35, -0.35])]));
        for _ in 0..20 {
            dual.turn(&mut direction, &[]);
        }
        let kept = direction[&(0, 0)][0];
        assert!((kept - 0.5 * 0.7_f64.powi(21)).abs() < 1e-12, "{kept}");
        for _ in 0..20 {
            dual.turn(&mut direction, &[]);
        }
        assert!(direction.is_empty());
    }

    #[test]
    fn projections_are_points_of_the_simplex() {
        for (point, total, nearest) in [
            ([0.5, 0.2, -0.7], 0.0, [0.0; 3]),
            ([0.0; 3], 0.0, [0.0; 3]),
            ([0.5, 0.5, 0.5], 3.0, [1.0; 3]),
            ([2.0, 0.5, -1.0], 1.0, [1.0, 0.0, 0.0]),
        ] {
            let mut moved = point;
            onto_simplex(&mut moved, total);
            assert_eq!(moved, nearest, "{point:?} onto {total}");
        }
    }
}
