//! Instance grammars as 3D Tiles 1.1: `tileset.json`, and for each tile a binary glTF with instances.
//!
//! The plan is halved along its longer side until a tile has at most the wanted number of instances; a building is in the tile
//! of its first instance, whole. Each tile's coordinates are relative to its middle, so that 32 bits hold millimetres
//! in a city of any size. From afar, up to [`BOXES`] times as many instances are drawn as boxes, in one tile that those of the
//! templates replace; its geometric error is the largest distance between a box and what it stands for. The tileset is in the metres of the
//! grammar's reference system, z up, its origin in the `extras` of the asset. Where the reference system is known, each content is
//! put on the earth for itself ([`super::earth`]), so that the tileset bends with the earth; what a tile without content covers is then a
//! region of longitudes, latitudes and heights, and `extras.at` of a tile tells where in the reference system the origin of its content is.
//! Contents have normals and no origin.

use serde_json::{Value, json};

use super::earth;
use super::glb::{self, GlbError};
use super::glb_compressed;
use super::gltf_transform::{Matrix, rigid_inverse, shift};
use super::region::Region;
use super::tile_boxes::{box_errors, boxes};
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar};

/// Instances in a tile at most.
pub const MOST_INSTANCES: usize = 4000;
/// A tile of so many instances at most, times those of a leaf, is drawn from afar by their boxes, in one file.
pub const BOXES: usize = 16;
/// Error of a tile that is not drawn, as a share of its extent.
const ERROR_SHARE: f64 = 0.1;

/// Settings of a tileset.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Settings {
    /// Instances in a tile at most; a building is not cut.
    pub most_instances: usize,
    /// Contents with `EXT_meshopt_compression` and `KHR_mesh_quantization` ([`glb_compressed`]).
    pub compress: bool,
    /// A coarse level: each instance as a box ([`BOXES`]).
    pub boxes: bool,
    /// Contents are put on the earth, where the reference system is known.
    pub on_the_earth: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            most_instances: MOST_INSTANCES,
            compress: false,
            boxes: true,
            on_the_earth: true,
        }
    }
}

/// The files of a tileset, by name; `tileset.json` is the last.
///
/// # Errors
/// [`GlbError`].
pub fn to_files(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
    settings: &Settings,
) -> Result<Vec<(String, Vec<u8>)>, GlbError> {
    // Instances that stay together.
    let mut first = rustc_hash::FxHashMap::default();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, instance) in derivation.instances.iter().enumerate() {
        let next = groups.len();
        let group = match instance.building {
            Some(b) => *first.entry(b).or_insert(next),
            None => next,
        };
        if group == next {
            groups.push(Vec::new());
        }
        groups[group].push(i);
    }
    if groups.is_empty() {
        return Err(GlbError::Empty);
    }
    let system = grammar.reference_system.as_deref();
    let first = derivation.instances[groups[0][0]].at;
    let is_known = |system: &&str| earth::place(system, grammar.origin, first).is_some();
    let mut tiler = Tiler {
        grammar,
        derivation,
        groups,
        settings,
        system: system.filter(|_| settings.on_the_earth).filter(is_known),
        box_errors: match settings.boxes {
            true => box_errors(grammar, derivation),
            false => Vec::new(),
        },
        boxes: boxes(grammar),
        files: Vec::new(),
    };
    let all: Vec<usize> = (0..tiler.groups.len()).collect();
    let (root, space) = tiler.tile(all, None)?;
    let document = json!({
        "asset": { "version": "1.1", "extras": { "name": grammar.name, "unit": "m", "up": "z",
            "origin": grammar.origin, "reference_system": grammar.reference_system } },
        "geometricError": extent(&space.bounds),
        "root": root,
    });
    let mut files = tiler.files;
    files.push(("tileset.json".to_owned(), document.to_string().into_bytes()));
    Ok(files)
}

type Bounds = ([f64; 3], [f64; 3]);

/// The space that a tile takes up.
struct Space {
    /// In the coordinates of the city.
    bounds: Bounds,
    /// On the earth, where its contents are put there.
    region: Option<Region>,
}

