//! All rules of all types, and all places of the facades where a derivation can meet them.

use std::ops::Range;
use std::rc::Rc;

use rustc_hash::FxHashMap;

use crate::grammar::Costs;
use crate::methods::facade_grammar::choice::{Arrangement, Choice, operation_cost};
use crate::methods::facade_grammar::operations::Operations;
use crate::methods::facade_grammar::regions::{Region, Strips, TypeId, Types, part};
use crate::methods::facade_grammar::walk::AddRule;
use crate::shape::{Axis, Facade};

/// What stands for the place of a terminal until all places are known.
const TERMINAL: u32 = u32::MAX;

/// A non-terminal type, and all rules that it can have. Each rule is a path: the *items* that it pays
/// for are the arcs of the path and, behind them, the operation.
#[derive(Debug)]
pub(crate) struct Kind {
    /// The first place found with the type.
    region: Region,
    pub ways: Vec<Way>,
    pub arcs: Vec<Arc>,
    /// Where the parts of arcs with several copies stand among those of a place.
    slots: Vec<u32>,
    /// Cost of each item: of the arcs, then of the ways.
    pub costs: Vec<f64>,
    /// Index of the kind's first item among those of all kinds.
    pub first: usize,
    /// Where the type occurs.
    pub places: Vec<u32>,
    /// Groups of places that pay together, each by its indices in `places`: of places that overlap, a derivation
    /// splits one at most.
    pub purses: Vec<Vec<u32>>,
    /// The purses of each place.
    pub purses_of: Vec<Vec<u32>>,
    /// Index of the first purse's first item among those of all purses.
    pub first_share: usize,
}

/// An operation along one axis: paths from node 0 to the last node.
#[derive(Debug)]
pub(crate) struct Way {
    arrangement: Arrangement,
    axis: Axis,
    pub last: u16,
    /// Sorted by where they lead.
    pub arcs: Range<usize>,
}

/// A successor of a rule, or the end of a mirrored rule whose halves meet.
#[derive(Debug)]
pub(crate) struct Arc {
    pub from: u16,
    pub to: u16,
    /// The cuts between which the successor stands first.
    pub lines: (u16, u16),
    /// How often the rule writes the successor out.
    copies: u32,
    /// Where the only copy stands among the parts of a place; of several copies, where their list begins.
    slot: u32,
}

impl Kind {
    /// Item of a way's operation.
    pub fn operation(&self, way: usize) -> usize {
        self.arcs.len() + way
    }

    /// Items that no rule with this one has.
    pub fn excluded_by(&self, item: usize) -> impl Iterator<Item = usize> {
        let way = |item: usize| match item.checked_sub(self.arcs.len()) {
            Some(way) => way,
            None => self.ways.partition_point(|w| w.arcs.end <= item),
        };
        let mine = way(item);
        let operations = (0..self.ways.len()).filter(move |&w| w != mine);
        let overlapping = self.ways[mine].arcs.clone().filter(move |&other| {
            other != item
                && self.arcs.get(item).is_some_and(|arc| {
                    self.arcs[other].from < arc.to && arc.from < self.arcs[other].to
                })
        });
        operations.map(|w| self.operation(w)).chain(overlapping)
    }

    /// The rule that follows some arcs of a way, as the other methods write it.
    pub fn rule(&self, types: &mut Types, way: usize, arcs: &[usize]) -> AddRule {
        let written = arcs.iter().map(|&a| &self.arcs[a]).filter(|a| a.copies > 0);
        let lines = std::iter::once(0)
            .chain(written.map(|a| a.lines.1))
            .collect();
        let middle = |arc: &Arc| arc.to == self.ways[way].last && arc.copies > 0;
        let arrangement = match self.ways[way].arrangement {
            Arrangement::Symmetric(axis, _) => {
                Arrangement::Symmetric(axis, arcs.iter().any(|&a| middle(&self.arcs[a])))
            }
            other => other,
        };
        let id = types.intern(self.region);
        let strips = types.strips(id, self.ways[way].axis);
        AddRule {
            id,
            choice: Rc::new(Choice::between(arrangement, lines, &strips)),
        }
    }
}

