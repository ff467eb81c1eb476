//! The types and occurrences that derivations of some facades can meet.

use rustc_hash::FxHashMap;

use super::cliques::cliques;
use super::region_type::RegionType;
use super::rules::region_type_of;
use crate::operations::Operations;
use crate::regions::{Region, TypeId, Types, part};
use edifice_base::{Progress, Watched};
use edifice_grammar::Costs;
use edifice_shape::Axis;

/// The part that stands for a terminal until all occurrences are known.
const TERMINAL: u32 = u32::MAX;

/// A rectangle of a facade that a derivation can split.
#[derive(Debug)]
pub(crate) struct Occurrence {
    pub region: Region,
    pub region_type: u32,
    /// Index among the occurrences of its region type.
    pub index: u32,
    /// Index of the occurrence's first item among those of all occurrences.
    pub first: usize,
    /// Index of its first part.
    pub(super) parts: usize,
}

/// Region types and occurrences of one or several facades.
#[derive(Debug)]
pub(crate) struct Program {
    pub region_types: Vec<RegionType>,
    pub occurrences: Vec<Occurrence>,
    /// Parts of all occurrences: the strips along x, then those along y. Each is the index of an occurrence, or the number of
    /// occurrences for a terminal, or an index that [`Program::removed`] gives.
    pub(super) parts: Vec<u32>,
    /// Occurrences, parts before what they are parts of.
    pub order: Vec<u32>,
    /// The facades as a whole; several facades of one type have one root.
    pub roots: Vec<u32>,
    /// Cost that is not split by multipliers: what all rules of required types have in common.
    pub constant: f64,
    /// Number of items of all occurrences.
    pub items: usize,
    /// Number of items of all region types.
    pub type_items: usize,
    /// Number of items of all cliques.
    pub multipliers: usize,
}

impl Program {
    /// Everything that full lines can make of the facades; `None` when there are more than `limit` items,
    /// when grids are allowed, whose rules are no paths, or when the search is stopped meanwhile.
    pub(crate) fn new(
        mut types: Types,
        costs: &Costs,
        operations: Operations,
        limit: usize,
        watched: &Watched,
    ) -> Option<Self> {
        if operations.grid_split {
            return None;
        }
        let types = &mut types;
        let mut index_of = OccurrenceIndex::default();
        let mut roots: Vec<u32> = Vec::new();
        let mut seen: Vec<TypeId> = Vec::new();
        for index in 0..types.layouts.len() {
            let (root, id) = (types.layouts[index].root(index as u16), types.roots[index]);
            if !types.is_terminal(id) && !seen.contains(&id) {
                seen.push(id);
                roots.push(index_of.occurrence_of(root));
            }
        }
        let mut program = Self {
            region_types: Vec::new(),
            occurrences: Vec::new(),
            parts: Vec::new(),
            order: Vec::new(),
            roots,
            constant: 0.0,
            items: 0,
            type_items: 0,
            multipliers: 0,
        };
        let mut region_types: FxHashMap<TypeId, u32> = FxHashMap::default();
        while let Some(&region) = index_of.regions.get(program.occurrences.len()) {
            let id = types.intern(region);
            let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
            let fresh = program.region_types.len() as u32;
            let region_type = *region_types.entry(id).or_insert(fresh);
            if region_type == fresh {
                let new = region_type_of(region, &strips, costs, operations, program.type_items);
                program.type_items += new.costs.len();
                program.region_types.push(new);
            }
            program.add(types, &mut index_of, region, region_type);
            // An occurrence has two successors and an operation at least.
            let too_large = program.items.max(3 * index_of.regions.len()) > limit;
            if too_large || !watched.goes_on(Progress::stage("rules of all regions")) {
                return None;
            }
        }
        program.fill_cliques();
        let terminal = program.occurrences.len() as u32;
        for part in &mut program.parts {
            *part = terminal.min(*part);
        }
        program.order = (0..terminal).collect();
        program.order.sort_by_key(|&occurrence| {
            let r = program.occurrences[occurrence as usize].region;
            u32::from(r.x1 - r.x0) * u32::from(r.y1 - r.y0)
        });
        Some(program)
    }

