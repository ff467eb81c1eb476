//! Instance grammars as 3D Tiles 1.1: `tileset.json`, and for each tile a binary glTF with instances.
//!
//! The plan is halved along its longer side until a tile has at most the wanted number of instances; a building is in the tile
//! of its first instance, whole. Each tile's coordinates are relative to its middle, so that 32 bits hold millimetres
//! in a city of any size. The tileset is in the metres of the grammar's reference system, z up, its origin in the
//! `extras` of the asset; where the reference system is known, the root's `transform` puts its middle on the earth ([`super::earth`]).
//! Contents have normals and no origin.

use serde_json::{Value, json};

use super::earth;
use super::glb::{self, GlbError};
use super::glb_compressed;
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar};

/// Instances in a tile at most.
pub const MOST_INSTANCES: usize = 4000;
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
    /// The root is put on the earth, where the reference system is known.
    pub on_the_earth: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            most_instances: MOST_INSTANCES,
            compress: false,
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
    let mut tiler = Tiler {
        grammar,
        derivation,
        groups,
        settings,
        files: Vec::new(),
    };
    let all: Vec<usize> = (0..tiler.groups.len()).collect();
    let (mut root, bounds) = tiler.tile(all)?;
    let place = place(grammar, &bounds).filter(|_| settings.on_the_earth);
    if let Some(transform) = place {
        root = json!({ "boundingVolume": { "box": box_of(&bounds) }, "transform": transform,
            "geometricError": extent(&bounds), "refine": "ADD", "children": [root] });
    }
    let document = json!({
        "asset": { "version": "1.1", "extras": { "name": grammar.name, "unit": "m", "up": "z",
            "origin": grammar.origin, "reference_system": grammar.reference_system } },
        "geometricError": extent(&bounds),
        "root": root,
    });
    let mut files = tiler.files;
    files.push(("tileset.json".to_owned(), document.to_string().into_bytes()));
    Ok(files)
}

/// The place on the earth of a city within bounds, column by column, if its reference system is known.
fn place(grammar: &InstanceGrammar, (low, high): &Bounds) -> Option<[f64; 16]> {
    let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, 0.0];
    let system = grammar.reference_system.as_deref()?;
    earth::place(system, grammar.origin, middle)
}

type Bounds = ([f64; 3], [f64; 3]);

struct Tiler<'a> {
    grammar: &'a InstanceGrammar,
    derivation: &'a InstanceDerivation,
    groups: Vec<Vec<usize>>,
    settings: &'a Settings,
    files: Vec<(String, Vec<u8>)>,
}

impl Tiler<'_> {
    /// A tile of groups, with the tiles below it, and its bounds.
    fn tile(&mut self, mut own: Vec<usize>) -> Result<(Value, Bounds), GlbError> {
        let count: usize = own.iter().map(|&g| self.groups[g].len()).sum();
        if count <= self.settings.most_instances.max(1) || own.len() == 1 {
            return self.leaf(&own);
        }
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
        let (first, a) = self.tile(own)?;
        let (second, b) = self.tile(right)?;
        let bounds = (
            [0, 1, 2].map(|k| a.0[k].min(b.0[k])),
            [0, 1, 2].map(|k| a.1[k].max(b.1[k])),
        );
        let tile = json!({ "boundingVolume": { "box": box_of(&bounds) },
            "geometricError": ERROR_SHARE * extent(&bounds), "refine": "ADD", "children": [first, second] });
        Ok((tile, bounds))
    }

    fn leaf(&mut self, own: &[usize]) -> Result<(Value, Bounds), GlbError> {
        let members: Vec<usize> = own.iter().flat_map(|&g| self.groups[g].clone()).collect();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &i in &members {
            let instance = &self.derivation.instances[i];
            for &p in &self.grammar.templates[instance.template].mesh.positions {
                let p = instance.place(p);
                for k in 0..3 {
                    low[k] = low[k].min(p[k]);
                    high[k] = high[k].max(p[k]);
                }
            }
        }
        if low[0] > high[0] {
            return Err(GlbError::Empty);
        }
        let bounds = (low, high);
        let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, low[2]];
        let part = self.derivation.part(&members, middle);
        let name = format!("tile-{}.glb", self.files.len());
        let bytes = match self.settings.compress {
            true => glb_compressed::tile_to_bytes(self.grammar, &part)?,
            false => glb::tile_to_bytes(self.grammar, &part)?,
        };
        self.files.push((name.clone(), bytes));
        let [x, y, z] = middle;
        let local = (
            [0, 1, 2].map(|k| low[k] - middle[k]),
            [0, 1, 2].map(|k| high[k] - middle[k]),
        );
        // Column by column.
        let transform = [
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0,
        ];
        let tile = json!({ "boundingVolume": { "box": box_of(&local) }, "geometricError": 0,
            "refine": "ADD", "transform": transform, "content": { "uri": name } });
        Ok((tile, bounds))
    }
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
