//! The studies of this paper, for sweeps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::data::Item;
use super::figures::{drawn, in_size, without};
use crate::sweep::{Better, Given, Outcome, Shared, Study};
use edifice_base::Ended;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_io::{ReadOptions, read_source};
use edifice_structure_completion::layout::{Class, Element, Layout, extract, scope};
use edifice_structure_completion::measure::{agreement, area_iou};
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::policy::{Budget, PaperModel};
use edifice_structure_completion::score::Term;
use edifice_structure_completion::task::Task;

/// Settings of completion.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Complete {
    /// Method of completion.
    method: Method,
    /// Part that is hidden.
    task: Task,
    /// Scoring functions whose weight is set to 0, of `paper`.
    left_out: Vec<Term>,
    /// Policies of a generation, of `paper`.
    population: usize,
    /// Generations after the first, of `paper`.
    generations: u64,
    /// Candidates of each policy, of `paper`.
    draws: usize,
}

impl Default for Complete {
    fn default() -> Self {
        Self {
            method: Method::Best,
            task: Task::Side50,
            left_out: Vec::new(),
            population: Budget::PAPER.population,
            generations: Budget::PAPER.generations,
            draws: Budget::PAPER.draws,
        }
    }
}

/// Completion of one facade by a model learnt from others.
pub fn complete() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("f1", Better::Higher),
        ("iou", Better::Higher),
        ("count_error", Better::Lower),
    ];
    let about = "completion of facade layouts (Fan et al. 2014): part of a facade is hidden, and completed by what others teach";
    Study::new(
        "structure_completion/complete",
        about,
        "facade_grammar",
        METRICS,
        run,
    )
    .learning()
}

/// Why a facade is not completed.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error("only `paper` weighs scoring functions: leave `left_out` empty for other methods")]
    LeftOut,
    #[error("nothing of the facade is hidden")]
    NothingHidden,
}

fn run(settings: &Complete, given: &Given) -> Result<Outcome> {
    let layout = item(given.path)?.layout;
    let mut drawn = drawn(&layout, given.seed);
    let (partial, hidden) = settings.task.hide(&layout, &mut drawn);
    if hidden.is_empty() {
        return Err(Error::content(given.path, Refused::NothingHidden));
    }
    let key = format!("{} {:?}", given.seed, given.database);
    let added: Vec<Element> = if settings.method == Method::Paper {
        static MODELS: Shared<PaperModel> = Shared::new();
        let model = MODELS.get(key, || {
            let watch = given.watched.inner();
            let model = PaperModel::train(&layouts(given)?, given.seed, &watch);
            match given.watched.is_stopped() {
                false => model.map_err(Error::method),
                true => Err(Error::Interrupted),
            }
        })?;
        let budget = Budget {
            population: settings.population,
            generations: settings.generations,
            draws: settings.draws,
        };
        let left_out: Vec<usize> = settings
            .left_out
            .iter()
            .map(|&term| term as usize)
            .collect();
        without(&partial, &left_out, &model, &budget, given.seed)?
    } else {
        if !settings.left_out.is_empty() {
            return Err(Error::method(Refused::LeftOut));
        }
        static MODELS: Shared<Model> = Shared::new();
        let model = MODELS.get(key, || {
            let watch = given.watched.inner();
            let trained =
                Model::train(layouts(given)?, given.seed, &watch).map_err(Error::method)?;
            // A model that is not finished serves no other task.
            match trained.ended {
                Ended::Finished => Ok(trained.model),
                Ended::Interrupted => Err(Error::Interrupted),
            }
        })?;
        let rng = &mut stream(given.seed, "completion", 0);
        let found = method::complete(settings.method, &partial, &model, 1, rng);
        let first = found.first().into_iter();
        first
            .flat_map(|c| c.added.iter().map(|a| a.element))
            .collect()
    };
    // Judged by what was hidden, as the benchmark judges all methods.
    let mut found = Outcome::default();
    for (name, value) in [
        ("f1", agreement(&added, &hidden, 0.5).f1),
        ("iou", area_iou(&added, &hidden)),
        (
            "count_error",
            (added.len() as f64 - hidden.len() as f64).abs(),
        ),
    ] {
        found.metrics.insert(name.into(), value);
    }
    Ok(found)
}

fn item(path: &std::path::Path) -> Result<Item> {
    let source = read_source(path, &ReadOptions::default())?.labelled()?;
    let layout = extract::elements(&source).map_err(|e| Error::content(path, e))?;
    Ok(Item {
        dataset: "sweep",
        in_scope: scope::in_scope(&layout),
        layout,
    })
}

/// The layouts of the database that have a window and a size that can be learnt from; those in scope only, where there are enough.
fn layouts(given: &Given) -> Result<Vec<Layout>> {
    let mut items: Vec<Item> = given
        .database
        .iter()
        .map(|path| item(path))
        .collect::<Result<_>>()?;
    items.retain(|item| item.layout.count(Class::Window) > 0);
    if items.iter().any(in_size) {
        items.retain(in_size);
    }
    if items.iter().filter(|i| i.in_scope).count() > items.len() / 2 {
        items.retain(|i| i.in_scope);
    }
    Ok(items.into_iter().map(|item| item.layout).collect())
}
