//! Branch and bound where the shares leave a gap.
//!
//! Branches decide which items rules have: in one no rule may have the item, in the other every rule of its type
//! has it, if the type has a rule at all. A branch starts from the shares of the one that it branched off from, and
//! without what variable fixing takes out.

use std::rc::Rc;

use super::fixing::Live;
use super::{Ascent, Incumbent, Item, Program, Shares};

/// How much work a bound may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundLimits {
    /// Items of the rules of all places (some 30 bytes each) beyond which only the weak bound is given.
    pub items: usize,
    /// Subgradient steps at the root.
    pub root_steps: u64,
    /// Subgradient steps in every other branch.
    pub branch_steps: u64,
    /// Branches examined.
    pub nodes: u64,
    /// Items that all steps may look at: those of all places that variable fixing leaves, for each step.
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
        if nodes == limits.nodes || work < branch.parent.program.items as u64 {
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
const FIRST_ROUND: u64 = 20;
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
    let mut shares = Shares::new(&program).shares;
    loop {
        let mut at = Shares::from(&program, shares);
        let found = at.ascend(incumbent, round.min(steps.saturating_sub(made)), work);
        let before = best;
        best = best.max(found.bound);
        let lower = incumbent.attainable(best);
        if incumbent.is_optimal(lower) {
            return None;
        }
        let live = at.live(incumbent);
        shares = at.shares;
        made += round;
        round *= 2;
        let converged = best - before < WORTH_A_ROUND * (incumbent.cost - best);
        if made >= steps || converged || *work < program.items as u64 {
            return Some(Branch {
                lower,
                parent: Rc::new(Expanded {
                    program,
                    shares,
                    live,
                }),
                blocked: Vec::new(),
            });
        }
        if live.items(&program) as f64 <= WORTH_FIXING * program.items as f64 {
            (program, shares) = program.reduced(&live, &shares)?;
        }
    }
}

/// A program whose bound was raised, and what variable fixing leaves of it.
struct Expanded {
    program: Program,
    shares: Vec<f64>,
    live: Live,
}

/// A branch: what rules may have, and the bound inherited from where it branched off.
struct Branch {
    lower: f64,
    parent: Rc<Expanded>,
    /// Items that no rule may have, by their index among those of all kinds.
    blocked: Vec<usize>,
}

fn expand(
    branch: &Branch,
    incumbent: &mut Incumbent,
    steps: u64,
    work: &mut u64,
    open: &mut Vec<Branch>,
) {
    let parent = &branch.parent;
    let live = parent.live.without(&branch.blocked);
    let Some((program, shares)) = parent.program.reduced(&live, &parent.shares) else {
        return;
    };
    let mut shares = Shares::from(&program, shares);
    let found = shares.ascend(incumbent, steps, work);
    let lower = branch.lower.max(incumbent.attainable(found.bound));
    if incumbent.is_optimal(lower) {
        return;
    }
    let Some(item) = undecided(&program, &found) else {
        // One derivation is left, and its grammar was offered.
        return;
    };
    let live = shares.live(incumbent);
    let shares = shares.shares;
    let alternatives = alternatives(&program, item).collect();
    let item = index(&program, item);
    let parent = Rc::new(Expanded {
        program,
        shares,
        live,
    });
    for blocked in [vec![item], alternatives] {
        open.push(Branch {
            lower,
            parent: Rc::clone(&parent),
            blocked,
        });
    }
}

fn index(program: &Program, (kind, item): Item) -> usize {
    program.kinds[kind as usize].first + item
}

/// Items that no rule with this one has: other ways, and successors that overlap.
fn alternatives(program: &Program, (kind, item): Item) -> impl Iterator<Item = usize> {
    let known = &program.kinds[kind as usize];
    known.excluded_by(item).map(|other| known.first + other)
}

/// The item to decide: the one that the cheapest derivations of the last steps were least sure of, else any of
/// the last one that has an alternative; `None` when there is none.
fn undecided(program: &Program, found: &Ascent) -> Option<Item> {
    let open = |item: &Item| alternatives(program, *item).next().is_some();
    let doubt = |usage: f64| usage.min(1.0 - usage);
    let doubtful = found
        .usage
        .iter()
        .filter(|(item, usage)| doubt(**usage) > 0.05 && open(item));
    doubtful
        .max_by(|a, b| doubt(*a.1).total_cmp(&doubt(*b.1)))
        .map(|(item, _)| *item)
        .or_else(|| found.items.iter().copied().find(open))
}

/// The branch with the least bound, the youngest of equals.
fn pop_least(open: &mut Vec<Branch>) -> Option<Branch> {
    let mut least = open.len().checked_sub(1)?;
    for i in (0..least).rev() {
        if open[i].lower < open[least].lower {
            least = i;
        }
    }
    Some(open.remove(least))
}
