//! Pictures of scenes as PNG.

use edifice_scene::Scene;
use edifice_scene::render::{Camera, Picture, render};
use edifice_scene::textures::Pixels;

/// Draws a scene as an RGB PNG of `width` x `height` pixels.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn scene_png(
    scene: &Scene,
    camera: &Camera,
    width: usize,
    height: usize,
) -> Result<Vec<u8>, png::EncodingError> {
    picture_png(&render(scene, camera, width, height))
}

/// A picture as an RGB PNG.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn picture_png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let size = [picture.width as u32, picture.height as u32];
    encoded(
        size,
        png::ColorType::Rgb,
        png::Compression::Balanced,
        &picture.rgb,
    )
}

/// A picture of a texture as a PNG, grey or RGB as it is, in few bytes.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn texture_png(pixels: &Pixels) -> Result<Vec<u8>, png::EncodingError> {
    let kind = match pixels.channels {
        1 => png::ColorType::Grayscale,
        _ => png::ColorType::Rgb,
    };
    let size = [pixels.side as u32; 2];
    encoded(size, kind, png::Compression::High, &pixels.bytes)
}

fn encoded(
    [width, height]: [u32; 2],
    kind: png::ColorType,
    compression: png::Compression,
    pixels: &[u8],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(kind);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_compression(compression);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
