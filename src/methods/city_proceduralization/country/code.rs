//! The second pass: a tile by the dictionary and local types.

use edifice_base::{Progress, Watch, Watched};
use edifice_grammar::instance::{InstanceGrammar, InstanceRule};
use edifice_shape::triangles::City;
use rayon::prelude::*;

use super::sample::{Sample, examples, templates};
use super::{CountrySettings, components};
use crate::arrangement::arrange;
use crate::building_types::BuildingTypes;
use crate::component::Component;
use crate::detail::Detail;
use crate::emission::{AXIOM, Found, emit_rules, named_rules};
use crate::facility::Facilities;
use crate::features::geometric_features;
use crate::medoids::{CANDIDATES, Form, Price, Table};
use crate::nearest::Nearest;
use crate::rulebook::Stacks;
use crate::settings::{ProceduralizeError, Representative};
use crate::types::{Priced, Types, template_triangles};
use crate::uses::Use;

/// Beginnings of the symbols of local types of buildings, and of local escapes.
const LOCAL: [&str; 2] = ["L", "E"];

/// The grammar of a tile: the dictionary's templates and rules, as they are and in their order, then the axiom's rule, then local
/// rules; local templates follow those of the dictionary. Local types are some of the tile's own `proposal`.
///
/// # Errors
/// [`ProceduralizeError::Empty`] where no building has an area, [`ProceduralizeError::Stopped`] when `watch` stopped it.
pub fn code(
    tile: &City,
    dictionary: &InstanceGrammar,
    proposal: &Sample,
    settings: &CountrySettings,
    watch: &Watch,
) -> Result<InstanceGrammar, ProceduralizeError> {
    let watched = Watched::new(watch);
    let components = components(tile, &watched)?;
    let own = components.len();
    let more = settings.local(own);
    let pool = Pool::new(tile, components, dictionary, &proposal.grammar);
    let priced = pool.types(settings.representative, more);
    if !watched.goes_on(Progress::stage("rules of buildings over templates")) {
        return Err(ProceduralizeError::Stopped);
    }
    let buildings = pool.buildings();
    let stacks = Stacks::new(&pool.components, &buildings)?;
    let rulebook = stacks.extended(&priced, &pool.shared_rules, &pool.local_rules, more);
    let found = Found {
        city: tile,
        components: &pool.components,
        types: &priced.types,
        buildings: &buildings,
        rulebook: &rulebook,
        patterns: &[],
    };
    let shared: Vec<InstanceRule> = Sample::rules(dictionary).into_iter().cloned().collect();
    let local = named_rules(&found, shared.len(), LOCAL);
    let rules = shared.iter().cloned().chain(local).collect();
    let detail = Detail::from(settings.precision);
    let mut grammar = emit_rules(&found, rules, &detail, false);
    let shared_templates = dictionary.templates.iter().cloned();
    for (own, shared) in grammar.templates.iter_mut().zip(shared_templates) {
        *own = shared;
    }
    // The dictionary's rules first.
    let axiom = grammar.rules.iter().position(|r| r.symbol == AXIOM);
    grammar.rules[axiom.unwrap_or(0)..=shared.len()].rotate_left(1);
    Ok(arrange(&grammar, &detail.grid()))
}

/// The components of a tile with those of the types that may stand for them.
struct Pool {
    /// Of the tile; of the examples of local rules, then of shared ones; templates of the dictionary, then local ones.
    components: Vec<Component>,
    /// Those of the tile and of the examples of local rules, which take the best templates.
    free: usize,
    /// Those of the tile.
    own: usize,
    /// The first template of the dictionary, and the first local one.
    shared: usize,
    local: usize,
    /// Buildings of the tile, and all, those of types counted.
    buildings: usize,
    count: usize,
    /// Buildings that are examples of rules.
    shared_rules: Vec<usize>,
    local_rules: Vec<usize>,
}

