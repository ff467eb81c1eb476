//! Cross-validation by building: near-twins are in one fold, and a model never sees its fold.

use rand::seq::SliceRandom;

use super::data::Item;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_base::{Watched, unwatched};
use edifice_structure_completion::best::learn::twins;
use edifice_structure_completion::layout::{Class, Layout};
use edifice_structure_completion::model::{Model, shipped_model};

/// The fold of each item: groups of near-twins in random order, dealt in turn.
pub(crate) fn folds(items: &[&Item], count: usize, seed: u64) -> Vec<usize> {
    dealt(&groups(items), count, seed)
}

/// The group of near-twins of each item.
fn groups(items: &[&Item]) -> Vec<usize> {
    let layouts: Vec<Layout> = items.iter().map(|i| i.layout.clone()).collect();
    twins(&layouts)
}

/// The groups, each once, in order.
fn distinct(groups: &[usize]) -> Vec<usize> {
    let mut order = groups.to_vec();
    order.sort_unstable();
    order.dedup();
    order
}

fn dealt(groups: &[usize], count: usize, seed: u64) -> Vec<usize> {
    let mut order = distinct(groups);
    order.shuffle(&mut stream(seed, "structure completion: folds", 0));
    let fold = |group: &usize| order.iter().position(|g| g == group).unwrap_or(0) % count;
    groups.iter().map(fold).collect()
}

/// Facades of a benchmark by fold, and the models that have not seen theirs.
pub(crate) struct Parted<'a> {
    /// The facades that are divided into folds.
    pub used: Vec<&'a Item>,
    /// Facades out of scope, which nothing is learnt from.
    pub apart: Vec<&'a Item>,
    /// The fold of each of `used`.
    pub fold: Vec<usize>,
    /// Of `used`, the first and every so manyth after it is completed by the methods that search, too.
    pub every: usize,
    /// The model of each fold; one that is not asked by the methods that search has no part of the paper's.
    pub models: Vec<Model>,
    /// True if there are no two facades that differ, so that the model that ships completes all.
    pub by_default: bool,
}

impl<'a> Parted<'a> {
    /// Divides the facades that have windows into at most `count` folds. Those out of scope stand apart, unless fewer than two of
    /// those in scope differ: then, and with `all`, they are divided too. Facades that are all near-twins leave none to learn
    /// from. The methods that search complete at most `searched` of them.
    ///
    /// # Errors
    /// [`Error::Method`] if no facade has a window; those of learning.
    pub(crate) fn new(
        items: &'a [Item],
        count: usize,
        all: bool,
        searched: usize,
        seed: u64,
    ) -> Result<Self> {
        let usable = items.iter().filter(|i| i.layout.count(Class::Window) > 0);
        let (mut used, mut apart): (Vec<&Item>, Vec<&Item>) =
            usable.partition(|i| all || i.in_scope);
        let mut groups = groups(&used);
        if distinct(&groups).len() < 2 {
            used.append(&mut apart);
            groups = self::groups(&used);
        }
        if used.is_empty() {
            return Err(Error::method(NoWindow(items.len())));
        }
        let count = count.min(distinct(&groups).len());
        let by_default = count < 2;
        let fold = dealt(&groups, count, seed);
        let every = used.len().div_ceil(searched.max(1)).max(1);
        let of_fold = |f: usize| {
            let others = |i: usize| fold[i] != f;
            match fold.iter().step_by(every).any(|of| *of == f) {
                true => model(&used, seed, others),
                false => fast_model(&used, seed, others),
            }
        };
        let models = match by_default {
            true => vec![shipped_model().map_err(Error::method)?],
            false => (0..count).map(of_fold).collect::<Result<_>>()?,
        };
        Ok(Self {
            used,
            apart,
            fold,
            every,
            models,
            by_default,
        })
    }
}

/// There is nothing to complete.
#[derive(Debug, thiserror::Error)]
#[error(
    "none of the {0} facades has an element that is labelled `window`; `--dataset NAME=GLOB:MAP.json` says what their labels are"
)]
struct NoWindow(usize);

/// A model of the items that `keep` keeps.
pub(crate) fn model(items: &[&Item], seed: u64, keep: impl Fn(usize) -> bool) -> Result<Model> {
    let trained = Model::train(kept(items, keep), seed, &unwatched).map_err(Error::method)?;
    Ok(trained.model)
}

/// The same without the paper's part, whose learning takes longest and which fast methods do not ask.
pub(crate) fn fast_model(
    items: &[&Item],
    seed: u64,
    keep: impl Fn(usize) -> bool,
) -> Result<Model> {
    Model::of_best(kept(items, keep), seed, &Watched::new(&unwatched)).map_err(Error::method)
}

fn kept(items: &[&Item], keep: impl Fn(usize) -> bool) -> Vec<Layout> {
    let kept = (0..items.len()).filter(|&i| keep(i));
    kept.map(|i| items[i].layout.clone()).collect()
}
