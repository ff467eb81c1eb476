//! The search for a number of templates: the grammar of most templates, or of fewest bytes, that fits.
//!
//! The size of a file does not grow with the number of templates throughout: fewer templates say more of each instance. So
//! numbers over the whole range are tried first, on a geometric ladder, that of the default level among them; then those
//! around the best of them, by bisection of the logarithm.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use super::components::decompose;
use super::proceduralize::{Made, Prepared, Proceduralized};
use super::settings::{Budget, ProceduralizeError, Settings};
use edifice_base::{Progress, Watch, Watched};
use edifice_grammar::instance::InstanceGrammar;
use edifice_shape::triangles::City;

/// Rungs of the ladder, both ends among them, and numbers tried after those of the ladder.
const RUNGS: usize = 6;
const SEARCH_STEPS: usize = 7;

/// The judgement on a grammar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verdict {
    /// True if it may be chosen.
    pub fits: bool,
    /// Bytes of its file.
    pub bytes: usize,
}

/// The grammar of the most templates that fits; `None` where none of the numbers tried does. Stopped by `watch`, it is that of
/// those tried until then.
///
/// # Errors
/// [`ProceduralizeError`], or those of `judge`.
pub fn largest<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    judge: impl Fn(&InstanceGrammar) -> Result<Verdict, E>,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    search(city, settings, judge, true, watch)
}

/// The grammar of the fewest bytes that fits; `None` where none of the numbers of templates tried does. Stopped by `watch`, it
/// is that of those tried until then.
///
/// # Errors
/// [`ProceduralizeError`], or those of `judge`.
pub fn smallest<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    judge: impl Fn(&InstanceGrammar) -> Result<Verdict, E>,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    search(city, settings, judge, false, watch)
}

fn search<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    judge: impl Fn(&InstanceGrammar) -> Result<Verdict, E>,
    many: bool,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    let watched = &Watched::new(watch);
    let decomposition = decompose(city, true, &watched.inner());
    let prepared = Prepared::new(city, &decomposition, settings, watched)?;
    let usual = settings.budget.templates(prepared.components.len());
    let make = |k: usize| -> Result<(Made, Verdict), E> {
        let made = prepared.grammar(Budget::Templates(k));
        let verdict = judge(&made.grammar)?;
        Ok((made, verdict))
    };
    let goes_on = || watched.goes_on(Progress::stage("numbers of templates"));
    let best = sought(prepared.most(), usual, many, make, goes_on)?;
    Ok(best.map(|made: Made| made.of(decomposition, watched)))
}

/// The rank of a number of templates, the least is the best: those that fit first, of them the most templates, or the fewest
/// bytes; of those that do not fit the fewest bytes.
type Rank = (bool, Reverse<usize>, usize);

/// Tries numbers of templates from 1 to `last`; the best that fits.
fn sought<M, E>(
    last: usize,
    usual: usize,
    many: bool,
    make: impl Fn(usize) -> Result<(M, Verdict), E>,
    goes_on: impl Fn() -> bool,
) -> Result<Option<M>, E> {
    let mut tried: BTreeMap<usize, Rank> = BTreeMap::new();
    let mut best: Option<(Rank, M)> = None;
    let mut ladder = ladder(last, usual).into_iter();
    let mut steps = 0;
    loop {
        let next = match ladder.next() {
            Some(k) => Some(k),
            None if steps == SEARCH_STEPS => None,
            None => {
                steps += 1;
                between(&tried, many)
            }
        };
        let Some(k) = next else { break };
        let (made, verdict) = make(k)?;
        let by_count = if many && verdict.fits { k } else { 0 };
        let rank = (!verdict.fits, Reverse(by_count), verdict.bytes);
        tried.insert(k, rank);
        if verdict.fits && best.as_ref().is_none_or(|(known, _)| rank < *known) {
            best = Some((rank, made));
        }
        if !goes_on() {
            break;
        }
    }
    Ok(best.map(|(_, made)| made))
}

/// Numbers from 1 to `last`, about equally far apart by their logarithms, and `usual`.
fn ladder(last: usize, usual: usize) -> Vec<usize> {
    let rung = |i: usize| (last as f64).powf(i as f64 / (RUNGS - 1) as f64).round() as usize;
    let mut all: Vec<usize> = (0..RUNGS).map(rung).chain([usual]).collect();
    all.iter_mut().for_each(|k| *k = (*k).clamp(1, last));
    all.sort_unstable();
    all.dedup();
    all
}

/// The number to try next: in the middle between the best one and a neighbour among those tried, the one of more templates where
/// the most are sought, else the farther one; `None` where all in between are tried.
fn between(tried: &BTreeMap<usize, Rank>, many: bool) -> Option<usize> {
    let (&k, rank) = tried.iter().min_by_key(|(_, rank)| **rank)?;
    let middle = |low: usize, high: usize| {
        let middle = (low as f64 * high as f64).sqrt().round() as usize;
        (high > low + 1).then(|| (high as f64 / low as f64, middle.clamp(low + 1, high - 1)))
    };
    let above = tried.range(k + 1..).next().and_then(|(&n, _)| middle(k, n));
    let below = tried.range(..k).next_back();
    let below = below.and_then(|(&n, _)| middle(n, k));
    let found = match (many && !rank.0, above, below) {
        (true, above, _) => above,
        (false, Some(a), Some(b)) if b.0 > a.0 => Some(b),
        (false, above, below) => above.or(below),
    };
    found.map(|(_, middle)| middle)
}
