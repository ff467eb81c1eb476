//! A city of stochastic variations (Wu et al. 2014, Sec. 6.2, Fig. 15 and 16).
//!
//! Size-independent grammars are derived at the sizes of building masses: a type of building is a
//! box with the facade of one grammar at two sizes, one for front and back, one for the sides. Types
//! are made once and stand in the city many times, as instances of their meshes, so that a scene of
//! tens of millions of polygons is stored in megabytes. Blocks of lots stand on a street grid.
//!
//! # Deviations and readings
//! - The paper drew 3,500 buildings with CityEngine and edited its twelve grammars by hand; here
//!   nothing is edited, and windows, doors and balconies are boxes and niches by their label.
//! - Every building is one box with four facades and a flat or pitched roof.
//! - Sizes and rules are drawn together, several times, until the parts are nearly as large as in the facades
//!   that the grammar was made from: two floors drawn at the height of three would stretch their windows.
//! - Facades whose unit is not metric are scaled to [`Settings::height`].

mod town;

use std::collections::BTreeMap;

use rand::RngExt;
use rayon::prelude::*;

use edifice_base::rng::{Stream, stream};
use edifice_grammar::{Grammar, GrammarError, Sampler, scaled, size_independent};
use edifice_scene::relief::{material, relief};
use edifice_scene::render::Camera;
use edifice_scene::{Instance, Material, Scene};
use edifice_shape::Facade;

/// The size of the city: number of buildings and of types, and the height of facades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Number of buildings.
    pub buildings: usize,
    /// Types of buildings, at least one for each grammar.
    pub types: usize,
    /// Height in metres given to facades that are not in metres or centimetres.
    pub height: f64,
}

impl Default for Settings {
    /// The paper's number of buildings (Sec. 6.2).
    fn default() -> Self {
        Self {
            buildings: 3500,
            types: 120,
            height: 14.0,
        }
    }
}

/// A scene and what it counts.
#[derive(Debug, Clone, PartialEq)]
pub struct City {
    /// The scene.
    pub scene: Scene,
    /// Number of buildings.
    pub buildings: usize,
    /// Number of different facades, each stored once.
    pub facades: usize,
    /// Number of facades shown.
    pub facade_instances: usize,
    /// Number of triangles shown.
    pub triangles: u64,
    /// Number of triangles stored.
    pub stored_triangles: u64,
    /// Height of the tallest building without its roof, in metres.
    pub tallest: f32,
}

impl City {
    /// A camera over the roofs near the middle, which looks to the horizon.
    pub fn from_above(&self) -> Camera {
        let height = 55.0 + 1.5 * self.tallest;
        Camera {
            eye: [-1.5 * height, 0.9 * height, 1.25 * height],
            target: [0.6 * height, 0.0, -0.45 * height],
            angle: 36.0,
        }
    }

    /// A camera in the street beside the middle, a little above the heads of people.
    pub fn in_the_street(&self) -> Camera {
        let street = town::middle_of_street();
        Camera {
            eye: [-64.0, 5.0, street + 3.0],
            target: [20.0, 3.0 + 0.3 * self.tallest, street - 7.0],
            angle: 48.0,
        }
    }
}

/// A kind of building: meshes and sizes in metres.
struct Type {
    width: f32,
    depth: f32,
    height: f32,
    /// Meshes of the front and back, and of the sides.
    facades: [usize; 2],
    pitched: bool,
}

/// Builds a city from grammars, the same for the same seed. Each facade of a joint grammar is a grammar of its own.
///
/// # Errors
/// [`GrammarError`] for an invalid grammar, or no grammar at all, or one that does not fit even at
/// its own size.
pub fn city(grammars: &[Grammar], settings: &Settings, seed: u64) -> Result<City, GrammarError> {
    if grammars.is_empty() || grammars.iter().any(|g| g.starts.is_empty()) {
        return Err(GrammarError::NoStart);
    }
    let each = grammars.iter().flat_map(Grammar::of_each_start);
    let styles: Vec<Grammar> = each.map(|g| style(&g, settings.height)).collect();
    let samplers = styles
        .iter()
        .map(Sampler::new)
        .collect::<Result<Vec<_>, _>>()?;
    let count = settings.types.max(styles.len());
    let drawn = (0..count).into_par_iter().map(|index| {
        let number = index % styles.len();
        draw_type(&samplers[number], &styles[number], seed, index)
    });
    let drawn: Vec<[Facade; 2]> = drawn.collect::<Result<_, _>>()?;

    let mut scene = Scene::default();
    let mut materials = Materials::default();
    let kit = town::Kit::new(&mut scene, &mut materials.list);
    let mut types = Vec::with_capacity(count);
    for (index, facades) in drawn.iter().enumerate() {
        let number = index % styles.len();
        for facade in facades {
            for region in &facade.regions {
                materials.number(&region.label, number);
            }
        }
        let meshes = [0, 1].map(|side| {
            let name = format!("type {} {}", index + 1, ["front", "side"][side]);
            let mesh = relief(name, &facades[side], |label| materials.find(label, number));
            scene.meshes.push(mesh);
            scene.meshes.len() - 1
        });
        let height = facades[0].height as f32;
        types.push(Type {
            width: facades[0].width as f32,
            depth: facades[1].width as f32,
            height,
            facades: meshes,
            pitched: height < 12.0,
        });
    }
    scene.materials = materials.list;
    let facades = 2 * types.len();
    let mut rng = stream(seed, "city", 0);
    scene.groups = town::town(&kit, &types, settings.buildings, &mut rng);
    // All groups but the ground are buildings.
    let buildings = scene.groups.len() - 1;
    Ok(City {
        buildings,
        facades,
        facade_instances: 4 * buildings,
        triangles: scene.triangles(),
        stored_triangles: scene.stored_triangles(),
        tallest: types.iter().map(|t| t.height).fold(0.0, f32::max),
        scene,
    })
}

