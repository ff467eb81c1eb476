//! Branch and bound where the multipliers leave a gap.
//!
//! Branches decide which types have rules: in one the type has none, in the other it has one, and the part of the cost that all
//! its rules have in common is paid whatever the multipliers. Where all types of the cheapest derivation have rules, branches
//! decide which items these have: in one the rule may not have the item, in the other nothing that excludes it. A branch starts
//! from the multipliers of the one that it branched off from, and without what variable fixing takes out.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::ascent::{Ascent, Item};
use super::dual::Dual;
use super::fixing::Live;
use super::incumbent::Incumbent;
use super::program::Program;

/// Limits on the work that a bound may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundLimits {
    /// Items of the rules of all occurrences (some 30 bytes each) beyond which only the weak bound is given.
    pub items: usize,
    /// Maximum number of subgradient steps at the root.
    pub root_steps: u64,
    /// Maximum number of subgradient steps in every other branch.
    pub branch_steps: u64,
    /// Maximum number of branches examined.
    pub nodes: u64,
    /// Number of items that all steps may look at: those of all occurrences that variable fixing leaves, for each step.
    pub work: u64,
}

impl Default for BoundLimits {
    fn default() -> Self {
        Self {
            items: 10_000_000,
            root_steps: 2_000,
            branch_steps: 100,
            nodes: 1_000,
            work: u64::MAX,
        }
    }
}

/// The greatest lower bound on the cost of a grammar that is found, and how many branches were examined; the incumbent
/// becomes the best grammar met.
pub(crate) fn solve(
    program: Program,
    incumbent: &mut Incumbent,
    limits: &BoundLimits,
) -> (f64, u64) {
    let mut work = limits.work;
    let Some(root) = ascend_root(program, incumbent, limits.root_steps, &mut work) else {
        return (incumbent.cost, 1);
    };
    let mut open = vec![root];
    let mut nodes = 0;
    while let Some(branch) = pop_least(&mut open) {
        if incumbent.is_optimal(branch.lower) {
            break;
        }
        let exhausted = nodes == limits.nodes || work < branch.parent.program.items as u64;
        if exhausted || !incumbent.goes_on() {
            return (branch.lower, nodes);
        }
        nodes += 1;
        expand(
            &branch,
            incumbent,
            limits.branch_steps,
            &mut work,
            &mut open,
        );
    }
    (incumbent.cost, nodes)
}

/// Steps of the first round at the root; each round doubles them.
const FIRST_ROUND: u64 = 10;
/// A program is made anew without what is fixed when at most this part of its items is left.
const WORTH_FIXING: f64 = 0.8;
/// Rounds at the root go on while each closes this part of the gap.
const WORTH_A_ROUND: f64 = 0.1;

/// Rounds of steps at the root, each followed by variable fixing; `None` when the incumbent is proven optimal.
fn ascend_root(
    mut program: Program,
    incumbent: &mut Incumbent,
    steps: u64,
    work: &mut u64,
) -> Option<Branch> {
    let mut best = f64::NEG_INFINITY;
    let (mut round, mut made) = (FIRST_ROUND, 0);
    let mut multipliers = Dual::new(&program).multipliers;
    loop {
        let mut dual = Dual::from(&program, multipliers);
        let found = dual.ascend(incumbent, round.min(steps.saturating_sub(made)), work);
        let before = best;
        best = best.max(found.bound);
        let lower = incumbent.round_up(best);
        if incumbent.is_optimal(lower) {
            return None;
        }
        let live = dual.live(incumbent);
        multipliers = dual.multipliers;
        made += round;
        round *= 2;
        let converged = best - before < WORTH_A_ROUND * (incumbent.cost - best);
        let exhausted = made >= steps || *work < program.items as u64;
        if exhausted || converged || !incumbent.goes_on() {
            return Some(Branch {
                lower,
                parent: Rc::new(Expanded {
                    program,
                    multipliers,
                    live,
                }),
                decision: Decision::Nothing,
            });
        }
        if live.items(&program) as f64 <= WORTH_FIXING * program.items as f64 {
            (program, multipliers) = program.reduced(&live, &multipliers)?;
        }
    }
}

