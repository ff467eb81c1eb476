//! Cross-validation by building: near-twins are in one fold, and a model never sees its fold.

use rand::seq::SliceRandom;

use super::data::Item;
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_structure_completion::best::learn::twins;
use edifice_structure_completion::layout::Layout;
use edifice_structure_completion::model::Model;

/// The fold of each item: groups of near-twins in random order, dealt in turn.
pub(crate) fn folds(items: &[&Item], count: usize, seed: u64) -> Vec<usize> {
    let layouts: Vec<Layout> = items.iter().map(|i| i.layout.clone()).collect();
    let groups = twins(&layouts);
    let mut order: Vec<usize> = groups.clone();
    order.sort_unstable();
    order.dedup();
    order.shuffle(&mut stream(seed, "structure completion: folds", 0));
    let fold = |group: &usize| order.iter().position(|g| g == group).unwrap_or(0) % count;
    groups.iter().map(fold).collect()
}

/// A model of the items that `keep` keeps.
pub(crate) fn model(items: &[&Item], seed: u64, keep: impl Fn(usize) -> bool) -> Result<Model> {
    let kept = (0..items.len()).filter(|&i| keep(i));
    let layouts = kept.map(|i| items[i].layout.clone()).collect();
    let trained = Model::train(layouts, seed, &unwatched).map_err(Error::method)?;
    Ok(trained.model)
}
