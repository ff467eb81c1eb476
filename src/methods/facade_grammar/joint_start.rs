//! The start of a joint search: the union of the cheapest grammars of each facade alone.
//!
//! The union has the rules of all separate grammars, of each region type one, the cheapest; types that occur in several
//! facades share it. Then every type takes the cheapest rule over the types of the union
//! ([`crate::annealing`]), and types that no rule needs any more leave. Neither step raises the cost, so that the union
//! costs at most the sum of the separate grammars.

use std::collections::BTreeMap;
use std::rc::Rc;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::adp::search::Setup;
use crate::regions::{LayoutIndex, Region, Strips, TypeId, Types};
use crate::rules::AddRule;
use crate::rules::RuleCandidate;
use crate::rules::RulePricer;
use crate::rules::grid;
use crate::settings::InferError;
use edifice_base::{Progress, Watched};
use edifice_shape::{Axis, Facade};

/// A rule and its cost.
type Ruled = (f64, Rc<RuleCandidate>);

impl Setup<'_> {
    /// Rules of the union over the types of this search; `None` where equal sizes of one facade are told apart beside
    /// another facade, so that no rule over the union's types derives it.
    pub(crate) fn union(&self, facades: &[Facade]) -> Result<Option<Vec<AddRule>>, InferError> {
        let mut members = FxHashSet::default();
        let mut known: FxHashMap<TypeId, Ruled> = FxHashMap::default();
        for (index, facade) in facades.iter().enumerate() {
            let alone = std::slice::from_ref(facade);
            let one = |_| {
                self.watched
                    .tell(Progress::stage("a grammar of each facade"))
            };
            let watched = Watched::new(&one);
            let search = Setup::new(alone, self.settings, &watched)?;
            let (rules, _) = search.best(alone)?;
            let (from, to) = (&mut search.types.borrow_mut(), &mut self.types.borrow_mut());
            for rule in rules {
                let region = on_layout(from, rule.id, to, index);
                let id = to.intern(region);
                members.insert(id);
                let Some(candidate) = translated(from, &rule, to, id) else {
                    continue;
                };
                let cost = candidate.cost(&self.settings.costs);
                if known.get(&id).is_none_or(|(least, _)| cost < *least) {
                    known.insert(id, (cost, Rc::new(candidate)));
                }
            }
        }
        let mut pricer = RulePricer::new(self.settings.costs, self.settings.operations);
        let start = self.closed(|types, id| match known.get(&id) {
            Some(rule) => Some(rule.clone()),
            None => cheapest_over(&mut pricer, types, id, &members),
        });
        let Some(start) = start else {
            return Ok(None);
        };
        let members: FxHashSet<TypeId> = start.keys().copied().collect();
        let improved = self.closed(|types, id| {
            let before = start.get(&id).cloned();
            let found = cheapest_over(&mut pricer, types, id, &members);
            match (before, found) {
                (Some(before), Some(found)) if found.0 < before.0 => Some(found),
                (before, found) => before.or(found),
            }
        });
        let rules = improved.unwrap_or(start).into_iter();
        Ok(Some(
            rules
                .map(|(id, (_, candidate))| AddRule { id, candidate })
                .collect(),
        ))
    }

    /// The rules that the facades need, each as `pick` has it, in the order of their types.
    fn closed(
        &self,
        mut pick: impl FnMut(&mut Types, TypeId) -> Option<Ruled>,
    ) -> Option<BTreeMap<TypeId, Ruled>> {
        let types = &mut self.types.borrow_mut();
        let mut rules = BTreeMap::new();
        let mut waiting = types.roots.clone();
        while let Some(id) = waiting.pop() {
            if !types.is_terminal(id) && !rules.contains_key(&id) {
                let rule = pick(types, id)?;
                waiting.extend(&rule.1.successors);
                rules.insert(id, rule);
            }
        }
        Some(rules)
    }
}

/// The cheapest rule over some types and terminals.
fn cheapest_over(
    pricer: &mut RulePricer,
    types: &mut Types,
    id: TypeId,
    members: &FxHashSet<TypeId>,
) -> Option<Ruled> {
    let price = |types: &Types, id: TypeId| match types.is_terminal(id) || members.contains(&id) {
        true => 0.0,
        false => f64::INFINITY,
    };
    let (_, candidate) = pricer.cheapest(types, id, &price)?;
    Some((candidate.cost(&pricer.costs), Rc::new(candidate)))
}

/// A rule of one facade's own search as a rule for the same region, of type `id`, in another search; `None` where that
/// search tells sizes apart that are equal here.
fn translated(
    from: &mut Types,
    rule: &AddRule,
    to: &mut Types,
    id: TypeId,
) -> Option<RuleCandidate> {
    let candidate = &rule.candidate;
    let axes = match candidate.arrangement.axis() {
        Some(axis) => vec![axis],
        None => Axis::BOTH.to_vec(),
    };
    for &axis in &axes {
        let (old, new) = (from.strips(rule.id, axis), to.strips(id, axis));
        if !alike(&old, &new) {
            return None;
        }
    }
    match axes[..] {
        [axis] => {
            let (lines, strips) = (candidate.lines.clone(), to.strips(id, axis));
            Some(RuleCandidate::between(
                candidate.arrangement,
                lines,
                &strips,
            ))
        }
        _ => {
            let cells = to.cells(id)?;
            Some(grid::between(
                &cells,
                candidate.lines.clone(),
                candidate.rows.clone(),
            ))
        }
    }
}

/// True if rules over the strips of a region in one search hold in another: strips that are equal in the old are equal in the new.
fn alike(old: &Strips, new: &Strips) -> bool {
    let mut equal: FxHashMap<TypeId, TypeId> = FxHashMap::default();
    let pairs = || old.all().iter().zip(new.all());
    old.cuts.len() == new.cuts.len()
        && old.periods.iter().all(|p| new.periods.contains(p))
        && old
            .alternations
            .iter()
            .all(|a| new.alternations.contains(a))
        && old.mirrors.iter().all(|m| new.mirrors.contains(m))
        && pairs().all(|(&a, &b)| *equal.entry(a).or_insert(b) == b)
}

/// The first region of a type of one facade's own search, on that facade's layout in another search.
fn on_layout(from: &Types, id: TypeId, to: &Types, index: usize) -> Region {
    let (region, old, new) = (from.region(id), &from.layouts[0], &to.layouts[index]);
    let line = |edges: fn(&LayoutIndex) -> &Vec<f64>, at: u16| {
        nearest(edges(new), edges(old)[usize::from(at)])
    };
    Region {
        layout: index as u16,
        x0: line(|layout| &layout.xs, region.x0),
        x1: line(|layout| &layout.xs, region.x1),
        y0: line(|layout| &layout.ys, region.y0),
        y1: line(|layout| &layout.ys, region.y1),
    }
}

/// Index of the edge nearest to a coordinate.
fn nearest(edges: &[f64], at: f64) -> u16 {
    let next = edges
        .partition_point(|&edge| edge < at)
        .min(edges.len() - 1);
    let before = next.saturating_sub(1);
    match at - edges[before] < edges[next] - at {
        true => before as u16,
        false => next as u16,
    }
}