/// A rectangle of a facade that a derivation can split.
#[derive(Debug)]
pub(crate) struct Place {
    pub kind: u32,
    /// Index among the places of its kind.
    pub index: u32,
    /// Index of the place's first item among those of all places.
    pub first: usize,
    /// Index of its first part.
    parts: usize,
}

/// Kinds and places of one or several facades.
#[derive(Debug)]
pub(crate) struct Program {
    pub kinds: Vec<Kind>,
    pub places: Vec<Place>,
    /// Parts of all places: the strips along x, then those along y.
    parts: Vec<u32>,
    /// Places, parts before what they are parts of.
    pub order: Vec<u32>,
    /// The facades as a whole; several facades of one type have one root.
    pub roots: Vec<u32>,
    /// Number of items of all places.
    pub items: usize,
    /// Number of items of all kinds.
    pub kind_items: usize,
    /// Number of items of all purses.
    pub shares: usize,
}

impl Program {
    /// Everything that full lines can make of the facades; `None` when there are more than `limit` items,
    /// or when grids are allowed, whose rules are no paths.
    pub fn new(
        facades: &[Facade],
        costs: &Costs,
        operations: Operations,
        limit: usize,
    ) -> Option<Self> {
        if operations.grid_split {
            return None;
        }
        let types = &mut Types::new(facades);
        let mut survey = Survey::default();
        let mut roots: Vec<u32> = Vec::new();
        let mut seen: Vec<TypeId> = Vec::new();
        for index in 0..types.sheets.len() {
            let (root, id) = (types.sheets[index].root(index as u16), types.roots[index]);
            if !types.is_terminal(id) && !seen.contains(&id) {
                seen.push(id);
                roots.push(survey.place_of(root));
            }
        }
        let mut program = Self {
            kinds: Vec::new(),
            places: Vec::new(),
            parts: Vec::new(),
            order: Vec::new(),
            roots,
            items: 0,
            kind_items: 0,
            shares: 0,
        };
        let mut kinds: FxHashMap<TypeId, u32> = FxHashMap::default();
        while let Some(&region) = survey.regions.get(program.places.len()) {
            let id = types.intern(region);
            let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
            let fresh = program.kinds.len() as u32;
            let kind = *kinds.entry(id).or_insert(fresh);
            if kind == fresh {
                let new = kind_of(region, &strips, costs, operations, program.kind_items);
                program.kind_items += new.costs.len();
                program.kinds.push(new);
            }
            program.add(types, &mut survey, region, kind);
            if program.items > limit {
                return None;
            }
        }
        program.fill_purses(&survey);
        let terminal = program.places.len() as u32;
        for part in &mut program.parts {
            *part = terminal.min(*part);
        }
        program.order = (0..terminal).collect();
        program.order.sort_by_key(|&place| {
            let r = survey.regions[place as usize];
            u32::from(r.x1 - r.x0) * u32::from(r.y1 - r.y0)
        });
        Some(program)
    }

    /// A further place, with the strips that it can be split into.
    fn add(&mut self, types: &mut Types, survey: &mut Survey, region: Region, kind: u32) {
        let id = types.intern(region);
        let place = self.places.len() as u32;
        self.places.push(Place {
            kind,
            index: self.kinds[kind as usize].places.len() as u32,
            first: self.items,
            parts: self.parts.len(),
        });
        let known = &mut self.kinds[kind as usize];
        known.places.push(place);
        self.items += known.costs.len();
        for axis in Axis::BOTH {
            let strips = types.strips(id, axis);
            if strips.intervals() < 2 {
                continue;
            }
            let cuts = types.cuts_at(id, axis, region);
            for b in 1..cuts.len() {
                for a in 0..b {
                    self.parts
                        .push(match types.is_terminal(strips.strip(a, b)) {
                            true => TERMINAL,
                            false => survey.place_of(part(region, axis, cuts[a], cuts[b])),
                        });
                }
            }
        }
    }

