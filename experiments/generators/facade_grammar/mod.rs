//! Layouts made by rule and chance, with the grammars that made them.
//!
//! Real facades of the kind that Wu et al. 2014 evaluate on cannot ship with the project. These stand in
//! for them: 34 facades of 50 to about 1,100 terminals, spread as `#T` of the paper's Table 1, with the
//! irregularities that make such facades hard: columns whose kinds alternate on one floor (ABAB) and mirror on
//! the next (ABBA), shop floors with another rhythm, windows of many parts, sills, pediments, cornices,
//! balconies, doors that interrupt a rhythm, towers and projections whose floors do not line up with the
//! rest, attics with another spacing, and windows that differ from their neighbours in size or label.
//!
//! Each facade is designed from named parts, as an expert would write its grammar; the parts' rules are kept as the
//! *known* grammar, which the methods do not see (precision and recall, as in Table 4). Sizes are whole
//! centimetres; every facade can be split by full lines. The last four share their elements (Fig. 13).
//!
//! Those grammars split all floors of a wing at once and then all elements of a floor, as some baselines do; [`references`] makes
//! layouts with grammars of other kinds too.
//!
//! Nothing here looks at a method: no layout is made easy or hard for one.

mod composition;
mod draft;
mod elements;
pub mod references;
mod theme;

use edifice_base::rng::{Stream, stream};
use edifice_grammar::{Grammar, GrammarError, derive};
use edifice_shape::Facade;

use composition::compose;
use draft::Draft;
use elements::Style;
use theme::{FAMILY, PLAN, Theme};

/// A made facade.
#[derive(Debug, Clone)]
pub struct Synthetic {
    /// The facade.
    pub facade: Facade,
    /// The grammar it was derived from.
    pub grammar: Grammar,
}

/// Designs tried to come near the wanted number of terminals.
const TRIES: u64 = 300;

/// The 34 layouts of a seed.
///
/// # Errors
/// [`GrammarError`] if a designed grammar did not derive, which the tests exclude.
pub fn layouts(seed: u64) -> Result<Vec<Synthetic>, GrammarError> {
    let single = PLAN.iter().enumerate().map(|(k, &(theme, target))| {
        let name = format!("{}_{}", theme.name, number(k));
        near(seed, &name, theme, target, None)
    });
    // The family: one style, so that windows and doors recur from facade to facade.
    let shared = Style::draw(&mut stream(seed, "family", 0), FAMILY[0].0.glazing);
    let family = FAMILY.iter().enumerate().map(|(k, &(theme, target))| {
        let name = format!("terrace_{}", ["a", "b", "c", "d"][k % 4]);
        near(seed, &name, theme, target, Some(&shared))
    });
    single.chain(family).collect()
}

/// A facade of about `terminals` terminals, from 50 up to any number, for measurements of speed.
///
/// # Errors
/// As [`layouts`].
pub fn sized(seed: u64, terminals: usize) -> Result<Synthetic, GrammarError> {
    let name = format!("sized_{terminals}");
    let theme = theme::scaled(terminals);
    let style = Style::draw(&mut stream(seed, &name, TRIES), theme.glazing);
    near(seed, &name, &theme, terminals, Some(&style))
}

/// The number of this facade among those of its theme, from 1.
fn number(k: usize) -> usize {
    1 + PLAN[..k]
        .iter()
        .filter(|p| p.0.name == PLAN[k].0.name)
        .count()
}

/// The design nearest to `target` terminals.
fn near(
    seed: u64,
    name: &str,
    theme: &Theme,
    target: usize,
    style: Option<&Style>,
) -> Result<Synthetic, GrammarError> {
    let mut best: Option<(usize, Synthetic)> = None;
    for attempt in 0..TRIES {
        let made = design(&mut stream(seed, name, attempt), name, theme, style)?;
        let off = made.facade.regions.len().abs_diff(target);
        if best.as_ref().is_none_or(|(least, _)| off < *least) {
            best = Some((off, made));
        }
        if off * 25 <= target {
            break;
        }
    }
    // The loop runs at least once.
    match best {
        Some((_, made)) => Ok(made),
        None => design(&mut stream(seed, name, 0), name, theme, style),
    }
}

fn design(
    rng: &mut Stream,
    name: &str,
    theme: &Theme,
    style: Option<&Style>,
) -> Result<Synthetic, GrammarError> {
    let style = match style {
        Some(style) => style.clone(),
        None => Style::draw(rng, theme.glazing),
    };
    let mut draft = Draft::default();
    let root = compose(&mut draft, rng, theme, &style);
    let grammar = draft.finish(name, &root);
    let facade = derive(&grammar, 0)?;
    Ok(Synthetic { facade, grammar })
}

#[cfg(test)]
mod tests;