/// A program whose bound was raised, and what variable fixing leaves of it.
struct Expanded {
    program: Program,
    multipliers: Vec<f64>,
    live: Live,
}

/// A branch: the restriction of the rules, and the bound inherited from where it branched off.
struct Branch {
    lower: f64,
    parent: Rc<Expanded>,
    decision: Decision,
}

/// The decision of a branch, in terms of its parent's program.
enum Decision {
    Nothing,
    /// The type has no rule.
    WithoutType(u32),
    /// The type has a rule.
    WithType(u32),
    /// No rule has any of these items, by their index among those of all region types.
    WithoutItems(Vec<usize>),
}

fn expand(
    branch: &Branch,
    incumbent: &mut Incumbent,
    steps: u64,
    work: &mut u64,
    open: &mut Vec<Branch>,
) {
    let Some((program, multipliers)) = branch.program() else {
        return;
    };
    let mut dual = Dual::from(&program, multipliers);
    let found = dual.ascend(incumbent, steps, work);
    let lower = branch.lower.max(incumbent.round_up(found.bound));
    if incumbent.is_optimal(lower) {
        return;
    }
    let decisions = if let Some(region_type) = undecided_type(&program, &found) {
        [
            Decision::WithoutType(region_type),
            Decision::WithType(region_type),
        ]
    } else if let Some(item) = undecided_item(&program, &found) {
        let excluded = alternatives(&program, item).collect();
        let item = program.region_types[item.0 as usize].first + item.1;
        [vec![item], excluded].map(Decision::WithoutItems)
    } else {
        // One derivation is left, and its grammar was offered.
        return;
    };
    let live = dual.live(incumbent);
    let multipliers = dual.multipliers;
    let parent = Rc::new(Expanded {
        program,
        multipliers,
        live,
    });
    open.extend(decisions.map(|decision| Branch {
        lower,
        parent: Rc::clone(&parent),
        decision,
    }));
}

impl Branch {
    /// Its program and the multipliers to start from; `None` when it has no grammar cheaper than the incumbent.
    fn program(&self) -> Option<(Program, Vec<f64>)> {
        let Expanded {
            program,
            multipliers,
            live,
        } = &*self.parent;
        match &self.decision {
            Decision::Nothing => program.reduced(live, multipliers),
            Decision::WithoutItems(items) => {
                program.reduced(&live.without_items(items), multipliers)
            }
            Decision::WithoutType(region_type) => {
                let known = &program.region_types[*region_type as usize];
                program.reduced(&live.without_type(known), multipliers)
            }
            Decision::WithType(region_type) => {
                let region = program.region_types[*region_type as usize].region;
                let (mut program, mut multipliers) = program.reduced(live, multipliers)?;
                // Where nothing of it is left, no cheaper grammar has it.
                let region_type = program
                    .region_types
                    .iter()
                    .position(|known| known.region == region)?;
                program.require(region_type, &mut multipliers);
                Some((program, multipliers))
            }
        }
    }
}

/// Items that no rule with this one has: other operators, and successors that overlap.
fn alternatives(program: &Program, (region_type, item): Item) -> impl Iterator<Item = usize> {
    let known = &program.region_types[region_type as usize];
    known.excluded_by(item).map(|other| known.first + other)
}

/// The type to decide: the one that the derivations of the last steps were least sure of; `None` where the last one has
/// only types that are known to have rules.
fn undecided_type(program: &Program, found: &Ascent) -> Option<u32> {
    let mut doubts: BTreeMap<u32, f64> = BTreeMap::new();
    for (&(region_type, item), usage) in &found.usage {
        let known = &program.region_types[region_type as usize];
        if item >= known.arcs.len() {
            // Only one operator is used at an occurrence at a time.
            *doubts.entry(region_type).or_insert(0.0) += usage;
        }
    }
    let open = |region_type: u32| {
        let known = &program.region_types[region_type as usize];
        !known.required && !known.occurrences.iter().any(|p| program.roots.contains(p))
    };
    let doubt = |usage: f64| usage.min(1.0 - usage);
    let doubtful = doubts
        .iter()
        .filter(|(region_type, usage)| doubt(**usage) > 0.05 && open(**region_type));
    doubtful
        .max_by(|a, b| doubt(*a.1).total_cmp(&doubt(*b.1)))
        .map(|(region_type, _)| *region_type)
        .or_else(|| {
            found
                .items
                .iter()
                .map(|(region_type, _)| *region_type)
                .find(|region_type| open(*region_type))
        })
}