    /// A further occurrence, with the strips that it can be split into.
    fn add(
        &mut self,
        types: &mut Types,
        index_of: &mut OccurrenceIndex,
        region: Region,
        region_type: u32,
    ) {
        let id = types.intern(region);
        let occurrence = self.occurrences.len() as u32;
        self.occurrences.push(Occurrence {
            region,
            region_type,
            index: self.region_types[region_type as usize].occurrences.len() as u32,
            first: self.items,
            parts: self.parts.len(),
        });
        let known = &mut self.region_types[region_type as usize];
        known.occurrences.push(occurrence);
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
                            false => index_of.occurrence_of(part(region, axis, cuts[a], cuts[b])),
                        });
                }
            }
        }
    }

    /// Finds the maximal cliques of overlapping occurrences of each region type.
    pub(super) fn fill_cliques(&mut self) {
        for region_type in &mut self.region_types {
            let region = |&occurrence: &u32| self.occurrences[occurrence as usize].region;
            region_type.cliques = cliques(
                &region_type
                    .occurrences
                    .iter()
                    .map(region)
                    .collect::<Vec<_>>(),
            );
            region_type.cliques_of = vec![Vec::new(); region_type.occurrences.len()];
            for (clique, members) in region_type.cliques.iter().enumerate() {
                for &index in members {
                    region_type.cliques_of[index as usize].push(clique as u32);
                }
            }
            region_type.first_multiplier = self.multipliers;
            self.multipliers += region_type.cliques.len() * region_type.costs.len();
        }
    }

    /// The region type of an occurrence.
    pub(crate) fn region_type(&self, occurrence: u32) -> &RegionType {
        &self.region_types[self.occurrences[occurrence as usize].region_type as usize]
    }

    /// The parts into which an arc of a region type splits one of its occurrences.
    pub(crate) fn parts(
        &self,
        occurrence: u32,
        region_type: &RegionType,
        arc: usize,
    ) -> impl Iterator<Item = u32> {
        let (first, arc) = (
            self.occurrences[occurrence as usize].parts,
            &region_type.arcs[arc],
        );
        let slots = match arc.copies {
            1 => std::slice::from_ref(&arc.slot),
            copies => &region_type.slots[arc.slot as usize..][..copies as usize],
        };
        slots
            .iter()
            .map(move |&slot| self.parts[first + slot as usize])
    }

    /// The sum of the costs of the parts that an arc makes of an occurrence, given the cost of each occurrence.
    #[inline]
    pub(crate) fn below(
        &self,
        occurrence: u32,
        region_type: &RegionType,
        arc: usize,
        values: &[f64],
    ) -> f64 {
        let known = &region_type.arcs[arc];
        if known.copies == 1 {
            let first = self.occurrences[occurrence as usize].parts;
            return values[self.parts[first + known.slot as usize] as usize];
        }
        self.parts(occurrence, region_type, arc)
            .map(|part| values[part as usize])
            .sum()
    }

    /// True if a part is a terminal.
    pub(crate) fn is_terminal(&self, part: u32) -> bool {
        part as usize == self.occurrences.len()
    }

    /// Index that stands for the occurrences of a region type that variable fixing removed.
    pub(crate) fn removed(&self, region_type: u32) -> u32 {
        self.occurrences.len() as u32 + 1 + region_type
    }

    /// Index that stands for the occurrences of region types that were removed altogether.
    pub(super) fn removed_types(&self) -> u32 {
        self.removed(self.region_types.len() as u32)
    }

    /// The region type of a part that is no terminal.
    pub(crate) fn region_type_of(&self, part: u32) -> u32 {
        match self.occurrences.get(part as usize) {
            Some(occurrence) => occurrence.region_type,
            None => part - self.removed(0),
        }
    }

    /// Number of values that parts have: of occurrences, of terminals, and of what was removed.
    pub(crate) fn values(&self) -> usize {
        self.removed_types() as usize + 1
    }
}

/// The occurrences met so far.
#[derive(Default)]
struct OccurrenceIndex {
    regions: Vec<Region>,
    occurrences: FxHashMap<Region, u32>,
}

impl OccurrenceIndex {
    fn occurrence_of(&mut self, region: Region) -> u32 {
        let fresh = self.regions.len() as u32;
        let occurrence = *self.occurrences.entry(region).or_insert(fresh);
        if occurrence == fresh {
            self.regions.push(region);
        }
        occurrence
    }
}
