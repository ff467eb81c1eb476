//! Several facades explained by one joint grammar (Wu et al. 2014, Sec. 4.6): the rules that they share are written once.

use std::path::Path;

use super::super::split_grammar::{Resizing, Wish, derived};
use super::super::work::Work;
use edifice_base::{Error, Progress, Result};
use edifice_facade_grammar::{Outcome, Settings, infer};
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
            resizing: Resizing::Rules,
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
    let found = watched(&all, work)?;
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
/// Those of [`infer`], and when the work is stopped.
pub(super) fn watched(facades: &[Facade], work: &Work) -> Result<Outcome> {
    let watch = |progress: Progress| {
        if let Some(best) = progress.best {
            let step = format!("inferring the grammar, cost {best:.1}");
            // That it is stopped, the next line says.
            let _ = work.tell(&step, progress.share());
        }
        work.go_on()
    };
    let found = infer(facades, &Settings::default(), &watch).map_err(Error::method)?;
    work.whole(found.ended)?;
    Ok(found)
}

/// Facades from the texts of their files.
///
/// # Errors
/// Names the facade, from 1, that cannot be read or is no tiling.
pub(super) fn facades(texts: &[String]) -> Result<Vec<Facade>> {
    let read = |(k, text): (usize, &String)| {
        let name = format!("facade {}", k + 1);
        let path = Path::new(&name);
        let facade = facade_json::parse(text.as_bytes(), path)?;
        facade.check_tiling().map_err(|e| Error::content(path, e))?;
        Ok(facade)
    };
    texts.iter().enumerate().map(read).collect()
}
