//! The search for a number of templates: the largest grammar, or the smallest, that fits.

use super::components::decompose;
use super::proceduralize::{Made, Prepared, Proceduralized};
use super::settings::{Budget, ProceduralizeError, Settings};
use edifice_base::{Progress, Watch, Watched};
use edifice_grammar::instance::InstanceGrammar;
use edifice_shape::triangles::City;

/// Steps of the search for a number of templates.
const SEARCH_STEPS: usize = 9;

/// The grammar of the most templates that `fits`, on the assumption that fewer templates fit as well; `None`
/// when one template does not fit. Stopped by `watch`, it is the most of those tried.
///
/// # Errors
/// [`ProceduralizeError`], or those of `fits`.
pub fn largest<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    fits: impl Fn(&InstanceGrammar) -> Result<bool, E>,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    search(city, settings, fits, true, watch)
}

/// The grammar of the fewest templates that `fits`, on the assumption that more templates fit as well; `None`
/// when a template for each component does not fit. Stopped by `watch`, it is the fewest of those tried.
///
/// # Errors
/// [`ProceduralizeError`], or those of `fits`.
pub fn smallest<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    fits: impl Fn(&InstanceGrammar) -> Result<bool, E>,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    search(city, settings, fits, false, watch)
}

/// Bisection over the logarithm of the number of templates.
fn search<E: From<ProceduralizeError>>(
    city: &City,
    settings: &Settings,
    fits: impl Fn(&InstanceGrammar) -> Result<bool, E>,
    many: bool,
    watch: &Watch,
) -> Result<Option<Proceduralized>, E> {
    let watched = &Watched::new(watch);
    let decomposition = decompose(city, true, &watched.inner());
    let prepared = Prepared::new(city, &decomposition, settings, watched)?;
    let best = bisected(&prepared, fits, many)?;
    Ok(best.map(|made| made.of(decomposition, watched)))
}

fn bisected<E: From<ProceduralizeError>>(
    prepared: &Prepared,
    fits: impl Fn(&InstanceGrammar) -> Result<bool, E>,
    many: bool,
) -> Result<Option<Made>, E> {
    let (mut low, mut high) = (1, prepared.components.len());
    let sure = prepared.grammar(Budget::Templates(if many { low } else { high }));
    let mut best = fits(&sure.grammar)?.then_some(sure);
    for _ in 0..SEARCH_STEPS {
        let middle = ((low as f64 * high as f64).sqrt() as usize).max(low);
        let goes_on = (prepared.watched).goes_on(Progress::stage("numbers of templates"));
        if best.is_none() || middle == low || middle == high || !goes_on {
            break;
        }
        let made = prepared.grammar(Budget::Templates(middle));
        let fit = fits(&made.grammar)?;
        if fit {
            best = Some(made);
        }
        if fit == many {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(best)
}
