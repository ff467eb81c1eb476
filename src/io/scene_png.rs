//! Pictures of scenes as PNG.

use edifice_scene::Scene;
use edifice_scene::render::{Camera, Picture, render};

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
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb)?;
    writer.finish()?;
    Ok(bytes)
}
