//! The inference over many facades: parse, n-ary, rules and statistics, in bounded memory.

use std::borrow::Borrow;

use rayon::prelude::*;

use super::affinity::{Affinity, Coefficients};
use super::alphabet::Alphabet;
use super::canvas::Canvas;
use super::nary::NaryTree;
use super::parameters::Parameters;
use super::parse::{BinaryTree, NoSplit, parse};
use super::rules::{Instance, RuleSet};
use edifice_shape::LabelGrid;

/// Facades parsed at once before their trees are added to the rules.
const CHUNK: usize = 256;

/// Rules and counts over the facades added so far; its size depends on the rules alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inference {
    /// The inferred rules.
    pub rules: RuleSet,
    /// Number of facades.
    pub facades: u64,
    /// Split nodes of all binary trees: the rules before any compression.
    pub binary_splits: u64,
    /// Split nodes of all n-ary trees: the rules after the transformation of Eq. 9.
    pub nary_splits: u64,
    /// Splits that had to cross an edge.
    pub forced: u64,
}

/// A parsed facade on its way into the rules.
struct Parsed {
    nary: NaryTree,
    binary_splits: usize,
    forced: usize,
}

impl Parsed {
    fn new(tree: &BinaryTree) -> Self {
        Self {
            nary: NaryTree::from_binary(tree),
            binary_splits: tree.splits(),
            forced: tree.forced,
        }
    }
}

impl Inference {
    /// Adds one parsed facade. Linear in the facade.
    pub fn add(&mut self, tree: &BinaryTree) -> Instance {
        self.add_parsed(&Parsed::new(tree))
    }

    fn add_parsed(&mut self, parsed: &Parsed) -> Instance {
        self.facades += 1;
        self.binary_splits += parsed.binary_splits as u64;
        self.nary_splits += parsed.nary.splits() as u64;
        self.forced += parsed.forced as u64;
        self.rules.add(&parsed.nary)
    }

    /// Parses and adds any number of facades, on all threads, and hands each instance to `keep` in
    /// the order of the facades. The result does not depend on the number of threads; beside the
    /// rules, memory holds one chunk of facades.
    ///
    /// # Errors
    /// [`NoSplit`], which label images never meet.
    pub fn add_all<G: Borrow<LabelGrid> + Sync>(
        &mut self,
        grids: impl IntoIterator<Item = G>,
        alphabet: &mut Alphabet,
        coefficients: &Coefficients,
        parameters: &Parameters,
        mut keep: impl FnMut(Instance),
    ) -> Result<(), NoSplit> {
        let mut grids = grids.into_iter();
        let mut chunk: Vec<(G, Vec<u32>)> = Vec::with_capacity(CHUNK);
        loop {
            chunk.clear();
            for grid in grids.by_ref().take(CHUNK) {
                let labels = alphabet.intern_all(&grid.borrow().labels);
                chunk.push((grid, labels));
            }
            if chunk.is_empty() {
                return Ok(());
            }
            let parsed: Vec<Parsed> = chunk
                .par_iter()
                .map(|(grid, labels)| {
                    let canvas = Canvas::from_grid(grid.borrow(), labels.clone());
                    Ok(Parsed::new(&parse(&canvas, coefficients, parameters)?))
                })
                .collect::<Result<_, NoSplit>>()?;
            for parsed in &parsed {
                keep(self.add_parsed(parsed));
            }
        }
    }
}

/// The affinities of a set of facades (Eq. 7 and 8), "computed across all facades".
///
/// The alphabet learns their labels. Linear in the cells.
pub fn learn_affinity<G: Borrow<LabelGrid>>(
    grids: impl IntoIterator<Item = G>,
    alphabet: &mut Alphabet,
    parameters: &Parameters,
) -> Affinity {
    let mut affinity = Affinity::new(parameters.facing);
    for grid in grids {
        let labels = alphabet.intern_all(&grid.borrow().labels);
        let canvas = Canvas::from_grid(grid.borrow(), labels);
        affinity.add(&canvas, alphabet.len());
    }
    affinity
}
