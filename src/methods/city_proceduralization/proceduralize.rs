//! The whole pipeline: from a city to a grammar of instances.

use rayon::prelude::*;

use super::arrangement::arrange;
use super::building_types::{BuildingTypes, building_types};
use super::component::Component;
use super::components::{Decomposition, decompose};
use super::detail::Detail;
use super::emission::{Found, derived_triangles, emit, emit_tree, placed_components};
use super::features::geometric_features;
use super::parse_tree::{ParseTree, grow};
use super::patterns::patterns;
use super::rulebook::Stacks;
use super::settings::{Budget, Mode, ProceduralizeError, Settings};
use super::types::{Priced, TypeTree, Types, distinct_types, paper_types, stated_types};
use edifice_base::{Ended, Progress, Watch, Watched};
use edifice_grammar::instance::{InstanceGrammar, Repeated};
use edifice_shape::triangles::{BoxTexture, City};

/// A city as a grammar, and what it was made from.
#[derive(Debug, Clone)]
pub struct Proceduralized {
    /// The grammar.
    pub grammar: InstanceGrammar,
    /// The components into which the city was cut.
    pub decomposition: Decomposition,
    /// The types of the components.
    pub types: Types,
    /// The groups that stand together.
    pub structure: Structure,
    /// The way in which it ended. Of an interrupted one, the grammar derives the buildings that were cut until then, and where
    /// types and groups were not found yet, each distinct component has its own template.
    pub ended: Ended,
}

impl Proceduralized {
    /// The looks of each template, in at most `pixels` along a side: those of the component that it is the shape of, where
    /// `city` is painted with pictures.
    pub fn box_textures(&self, city: &City, pixels: usize) -> Vec<Option<BoxTexture>> {
        let representatives = self.types.representatives.par_iter();
        let looks = representatives.map(|&c| {
            let component = &self.decomposition.components[c];
            let paint = &city.buildings[component.building].paint;
            BoxTexture::of(paint, &component.frame, pixels)
        });
        looks.collect()
    }
}

/// The groups that stand together in a city.
#[derive(Debug, Clone)]
pub enum Structure {
    /// In `paper`: types of components, up to one root.
    Tree(ParseTree),
    /// In `best`: types of buildings that repeat at like places.
    Patterns {
        /// The types of the buildings.
        buildings: BuildingTypes,
        /// The patterns, over types of buildings and other patterns.
        patterns: Vec<Repeated>,
    },
}

/// Makes a grammar of a city, telling `watch` of each building that is cut and of each stage after that.
///
/// # Errors
/// [`ProceduralizeError`].
pub fn proceduralize(
    city: &City,
    settings: &Settings,
    watch: &Watch,
) -> Result<Proceduralized, ProceduralizeError> {
    let watched = Watched::new(watch);
    let bottoms = settings.budget != Budget::All;
    let decomposition = decompose(city, bottoms, &watched.inner());
    from_components(city, decomposition, settings, &watched.inner())
}

/// Makes a grammar of a city that is already cut.
///
/// # Errors
/// [`ProceduralizeError`].
pub fn from_components(
    city: &City,
    decomposition: Decomposition,
    settings: &Settings,
    watch: &Watch,
) -> Result<Proceduralized, ProceduralizeError> {
    let watched = &Watched::new(watch);
    let prepared = Prepared::new(city, &decomposition, settings, watched)?;
    let made = prepared.grammar(settings.budget);
    Ok(made.of(decomposition, watched))
}

/// A city of which grammars of several budgets are made.
pub(super) struct Prepared<'a> {
    city: &'a City,
    pub(super) components: &'a [Component],
    settings: &'a Settings,
    best: Option<Best<'a>>,
    pub(super) watched: &'a Watched<'a>,
}

/// The part of method `best` that is the same for all budgets.
struct Best<'a> {
    /// The templates that the input states: where there are no more of them than asked for, they are kept, so that
    /// a derived city becomes the grammar that it was derived from.
    stated: Option<Types>,
    /// `None` where it was stopped before.
    types: Option<TypeTree<'a>>,
    buildings: BuildingTypes,
    stacks: Stacks<'a>,
    patterns: Vec<Repeated>,
}

/// A grammar without what it was made from.
pub(super) struct Made {
    pub(super) grammar: InstanceGrammar,
    types: Types,
    structure: Structure,
}

impl Made {
    pub(super) fn of(self, decomposition: Decomposition, watched: &Watched) -> Proceduralized {
        let ended = match decomposition.ended {
            Ended::Finished => watched.ended(),
            Ended::Interrupted => Ended::Interrupted,
        };
        Proceduralized {
            ended,
            grammar: self.grammar,
            decomposition,
            types: self.types,
            structure: self.structure,
        }
    }
}

