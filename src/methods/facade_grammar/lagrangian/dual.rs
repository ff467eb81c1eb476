//! The Lagrangian dual of a program under given multipliers.

use super::derivation::{Paths, Prices, Rule};
use super::incumbent::Restricted;
use super::program::Program;
use super::region_type::RegionType;

/// The Lagrangian dual: multipliers that split the costs of items, and the dynamic program that evaluates `L` under them.
#[derive(Debug)]
pub(crate) struct Dual<'a> {
    pub(super) program: &'a Program,
    /// Multiplier of each item, clique by clique.
    pub(super) multipliers: Vec<f64>,
    /// Cost of each item at each occurrence: the sum of the multipliers over its cliques.
    pub(super) item_costs: Vec<f64>,
    /// `V`: cost of the cheapest derivation of each occurrence.
    pub(super) values: Vec<f64>,
    /// Operator of the cheapest rule of each occurrence.
    pub(super) operators: Vec<usize>,
    pub(super) paths: Paths,
    pub(super) restricted: Restricted,
}

impl<'a> Dual<'a> {
    /// The dual with equal multipliers over the cliques of each region type.
    pub(super) fn new(program: &'a Program) -> Self {
        let mut multipliers = Vec::with_capacity(program.multipliers);
        for region_type in &program.region_types {
            let count = region_type.cliques.len();
            for _ in 0..count {
                multipliers.extend(region_type.costs.iter().map(|cost| cost / count as f64));
            }
        }
        Self::from(program, multipliers)
    }

    /// The dual with given multipliers, by clique and item.
    pub(super) fn from(program: &'a Program, multipliers: Vec<f64>) -> Self {
        let mut values = vec![f64::INFINITY; program.values()];
        values[program.occurrences.len()] = 0.0;
        let mut new = Self {
            program,
            multipliers,
            item_costs: vec![0.0; program.items],
            values,
            operators: vec![0; program.occurrences.len()],
            paths: Paths::default(),
            restricted: Restricted::new(program),
        };
        new.update_all_costs();
        new
    }

    /// Cost of an item at the occurrences of a region type.
    pub(super) fn update_costs(&mut self, region_type: &RegionType, item: usize) {
        let multiplier = |&clique: &u32| {
            self.multipliers
                [region_type.first_multiplier + clique as usize * region_type.costs.len() + item]
        };
        for (&occurrence, cliques) in region_type.occurrences.iter().zip(&region_type.cliques_of) {
            let slot = self.program.occurrences[occurrence as usize].first + item;
            self.item_costs[slot] = cliques.iter().map(multiplier).sum();
        }
    }

    /// Costs of all items at all occurrences.
    pub(super) fn update_all_costs(&mut self) {
        let program = self.program;
        for region_type in &program.region_types {
            for item in 0..region_type.costs.len() {
                self.update_costs(region_type, item);
            }
        }
    }

    /// `L`, a lower bound of the cost of every grammar; infinite when what is left derives no facade.
    pub(super) fn bound(&mut self) -> f64 {
        for &occurrence in &self.program.order {
            let prices = prices(self.program, occurrence, &self.item_costs, &self.values);
            let (value, operator) = self.paths.cheapest(self.program, occurrence, &prices);
            self.values[occurrence as usize] = value;
            self.operators[occurrence as usize] = operator;
        }
        let roots = self.program.roots.iter();
        let derivation: f64 = roots.map(|&root| self.values[root as usize]).sum();
        self.program.constant + derivation
    }

    /// The cheapest derivation: the rule of each occurrence that it splits.
    pub(super) fn derivation(&mut self) -> Vec<(u32, Rule)> {
        let program = self.program;
        let mut derivation: Vec<(u32, Rule)> = Vec::new();
        let mut waiting = program.roots.clone();
        while let Some(occurrence) = waiting.pop() {
            let prices = prices(program, occurrence, &self.item_costs, &self.values);
            let operator = self.operators[occurrence as usize];
            let rule = self.paths.rule(program, occurrence, operator, &prices);
            let region_type = program.region_type(occurrence);
            let parts = rule
                .arcs
                .iter()
                .flat_map(|&arc| program.parts(occurrence, region_type, arc));
            waiting.extend(parts.filter(|&part| !program.is_terminal(part)));
            derivation.push((occurrence, rule));
        }
        derivation
    }
}

pub(super) fn prices<'p>(
    program: &Program,
    occurrence: u32,
    item_costs: &'p [f64],
    parts: &'p [f64],
) -> Prices<'p> {
    let (region_type, first) = (
        program.region_type(occurrence),
        program.occurrences[occurrence as usize].first,
    );
    let items = region_type.costs.len();
    Prices {
        items: &item_costs[first..first + items],
        parts,
    }
}
