//! Grammar inference as a decision process (Sec. 4.1 and 4.2).
//!
//! A state is the set of rules so far; an action adds a rule for the next non-terminal region
//! without one, bottom to top and left to right. Only the first instance of a region is split: all
//! others have its type, and so its rule.

use std::cell::RefCell;
use std::rc::Rc;

use rand::Rng;

use super::exploration::Exploration;
use super::readings::Protect;
use super::value_estimates::ValueEstimates;
use crate::regions::{TypeId, Types};
use crate::rules::AddRule;
use crate::rules::RulePricer;
use edifice_grammar::Costs;
use edifice_optim::adp::{Approximation, Heuristic, Process};

/// Types are interned while the search discovers them, by every part of the solver.
pub(crate) type SharedTypes = Rc<RefCell<Types>>;

/// Rules so far, and what is still to be split.
#[derive(Debug)]
pub(crate) struct Derivation {
    /// Types that have a rule or wait for one, in the order of their discovery.
    pub known: Vec<TypeId>,
    /// One bit for each type, 64 a word, set if the type is known; small, since it is made anew for each walk.
    is_known: Vec<u64>,
    /// Types that wait, the next one last: place of the region (bottom to top, left to right), type.
    waiting: Vec<((u16, u16, u16), TypeId)>,
}

impl Derivation {
    /// True if the type has a rule or waits for one.
    pub(crate) fn knows(&self, id: TypeId) -> bool {
        let word = self.is_known.get(id as usize / 64);
        word.is_some_and(|word| word >> (id % 64) & 1 == 1)
    }

    /// The type to split next. The process is not final.
    pub(crate) fn next(&self) -> TypeId {
        self.waiting.last().map_or(TypeId::MAX, |(_, id)| *id)
    }

    fn discover(&mut self, types: &Types, id: TypeId) {
        if !types.is_terminal(id) && !self.knows(id) {
            self.is_known.resize(types.len().div_ceil(64), 0);
            self.is_known[id as usize / 64] |= 1 << (id % 64);
            self.known.push(id);
            let r = types.region(id);
            let entry = ((r.layout, r.y0, r.x0), id);
            let at = self.waiting.partition_point(|w| *w > entry);
            self.waiting.insert(at, entry);
        }
    }
}

/// The decision process of one or several facades.
#[derive(Debug)]
pub(crate) struct Inference {
    pub types: SharedTypes,
    pub costs: Costs,
}

impl Process for Inference {
    type State = Derivation;
    type Action = AddRule;

    fn initial(&self) -> Derivation {
        let mut state = Derivation {
            known: Vec::new(),
            is_known: Vec::new(),
            waiting: Vec::new(),
        };
        let types = self.types.borrow();
        for &root in &types.roots {
            state.discover(&types, root);
        }
        state
    }

    fn is_final(&self, state: &Derivation) -> bool {
        state.waiting.is_empty()
    }

    fn is_exhausted(&self) -> bool {
        self.types.borrow().is_full()
    }

    fn cost(&self, _: &Derivation, action: &AddRule) -> f64 {
        action.candidate.cost(&self.costs)
    }

    fn apply(&self, state: &mut Derivation, action: &AddRule) {
        state.waiting.pop();
        let types = self.types.borrow();
        for &successor in &action.candidate.successors {
            state.discover(&types, successor);
        }
    }
}

/// Draws rules from the splitting heuristic.
pub(crate) struct Explore {
    types: SharedTypes,
    exploration: Rc<RefCell<Exploration>>,
    protect: Protect,
    /// True once the regions of [`Protect::Run`] were drawn.
    drawn: bool,
}

impl Explore {
    pub(crate) fn new(
        types: SharedTypes,
        exploration: Rc<RefCell<Exploration>>,
        protect: Protect,
    ) -> Self {
        Self {
            types,
            exploration,
            protect,
            drawn: false,
        }
    }
}