/// The item to decide: any of the last derivation that has an alternative.
fn undecided_item(program: &Program, found: &Ascent) -> Option<Item> {
    let open = |item: &Item| alternatives(program, *item).next().is_some();
    found.items.iter().copied().find(open)
}

/// The branch with the least bound, the youngest of equals.
fn pop_least(open: &mut Vec<Branch>) -> Option<Branch> {
    let least = last_least(open.iter().map(|branch| branch.lower))?;
    Some(open.remove(least))
}

/// Index of the least number, the last of equals.
fn last_least(bounds: impl DoubleEndedIterator<Item = f64> + ExactSizeIterator) -> Option<usize> {
    bounds
        .enumerate()
        .rev()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::super::region_type::RegionType;
    use super::super::tests::programs_of_small_facades;
    use super::{Ascent, Item, alternatives, last_least, undecided_item, undecided_type};
    use proptest::prelude::*;

    /// A type used in half of the steps is in doubt, one used in all or in none is not; the one of most doubt is decided first.
    #[test]
    fn the_type_that_steps_were_least_sure_of_is_decided() {
        let program = &programs_of_small_facades()[0];
        let open: Vec<u32> = (0..program.region_types.len() as u32)
            .filter(|&index| {
                let known = &program.region_types[index as usize];
                known.occurrences.iter().all(|o| !program.roots.contains(o))
            })
            .collect();
        let decided = |usage: &[(u32, f64)], last: u32| {
            let operation = |index: u32| program.region_types[index as usize].operation(0);
            let usage = usage
                .iter()
                .map(|&(index, share)| ((index, operation(index)), share));
            let found = Ascent {
                bound: 0.0,
                usage: usage.collect(),
                items: vec![(last, 0)],
            };
            undecided_type(program, &found)
        };
        let [a, b, c] = [open[0], open[1], open[2]];
        assert_eq!(decided(&[(a, 0.9), (b, 0.6), (c, 0.2)], a), Some(b));
        assert_eq!(decided(&[(a, 0.1), (b, 0.96), (c, 0.92)], b), Some(a));
        // Where all types are almost certain, one of the last derivation.
        assert_eq!(decided(&[(a, 0.02), (b, 0.99)], c), Some(c));
        assert_eq!(decided(&[], b), Some(b));
    }

    /// The first item of the derivation with an alternative; none of an empty one.
    #[test]
    fn the_first_item_with_an_alternative_is_decided() {
        for program in &programs_of_small_facades() {
            let types = program.region_types.iter().enumerate();
            let of_type = |(t, known): (usize, &RegionType)| {
                (0..known.costs.len()).map(move |item| (t as u32, item))
            };
            let items: Vec<Item> = types.flat_map(of_type).collect();
            let decided = |items: &[Item]| {
                let items = items.to_vec();
                let (bound, usage) = (0.0, Default::default());
                undecided_item(
                    program,
                    &Ascent {
                        bound,
                        usage,
                        items,
                    },
                )
            };
            for from in 0..items.len() {
                let has_other = |item: &&Item| alternatives(program, **item).next().is_some();
                let first = items[from..].iter().find(has_other).copied();
                assert_eq!(decided(&items[from..]), first);
            }
            assert_eq!(decided(&[]), None);
        }
    }

    proptest! {
        #[test]
        fn the_youngest_of_the_least_bounds_is_next(bounds in prop::collection::vec(0..4u8, 0..9)) {
            let found = last_least(bounds.iter().map(|&b| f64::from(b)));
            prop_assert_eq!(found.is_none(), bounds.is_empty());
            if let Some(found) = found {
                prop_assert!(bounds.iter().all(|&b| bounds[found] <= b));
                prop_assert!(bounds[found + 1..].iter().all(|&b| bounds[found] < b));
            }
        }
    }
}