/// A grammar in metres that can be derived at any size.
fn style(grammar: &Grammar, height: f64) -> Grammar {
    let own = grammar.starts.first().map_or(1.0, |s| s.height);
    let factor = match grammar.unit.as_str() {
        "m" => 1.0,
        "dm" => 0.1,
        "cm" => 0.01,
        "mm" => 0.001,
        _ => height / own,
    };
    let metres = scaled(grammar, factor, "m");
    size_independent(&metres)
}

/// Draws sizes and rules that fit one another, and derives front and side.
fn draw_type(
    sampler: &Sampler<'_>,
    style: &Grammar,
    seed: u64,
    index: usize,
) -> Result<[Facade; 2], GrammarError> {
    let mut rng = stream(seed, "building type", index as u64);
    let own = &style.starts[0];
    let vary = |rng: &mut Stream, own: f64, low: f64, high: f64| {
        (own * rng.random_range(low..high) * 2.0).round() / 2.0
    };
    let mut best: Option<(f64, [Facade; 2])> = None;
    for attempt in 0..ATTEMPTS {
        let width = vary(&mut rng, own.width, 0.8, 1.3).clamp(6.0, 40.0);
        let depth = rng.random_range(9.0..15.0f64).round();
        let height = vary(&mut rng, own.height, 0.85, 1.3).max(3.0);
        // Both sides take their choices from the same numbers, so that they match.
        let number = index as u64 * ATTEMPTS + attempt;
        let choices = || stream(seed, "building type choices", number);
        let derive = |width| sampler.derive(0, width, height, &mut choices());
        let (Ok(front), Ok(side)) = (derive(width), derive(depth)) else {
            continue;
        };
        if !(front.shrunk.is_empty() && side.shrunk.is_empty()) {
            continue;
        }
        let stretched = sampler.stretch(&front).max(sampler.stretch(&side));
        if best.as_ref().is_none_or(|(least, _)| stretched < *least) {
            best = Some((stretched, [front.facade, side.facade]));
        }
        if stretched <= STRETCH {
            break;
        }
    }
    if let Some((_, facades)) = best {
        return Ok(facades);
    }
    let mut choices = stream(seed, "building type choices", index as u64 * ATTEMPTS);
    let derivation = sampler.derive(0, own.width, own.height, &mut choices)?;
    let front = derivation.facade;
    Ok([front.clone(), front])
}

/// Draws for a type of building.
const ATTEMPTS: u64 = 16;
/// The first draw is taken whose parts are at most this much larger or smaller than in the facades that
/// the grammar was made from; or the one with the least such factor.
const STRETCH: f64 = 1.5;

/// Materials by label and style, in order of appearance.
#[derive(Default)]
struct Materials {
    list: Vec<Material>,
    numbers: BTreeMap<(String, usize), usize>,
}

impl Materials {
    fn number(&mut self, label: &str, style: usize) {
        let key = (label.to_owned(), style);
        if self.numbers.contains_key(&key) {
            return;
        }
        let material = material(label, style);
        let known = self.list.iter().position(|m| m.name == material.name);
        let number = known.unwrap_or_else(|| {
            self.list.push(material);
            self.list.len() - 1
        });
        self.numbers.insert(key, number);
    }

    fn find(&self, label: &str, style: usize) -> usize {
        self.numbers
            .get(&(label.to_owned(), style))
            .copied()
            .unwrap_or(0)
    }
}

impl Type {
    /// Four facades around a box that stands on the origin.
    fn walls(&self) -> [Instance; 4] {
        let (w, d) = (self.width / 2.0, self.depth / 2.0);
        let quarter = std::f32::consts::FRAC_PI_2;
        let side = |mesh: usize, turns: f32, x: f32, z: f32| Instance {
            yaw: turns * quarter,
            ..Instance::at(mesh, [x, 0.0, z])
        };
        [
            side(self.facades[0], 0.0, -w, d),
            side(self.facades[1], 1.0, w, d),
            side(self.facades[0], 2.0, w, -d),
            side(self.facades[1], 3.0, -w, -d),
        ]
    }
}