impl<'a> Prepared<'a> {
    pub(super) fn new(
        city: &'a City,
        decomposition: &'a Decomposition,
        settings: &'a Settings,
        watched: &'a Watched<'a>,
    ) -> Result<Self, ProceduralizeError> {
        let components = &decomposition.components[..];
        if components.is_empty() {
            return Err(match decomposition.ended {
                Ended::Finished => ProceduralizeError::Empty,
                Ended::Interrupted => ProceduralizeError::Stopped,
            });
        }
        let best = match settings.mode {
            Mode::Paper => None,
            Mode::Best => {
                let count = city.buildings.len();
                let goes_on = |stage| watched.goes_on(Progress::stage(stage));
                // What was stopped is not told apart by form any more.
                let shape = goes_on("forms").then(|| geometric_features(components));
                let buildings = match &shape {
                    Some(shape) if goes_on("types of buildings") => {
                        building_types(components, shape, count)?
                    }
                    _ => BuildingTypes::apart(components, count),
                };
                let mut best = Best {
                    stated: stated_types(components),
                    types: None,
                    stacks: Stacks::new(components, &buildings)?,
                    buildings,
                    patterns: Vec::new(),
                };
                if let Some(shape) = &shape
                    && goes_on("types of components")
                {
                    best.types = Some(TypeTree::new(components, shape, settings.representative)?);
                }
                if goes_on("patterns") {
                    best.patterns = patterns(components, &best.buildings);
                }
                Some(best)
            }
        };
        Ok(Self {
            city,
            components,
            settings,
            best,
            watched,
        })
    }

    /// The number of templates from which on more change nothing.
    pub(super) fn most(&self) -> usize {
        let stated = self.best.as_ref().and_then(|best| best.stated.as_ref());
        stated.map_or(self.components.len(), |s| s.representatives.len())
    }

    pub(super) fn grammar(&self, budget: Budget) -> Made {
        let (city, components, settings) = (self.city, self.components, self.settings);
        let k = budget.templates(components.len());
        let Some(best) = &self.best else {
            let (weights, representative) = (&settings.weights, settings.representative);
            let types = paper_types(
                components,
                k,
                weights,
                representative,
                settings.seed,
                self.watched,
            );
            let placed = placed_components(city, components, &types);
            let leaves = types.representatives.len();
            let (detection, distance) = (settings.detection, settings.distance);
            let tree = grow(leaves, placed, detection, distance, self.watched);
            self.watched.goes_on(Progress::stage("rules"));
            return Made {
                grammar: emit_tree(city, components, &types, &tree),
                types,
                structure: Structure::Tree(tree),
            };
        };
        let own: usize = city.buildings.iter().map(|b| b.mesh.triangles.len()).sum();
        let (mut flat, mut types, mut detail) = self.flat(best, budget, k, 1.0);
        for times in DEARER {
            if types.is_free() || derived_triangles(&flat) <= own {
                break;
            }
            (flat, types, detail) = self.flat(best, budget, k, times);
        }
        Made {
            grammar: arrange(&flat, &detail.grid()),
            types: types.types,
            structure: Structure::Patterns {
                buildings: best.buildings.clone(),
                patterns: best.patterns.clone(),
            },
        }
    }

    /// The grammar of `best` before buildings are arranged in rows, blocks and districts; derived triangles cost so many `times` the usual.
    fn flat(
        &self,
        best: &Best,
        budget: Budget,
        k: usize,
        times: f64,
    ) -> (InstanceGrammar, Priced, Detail) {
        let (components, settings) = (self.components, self.settings);
        let stated = best.stated.as_ref();
        let stated = stated.filter(|s| s.representatives.len() <= k);
        let free = Priced::free;
        let (priced, detail) = match (stated, budget) {
            (Some(stated), Budget::All) => (free(stated.clone()), Detail::MILLIMETRE),
            (Some(stated), _) => (free(stated.clone()), Detail::CENTIMETRE),
            (None, Budget::All) => (free(distinct_types(components)), Detail::MILLIMETRE),
            (None, _) => match &best.types {
                Some(types) => (types.cut(k, times), Detail::CENTIMETRE),
                None => (free(distinct_types(components)), Detail::CENTIMETRE),
            },
        };
        let detail = match settings.precision {
            None => detail,
            Some(precision) => precision.into(),
        };
        (self.watched).goes_on(Progress::stage("rules of buildings over templates"));
        // What is stated is kept as it is.
        let detail = match stated {
            Some(_) => detail.at_least_centimetre(),
            None => detail,
        };
        let exact = stated.is_some() || budget == Budget::All;
        let rulebook = best.stacks.rulebook(&priced, k);
        let found = Found {
            city: self.city,
            components,
            types: &priced.types,
            buildings: &best.buildings,
            rulebook: &rulebook,
            patterns: &best.patterns,
        };
        (emit(&found, &detail, exact), priced, detail)
    }
}

/// Factors of the price of derived triangles, one tried after the other while there are more of them than the city has. Delft has
/// 1,682,341; 2,308,261 are derived at the usual price (intersection over union 0.970), 1,597,704 at the first of these (0.965).
const DEARER: [f64; 2] = [12.0, 30.0];
