//! Several facades explained by one joint grammar (Wu et al. 2014, Sec. 4.6): the rules that they share are written once.

use std::path::Path;
use std::rc::Rc;

use super::super::split_grammar::{Wish, derived};
use super::super::work::{Work, stoppable};
use edifice_base::{Error, Result};
use edifice_facade_grammar::{InferError, Outcome, Settings, infer_watched};
use edifice_grammar::{Grammar, check};
use edifice_io::facade_json;
use edifice_shape::Facade;

/// The smallest grammar found of all facades of a grammar, each at its own size, and further ones.
///
/// # Errors
/// When a facade cannot be split by full lines, two have one name, units differ, or the work is stopped.
pub fn merge(grammar: &Grammar, further: &[Facade], work: &Work) -> Result<Outcome> {
    let own = (0..grammar.starts.len()).map(|start| {
        let wish = Wish {
            start,
            size: None,
            seed: 0,
            align: false,
        };
        let mut facade = derived(grammar, &wish).map_err(Error::method)?.facade;
        facade.name.clone_from(&grammar.starts[start].name);
        Ok(facade)
    });
    let mut all: Vec<Facade> = own.collect::<Result<_>>()?;
    for facade in further {
        let mut facade = facade.clone();
        if facade.unit != grammar.unit {
            let (a, b) = (&facade.unit, &grammar.unit);
            let text = format!(
                "{}: its unit is {a:?}, that of the others {b:?}",
                facade.name
            );
            return Err(Error::method(MergeError(text)));
        }
        // Facades of one name stay apart.
        let taken = |name: &str| all.iter().any(|f| f.name == name);
        let mut names = (2..).map(|k| format!("{}_{k}", facade.name));
        if taken(&facade.name) {
            facade.name = names.find(|n| !taken(n)).unwrap_or_default();
        }
        all.push(facade);
    }
    work.tell("looking for a joint grammar", None)?;
    let found = stoppable(|| observed(&all, work))?.map_err(Error::method)?;
    check(&found.grammar).map_err(Error::method)?;
    Ok(found)
}

/// Facades that cannot be merged.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct MergeError(String);

/// The cheapest grammar of facades, telling of the steps.
///
/// # Errors
/// [`InferError`].
pub fn observed(facades: &[Facade], work: &Work) -> std::result::Result<Outcome, InferError> {
    let settings = Settings::default();
    let steps = settings.steps().max(1) as f64;
    let (told, watched) = (work.clone(), work.clone());
    let pulse = Rc::new(move || watched.go_on_or_unwind());
    let tell = move |iteration: u64, best: f64| {
        let part = (iteration as f64 / steps).min(1.0);
        let step = format!("inferring the grammar, cost {best:.1}");
        told.tell_or_unwind(&step, Some(part));
    };
    infer_watched(
        facades,
        &settings,
        move |step| tell(step.iteration, step.best),
        pulse,
    )
}

/// Facades from the texts of their files.
///
/// # Errors
/// Names the facade, from 1, that cannot be read or is no tiling.
pub fn facades(texts: &[String]) -> Result<Vec<Facade>> {
    let read = |(k, text): (usize, &String)| {
        let name = format!("facade {}", k + 1);
        let path = Path::new(&name);
        let facade = facade_json::parse(text.as_bytes(), path)?;
        facade.check_tiling().map_err(|e| Error::content(path, e))?;
        Ok(facade)
    };
    texts.iter().enumerate().map(read).collect()
}
