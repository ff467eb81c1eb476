//! The cheapest grammar, and a proof that it is: the costs of rules shared out among places.
//!
//! [`super`] says what a share is and why the least cost of a derivation under any shares bounds the cost of all
//! grammars from below. Here are the program (types, rules, places), the dynamic program over places, the
//! steps that raise the bound, and branch and bound.

mod ascent;
mod branch;
mod derivation;
mod fixing;
mod incumbent;
mod kind;
mod program;
mod purses;
mod require;
mod rules;

pub use branch::BoundLimits;
pub(crate) use branch::solve;
pub(crate) use incumbent::{Incumbent, NOISE};
pub(crate) use program::Program;

use ascent::{Ascent, Item};
use derivation::{Paths, Prices, Rule};
use incumbent::Restricted;
use kind::Kind;

/// Shares of costs, and the dynamic program under them.
#[derive(Debug)]
pub(crate) struct Shares<'a> {
    program: &'a Program,
    /// By purse and item.
    shares: Vec<f64>,
    /// What each place pays, by place and item: the sum over its purses.
    paid: Vec<f64>,
    /// `V`, by place.
    values: Vec<f64>,
    /// Way of the cheapest rule, by place.
    ways: Vec<usize>,
    paths: Paths,
    restricted: Restricted,
}

impl<'a> Shares<'a> {
    /// Equal shares.
    pub fn new(program: &'a Program) -> Self {
        let mut shares = Vec::with_capacity(program.shares);
        for kind in &program.kinds {
            let count = kind.purses.len();
            for _ in 0..count {
                shares.extend(kind.costs.iter().map(|cost| cost / count as f64));
            }
        }
        Self::from(program, shares)
    }

    /// Given shares, by purse and item.
    pub fn from(program: &'a Program, shares: Vec<f64>) -> Self {
        let mut values = vec![f64::INFINITY; program.values()];
        values[program.places.len()] = 0.0;
        let mut new = Self {
            program,
            shares,
            paid: vec![0.0; program.items],
            values,
            ways: vec![0; program.places.len()],
            paths: Paths::default(),
            restricted: Restricted::new(program),
        };
        new.pay_all();
        new
    }

    /// What the places of a kind pay for an item.
    fn pay(&mut self, kind: &Kind, item: usize) {
        let share =
            |&purse: &u32| self.shares[kind.first_share + purse as usize * kind.costs.len() + item];
        for (&place, purses) in kind.places.iter().zip(&kind.purses_of) {
            let slot = self.program.places[place as usize].first + item;
            self.paid[slot] = purses.iter().map(share).sum();
        }
    }

    /// What all places pay for all items.
    fn pay_all(&mut self) {
        let program = self.program;
        for kind in &program.kinds {
            for item in 0..kind.costs.len() {
                self.pay(kind, item);
            }
        }
    }

    /// `L`; infinite when what is left derives no facade.
    fn bound(&mut self) -> f64 {
        for &place in &self.program.order {
            let prices = prices(self.program, place, &self.paid, &self.values);
            let (value, way) = self.paths.cheapest(self.program, place, &prices);
            self.values[place as usize] = value;
            self.ways[place as usize] = way;
        }
        let roots = self.program.roots.iter();
        let derivation: f64 = roots.map(|&root| self.values[root as usize]).sum();
        self.program.constant + derivation
    }

    /// The cheapest derivation: the rule of each place that it splits.
    fn derivation(&mut self) -> Vec<(u32, Rule)> {
        let program = self.program;
        let mut derivation: Vec<(u32, Rule)> = Vec::new();
        let mut waiting = program.roots.clone();
        while let Some(place) = waiting.pop() {
            let prices = prices(program, place, &self.paid, &self.values);
            let way = self.ways[place as usize];
            let rule = self.paths.rule(program, place, way, &prices);
            let kind = program.kind(place);
            let parts = rule
                .arcs
                .iter()
                .flat_map(|&arc| program.parts(place, kind, arc));
            waiting.extend(parts.filter(|&part| !program.is_terminal(part)));
            derivation.push((place, rule));
        }
        derivation
    }
}

fn prices<'p>(program: &Program, place: u32, paid: &'p [f64], parts: &'p [f64]) -> Prices<'p> {
    let (kind, first) = (program.kind(place), program.places[place as usize].first);
    let items = kind.costs.len();
    Prices {
        items: &paid[first..first + items],
        parts,
    }
}

#[cfg(test)]
mod tests;