impl Heuristic<Inference> for Explore {
    fn start_walk<R: Rng>(&mut self, _: &mut Inference, rng: &mut R) {
        let mut exploration = self.exploration.borrow_mut();
        let protection = exploration.protection();
        match self.protect {
            Protect::Never => protection.lift(),
            Protect::Walk { draws } => protection.draw(draws, rng),
            Protect::Run if self.drawn => protection.restore(),
            Protect::Run => protection.draw_all(&self.types.borrow().extents(), rng),
        }
        self.drawn = true;
    }

    fn sample<R: Rng>(&mut self, _: &mut Inference, state: &Derivation, rng: &mut R) -> AddRule {
        let id = state.next();
        let candidate = self
            .exploration
            .borrow_mut()
            .sample(&mut self.types.borrow_mut(), id, rng);
        AddRule { id, candidate }
    }
}

/// The approximation of the default method: over all rules, by shortest paths, with the
/// learnt values as prices.
#[derive(Debug)]
pub(crate) struct ShortestPathRules {
    pricer: RulePricer,
    /// `V(R)` by type, infinite when unknown.
    values: Vec<f64>,
    /// Prices of this walk: 0 for what is known already.
    prices: Vec<f64>,
    settled: usize,
    zeroed: Vec<TypeId>,
    estimates: ValueEstimates,
}

impl ShortestPathRules {
    pub(crate) fn new(pricer: RulePricer) -> Self {
        Self {
            pricer,
            values: Vec::new(),
            prices: Vec::new(),
            settled: 0,
            zeroed: Vec::new(),
            estimates: ValueEstimates::default(),
        }
    }

    /// The least `V(R)` learnt, by type; infinite where nothing is known.
    pub(crate) fn into_values(self) -> Vec<f64> {
        self.values
    }

    /// Initial estimate of a type's cost, before it was ever split: a rule with all its terminals.
    fn guess(types: &Types, id: TypeId, costs: &Costs) -> f64 {
        if types.is_terminal(id) {
            0.0
        } else {
            costs.split + costs.successor * f64::from(types.terminals(id))
        }
    }

    fn extend(&mut self, types: &Types) {
        let costs = self.pricer.costs;
        for id in self.values.len()..types.len() {
            let guess = Self::guess(types, id as TypeId, &costs);
            self.values.push(guess);
            self.prices.push(guess);
        }
    }

    /// Prices follow the walk: what it knows already is free.
    fn follow(&mut self, state: &Derivation) {
        for &id in &state.known[self.settled..] {
            self.prices[id as usize] = 0.0;
            self.zeroed.push(id);
        }
        self.settled = state.known.len();
    }
}

impl Approximation<Inference> for ShortestPathRules {
    fn best(&mut self, process: &mut Inference, state: &Derivation) -> Option<AddRule> {
        let id = state.next();
        let types = &mut process.types.borrow_mut();
        self.extend(types);
        self.follow(state);
        let (costs, prices) = (self.pricer.costs, &self.prices);
        let price = |types: &Types, t: TypeId| {
            prices
                .get(t as usize)
                .copied()
                .unwrap_or_else(|| Self::guess(types, t, &costs))
        };
        let (_, candidate) = self.pricer.cheapest(types, id, &price)?;
        Some(AddRule {
            id,
            candidate: Rc::new(candidate),
        })
    }

    fn learn(&mut self, process: &mut Inference, walk: &[AddRule], costs: &[f64]) {
        self.extend(&process.types.borrow());
        for (action, value) in walk.iter().zip(self.estimates.costs(walk, costs)) {
            let known = &mut self.values[action.id as usize];
            *known = known.min(value);
        }
        for id in self.zeroed.drain(..) {
            self.prices[id as usize] = self.values[id as usize];
        }
        for action in walk {
            self.prices[action.id as usize] = self.values[action.id as usize];
        }
        self.settled = 0;
    }
}