impl Pool {
    fn new(
        tile: &City,
        mut components: Vec<Component>,
        dictionary: &InstanceGrammar,
        proposal: &InstanceGrammar,
    ) -> Self {
        let (own, buildings) = (components.len(), tile.buildings.len());
        let mut count = buildings;
        let mut add = |grammar: &InstanceGrammar, components: &mut Vec<Component>| {
            let stacks = examples(grammar, count);
            let rules = count..count + stacks.len();
            count = rules.end;
            components.extend(stacks.into_iter().flatten());
            rules.collect()
        };
        let local_rules = add(proposal, &mut components);
        let free = components.len();
        let shared_rules = add(dictionary, &mut components);
        let shared = components.len();
        components.extend(templates(dictionary, count));
        let local = components.len();
        count += local - shared;
        components.extend(templates(proposal, count));
        count += components.len() - local;
        Self {
            components,
            free,
            own,
            shared,
            local,
            buildings,
            count,
            shared_rules,
            local_rules,
        }
    }

    /// The buildings of the tile and the examples of rules, as stacks.
    fn buildings(&self) -> BuildingTypes {
        let mut buildings = BuildingTypes::apart(&self.components, self.count);
        let end = self.buildings + self.shared_rules.len() + self.local_rules.len();
        buildings.order.retain(|&b| b < end);
        buildings
    }

    /// The dictionary's templates and at most `more` local ones, with their uses.
    fn types(&self, representative: Representative, more: usize) -> Priced {
        let table = self.table(representative);
        let mut medoids: Vec<usize> = (self.shared..self.local).collect();
        let first = Use {
            kind: 0,
            quarter: 0,
        };
        let uses = table.assign(&medoids, &vec![first; self.free], Price::default());
        let price = table.price(&medoids, &uses[..self.own], 1.0);
        let uses = table.assign(&medoids, &uses, price);
        let locals: Vec<usize> = (self.local..self.components.len()).collect();
        let chosen = self.chosen(&table, &medoids, &uses, &locals, price, more);
        medoids.extend(chosen.into_iter().map(|k| locals[k]));
        let mut uses = table.assign(&medoids, &uses, price);
        let stated = self.components[self.free..self.shared].iter();
        let stated = stated.map(|c| Use {
            kind: c.stated.unwrap_or(0),
            quarter: 0,
        });
        uses.extend(stated);
        Priced {
            triangles: medoids.iter().map(|&m| table.triangles[m]).collect(),
            types: Types {
                representatives: medoids,
                uses,
            },
            price,
        }
    }

    fn table(&self, representative: Representative) -> Table<'_> {
        let points = geometric_features(&self.components);
        let triangles = self.components.par_iter().enumerate();
        let triangles = triangles.map(|(i, c)| match i >= self.shared {
            true => template_triangles(c),
            // Only templates are priced.
            false => 0.0,
        });
        let weights = self.components.iter().map(|c| c.volume.max(1e-3));
        Table {
            d: points.dimension,
            weights: weights.collect(),
            counts: vec![1.0; self.components.len()],
            triangles: triangles.collect(),
            few: representative == Representative::FewestPolygons,
            forms: self.components.iter().map(Form::of).collect(),
            rows: points.values,
        }
    }

    /// The local templates, at most `more`, that remove most of the cost that the dictionary leaves to the tile's components.
    fn chosen(
        &self,
        table: &Table,
        shared: &[usize],
        uses: &[Use],
        locals: &[usize],
        price: Price,
        more: usize,
    ) -> Vec<usize> {
        let nearest = Nearest::new(&table.rows, table.d, locals);
        let cost = |i: usize, medoid: usize, limit: f64| {
            table.weights[i] * table.share(medoid, i, price, limit).0
        };
        let one = |i: usize| {
            let left = cost(i, shared[uses[i].kind], f64::INFINITY);
            let near = nearest.of(table.row(i), CANDIDATES).into_iter();
            let near = near.map(|k| (k, cost(i, locals[k], left / table.weights[i])));
            let near = near.filter(|(_, cost)| *cost < left);
            (left, near.collect())
        };
        let customers: Vec<(f64, Vec<(usize, f64)>)> =
            (0..self.own).into_par_iter().map(one).collect();
        let mut facilities = Facilities {
            served: vec![Vec::new(); locals.len()],
            price: vec![1.0; locals.len()],
            left: customers.iter().map(|c| c.0).collect(),
        };
        for (i, (_, near)) in customers.into_iter().enumerate() {
            for (k, cost) in near {
                facilities.served[k].push((i, cost));
            }
        }
        facilities.choose(Vec::new(), more)
    }
}
