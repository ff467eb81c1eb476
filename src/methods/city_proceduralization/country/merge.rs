//! The merge: one dictionary of the proposals of all tiles.

use edifice_base::{Progress, Watch, Watched};

use super::CountrySettings;
use super::sample::{Sample, Stands, examples, named, templates};
use crate::building_types::BuildingTypes;
use crate::component::Component;
use crate::detail::Detail;
use crate::emission::Found;
use crate::features::geometric_features;
use crate::rulebook::Stacks;
use crate::settings::ProceduralizeError;
use crate::types::{Priced, TypeTree};

/// The dictionary of proposals, which depends on their order, but not on how they were made.
///
/// # Errors
/// [`ProceduralizeError::Empty`] without a proposal, [`ProceduralizeError::Stopped`] when `watch` stopped it.
pub fn merge(
    proposals: &[Sample],
    settings: &CountrySettings,
    watch: &Watch,
) -> Result<Sample, ProceduralizeError> {
    let watched = Watched::new(watch);
    let k = settings.shared(proposals.iter().map(|p| p.components).sum());
    let (mut pool, mut counts) = (Vec::new(), Vec::new());
    for proposal in proposals {
        for (mut template, stands) in
            (templates(&proposal.grammar, pool.len()).into_iter()).zip(&proposal.stands)
        {
            template.volume = stands.volume;
            counts.push(stands.count);
            pool.push(template);
        }
    }
    if pool.is_empty() {
        return Err(ProceduralizeError::Empty);
    }
    let proposed = pool.len();
    if !watched.goes_on(Progress::stage("templates of the dictionary")) {
        return Err(ProceduralizeError::Stopped);
    }
    let shape = geometric_features(&pool);
    let tree = TypeTree::weighted(&pool, &shape, &counts, settings.representative)?;
    let Priced {
        mut types,
        triangles,
        price,
    } = tree.cut(k, 1.0);
    drop(tree);
    // What the chosen stand for.
    let mut stands = vec![Stands::default(); types.representatives.len()];
    for ((template, count), used) in pool.iter().zip(&counts).zip(&types.uses) {
        stands[used.kind].count += count;
        stands[used.kind].volume += template.volume;
    }
    let (mut times, mut first) = (vec![0.0; proposed], 0);
    for proposal in proposals {
        let weights = Sample::rules(&proposal.grammar);
        let stacks = examples(&proposal.grammar, times.len());
        times.extend(weights.iter().map(|r| r.weight));
        for part in stacks.into_iter().flatten() {
            types
                .uses
                .push(types.uses[first + part.stated.unwrap_or(0)]);
            pool.push(part);
        }
        first += proposal.grammar.templates.len();
    }
    if !watched.goes_on(Progress::stage("rules of the dictionary")) {
        return Err(ProceduralizeError::Stopped);
    }
    let priced = Priced {
        types,
        triangles,
        price,
    };
    let buildings = only_from(&pool, proposed, times.len());
    let stacks = Stacks::weighted(&pool, &buildings, &times)?;
    let rulebook = stacks.rulebook(&priced, k);
    let mut weights = vec![0.0; rulebook.rules.len()];
    for (used, times) in rulebook.uses.iter().zip(&times) {
        if let Some(used) = used {
            weights[used.rule] += times;
        }
    }
    let city = named("dictionary");
    let found = Found {
        city: &city,
        components: &pool,
        types: &priced.types,
        buildings: &buildings,
        rulebook: &rulebook,
        patterns: &[],
    };
    let detail = Detail::from(settings.precision);
    Ok(Sample {
        components: proposals.iter().map(|p| p.components).sum(),
        ..Sample::of(&found, stands, &weights, &detail)
    })
}

/// The stacks of the buildings from the number `first` on, of `count`.
fn only_from(components: &[Component], first: usize, count: usize) -> BuildingTypes {
    let mut buildings = BuildingTypes::apart(components, count);
    buildings.order.retain(|&b| b >= first);
    buildings
}
