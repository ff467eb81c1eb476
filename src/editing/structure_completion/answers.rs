//! Completions of a drawing, with the model that ships.

use std::path::Path;
use std::sync::OnceLock;

use super::{Given, Wanted};
use edifice_base::{Error, Result, rng};
use edifice_shape::AnnotatedFacade;
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::scope;
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::{self, Model};

/// The model that ships with the project, read once.
///
/// # Errors
/// When it cannot be read; a test keeps it readable.
pub fn shipped_model() -> Result<&'static Model> {
    static READ: OnceLock<Model> = OnceLock::new();
    if let Some(model) = READ.get() {
        return Ok(model);
    }
    let model = model::shipped_model().map_err(Error::method)?;
    Ok(READ.get_or_init(|| model))
}

/// Completions of a layout.
pub struct Answers {
    /// The input that was completed.
    pub given: Given,
    /// The completions, the best first.
    pub completions: Vec<Completion>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl Answers {
    /// The completed layouts, in the same order.
    pub fn whole(&self) -> Vec<AnnotatedFacade> {
        let completed = |c| self.given.completed(c);
        self.completions.iter().map(completed).collect()
    }
}

/// Completes a layout in up to `count` ways, the best first; the path only names it.
///
/// # Errors
/// As [`Given::new`].
pub fn complete(
    layout: AnnotatedFacade,
    wanted: &Wanted,
    method: Method,
    model: &Model,
    count: usize,
    seed: u64,
    path: &Path,
) -> Result<Answers> {
    let given = Given::new(layout, wanted, path)?;
    let mut warnings = given.warnings.clone();
    let completions = if given.partial.has_unknown() {
        let mut stream = rng::stream(seed, "facade complete", 0);
        method::complete(method, &given.partial, model, count, &mut stream)
    } else {
        warnings.push("nothing is unknown: the layout is returned as it is".into());
        vec![Completion {
            added: Vec::new(),
            score: 0.0,
            mass: 1.0,
        }]
    };
    let out_of_scope = |best: &Completion| !scope::in_scope(&given.layout(best));
    if completions.first().is_some_and(out_of_scope) {
        warnings.push(
            "out of scope: the completed facade has no regular lattice of at least 8 windows; expect less of it".into(),
        );
    }
    Ok(Answers {
        given,
        completions,
        warnings,
    })
}
