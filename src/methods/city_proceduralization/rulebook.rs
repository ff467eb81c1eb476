//! Rules of buildings with parameters: from which buildings they are made, and for which others they stand.
//!
//! Buildings of equally many levels are compared as stacks ([`Stack`]). Candidates are the buildings nearest to the means of many
//! clusters (Ward, weighted by volume). Of them, one after the other becomes a rule: always the one that removes most
//! mismatched volume for its bytes ([`Facilities`]). A building that no rule reaches within its neighbourhood takes the nearest rule of its number of levels.
//! Rules of one instance are escapes: buildings whose shape no type explains.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::building_types::{BuildingTypes, projected};
use super::candidates::{Candidate, Near, best};
use super::component::Component;
use super::facility::Facilities;
use super::nearest::Nearest;
use super::nearest::square;
use super::settings::ProceduralizeError;
use super::stacks::Stack;
use super::types::Priced;
use edifice_cluster::{WardTree, ward};

/// Cells along a side of a level's features, in stacks of few levels and of more than [`FEW`].
const FINE: usize = 8;
const COARSE: usize = 4;
const FEW: usize = 3;
/// Candidates for each rule that is asked for, and for each number of levels at least.
const SURPLUS: f64 = 2.0;
const LEAST: usize = 8;
/// Candidates that a building is compared with.
const NEAR: usize = 20;
/// Steps of features within which they are equal.
const STEPS: f64 = 255.0;
/// Cost of a rule beside that of each of its levels, in levels.
const RULE: f64 = 1.0;

/// Which rule stands for a building.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RuleUse {
    /// Index of the rule.
    pub(super) rule: usize,
    /// Quarter turns of the rule, counterclockwise.
    pub(super) quarter: u8,
}

/// The rules of a city's buildings.
#[derive(Debug, Clone, Default)]
pub(super) struct Rulebook {
    /// The building that each rule is made from.
    pub(super) rules: Vec<usize>,
    /// The rule of each building; `None` where it has no component.
    pub(super) uses: Vec<Option<RuleUse>>,
}

/// The stacks of a city, which are the same however many rules are asked for.
pub(super) struct Stacks<'a> {
    components: &'a [Component],
    /// Buildings of the city.
    count: usize,
    classes: Vec<Class>,
}

/// The buildings of one number of levels.
struct Class {
    levels: usize,
    members: Vec<usize>,
    /// Components of each member, from the ground up.
    parts: Vec<Vec<usize>>,
    stacks: Vec<Stack>,
    /// Members of distinct features, the first of each, and which of them each member is like.
    distinct: Vec<usize>,
    group: Vec<usize>,
    /// Features of the distinct members, row after row, what they weigh, and their hierarchy.
    rows: Vec<f64>,
    dimension: usize,
    weights: Vec<f64>,
    tree: WardTree,
    volume: f64,
    /// The number of buildings that each member stands for.
    times: Vec<f64>,
}

impl<'a> Stacks<'a> {
    /// # Errors
    /// [`ProceduralizeError::Ward`].
    pub(super) fn new(
        components: &'a [Component],
        buildings: &BuildingTypes,
    ) -> Result<Self, ProceduralizeError> {
        Self::weighted(components, buildings, &vec![1.0; buildings.parts.len()])
    }

    /// Stacks that stand for others, each for so many `times` buildings.
    ///
    /// # Errors
    /// [`ProceduralizeError::Ward`].
    pub(super) fn weighted(
        components: &'a [Component],
        buildings: &BuildingTypes,
        times: &[f64],
    ) -> Result<Self, ProceduralizeError> {
        let mut by_levels: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
        for &b in &buildings.order {
            by_levels
                .entry(buildings.parts[b].len())
                .or_default()
                .push(b);
        }
        let class = |(levels, members): (usize, Vec<usize>)| {
            let parts: Vec<Vec<usize>> = members
                .iter()
                .map(|&b| buildings.parts[b].clone())
                .collect();
            let one = |parts: &Vec<usize>| Stack::of(components, parts);
            let stacks: Vec<Stack> = parts.par_iter().map(one).collect();
            let side = if levels <= FEW { FINE } else { COARSE };
            let raw: Vec<Vec<f64>> = stacks.par_iter().map(|s| s.features(side)).collect();
            // Equal features first: the hierarchy is over distinct ones.
            let mut known: FxHashMap<Vec<u8>, usize> = FxHashMap::default();
            let (mut distinct, mut group, mut weights) = (Vec::new(), Vec::new(), Vec::new());
            for (i, features) in raw.iter().enumerate() {
                let key = features.iter().map(|v| (v * STEPS).round() as u8).collect();
                let g = *known.entry(key).or_insert_with(|| {
                    distinct.push(i);
                    weights.push(0.0);
                    distinct.len() - 1
                });
                weights[g] += times[members[i]] * stacks[i].volume.max(1e-3);
                group.push(g);
            }
            let own: Vec<Vec<f64>> = distinct.iter().map(|&i| raw[i].clone()).collect();
            let (rows, dimension) = match own.len() {
                1 => (vec![0.0], 1),
                _ => projected(&own),
            };
            Ok(Class {
                times: members.iter().map(|&b| times[b]).collect(),
                tree: ward(&rows, dimension, &weights)?,
                volume: weights.iter().sum(),
                distinct,
                group,
                weights,
                levels,
                members,
                parts,
                stacks,
                rows,
                dimension,
            })
        };
        let classes = by_levels.into_iter().map(class);
        let classes: Result<Vec<Class>, ProceduralizeError> = classes.collect();
        Ok(Self {
            components,
            count: buildings.parts.len(),
            classes: classes?,
        })
    }

