//! Materials of a palette, and the images of their textures, each written when it is first used.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::{Arc, Mutex, PoisonError};

use gltf_json as json;
use json::Index;
use json::material::{NormalTexture, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use json::validation::Checked::Valid;
use serde_json::{Map, Value, json};

use crate::gltf_document::{Document, linear};
use crate::gltf_error::GltfError;
use crate::scene_png::texture_png;
use edifice_scene::palette::{Look, Palette};
use edifice_scene::textures::{Pixels, Texture, Tile, tile};
use edifice_shape::solid::Finish;

const TRANSFORM: &str = "KHR_texture_transform";
const TRANSMISSION: &str = "KHR_materials_transmission";

/// The materials of a document.
pub(super) struct Materials<'p> {
    palette: &'p Palette,
    known: BTreeMap<(Finish, bool), Index<json::Material>>,
    tiles: BTreeMap<Key, Images>,
    extensions: Vec<&'static str>,
}

/// The textures of a material's pattern.
struct Images {
    drawn: Arc<Drawn>,
    base: Index<json::Texture>,
    normal: Option<Index<json::Texture>>,
}

impl<'p> Materials<'p> {
    pub(super) fn new(palette: &'p Palette) -> Self {
        Self {
            palette,
            known: BTreeMap::new(),
            tiles: BTreeMap::new(),
            extensions: Vec::new(),
        }
    }

    /// True if the material of a finish has a map of normals.
    pub(super) fn has_relief(&self, finish: Finish, is_level: bool) -> bool {
        let (_, look) = self.palette.look(finish, is_level);
        look.texture.is_some_and(Texture::has_relief)
    }

    /// The extensions that the materials use, by name.
    pub(super) fn extensions(&self) -> Vec<String> {
        let mut names = self.extensions.clone();
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(str::to_owned).collect()
    }

    /// The material of a finish; `is_level` for level roofs.
    ///
    /// # Errors
    /// [`GltfError::Image`] when an image cannot be encoded.
    pub(super) fn index(
        &mut self,
        document: &mut Document,
        finish: Finish,
        is_level: bool,
    ) -> Result<Index<json::Material>, GltfError> {
        if let Some(known) = self.known.get(&(finish, is_level)) {
            return Ok(*known);
        }
        let (name, look) = self.palette.look(finish, is_level);
        let mut own = plain(name, look);
        if let Some(texture) = look.texture {
            let images = self.images(document, texture, look.colour)?;
            let [r, g, b] = images.drawn.tile.factor(look.colour).map(|v| v as f32);
            let pbr = &mut own.pbr_metallic_roughness;
            pbr.base_color_factor = PbrBaseColorFactor([r, g, b, 1.0]);
            pbr.base_color_texture = Some(json::texture::Info {
                index: images.base,
                tex_coord: 0,
                extensions: Some(json::extensions::texture::Info {
                    others: scaled(texture),
                }),
                extras: Default::default(),
            });
            own.normal_texture = images.normal.map(|index| NormalTexture {
                index,
                scale: 1.0,
                tex_coord: 0,
                extensions: Some(json::extensions::material::NormalTexture {
                    others: scaled(texture),
                }),
                extras: Default::default(),
            });
            self.extensions.push(TRANSFORM);
        }
        if look.transmission > 0.0 {
            self.extensions.push(TRANSMISSION);
        }
        let index = document.root.push(own);
        self.known.insert((finish, is_level), index);
        Ok(index)
    }

    fn images(
        &mut self,
        document: &mut Document,
        texture: Texture,
        colour: [u8; 3],
    ) -> Result<&Images, GltfError> {
        let vacant = match self.tiles.entry(key(texture, colour)) {
            Entry::Occupied(known) => return Ok(known.into_mut()),
            Entry::Vacant(vacant) => vacant,
        };
        let drawn = drawn(texture, colour)?;
        let mut add = |name: String, png: &[u8]| {
            let source = document.image(name, png.to_vec());
            picture(document, source)
        };
        let base = add(texture.name().into(), &drawn.base);
        let normal = drawn.normal.as_ref();
        let normal = normal.map(|png| add(format!("{}_normal", texture.name()), png));
        Ok(vacant.insert(Images {
            drawn,
            base,
            normal,
        }))
    }
}

/// A texture, with the colour that its picture depends on.
type Key = (Texture, Option<[u8; 3]>);

fn key(texture: Texture, colour: [u8; 3]) -> Key {
    (texture, texture.has_joints().then_some(colour))
}

/// A tile and its pictures as PNG.
struct Drawn {
    tile: Tile,
    base: Vec<u8>,
    normal: Option<Vec<u8>>,
}

/// Textures drawn earlier in this run, since many houses have the same few. No more than [`KEPT`] are kept.
static KNOWN: Mutex<BTreeMap<Key, Arc<Drawn>>> = Mutex::new(BTreeMap::new());
const KEPT: usize = 32;

fn drawn(texture: Texture, colour: [u8; 3]) -> Result<Arc<Drawn>, GltfError> {
    let key = key(texture, colour);
    // A thread that panicked left the map whole: entries are inserted complete.
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(drawn) = known().get(&key) {
        return Ok(Arc::clone(drawn));
    }
    let tile = tile(texture, colour);
    let png = |pixels: &Pixels| texture_png(pixels).map_err(|e| GltfError::Image(e.to_string()));
    let drawn = Arc::new(Drawn {
        base: png(&tile.base)?,
        normal: tile.normal.as_ref().map(png).transpose()?,
        tile,
    });
    let mut all = known();
    if all.len() < KEPT {
        all.insert(key, Arc::clone(&drawn));
    }
    Ok(drawn)
}

/// A material without a pattern.
fn plain(name: &str, look: Look) -> json::Material {
    let [r, g, b] = linear(look.colour);
    let transmission = json::extensions::material::Transmission {
        transmission_factor: json::extensions::material::TransmissionFactor(look.transmission),
        ..Default::default()
    };
    json::Material {
        name: Some(name.to_owned()),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(look.roughness),
            ..Default::default()
        },
        extensions: (look.transmission > 0.0).then(|| json::extensions::material::Material {
            transmission: Some(transmission),
            ..Default::default()
        }),
        ..Default::default()
    }
}

/// A texture that repeats.
fn picture(document: &mut Document, source: Index<json::Image>) -> Index<json::Texture> {
    if document.root.samplers.is_empty() {
        document.root.push(json::texture::Sampler {
            mag_filter: Some(Valid(json::texture::MagFilter::Linear)),
            min_filter: Some(Valid(json::texture::MinFilter::LinearMipmapLinear)),
            ..Default::default()
        });
    }
    document.root.push(json::Texture {
        name: None,
        sampler: Some(Index::new(0)),
        source,
        extensions: None,
        extras: Default::default(),
    })
}

/// Repeats of a texture in a metre, as `KHR_texture_transform` states them. The type for it in `gltf-json` 1.4 writes a
/// `texCoord` of null, which is no number, and normals have none.
fn scaled(texture: Texture) -> Map<String, Value> {
    let repeats = 1.0 / texture.size();
    let scale = json!({ "scale": [repeats, repeats] });
    [(TRANSFORM.to_owned(), scale)].into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_repeats_once_over_its_size() {
        for texture in Texture::ALL {
            let stated = scaled(texture);
            let [x, y] = [0, 1].map(|k| stated[TRANSFORM]["scale"][k].as_f64().unwrap());
            assert!(
                (x * texture.size() - 1.0).abs() < 1e-12 && x == y,
                "{stated:?}"
            );
        }
    }
}
