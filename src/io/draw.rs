//! Drawings of layouts: label images as PNG, and SVG with a rectangle for each region.

use std::fmt::Write;

use super::palette::Palette;
use super::raster::{BACKGROUND, Raster};
use edifice_shape::Facade;

fn labels(facade: &Facade) -> impl Iterator<Item = &str> {
    facade.regions.iter().map(|r| r.label.as_str())
}

fn palette(facade: &Facade) -> Palette {
    Palette::new(labels(facade).chain([BACKGROUND]))
}

/// Labels that a [`png()`] of the layout shows in one colour: read back, they are one label.
pub fn shared_colours(facade: &Facade) -> Vec<Vec<String>> {
    let owned = |labels: Vec<&str>| labels.into_iter().map(str::to_owned).collect();
    let palette = Palette::new(labels(facade));
    palette.shared().into_iter().map(owned).collect()
}

/// A label image: an RGB PNG in the colours of [`Palette`], sampled as [`Raster`] says.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn png(facade: &Facade) -> Result<Vec<u8>, png::EncodingError> {
    let raster = Raster::new(facade);
    let palette = palette(facade);
    let colors: Vec<[u8; 3]> = raster.labels.iter().map(|l| palette.color(l)).collect();
    let pixels = raster
        .pixels
        .iter()
        .flat_map(|&label| colors[label as usize]);
    let data: Vec<u8> = pixels.collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, raster.width as u32, raster.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&data)?;
    writer.finish()?;
    Ok(bytes)
}

/// An SVG drawing with one outlined rectangle a region, its label as a tooltip.
pub fn svg(facade: &Facade) -> String {
    let palette = palette(facade);
    let hex = |label: &str| {
        let [r, g, b] = palette.color(label);
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    let (width, height) = (facade.width, facade.height);
    let scale = 800.0 / width.max(height);
    let line = width.max(height) / 1000.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" height=\"{:.0}\" viewBox=\"0 0 {width} {height}\">\n\
         <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n\
         <g stroke=\"#000000\" stroke-width=\"{line}\">\n",
        width * scale,
        height * scale,
        escaped(&facade.name),
        hex(BACKGROUND)
    );
    for region in &facade.regions {
        let r = region.rect;
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"><title>{}</title></rect>",
            r.x,
            height - r.top(),
            r.width,
            r.height,
            hex(&region.label),
            escaped(&region.label)
        );
    }
    out.push_str("</g>\n</svg>\n");
    out
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Not allowed in XML at all.
            c if c.is_control() && !matches!(c, '\n' | '\t' | '\r') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