    /// At most `count` rules, but one for each number of levels, over templates of these `types`.
    pub(super) fn rulebook(&self, types: &Priced, count: usize) -> Rulebook {
        let candidates = self.candidates(types, self.means(count));
        self.of(&candidates, 0, count)
    }

    /// The rules made from the buildings `given`, and at most `more` of those made from `others`, but one for each number of levels.
    /// Those given are first, in their order, also those that stand for no building.
    pub(super) fn extended(
        &self,
        types: &Priced,
        given: &[usize],
        others: &[usize],
        more: usize,
    ) -> Rulebook {
        let mut places = vec![None; self.count];
        for (class, c) in self.classes.iter().enumerate() {
            for (i, &b) in c.members.iter().enumerate() {
                places[b] = Some((class, i));
            }
        }
        let named = given.iter().chain(others).filter_map(|&b| places[b]);
        let candidates = self.candidates(types, named.collect());
        self.of(&candidates, given.len(), given.len() + more)
    }

    fn of(&self, candidates: &[Candidate], given: usize, count: usize) -> Rulebook {
        let near = self.near(candidates);
        let chosen = self.choose(candidates, &near, given, count);
        self.assigned(candidates, &near, &chosen, given)
    }

    /// Members of classes that are nearest to the means of clusters: where `count` rules are wanted, so many more.
    fn means(&self, count: usize) -> Vec<(usize, usize)> {
        let all: usize = self.classes.iter().map(|c| c.members.len()).sum();
        let volume: f64 = self.classes.iter().map(|c| c.volume).sum();
        let mut out = Vec::new();
        for (class, c) in self.classes.iter().enumerate() {
            let n = c.distinct.len();
            let share = (c.members.len() as f64 / all as f64 + c.volume / volume) / 2.0;
            let wanted = (SURPLUS * count as f64 * share).ceil() as usize + LEAST;
            let medoids = c.medoids(wanted.min(n));
            out.extend(medoids.into_iter().map(|row| (class, c.distinct[row])));
        }
        out
    }

    fn candidates(&self, priced: &Priced, members: Vec<(usize, usize)>) -> Vec<Candidate> {
        let drawn = members.into_par_iter().map(|(class, member)| {
            let c = &self.classes[class];
            let parts = &c.parts[member];
            let types = &priced.types;
            let triangles = parts.iter().map(|&i| priced.triangles[types.uses[i].kind]);
            Candidate {
                class,
                member,
                row: c.group[member],
                maps: Stack::ruled(self.components, parts, types),
                price: priced.price.derived * triangles.sum::<f64>(),
            }
        });
        drawn.collect()
    }

    /// For each member of each class, candidates near to it.
    fn near(&self, candidates: &[Candidate]) -> Vec<Vec<Vec<Near>>> {
        let of_class = |(class, c): (usize, &Class)| {
            let own: Vec<usize> = (0..candidates.len())
                .filter(|&k| candidates[k].class == class)
                .collect();
            let rows: Vec<usize> = own.iter().map(|&k| candidates[k].row).collect();
            let nearest = Nearest::new(&c.rows, c.dimension, &rows);
            let one = |i: usize| -> Vec<Near> {
                let found = nearest.of(c.row(c.group[i]), NEAR).into_iter();
                found
                    .map(|position| best(&c.stacks[i], own[position], &candidates[own[position]]))
                    .collect()
            };
            (0..c.members.len()).into_par_iter().map(one).collect()
        };
        self.classes.iter().enumerate().map(of_class).collect()
    }

