//! The types and places that derivations of some facades can meet.

use rustc_hash::FxHashMap;

use super::kind::Kind;
use super::purses::purses;
use super::rules::kind_of;
use crate::grammar::Costs;
use crate::methods::facade_grammar::operations::Operations;
use crate::methods::facade_grammar::regions::{Region, TypeId, Types, part};
use crate::shape::Axis;

/// What stands for the place of a terminal until all places are known.
const TERMINAL: u32 = u32::MAX;

/// A rectangle of a facade that a derivation can split.
#[derive(Debug)]
pub(crate) struct Place {
    pub region: Region,
    pub kind: u32,
    /// Index among the places of its kind.
    pub index: u32,
    /// Index of the place's first item among those of all places.
    pub first: usize,
    /// Index of its first part.
    pub(super) parts: usize,
}

/// Kinds and places of one or several facades.
#[derive(Debug)]
pub(crate) struct Program {
    pub kinds: Vec<Kind>,
    pub places: Vec<Place>,
    /// Parts of all places: the strips along x, then those along y. Each is a place, the number of places for a terminal,
    /// or what [`Program::removed`] says.
    pub(super) parts: Vec<u32>,
    /// Places, parts before what they are parts of.
    pub order: Vec<u32>,
    /// The facades as a whole; several facades of one type have one root.
    pub roots: Vec<u32>,
    /// Cost that no share pays: of what rules of required types have in common.
    pub constant: f64,
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
        mut types: Types,
        costs: &Costs,
        operations: Operations,
        limit: usize,
    ) -> Option<Self> {
        if operations.grid_split {
            return None;
        }
        let types = &mut types;
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
            constant: 0.0,
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
            // A place has two successors and an operation at least.
            if program.items.max(3 * survey.regions.len()) > limit {
                return None;
            }
        }
        program.fill_purses();
        let terminal = program.places.len() as u32;
        for part in &mut program.parts {
            *part = terminal.min(*part);
        }
        program.order = (0..terminal).collect();
        program.order.sort_by_key(|&place| {
            let r = program.places[place as usize].region;
            u32::from(r.x1 - r.x0) * u32::from(r.y1 - r.y0)
        });
        Some(program)
    }

    /// A further place, with the strips that it can be split into.
    fn add(&mut self, types: &mut Types, survey: &mut Survey, region: Region, kind: u32) {
        let id = types.intern(region);
        let place = self.places.len() as u32;
        self.places.push(Place {
            region,
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

    /// Groups the places of each kind.
    pub(super) fn fill_purses(&mut self) {
        for kind in &mut self.kinds {
            let region = |&place: &u32| self.places[place as usize].region;
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
    pub fn is_terminal(&self, part: u32) -> bool {
        part as usize == self.places.len()
    }

    /// What stands for the places of a kind that variable fixing removed.
    pub fn removed(&self, kind: u32) -> u32 {
        self.places.len() as u32 + 1 + kind
    }

    /// What stands for the places of kinds that were removed altogether.
    pub(super) fn removed_kinds(&self) -> u32 {
        self.removed(self.kinds.len() as u32)
    }

    /// The kind of a part that is no terminal.
    pub fn kind_of(&self, part: u32) -> u32 {
        match self.places.get(part as usize) {
            Some(place) => place.kind,
            None => part - self.removed(0),
        }
    }

    /// Number of values that parts have: of places, of terminals, and of what was removed.
    pub fn values(&self) -> usize {
        self.removed_kinds() as usize + 1
    }
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
