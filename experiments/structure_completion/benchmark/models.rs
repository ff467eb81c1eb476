//! The facades that are tested, and the models that have not seen them.
//!
//! | column | learnt from |
//! | --- | --- |
//! | `default` | what ships: the model of every user who trains none |
//! | `other_sets` | the other real sets, facades of each taken evenly |
//! | `same_set` | the same set without the facade's fold; near-twins are in one fold |

use std::collections::BTreeMap;

use super::super::data::{self, Item};
use super::super::folds;
use edifice_base::{Error, Result, Watched, unwatched};
use edifice_frame::Context;
use edifice_structure_completion::layout::{Class, Layout};
use edifice_structure_completion::made::facades;
use edifice_structure_completion::model::{Model, shipped_model};

/// The set of generated facades, of which only the default model has learnt the like.
pub(crate) const MADE: &str = "made";

/// A facade that is tested.
pub(crate) struct Tested {
    /// Its set.
    pub set: &'static str,
    /// Its elements.
    pub layout: Layout,
    /// The name of each model for it, and its index in [`Models::all`].
    pub models: Vec<(&'static str, usize)>,
}

/// The models and what they are tested on.
pub(crate) struct Models {
    /// The models, the default one first.
    pub all: Vec<Model>,
    /// The facades, set by set.
    pub tested: Vec<Tested>,
    /// Index of a model of all real sets but the first, for the made grids; `None` without real data.
    pub real: Option<usize>,
}

/// Every so many of a list that at most `most` are left.
fn spread<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let every = all.len().div_ceil(most.max(1)).max(1);
    all.into_iter().step_by(every).collect()
}

/// The layouts that one model is learnt from.
struct Lesson {
    name: String,
    layouts: Vec<Layout>,
}

/// The text of a learnt model, without the paper's method.
fn learnt(lesson: &Lesson, seed: u64) -> Result<String> {
    let layouts = lesson.layouts.clone();
    let model = Model::of_best(layouts, seed, &Watched::new(&unwatched));
    Ok(model.map_err(Error::method)?.to_json())
}

/// Reads the facades and learns the models.
///
/// # Errors
/// Those of reading and learning.
pub(crate) fn models(ctx: &mut Context) -> Result<Models> {
    let tested = ctx.budget().choose(2, 16, usize::MAX);
    let taught = ctx.budget().choose(0, 16, usize::MAX);
    let parts = ctx.budget().choose(2, 2, 5);
    ctx.setting("facades_of_a_set", tested.min(1_000_000));
    ctx.setting("facades_learnt_from_of_another_set", taught.min(1_000_000));
    ctx.setting("folds_of_a_set", parts);
    let mut sets: BTreeMap<&'static str, Vec<Item>> = BTreeMap::new();
    let usable = |i: &Item| i.in_scope && i.layout.count(Class::Window) > 0;
    for item in data::items(ctx)?.into_iter().filter(usable) {
        // The default model has learnt from the shipped ones.
        if item.dataset != "shipped" {
            sets.entry(item.dataset).or_default().push(item);
        }
    }
    let names: Vec<&'static str> = sets.keys().copied().collect();
    let mut lessons: Vec<Lesson> = Vec::new();
    let mut of_made = Vec::new();
    let count = ctx.budget().choose(4, 16, 100);
    // Other facades than those that the default model was learnt from.
    for layout in facades::several(count, ctx.seed() + 1_000_003) {
        of_made.push(Tested {
            set: MADE,
            layout,
            models: vec![("default", 0)],
        });
    }
    let mut all = of_made;
    for name in &names {
        let items: Vec<&Item> = sets[name].iter().collect();
        let fold = folds::folds(&items, parts, ctx.seed());
        let chosen = spread((0..items.len()).collect(), tested);
        let mut of_set = vec![("default", 0)];
        let others = || names.iter().filter(|other| *other != name);
        if taught > 0 && others().next().is_some() {
            let each = others().flat_map(|other| spread(sets[other].iter().collect(), taught));
            lessons.push(Lesson {
                name: format!("other_sets/{name}"),
                layouts: each.map(|i| i.layout.clone()).collect(),
            });
            of_set.push(("other_sets", lessons.len()));
        }
        let first = lessons.len() + 1;
        let own = taught > 0 && items.len() >= 4 * parts;
        if own {
            for part in 0..parts {
                let rest = (0..items.len()).filter(|&k| fold[k] != part).collect();
                let rest = spread(rest, taught.saturating_mul(3));
                lessons.push(Lesson {
                    name: format!("same_set/{name}/{part}"),
                    layouts: rest.into_iter().map(|k| items[k].layout.clone()).collect(),
                });
            }
        }
        for k in chosen {
            let mut models = of_set.clone();
            if own {
                models.push(("same_set", first + fold[k]));
            }
            all.push(Tested {
                set: name,
                layout: items[k].layout.clone(),
                models,
            });
        }
    }
    let seed = ctx.seed();
    let texts = ctx.units(&lessons, |l| l.name.clone(), |l| learnt(l, seed))?;
    let mut models = vec![shipped_model().map_err(Error::method)?];
    for text in &texts {
        models.push(Model::from_json(text).map_err(Error::method)?);
    }
    let real = lessons
        .iter()
        .position(|l| l.name.starts_with("other_sets"));
    Ok(Models {
        all: models,
        tested: all,
        real: real.map(|k| k + 1),
    })
}
