//! Branch and bound where the shares leave a gap.
//!
//! Branches decide which items rules have: in one no rule may have the item, in the other every rule of its type
//! has it, if the type has a rule at all. Shares found in one branch start the next, so the work is the same in
//! every run.

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
    let mut search = Search {
        program: &root.program,
        shares: Shares::from(&root.program, root.shares),
        limits,
        work,
    };
    search.run(root.lower, incumbent)
}

/// What is left at the root, where the bound does not meet the incumbent.
struct Root {
    program: Program,
    shares: Vec<f64>,
    lower: f64,
}

/// Steps of the first round at the root; each round doubles them.
const FIRST_ROUND: u64 = 20;
/// A program is made anew without what is fixed when at most this part of its items is left.
const WORTH_FIXING: f64 = 0.8;

/// Rounds of steps, each followed by variable fixing; `None` when the incumbent is proven optimal.
fn ascend_root(
    mut program: Program,
    incumbent: &mut Incumbent,
    steps: u64,
    work: &mut u64,
) -> Option<Root> {
    let mut lower: f64 = 0.0;
    let (mut round, mut made) = (FIRST_ROUND, 0);
    let mut shares = Shares::new(&program).shares;
    loop {
        let mut at = Shares::from(&program, shares);
        let found = at.ascend(incumbent, round.min(steps.saturating_sub(made)), work);
        lower = lower.max(incumbent.attainable(found.bound));
        if incumbent.is_optimal(lower) {
            return None;
        }
        let live = at.live(incumbent);
        shares = at.shares;
        if live.items(&program) as f64 <= WORTH_FIXING * program.items as f64 {
            (program, shares) = program.reduced(&live, &shares)?;
        }
        made += round;
        round *= 2;
        if made >= steps || *work < program.items as u64 {
            return Some(Root {
                program,
                shares,
                lower,
            });
        }
    }
}

/// A branch: what rules may not have, and the bound inherited from where it branched off.
struct Branch {
    lower: f64,
    /// Items by their index among those of all kinds.
    blocked: Vec<usize>,
}

struct Search<'a> {
    program: &'a Program,
    shares: Shares<'a>,
    limits: &'a BoundLimits,
    /// What is left of [`BoundLimits::work`].
    work: u64,
}

impl Search<'_> {
    /// The lower bound of all branches, and how many were examined.
    fn run(&mut self, root: f64, incumbent: &mut Incumbent) -> (f64, u64) {
        let mut open = vec![Branch {
            lower: root,
            blocked: Vec::new(),
        }];
        let mut nodes = 0;
        while let Some(branch) = pop_least(&mut open) {
            if incumbent.is_optimal(branch.lower) {
                break;
            }
            if nodes == self.limits.nodes || self.work < self.program.items as u64 {
                return (branch.lower, nodes);
            }
            nodes += 1;
            self.expand(branch, incumbent, &mut open);
        }
        (incumbent.cost, nodes)
    }

    fn expand(&mut self, branch: Branch, incumbent: &mut Incumbent, open: &mut Vec<Branch>) {
        self.shares.block(&branch.blocked);
        let steps = self.limits.branch_steps;
        let found = self.shares.ascend(incumbent, steps, &mut self.work);
        let lower = branch.lower.max(incumbent.attainable(found.bound));
        if incumbent.is_optimal(lower) {
            return;
        }
        let Some(item) = self.undecided(&found, &branch.blocked) else {
            // One derivation is left, and its grammar was offered.
            return;
        };
        for blocked in [vec![self.index(item)], self.alternatives(item)] {
            open.push(Branch {
                lower,
                blocked: [branch.blocked.as_slice(), &blocked].concat(),
            });
        }
    }

    fn index(&self, (kind, item): Item) -> usize {
        self.program.kinds[kind as usize].first + item
    }

    /// Items that no rule with this one has: other ways, and successors that overlap.
    fn alternatives(&self, (kind, item): Item) -> Vec<usize> {
        let known = &self.program.kinds[kind as usize];
        known
            .excluded_by(item)
            .map(|other| known.first + other)
            .collect()
    }

    /// The item to decide: the one that the cheapest derivations of the last steps were least sure of, else any of
    /// the last one that has an alternative; `None` when there is none.
    fn undecided(&self, found: &Ascent, blocked: &[usize]) -> Option<Item> {
        let free = |item: Item| !blocked.contains(&self.index(item));
        let open = |item: &Item| {
            let others = self.alternatives(*item);
            free(*item) && others.iter().any(|other| !blocked.contains(other))
        };
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
