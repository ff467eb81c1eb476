//! The whole pipeline: from a city to a grammar of instances.

use rayon::prelude::*;

use super::building_types::{BuildingTypes, building_types};
use super::components::{Component, Decomposition, decompose};
use super::emission::{Detail, Found, emit, emit_tree, placed_components};
use super::features::geometric_features;
use super::parse_tree::{Detection, ParseTree, grow};
use super::patterns::patterns;
use super::rulebook::Stacks;
use super::type_graph::DistanceWeights;
use super::types::{TypeTree, Types, distinct_types, paper_types, stated_types};
use edifice_base::{Ended, Progress, Watch, Watched};
use edifice_cluster::WardError;
use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError, Repeated};
use edifice_shape::triangles::{BoxTexture, City};

/// The method of finding types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// As the paper writes.
    Paper,
    /// Geometric features, Ward, medoids.
    Best,
}

/// The number of templates that the grammar may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// One for each distinct component.
    All,
    /// This number of templates.
    Templates(usize),
    /// The number of components, halved this many times.
    Level(u32),
}

/// The precision in which a grammar is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Millimetres, ten-thousandths of degrees, templates on 16 bits.
    Millimetre,
    /// Centimetres, hundredths of degrees, templates on 12 bits.
    Centimetre,
    /// Decimetres, half degrees, templates on 7 bits: for few bytes.
    Decimetre,
}

/// The member that represents a type in `paper`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Representative {
    /// The member nearest to the mean.
    Nearest,
    /// The member of fewest polygons ("-poly").
    FewestPolygons,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The method of finding types.
    pub mode: Mode,
    /// The number of templates that the grammar may have.
    pub budget: Budget,
    /// Weights W of the eleven features, in `paper`.
    pub weights: [f64; 11],
    /// The member that represents a type, in `paper`.
    pub representative: Representative,
    /// Weights of Eq. 11.
    pub distance: DistanceWeights,
    /// The method of finding communities, in `paper`.
    pub detection: Detection,
    /// Seed of k-means, in `paper`.
    pub seed: u64,
    /// The precision of numbers, in `best`. `None`: millimetres where each component has its own template,
    /// centimetres otherwise.
    pub precision: Option<Precision>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: Mode::Best,
            budget: Budget::Level(4),
            weights: [1.0; 11],
            representative: Representative::Nearest,
            distance: DistanceWeights::default(),
            detection: Detection::GirvanNewman,
            seed: 1,
            precision: None,
        }
    }
}

/// Why a city cannot be proceduralized.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProceduralizeError {
    /// There is nothing to proceduralize.
    #[error("no building has a triangle with an area")]
    Empty,
    /// It was stopped before anything was found.
    #[error("stopped before the first building was cut")]
    Stopped,
    /// Features cannot be clustered.
    #[error("features: {0}")]
    Ward(#[from] WardError),
    /// The grammar made is not sound: an error of this program.
    #[error("the grammar is not sound: {0}")]
    Grammar(#[from] InstanceGrammarError),
}

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
struct Prepared<'a> {
    city: &'a City,
    components: &'a [Component],
    settings: &'a Settings,
    best: Option<Best<'a>>,
    watched: &'a Watched<'a>,
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
struct Made {
    grammar: InstanceGrammar,
    types: Types,
    structure: Structure,
}

impl Made {
    fn of(self, decomposition: Decomposition, watched: &Watched) -> Proceduralized {
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
    fn new(
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
                let shape = geometric_features(components);
                let buildings = match goes_on("types of buildings") {
                    true => building_types(components, &shape, count)?,
                    false => BuildingTypes::apart(components, count),
                };
                let mut best = Best {
                    stated: stated_types(components),
                    types: None,
                    stacks: Stacks::new(components, &buildings)?,
                    buildings,
                    patterns: Vec::new(),
                };
                if goes_on("types of components") {
                    best.types = Some(TypeTree::new(components, &shape)?);
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

    fn grammar(&self, budget: Budget) -> Made {
        let (city, components, settings) = (self.city, self.components, self.settings);
        let n = components.len();
        let k = match budget {
            Budget::All => n,
            Budget::Templates(k) => k.clamp(1, n),
            Budget::Level(level) => n.checked_shr(level).unwrap_or(0).max(1),
        };
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
        let stated = best.stated.as_ref();
        let stated = stated.filter(|s| s.representatives.len() <= k);
        let (types, detail) = match (stated, budget) {
            (Some(stated), Budget::All) => (stated.clone(), Detail::MILLIMETRE),
            (Some(stated), _) => (stated.clone(), Detail::CENTIMETRE),
            (None, Budget::All) => (distinct_types(components), Detail::MILLIMETRE),
            (None, _) => match &best.types {
                Some(types) => (types.cut(k), Detail::CENTIMETRE),
                None => (distinct_types(components), Detail::CENTIMETRE),
            },
        };
        let detail = match settings.precision {
            None => detail,
            Some(Precision::Millimetre) => Detail::MILLIMETRE,
            Some(Precision::Centimetre) => Detail::CENTIMETRE,
            Some(Precision::Decimetre) => Detail::DECIMETRE,
        };
        (self.watched).goes_on(Progress::stage("rules of buildings over templates"));
        // What is stated is kept as it is.
        let detail = match stated {
            Some(_) => detail.at_least_centimetre(),
            None => detail,
        };
        let exact = stated.is_some() || budget == Budget::All;
        let (buildings, patterns) = (&best.buildings, &best.patterns);
        let rulebook = best.stacks.rulebook(&types, k);
        let found = Found {
            city,
            components,
            types: &types,
            buildings,
            rulebook: &rulebook,
            patterns,
        };
        Made {
            grammar: emit(&found, &detail, exact),
            types,
            structure: Structure::Patterns {
                buildings: buildings.clone(),
                patterns: patterns.clone(),
            },
        }
    }
}

/// Steps of the search for a number of templates.
const SEARCH_STEPS: usize = 7;

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