impl Space {
    fn union(&self, other: &Self) -> Self {
        let both = self.region.zip(other.region);
        Self {
            bounds: union(&self.bounds, &other.bounds),
            region: both.map(|(a, b)| a.union(&b)),
        }
    }

    /// The bounding volume of a tile without a transform.
    fn volume(&self) -> Value {
        match &self.region {
            Some(region) => json!({ "region": region.numbers() }),
            None => json!({ "box": box_of(&self.bounds) }),
        }
    }
}

struct Tiler<'a> {
    grammar: &'a InstanceGrammar,
    derivation: &'a InstanceDerivation,
    groups: Vec<Vec<usize>>,
    settings: &'a Settings,
    /// The reference system, if contents are put on the earth.
    system: Option<&'a str>,
    /// Of each instance, if there is a coarse level.
    box_errors: Vec<f64>,
    /// The grammar of the coarse level.
    boxes: InstanceGrammar,
    files: Vec<(String, Vec<u8>)>,
}

impl Tiler<'_> {
    /// A tile of groups, with the tiles below it, and what it takes up. `coarse`: the error of the tile above it that is drawn by boxes, if
    /// there is one: what that draws is replaced at once.
    fn tile(
        &mut self,
        mut own: Vec<usize>,
        coarse: Option<f64>,
    ) -> Result<(Value, Space), GlbError> {
        let most = self.settings.most_instances.max(1);
        let members = self.members(&own);
        if members.len() <= most || own.len() == 1 {
            return self.leaf(&members);
        }
        let is_coarse = self.settings.boxes && coarse.is_none() && members.len() <= BOXES * most;
        let error = is_coarse.then(|| self.box_error(&members)).or(coarse);
        let place = |g: usize| self.derivation.instances[self.groups[g][0]].at;
        let span = |k: usize| {
            let values = own.iter().map(|&g| place(g)[k]);
            let (l, h) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            h - l
        };
        let axis = usize::from(span(1) > span(0));
        own.sort_by(|&a, &b| place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(&b)));
        let right = own.split_off(own.len() / 2);
        let (first, a) = self.tile(own, error)?;
        let (second, b) = self.tile(right, error)?;
        let space = a.union(&b);
        let error = error.unwrap_or_else(|| {
            let below = [&first, &second].map(|t| t["geometricError"].as_f64().unwrap_or(0.0));
            below
                .into_iter()
                .fold(ERROR_SHARE * extent(&space.bounds), f64::max)
        });
        let below = json!([first, second]);
        if is_coarse {
            let drawn = self.bounds(&self.boxes, &members, true);
            let (mut tile, own) = self.content(&members, &union(&space.bounds, &drawn), true)?;
            let space = space.union(&own);
            // The children stand where they stand; this content is moved.
            let frame = self.frame(middle(&own.bounds))?;
            let children = json!([{ "boundingVolume": space.volume(), "geometricError": error, "refine": "REPLACE",
                "transform": rigid_inverse(&frame), "children": below }]);
            if space.region.is_some() {
                tile["boundingVolume"] = space.volume();
            }
            tile["refine"] = json!("REPLACE");
            tile["geometricError"] = json!(error);
            tile["children"] = children;
            return Ok((tile, space));
        }
        let refine = match coarse {
            Some(_) => "REPLACE",
            None => "ADD",
        };
        let tile = json!({ "boundingVolume": space.volume(),
            "geometricError": error, "refine": refine, "children": below });
        Ok((tile, space))
    }

    fn members(&self, own: &[usize]) -> Vec<usize> {
        own.iter().flat_map(|&g| self.groups[g].clone()).collect()
    }

    /// The largest distance of the boxes of instances from them, in one content that does not bend with the earth.
    fn box_error(&self, members: &[usize]) -> f64 {
        let errors = members.iter().map(|&i| self.box_errors[i]);
        let (low, high) = self.bounds(self.grammar, members, false);
        let bend = match self.system {
            Some(_) => earth::bend((high[0] - low[0]).hypot(high[1] - low[1]) / 2.0),
            None => 0.0,
        };
        errors.fold(0.0, f64::max) + bend
    }

    fn leaf(&mut self, members: &[usize]) -> Result<(Value, Space), GlbError> {
        let bounds = self.bounds(self.grammar, members, false);
        if bounds.0[0] > bounds.1[0] {
            return Err(GlbError::Empty);
        }
        self.content(members, &bounds, false)
    }

    /// The bounds of instances of a grammar's templates, or of its first.
    fn bounds(&self, grammar: &InstanceGrammar, members: &[usize], first: bool) -> Bounds {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &i in members {
            let instance = &self.derivation.instances[i];
            let template = if first { 0 } else { instance.template };
            for &p in &grammar.templates[template].mesh.positions {
                let p = instance.place(p);
                for k in 0..3 {
                    low[k] = low[k].min(p[k]);
                    high[k] = high[k].max(p[k]);
                }
            }
        }
        (low, high)
    }

    /// A tile with content: instances, or their boxes.
    fn content(
        &mut self,
        members: &[usize],
        bounds: &Bounds,
        as_boxes: bool,
    ) -> Result<(Value, Space), GlbError> {
        let (low, high) = *bounds;
        let middle = middle(bounds);
        let mut part = self.derivation.part(members, middle);
        let mut grammar = self.grammar;
        if as_boxes {
            part.instances.iter_mut().for_each(|i| i.template = 0);
            grammar = &self.boxes;
        }
        let name = format!("tile-{}.glb", self.files.len());
        let bytes = match self.settings.compress {
            true => glb_compressed::tile_to_bytes(grammar, &part)?,
            false => glb::tile_to_bytes(grammar, &part)?,
        };
        self.files.push((name.clone(), bytes));
        let low = [0, 1, 2].map(|k| low[k] - middle[k]);
        let high = [0, 1, 2].map(|k| high[k] - middle[k]);
        let frame = self.frame(middle)?;
        let region = self.system.map(|_| Region::around(&frame, low, high));
        let mut tile = json!({ "boundingVolume": { "box": box_of(&(low, high)) }, "geometricError": 0,
            "refine": "ADD", "transform": frame, "content": { "uri": name } });
        if region.is_some() {
            tile["extras"] = json!({ "at": middle });
        }
        let bounds = *bounds;
        Ok((tile, Space { bounds, region }))
    }

    /// The matrix that puts what stands at `middle`, a point of the city, into its place in the coordinates of the tileset.
    fn frame(&self, middle: [f64; 3]) -> Result<Matrix, GlbError> {
        let Some(system) = self.system else {
            return Ok(shift(middle));
        };
        let origin = [0, 1, 2].map(|k| self.grammar.origin[k] + middle[k]);
        let place = earth::place(system, origin, [0.0; 3]);
        place.ok_or_else(|| GlbError::NoPlace(system.to_owned()))
    }
}

/// The origin of the coordinates of a content: the middle of its ground.
fn middle((low, high): &Bounds) -> [f64; 3] {
    [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, low[2]]
}

fn union(a: &Bounds, b: &Bounds) -> Bounds {
    (
        [0, 1, 2].map(|k| a.0[k].min(b.0[k])),
        [0, 1, 2].map(|k| a.1[k].max(b.1[k])),
    )
}

/// Centre and half axes.
fn box_of((low, high): &Bounds) -> [f64; 12] {
    let c = [0, 1, 2].map(|k| (low[k] + high[k]) / 2.0);
    let h = [0, 1, 2].map(|k| ((high[k] - low[k]) / 2.0).max(1e-3));
    [
        c[0], c[1], c[2], h[0], 0.0, 0.0, 0.0, h[1], 0.0, 0.0, 0.0, h[2],
    ]
}

fn extent((low, high): &Bounds) -> f64 {
    (0..3)
        .map(|k| (high[k] - low[k]).powi(2))
        .sum::<f64>()
        .sqrt()
}