    /// The candidates that become rules, in the order of their choice, after the `given` first ones.
    fn choose(
        &self,
        candidates: &[Candidate],
        near: &[Vec<Vec<Near>>],
        given: usize,
        count: usize,
    ) -> Vec<usize> {
        let levels = |c: &Candidate| RULE + self.classes[c.class].levels as f64;
        let mut facilities = Facilities {
            served: vec![Vec::new(); candidates.len()],
            price: candidates.iter().map(levels).collect(),
            left: Vec::new(),
        };
        for (c, near) in self.classes.iter().zip(near) {
            for ((stack, near), times) in c.stacks.iter().zip(near).zip(&c.times) {
                for n in near {
                    let customer = (facilities.left.len(), times * n.cost);
                    facilities.served[n.candidate].push(customer);
                }
                facilities.left.push(times * stack.volume);
            }
        }
        let mut chosen: Vec<usize> = (0..given).collect();
        chosen.iter().for_each(|&k| facilities.take(k));
        // One of each number of levels, so that each building has a rule.
        for class in 0..self.classes.len() {
            let own = |k: &usize| candidates[*k].class == class;
            if chosen.iter().any(own) {
                continue;
            }
            let gains = (0..candidates.len())
                .filter(own)
                .map(|k| facilities.gain(k));
            if let Some(first) = gains.max() {
                facilities.take(first.candidate);
                chosen.push(first.candidate);
            }
        }
        facilities.choose(chosen, count)
    }

    fn building(&self, candidate: &Candidate) -> usize {
        self.classes[candidate.class].members[candidate.member]
    }

    /// The best rule for each building; after the `given` first, rules of most instances first, those of none left out.
    fn assigned(
        &self,
        candidates: &[Candidate],
        near: &[Vec<Vec<Near>>],
        chosen: &[usize],
        given: usize,
    ) -> Rulebook {
        let mut is_chosen = vec![false; candidates.len()];
        chosen.iter().for_each(|&k| is_chosen[k] = true);
        let mut found: Vec<(usize, Near)> = Vec::new();
        for (class, c) in self.classes.iter().enumerate() {
            let own: Vec<usize> = (0..candidates.len())
                .filter(|&k| is_chosen[k] && candidates[k].class == class)
                .collect();
            let rows: Vec<usize> = own.iter().map(|&k| candidates[k].row).collect();
            let nearest = Nearest::new(&c.rows, c.dimension, &rows);
            let one = |i: usize| {
                let kept = near[class][i].iter().filter(|n| is_chosen[n.candidate]);
                let others = nearest.of(c.row(c.group[i]), NEAR).into_iter();
                let others = others.map(|p| best(&c.stacks[i], own[p], &candidates[own[p]]));
                let all = kept.copied().chain(others);
                let least = all
                    .min_by(|a, b| (a.cost.total_cmp(&b.cost)).then(a.candidate.cmp(&b.candidate)));
                Some((c.members[i], least?))
            };
            let own: Vec<_> = (0..c.members.len())
                .into_par_iter()
                .filter_map(one)
                .collect();
            found.extend(own);
        }
        let mut counts = vec![0usize; candidates.len()];
        found.iter().for_each(|f| counts[f.1.candidate] += 1);
        let used = |&k: &usize| k < given || counts[k] > 0;
        let mut order: Vec<usize> = (0..candidates.len()).filter(used).collect();
        order[given..].sort_by_key(|&k| std::cmp::Reverse(counts[k]));
        let mut number = vec![0; candidates.len()];
        for (new, &old) in order.iter().enumerate() {
            number[old] = new;
        }
        let mut uses = vec![None; self.count];
        for (building, near) in found {
            uses[building] = Some(RuleUse {
                rule: number[near.candidate],
                quarter: near.quarter,
            });
        }
        Rulebook {
            rules: order
                .iter()
                .map(|&k| self.building(&candidates[k]))
                .collect(),
            uses,
        }
    }
}

impl Class {
    fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Of each of `k` clusters, the distinct member nearest to the mean, of equals the first.
    fn medoids(&self, k: usize) -> Vec<usize> {
        let labels = self.tree.cut(k);
        let count = labels.iter().max().map_or(0, |m| m + 1);
        let mut members = vec![Vec::new(); count];
        labels
            .iter()
            .enumerate()
            .for_each(|(i, &l)| members[l].push(i));
        let medoid = |list: &Vec<usize>| {
            let weight = |i: usize| self.weights[i];
            let total: f64 = list.iter().map(|&i| weight(i)).sum();
            let mean: Vec<f64> = (0..self.dimension)
                .map(|d| {
                    list.iter()
                        .map(|&i| weight(i) * self.row(i)[d])
                        .sum::<f64>()
                        / total
                })
                .collect();
            let far = |i: usize| square(self.row(i), &mean);
            let nearer = |a: &usize, b: &usize| far(*a).total_cmp(&far(*b)).then(a.cmp(b));
            list.iter().copied().min_by(nearer)
        };
        members.iter().filter_map(medoid).collect()
    }
}
