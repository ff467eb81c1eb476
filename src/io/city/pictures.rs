//! Pictures of surfaces: textures of files, and the box mapping of templates.

use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageFormat};
use rustc_hash::FxHashMap;

use super::CityError;
use edifice_grammar::instance::InstanceGrammar;
use edifice_io::pixels::{self, PixelError};
use edifice_shape::triangles::{
    BoxTexture, City, CityBuilding, Painted, Surface, Texture, box_coordinates, box_view,
};

/// Quality of JPEG, of 100.
const QUALITY: u8 = 80;

/// A texture from the bytes of a PNG, JPEG or WebP.
///
/// # Errors
/// [`PixelError`].
pub(super) fn decoded(name: &str, file: Arc<[u8]>) -> Result<Texture, PixelError> {
    let (width, colours) = pixels::colours(&file)?;
    Ok(Texture {
        name: name.to_owned(),
        width,
        colours,
        file,
    })
}

/// The media type of a picture file: JPEG, WebP, or else PNG.
pub(super) fn media_type(file: &[u8]) -> &'static str {
    match file {
        [0xff, 0xd8, ..] => "image/jpeg",
        [b'R', b'I', b'F', b'F', ..] => "image/webp",
        _ => "image/png",
    }
}

/// A picture file as a data URI (RFC 2397).
pub(super) fn data_uri(file: &[u8]) -> String {
    format!("data:{};base64,{}", media_type(file), STANDARD.encode(file))
}

/// The picture file in a data URI, if it is one that can be decoded.
///
/// # Errors
/// Says what is wrong.
pub(super) fn from_data_uri(uri: &str) -> Result<Arc<[u8]>, CityError> {
    let wrong = |text: String| CityError::Format(format!("texture: {text}"));
    let coded = uri.strip_prefix("data:image/").and_then(|rest| {
        let (_, coded) = rest.split_once(";base64,")?;
        Some(coded)
    });
    let coded = coded.ok_or_else(|| wrong("expected data:image/...;base64,...".to_owned()))?;
    let file = STANDARD.decode(coded).map_err(|e| wrong(e.to_string()))?;
    pixels::colours(&file).map_err(|e| wrong(e.to_string()))?;
    Ok(file.into())
}

/// The ending of a picture file's name.
pub(super) fn ending(file: &[u8]) -> &'static str {
    match media_type(file) {
        "image/jpeg" => "jpg",
        "image/webp" => "webp",
        _ => "png",
    }
}

/// Gives the templates of a grammar their pictures, as JPEG or PNG, whichever is smaller; those that have one keep it.
///
/// # Errors
/// Those of the encoder, which writes to memory.
pub fn add_textures(
    grammar: &mut InstanceGrammar,
    textures: &[Option<BoxTexture>],
) -> Result<(), ImageError> {
    for (template, texture) in grammar.templates.iter_mut().zip(textures) {
        if let (None, Some(texture)) = (&template.texture, texture) {
            let files = [
                encoded(texture, ImageFormat::Jpeg)?,
                encoded(texture, ImageFormat::Png)?,
            ];
            template.texture = files.into_iter().min_by_key(Vec::len).map(Arc::from);
        }
    }
    Ok(())
}

fn encoded(texture: &BoxTexture, format: ImageFormat) -> Result<Vec<u8>, ImageError> {
    let (width, height) = (
        texture.width as u32,
        texture.colours.len() / texture.width.max(1),
    );
    let (mut bytes, colours) = (Vec::new(), texture.colours.as_flattened());
    let (height, kind) = (height as u32, ExtendedColorType::Rgb8);
    match format {
        ImageFormat::Jpeg => JpegEncoder::new_with_quality(&mut bytes, QUALITY)
            .encode(colours, width, height, kind)?,
        _ => PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
            .write_image(colours, width, height, kind)?,
    }
    Ok(bytes)
}

/// Paints what a city's buildings are put together from with the textures of its parts. Buildings that are painted stay so.
///
/// # Errors
/// [`PixelError`] for a part's texture that is no picture.
pub fn paint_parts(city: &mut City) -> Result<(), PixelError> {
    let mut known: FxHashMap<usize, Arc<Surface>> = FxHashMap::default();
    for building in &mut city.buildings {
        if !building.paint.is_empty() {
            continue;
        }
        let mut paint = Vec::new();
        for part in &building.parts {
            let Some(file) = &part.texture else { continue };
            let surface = match known.get(&part.template) {
                Some(surface) => surface.clone(),
                None => {
                    let name = format!("T{}.{}", part.template + 1, ending(file));
                    let texture = decoded(&name, file.clone())?;
                    let surface = Arc::new(Surface::Texture(texture));
                    known.insert(part.template, surface.clone());
                    surface
                }
            };
            let CityBuilding { mesh, .. } = &*building;
            paint.extend(mesh.triangles[part.triangles.clone()].iter().map(|t| {
                let corners = t.map(|i| mesh.positions[i as usize]);
                let unit = corners.map(|p| part.frame.to_unit(p));
                let view = box_view(unit);
                Painted {
                    corners,
                    uv: unit.map(|p| box_coordinates(p, view)),
                    surface: surface.clone(),
                }
            }));
        }
        building.paint = paint;
    }
    Ok(())
}
