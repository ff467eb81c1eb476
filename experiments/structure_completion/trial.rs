//! Completion as question, candidate and judge.
//!
//! The question is a partial layout with other, whole layouts to learn from; the answer is the whole layout. The judge looks that all that was
//! observed still stands, that all that was added lies in the unknown part and within the outline and is of a known class, and compares what
//! was added with what was hidden.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::data::Item;
use super::figures::{drawn, in_size, without};
use super::settings::Complete;
use edifice_base::rng::stream;
use edifice_base::{Ended, Error, Result, Watched};
use edifice_io::{ReadOptions, facade_json, read_bytes, read_source, write_atomic};
use edifice_shape::{AnnotatedFacade, Facade, Note, Region};
use edifice_structure_completion::layout::{Class, Element, Layout, extract, scope};
use edifice_structure_completion::measure::{agreement, area_iou};
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::partial::PartialLayout;
use edifice_structure_completion::policy::{Budget, PaperModel};
use edifice_sweep::trial::{Answered, Posed, Trial};
use edifice_sweep::{Given, Shared};

/// Completion of one facade by what others teach.
pub(super) struct Completion;

/// A partial layout, and whole ones.
pub(super) struct Question {
    name: String,
    partial: PartialLayout,
    layouts: Arc<Vec<Layout>>,
    /// Names the whole layouts, for models that several tasks share.
    key: String,
}

/// Most elements of an answer beside those that are observed.
const MOST: usize = 10_000;

/// Why a facade is not asked about, or an answer is none.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error("only `paper` weighs scoring functions: leave `left_out` empty for other methods")]
    LeftOut,
    #[error("nothing of the facade is hidden")]
    NothingHidden,
    #[error("the answer is {found:?} in size, the facade {asked:?}")]
    Size { found: [f64; 2], asked: [f64; 2] },
    #[error("regions[{index}] is a `{label}`, expected window, door, balcony or shop")]
    Label { index: usize, label: String },
    #[error("the observed {label} at ({x}, {y}) is not in the answer")]
    Missing { label: &'static str, x: f64, y: f64 },
    #[error("the added {label} at ({x}, {y}), {width} x {height}, lies outside the unknown part")]
    Outside {
        label: &'static str,
        x: f64,
        y: f64,
        width: f64,
        height: f64,
    },
    #[error("the answer adds {0} elements, more than {MOST}")]
    TooMany(usize),
}

/// A model that is finished: one that is not serves no other task.
fn whole<M>(model: M, ended: Ended) -> Result<M> {
    match ended {
        Ended::Finished => Ok(model),
        Ended::Interrupted => Err(Error::Interrupted),
    }
}

impl Trial for Completion {
    type Settings = Complete;
    type Question = Question;
    /// The elements that are hidden.
    type Truth = Vec<Element>;
    /// The elements that are added.
    type Answer = Vec<Element>;