    fn fill_purses(&mut self, survey: &Survey) {
        for kind in &mut self.kinds {
            let region = |&place: &u32| survey.regions[place as usize];
            kind.purses = purses(&kind.places.iter().map(region).collect::<Vec<_>>());
            kind.purses_of = vec![Vec::new(); kind.places.len()];
            for (purse, members) in kind.purses.iter().enumerate() {
                for &index in members {
                    kind.purses_of[index as usize].push(purse as u32);
                }
            }
            kind.first_share = self.shares;
            self.shares += kind.purses.len() * kind.costs.len();
        }
    }

    /// The kind of a place.
    pub fn kind(&self, place: u32) -> &Kind {
        &self.kinds[self.places[place as usize].kind as usize]
    }

    /// What an arc of a kind makes of one of its places.
    pub fn parts(&self, place: u32, kind: &Kind, arc: usize) -> impl Iterator<Item = u32> {
        let (first, arc) = (self.places[place as usize].parts, &kind.arcs[arc]);
        let slots = match arc.copies {
            1 => std::slice::from_ref(&arc.slot),
            copies => &kind.slots[arc.slot as usize..][..copies as usize],
        };
        slots
            .iter()
            .map(move |&slot| self.parts[first + slot as usize])
    }

    /// What the parts that an arc makes of a place cost together, given what each place costs.
    #[inline]
    pub fn below(&self, place: u32, kind: &Kind, arc: usize, values: &[f64]) -> f64 {
        let known = &kind.arcs[arc];
        if known.copies == 1 {
            let first = self.places[place as usize].parts;
            return values[self.parts[first + known.slot as usize] as usize];
        }
        self.parts(place, kind, arc)
            .map(|part| values[part as usize])
            .sum()
    }

    /// Whether a part is a terminal.
    pub fn is_terminal(&self, place: u32) -> bool {
        place as usize == self.places.len()
    }
}

/// The largest groups of regions that share a corner of one of them, each by its indices.
fn purses(regions: &[Region]) -> Vec<Vec<u32>> {
    let covering = |corner: &Region| -> Vec<u32> {
        let covers = |r: &Region| {
            r.sheet == corner.sheet
                && (r.x0..r.x1).contains(&corner.x0)
                && (r.y0..r.y1).contains(&corner.y0)
        };
        (0..regions.len() as u32)
            .filter(|&i| covers(&regions[i as usize]))
            .collect()
    };
    let mut groups: Vec<Vec<u32>> = regions.iter().map(covering).collect();
    groups.sort_by(|a, b| b.len().cmp(&a.len()).then_with(|| a.cmp(b)));
    let mut largest: Vec<Vec<u32>> = Vec::new();
    for group in groups {
        let within = |other: &Vec<u32>| group.iter().all(|i| other.binary_search(i).is_ok());
        if !largest.iter().any(within) {
            largest.push(group);
        }
    }
    largest
}

/// The places met so far.
#[derive(Default)]
struct Survey {
    regions: Vec<Region>,
    places: FxHashMap<Region, u32>,
}

impl Survey {
    fn place_of(&mut self, region: Region) -> u32 {
        let fresh = self.regions.len() as u32;
        let place = *self.places.entry(region).or_insert(fresh);
        if place == fresh {
            self.regions.push(region);
        }
        place
    }
}

/// All rules of a type.
fn kind_of(
    region: Region,
    strips: &[Rc<Strips>; 2],
    costs: &Costs,
    operations: Operations,
    first: usize,
) -> Kind {
    let mut rules = Rules::default();
    let mut offset = 0;
    for (axis, strips) in Axis::BOTH.into_iter().zip(strips) {
        if strips.intervals() < 2 {
            continue;
        }
        rules.offset = offset;
        offset += strips.all().len();
        rules.along(strips, axis, costs, operations);
    }
    let mut costs = rules.arc_costs;
    costs.extend(rules.way_costs);
    Kind {
        region,
        ways: rules.ways,
        arcs: rules.arcs,
        slots: rules.slots,
        costs,
        first,
        places: Vec::new(),
        purses: Vec::new(),
        purses_of: Vec::new(),
        first_share: 0,
    }
}

/// The rules of a type while they are listed.
#[derive(Default)]
struct Rules {
    ways: Vec<Way>,
    way_costs: Vec<f64>,
    arcs: Vec<Arc>,
    arc_costs: Vec<f64>,
    slots: Vec<u32>,
    /// First part along the axis at hand.
    offset: usize,
}

