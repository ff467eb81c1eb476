//! The first pass: the types of a tile.

use edifice_base::{Progress, Watch, Watched};
use edifice_shape::triangles::City;

use super::sample::{Sample, Stands};
use super::{CountrySettings, components};
use crate::building_types::BuildingTypes;
use crate::detail::Detail;
use crate::emission::Found;
use crate::features::geometric_features;
use crate::rulebook::Stacks;
use crate::settings::ProceduralizeError;
use crate::types::TypeTree;

/// The types that a tile would have if it were a city, with what each stands for.
///
/// # Errors
/// [`ProceduralizeError::Empty`] where no building has an area, [`ProceduralizeError::Stopped`] when `watch` stopped it.
pub fn propose(
    tile: &City,
    settings: &CountrySettings,
    watch: &Watch,
) -> Result<Sample, ProceduralizeError> {
    let watched = Watched::new(watch);
    let components = components(tile, &watched)?;
    let k = settings
        .types(components.len())
        .min(settings.proposed.max(1));
    let shape = geometric_features(&components);
    let priced = TypeTree::new(&components, &shape, settings.representative)?.cut(k, 1.0);
    if !watched.goes_on(Progress::stage("rules of buildings over templates")) {
        return Err(ProceduralizeError::Stopped);
    }
    let buildings = BuildingTypes::apart(&components, tile.buildings.len());
    let rulebook = Stacks::new(&components, &buildings)?.rulebook(&priced, k);
    let mut stands = vec![Stands::default(); priced.types.representatives.len()];
    for (component, used) in components.iter().zip(&priced.types.uses) {
        stands[used.kind].count += 1.0;
        stands[used.kind].volume += component.volume;
    }
    let mut weights = vec![0.0; rulebook.rules.len()];
    let uses = rulebook.uses.iter().flatten();
    uses.for_each(|used| weights[used.rule] += 1.0);
    let found = Found {
        city: tile,
        components: &components,
        types: &priced.types,
        buildings: &buildings,
        rulebook: &rulebook,
        patterns: &[],
    };
    let detail = Detail::from(settings.precision);
    Ok(Sample::of(&found, stands, &weights, &detail))
}
