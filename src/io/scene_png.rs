//! Pictures of scenes as PNG.

use crate::scene::Scene;
use crate::scene::render::{Camera, render};

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
    let picture = render(scene, camera, width, height);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb)?;
    writer.finish()?;
    Ok(bytes)
}
