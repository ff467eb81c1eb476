//! Materials, textures and images of a glTF file: what its surfaces look like.

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;

use super::gltf_data::{Buffers, load};
use super::pictures::decoded;
use super::{CityError, glb::BOX_MAPPED};
use edifice_shape::triangles::Surface;

/// A material.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    #[serde(default)]
    name: String,
    #[serde(default)]
    pbr_metallic_roughness: Roughness,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Roughness {
    base_color_factor: Option<[f64; 4]>,
    base_color_texture: Option<Use>,
}

/// The use of a texture by a material.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Use {
    index: usize,
    #[serde(default)]
    tex_coord: usize,
    #[serde(default)]
    extensions: Extensions,
}

#[derive(Default, Deserialize)]
struct Extensions {
    #[serde(rename = "KHR_texture_transform")]
    transform: Option<Transform>,
}

/// The extension `KHR_texture_transform`.
#[derive(Clone, Copy, Deserialize)]
pub(super) struct Transform {
    #[serde(default)]
    offset: [f64; 2],
    #[serde(default)]
    rotation: f64,
    #[serde(default = "ones")]
    scale: [f64; 2],
}

fn ones() -> [f64; 2] {
    [1.0; 2]
}

/// A texture.
#[derive(Deserialize)]
pub(super) struct Texture {
    source: Option<usize>,
}

/// An image.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    uri: Option<String>,
    buffer_view: Option<usize>,
}

/// The look of a primitive.
#[derive(Clone)]
pub(super) struct Looks {
    /// Its picture or colour.
    pub surface: Arc<Surface>,
    /// The set of texture coordinates.
    pub coordinates: usize,
    /// The transform of these coordinates.
    pub transform: Option<Transform>,
    /// True if the picture is the box mapping of a template.
    pub box_mapped: bool,
}

impl Transform {
    /// Coordinates in the picture; v goes downwards.
    pub(super) fn applied(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [u, v] = [u * self.scale[0], v * self.scale[1]];
        let (sin, cos) = self.rotation.sin_cos();
        [
            u * cos + v * sin + self.offset[0],
            v * cos - u * sin + self.offset[1],
        ]
    }
}

/// The looks of each material, if the file has textures at all; `None` for one whose picture the file does not name.
///
/// # Errors
/// The element that is wrong, and why.
pub(super) fn looks(
    materials: &[Material],
    textures: &[Texture],
    images: &[Image],
    buffers: &Buffers,
    path: &Path,
) -> Result<Vec<Option<Looks>>, (String, CityError)> {
    if textures.is_empty() {
        return Ok(Vec::new());
    }
    let mut surfaces: Vec<Option<Arc<Surface>>> = vec![None; images.len()];
    let mut out = Vec::new();
    for (m, material) in materials.iter().enumerate() {
        let own = &material.pbr_metallic_roughness;
        let Some(used) = &own.base_color_texture else {
            let factor = own.base_color_factor.unwrap_or([1.0; 4]);
            let level = |k: usize| (factor[k].clamp(0.0, 1.0) * 255.0).round() as u8;
            out.push(Some(Looks {
                surface: Arc::new(Surface::Plain(std::array::from_fn(level))),
                coordinates: 0,
                transform: None,
                box_mapped: false,
            }));
            continue;
        };
        let missing = |what: &str| {
            let text = format!("{what} does not exist");
            (format!("materials[{m}]"), CityError::Format(text))
        };
        let texture = textures
            .get(used.index)
            .ok_or_else(|| missing("its texture"))?;
        // Without a source the picture is of an extension's kind.
        let Some(source) = texture.source else {
            out.push(None);
            continue;
        };
        let image = images.get(source).ok_or_else(|| missing("its image"))?;
        let surface = match &surfaces[source] {
            Some(known) => known.clone(),
            None => {
                let read = self::image(image, source, buffers, path);
                let read = read.map_err(|e| (format!("images[{source}]"), e))?;
                surfaces[source].insert(Arc::new(read)).clone()
            }
        };
        out.push(Some(Looks {
            surface,
            coordinates: used.tex_coord,
            transform: used.extensions.transform,
            box_mapped: material.name == BOX_MAPPED,
        }));
    }
    Ok(out)
}

fn image(
    image: &Image,
    index: usize,
    buffers: &Buffers,
    path: &Path,
) -> Result<Surface, CityError> {
    let wrong = |e: &dyn std::fmt::Display| CityError::Format(e.to_string());
    let (name, file) = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => {
            let file = load(uri, path).map_err(|e| wrong(&e))?;
            let name = if uri.starts_with("data:") { "" } else { uri };
            (name, file)
        }
        (None, Some(view)) => {
            let bytes = buffers.view(view);
            (
                "",
                bytes
                    .ok_or_else(|| wrong(&"lies outside its buffer"))?
                    .to_vec(),
            )
        }
        (None, None) => return Err(wrong(&"has neither bytes nor a name")),
    };
    let name = match name {
        "" => format!("image_{index}"),
        name => name.to_owned(),
    };
    decoded(&name, file.into())
        .map(Surface::Texture)
        .map_err(|e| wrong(&e))
}