impl Rules {
    fn along(&mut self, strips: &Strips, axis: Axis, costs: &Costs, operations: Operations) {
        let n = strips.intervals();
        // The whole region is no successor of itself.
        self.paths(n, 1, costs, |a, b| b - a < n);
        self.close(n, Arrangement::Split(axis), axis, costs);
        if operations.repeat {
            for period in &strips.periods {
                let k = usize::from(period.intervals);
                self.paths(k, period.repeats.into(), costs, |_, _| true);
                self.close(k, Arrangement::Repeat(axis), axis, costs);
            }
        }
        if operations.repeat_aba {
            for &(a, b) in &strips.alternations {
                let (a, b) = (usize::from(a), usize::from(b));
                let outer = (0..n).step_by(b).map(|s| (s, s + a));
                let inner = (a..n).step_by(b).map(|s| (s, s + b - a));
                self.arc(0, 1, costs.successor, outer);
                self.arc(1, 2, costs.successor, inner);
                self.close(2, Arrangement::RepeatAba(axis), axis, costs);
            }
        }
        if operations.sym_split && strips.mirrors.len() > 1 {
            self.mirrored(strips, costs);
            let arrangement = Arrangement::Symmetric(axis, true);
            self.close(strips.mirrors.len(), arrangement, axis, costs);
        }
    }

    /// Arcs between the cuts of a period, each of which has its copies in all periods.
    fn paths(
        &mut self,
        period: usize,
        repeats: usize,
        costs: &Costs,
        allowed: impl Fn(usize, usize) -> bool,
    ) {
        for b in 1..=period {
            for a in (0..b).filter(|&a| allowed(a, b)) {
                let copies = (0..repeats).map(|r| (a + r * period, b + r * period));
                self.arc(a, b, costs.successor, copies);
            }
        }
    }

    /// Arcs between mirrored cuts, and those that close a rule: with what is left in the middle, or, where
    /// the two halves meet, with nothing.
    fn mirrored(&mut self, strips: &Strips, costs: &Costs) {
        let cut = |m: usize| {
            (
                usize::from(strips.mirrors[m].0),
                usize::from(strips.mirrors[m].1),
            )
        };
        let count = strips.mirrors.len();
        for b in 1..count {
            for a in 0..b {
                let (outer, inner) = (cut(a), cut(b));
                let halves = [(outer.0, inner.0), (inner.1, outer.1)];
                if strips.strip(outer.0, inner.0) == strips.strip(inner.1, outer.1) {
                    self.arc(a, b, costs.successor, halves);
                }
            }
        }
        for b in 1..count {
            match cut(b) {
                (left, right) if left == right => self.arc(b, count, 0.0, []),
                middle => self.arc(b, count, costs.successor, [middle]),
            }
        }
    }

    /// An arc with the strips, cut to cut, that its successor fills.
    fn arc(
        &mut self,
        from: usize,
        to: usize,
        cost: f64,
        copies: impl IntoIterator<Item = (usize, usize)>,
    ) {
        let first = self.slots.len();
        let mut lines = None;
        for (a, b) in copies {
            lines = lines.or(Some((a as u16, b as u16)));
            self.slots.push((self.offset + b * (b - 1) / 2 + a) as u32);
        }
        let copies = self.slots.len() - first;
        let slot = match copies {
            1 => self.slots.pop(),
            _ => None,
        };
        self.arcs.push(Arc {
            from: from as u16,
            to: to as u16,
            lines: lines.unwrap_or_default(),
            copies: copies as u32,
            slot: slot.unwrap_or(first as u32),
        });
        self.arc_costs.push(cost);
    }

    /// Ends a way: its arcs are those since the last one.
    fn close(&mut self, last: usize, arrangement: Arrangement, axis: Axis, costs: &Costs) {
        let start = self.ways.last().map_or(0, |w| w.arcs.end);
        self.ways.push(Way {
            arrangement,
            axis,
            last: last as u16,
            arcs: start..self.arcs.len(),
        });
        self.way_costs.push(operation_cost(arrangement, costs));
    }
}