    const OUTPUT: &'static str = "answer.facade.json";
    const CLAIMS: &'static [&'static str] = &[];

    fn prepare(settings: &Complete, given: &Given) -> Result<(Question, Vec<Element>)> {
        static LAYOUTS: Shared<Vec<Layout>> = Shared::new();
        let layout = item(given.path)?.layout;
        let (partial, hidden) = match settings.frozen {
            true => settings.task.hide_frozen(&layout),
            false => settings.task.hide(&layout, &mut drawn(&layout, given.seed)),
        };
        if hidden.is_empty() {
            return Err(Error::content(given.path, Refused::NothingHidden));
        }
        let key = format!("{:?}", given.database);
        let question = Question {
            name: layout.name,
            partial,
            layouts: LAYOUTS.get(key.clone(), || layouts(given))?,
            key,
        };
        Ok((question, hidden))
    }

    fn candidate(
        settings: &Complete,
        question: &Question,
        seed: u64,
        watched: &Watched,
    ) -> Result<Answered<Vec<Element>>> {
        let key = format!("{seed} {}", question.key);
        let partial = &question.partial;
        if settings.method == Method::Paper {
            static MODELS: Shared<PaperModel> = Shared::new();
            let model = MODELS.get(key, || {
                let model = PaperModel::train(&question.layouts, seed, &watched.inner());
                whole(model.map_err(Error::method)?, watched.ended())
            })?;
            let budget = Budget {
                population: settings.population,
                generations: settings.generations,
                draws: settings.draws,
            };
            let left_out: Vec<usize> = (settings.left_out.iter())
                .map(|&term| term as usize)
                .collect();
            let added = without(partial, &left_out, &model, &budget, seed)?;
            return Ok(Answered::plain(added));
        }
        if !settings.left_out.is_empty() {
            return Err(Error::method(Refused::LeftOut));
        }
        static MODELS: Shared<Model> = Shared::new();
        let (is_learnt, is_slow) = (settings.method.is_learnt(), settings.method.is_slow());
        let model = MODELS.get(format!("{is_learnt} {is_slow} {key}"), || {
            let layouts = question.layouts.to_vec();
            if !is_learnt {
                return Ok(Model::of_spacing(layouts));
            }
            // Methods that search ask the paper's part, which takes longest to learn; the default method does not.
            let model = match is_slow {
                true => Model::train(layouts, seed, &watched.inner()).map(|t| t.model),
                false => Model::of_best(layouts, seed, watched),
            };
            whole(model.map_err(Error::method)?, watched.ended())
        })?;
        let rng = &mut stream(seed, "completion", 0);
        let found = method::complete(settings.method, partial, &model, 1, rng);
        let added = found.first().into_iter();
        let added = added.flat_map(|c| c.added.iter().map(|a| a.element));
        Ok(Answered::plain(added.collect()))
    }

    fn judge(
        _: &Complete,
        question: &Question,
        hidden: &Vec<Element>,
        added: &Vec<Element>,
    ) -> Result<BTreeMap<String, f64>> {
        if added.len() > MOST {
            return Err(Error::method(Refused::TooMany(added.len())));
        }
        if let Some(stray) = added.iter().find(|e| !question.partial.has_room(e)) {
            let r = stray.rect;
            return Err(Error::method(Refused::Outside {
                label: stray.class.name(),
                x: r.x,
                y: r.y,
                width: r.width,
                height: r.height,
            }));
        }
        // Judged by what was hidden, as the benchmark judges all methods.
        let count_error = (added.len() as f64 - hidden.len() as f64).abs();
        Ok(BTreeMap::from([
            ("f1".to_owned(), agreement(added, hidden, 0.5).f1),
            ("iou".to_owned(), area_iou(added, hidden)),
            ("count_error".to_owned(), count_error),
        ]))
    }

    fn pose(question: &Question, folder: &Path) -> Result<Posed> {
        let input = folder.join("partial.facade.json");
        write_partial(question, &[], &input)?;
        let learn = folder.join("learn");
        std::fs::create_dir(&learn).map_err(|e| Error::io(&learn, "create", e))?;
        for (index, layout) in question.layouts.iter().enumerate() {
            // Numbered, so that the order is that of the names.
            let path = learn.join(format!("{index:05}.facade.json"));
            let facade = layout.facade().map_err(|e| Error::content(&path, e))?;
            facade_json::write(&facade, &path)?;
        }
        Ok(Posed {
            input,
            learn: Some(learn),
        })
    }

    fn posed(posed: &Posed) -> Result<Question> {
        let facade = annotated(&posed.input)?;
        let observed = elements(&facade.facade)?;
        let mut layouts = Vec::new();
        if let Some(folder) = &posed.learn {
            for path in edifice_frame::layouts::files(folder, ".json")? {
                let facade = facade_json::read(&path)?;
                layouts.push(Layout {
                    elements: elements(&facade)?,
                    name: facade.name,
                    width: facade.width,
                    height: facade.height,
                });
            }
        }
        let partial = PartialLayout {
            width: facade.facade.width,
            height: facade.facade.height,
            observed,
            unknown: facade.unknown,
            forbidden: Vec::new(),
        };
        Ok(Question {
            name: facade.facade.name,
            partial,
            layouts: Arc::new(layouts),
            key: format!("{:?}", posed.learn),
        })
    }

    fn write(question: &Question, added: &Vec<Element>, path: &Path) -> Result<()> {
        write_partial(question, added, path)
    }

    fn read(question: &Question, path: &Path) -> Result<Vec<Element>> {
        let answer = annotated(path)?;
        let partial = &question.partial;
        let found = [answer.facade.width, answer.facade.height];
        let asked = [partial.width, partial.height];
        let slack = 1e-6 * partial.width.max(partial.height);
        if (0..2).any(|k| (found[k] - asked[k]).abs() > slack) {
            return Err(Error::content(path, Refused::Size { found, asked }));
        }
        let mut added = elements(&answer.facade).map_err(|e| Error::content(path, e))?;
        for observed in &partial.observed {
            let same = |e: &Element| {
                let (a, b) = (e.rect, observed.rect);
                let pairs = [
                    (a.x, b.x),
                    (a.y, b.y),
                    (a.width, b.width),
                    (a.height, b.height),
                ];
                e.class == observed.class && pairs.iter().all(|(a, b)| (a - b).abs() <= slack)
            };
            let Some(at) = added.iter().position(same) else {
                return Err(Error::content(
                    path,
                    Refused::Missing {
                        label: observed.class.name(),
                        x: observed.rect.x,
                        y: observed.rect.y,
                    },
                ));
            };
            added.remove(at);
        }
        Ok(added)
    }
}

/// Writes what is observed and what is added.
fn write_partial(question: &Question, added: &[Element], path: &Path) -> Result<()> {
    let partial = &question.partial;
    let region = |element: &Element| Region {
        label: element.class.name().to_owned(),
        rect: element.rect,
    };
    let all = partial.observed.iter().chain(added).map(region).collect();
    let (width, height) = (partial.width, partial.height);
    let facade = Facade::new(question.name.clone(), "px", width, height, all);
    let observed = |index: usize| Note {
        observed: Some(index < partial.observed.len()),
        ..Note::default()
    };
    let count = partial.observed.len() + added.len();
    let annotated = AnnotatedFacade {
        facade: facade.map_err(|e| Error::content(path, e))?,
        notes: (0..count).map(observed).collect(),
        unknown: partial.unknown.clone(),
        photograph: None,
    };
    write_atomic(
        path,
        facade_json::annotated_to_string(&annotated).as_bytes(),
    )
}

/// A layout with its annotations.
fn annotated(path: &Path) -> Result<AnnotatedFacade> {
    facade_json::parse_annotated(&read_bytes(path)?, path)
}

/// The elements of a layout that has nothing else, exactly where they are.
fn elements(facade: &Facade) -> Result<Vec<Element>> {
    let element = |(index, region): (usize, &Region)| {
        let class = Class::of_label(&region.label).ok_or_else(|| {
            let label = region.label.clone();
            Error::method(Refused::Label { index, label })
        })?;
        Ok(Element::new(class, region.rect))
    };
    facade.regions.iter().enumerate().map(element).collect()
}

fn item(path: &Path) -> Result<Item> {
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
