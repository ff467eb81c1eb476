//! Comparing facades (Sec. 4.3): what two facades have in common.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::parse::{BinaryNode, BinaryTree};
use super::rules::{Call, RuleSet};
use edifice_cluster::{Histogram, chi_square};
use edifice_shape::Lattice;

/// An element of the powerset of operations and labels: bit 0 the split along x, bit 1 the split
/// along y, bit `2 + l` label `l`; without trailing zero words.
pub type AssetSet = Vec<u64>;

/// The features of a facade that the distances compare.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// For every node of the binary split tree, the operations and labels at and below it.
    pub powerset: Histogram<AssetSet>,
    /// Number of applications of each rule.
    pub rules: Histogram<u32>,
    /// Rows and columns of its windows, without any rule.
    pub lattice: Lattice,
}

impl Profile {
    /// The profile of a facade from its binary split tree, its starting rule and its lattice.
    pub fn new(tree: &BinaryTree, rules: &RuleSet, start: Call, lattice: Lattice) -> Self {
        Self {
            powerset: Histogram::count(asset_sets(tree)),
            rules: Histogram::count(rules.applied(start)),
            lattice,
        }
    }
}

/// A distance between facades (Eq. 13).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// `delta_powersets`: chi-square over the powerset histograms.
    Powerset,
    /// `delta_common`: chi-square over the frequencies of the rules that both facades share; of two
    /// facades that share none, half the number of their rules, as for any disjoint histograms.
    CommonRules,
    /// Chi-square over the frequencies of all rules of both facades.
    AllRules,
    /// The ratio of Eq. 14: rules of both together to the sum of the rules of each, 1/2 to 1.
    RuleUnion,
    /// Number of architectural changes between the lattices of both ([`Lattice::changes`]). Not of the paper: it knows
    /// no rule, and counts what Sec. 5.4 calls different as far as the labels tell it. Facades without a label
    /// `window` are all equal.
    Lattice,
}

impl Measure {
    /// All measures, those of the paper first.
    pub const ALL: [Self; 5] = [
        Self::Powerset,
        Self::CommonRules,
        Self::AllRules,
        Self::RuleUnion,
        Self::Lattice,
    ];

    /// Name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Powerset => "powerset",
            Self::CommonRules => "common_rules",
            Self::AllRules => "all_rules",
            Self::RuleUnion => "rule_union",
            Self::Lattice => "lattice",
        }
    }

    /// The distance between two facades; symmetric.
    pub fn distance(self, a: &Profile, b: &Profile) -> f64 {
        match self {
            Self::Powerset => chi_square(&a.powerset, &b.powerset),
            Self::CommonRules => {
                let shared = |rule: &u32| a.rules.get(rule) > 0.0 && b.rules.get(rule) > 0.0;
                if a.rules.bins().iter().any(|bin| shared(&bin.0)) {
                    chi_square(&a.rules.filtered(shared), &b.rules.filtered(shared))
                } else {
                    chi_square(&a.rules, &b.rules)
                }
            }
            Self::AllRules => chi_square(&a.rules, &b.rules),
            Self::RuleUnion => {
                let (one, other) = (a.rules.bins().len(), b.rules.bins().len());
                let both = |bin: &&(u32, f64)| b.rules.get(&bin.0) > 0.0;
                let shared = a.rules.bins().iter().filter(both).count();
                let total = (one + other).max(1);
                (total - shared) as f64 / total as f64
            }
            Self::Lattice => a.lattice.changes(&b.lattice) as f64,
        }
    }

    /// All pairwise distances; the diagonal of [`Measure::RuleUnion`] is 1/2, of the others 0.
    pub fn matrix(self, profiles: &[Profile]) -> DMatrix<f64> {
        let n = profiles.len();
        let mut matrix = DMatrix::zeros(n, n);
        for i in 0..n {
            for j in 0..=i {
                matrix[(i, j)] = self.distance(&profiles[j], &profiles[i]);
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
        matrix
    }
}

/// For every node, the set of operations and labels of its subtree, itself included.
fn asset_sets(tree: &BinaryTree) -> Vec<AssetSet> {
    let mut sets: Vec<AssetSet> = vec![Vec::new(); tree.nodes.len()];
    for (node, content) in tree.nodes.iter().enumerate().rev() {
        let mut set = AssetSet::new();
        match *content {
            BinaryNode::Insert(label) => insert(&mut set, 2 + label as usize),
            BinaryNode::Split { axis, children, .. } => {
                insert(&mut set, axis as usize);
                for child in children {
                    unite(&mut set, &sets[child as usize]);
                }
            }
        }
        sets[node] = set;
    }
    sets
}

fn insert(set: &mut AssetSet, bit: usize) {
    if set.len() <= bit / 64 {
        set.resize(bit / 64 + 1, 0);
    }
    set[bit / 64] |= 1 << (bit % 64);
}

fn unite(set: &mut AssetSet, other: &AssetSet) {
    if set.len() < other.len() {
        set.resize(other.len(), 0);
    }
    for (word, more) in set.iter_mut().zip(other) {
        *word |= more;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::LabelGrid;
    use std::collections::BTreeSet;

    fn profile(rules: &[u32]) -> Profile {
        Profile {
            powerset: Histogram::count(std::iter::empty()),
            rules: Histogram::count(rules.iter().copied()),
            lattice: Lattice::read(&LabelGrid {
                name: "wall".to_owned(),
                unit: "pixel".to_owned(),
                xs: vec![0.0, 10.0],
                ys: vec![0.0, 10.0],
                labels: vec!["wall".to_owned()],
                cells: vec![0],
            }),
        }
    }

    #[test]
    fn the_union_of_rules_is_counted_against_the_rules_of_each() {
        let distance = |a: &[u32], b: &[u32]| Measure::RuleUnion.distance(&profile(a), &profile(b));
        // Four rules in all of two and three; the same; none in common; how often a rule is used does not count.
        assert_eq!(distance(&[1, 2], &[2, 3, 4]), 4.0 / 5.0);
        assert_eq!(distance(&[1, 2, 3], &[3, 2, 1]), 0.5);
        assert_eq!(distance(&[1, 2], &[3]), 1.0);
        assert_eq!(distance(&[1, 1, 1, 2], &[2, 3, 4]), 4.0 / 5.0);
    }

    #[test]
    fn rules_in_common_are_compared_alone() {
        let (a, b) = (profile(&[1, 1, 2]), profile(&[1, 2, 2, 7, 7, 7]));
        let shared = chi_square(&Histogram::count([1, 1, 2]), &Histogram::count([1, 2, 2]));
        assert_eq!(Measure::CommonRules.distance(&a, &b), shared);
        assert!(Measure::AllRules.distance(&a, &b) > shared);
        for measure in Measure::ALL {
            assert_eq!(measure.distance(&a, &b), measure.distance(&b, &a));
        }
        let names: BTreeSet<&str> = Measure::ALL.iter().map(|m| m.name()).collect();
        assert_eq!(names.len(), Measure::ALL.len());
        assert!(names.iter().all(|name| name.len() > 5), "{names:?}");
    }
}
