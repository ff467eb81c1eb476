//! Marks to SVG and PNG, through plotters.
//!
//! plotters' backends have whole-pixel coordinates: the SVG is drawn on a canvas eight times as fine and its
//! header sets the logical size; the PNG is drawn at four times the size and halved, which smooths edges.

use std::sync::Once;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, register_font};

use super::colour::Colour;
use super::drawing::{Anchor, Drawing, Mark, Text};
use super::indexed;
use edifice_base::{Error, Result};

const SVG_SCALE: f64 = 8.0;
const PNG_SCALE: f64 = 2.0;
const PNG_SAMPLES: u32 = 2;
const FAMILY: &str = "sans-serif";

/// The message of plotters when it cannot draw.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw: {0}")]
struct CannotDraw(String);

/// Registers the shipped font, once.
fn fonts() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // The only failure is a font file that cannot be read; these are part of the program.
        let _ = register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular());
        let _ = register_font(FAMILY, FontStyle::Bold, dejavu::sans::bold());
    });
}

/// Width of a text of the regular face, in the unit of `size`.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    fonts();
    // Measured large, since plotters answers in whole pixels.
    let font = (FAMILY, 100.0).into_font();
    font.box_size(text)
        .map_or(0.6 * size * text.chars().count() as f64, |(width, _)| {
            f64::from(width) * size / 100.0
        })
}

/// The picture as SVG text.
///
/// # Errors
/// [`Error::Method`] when plotters cannot draw it.
pub(crate) fn svg(drawing: &Drawing) -> Result<String> {
    let (width, height) = pixels(drawing, SVG_SCALE);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        draw(&root, drawing, SVG_SCALE)?;
    }
    let fine = format!("<svg width=\"{width}\" height=\"{height}\"");
    let logical = format!(
        "<svg width=\"{}\" height=\"{}\"",
        drawing.width, drawing.height
    );
    // DejaVu first, so that the text is as wide as it was measured where that font is installed.
    Ok(text.replacen(&fine, &logical, 1).replace(
        "font-family=\"sans-serif\"",
        "font-family=\"DejaVu Sans, Verdana, sans-serif\"",
    ))
}

/// The picture as PNG bytes, two pixels to a logical one.
///
/// # Errors
/// [`Error::Method`] when plotters cannot draw it.
pub(crate) fn png(drawing: &Drawing) -> Result<Vec<u8>> {
    let (width, height) = pixels(drawing, PNG_SCALE);
    let fine = (width * PNG_SAMPLES, height * PNG_SAMPLES);
    let mut buffer = vec![0u8; fine.0 as usize * fine.1 as usize * 3];
    {
        let root = BitMapBackend::with_buffer(&mut buffer, fine).into_drawing_area();
        draw(&root, drawing, PNG_SCALE * f64::from(PNG_SAMPLES))?;
    }
    indexed::png(width, height, &halved(&buffer, width, height)).map_err(Error::method)
}

/// Means of two by two pixels.
fn halved(fine: &[u8], width: u32, height: u32) -> Vec<u8> {
    let (width, height) = (width as usize, height as usize);
    let stride = width * 2 * 3;
    let mut out = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        let (above, below) = (2 * y * stride, (2 * y + 1) * stride);
        for x in 0..width {
            for c in 0..3 {
                let i = 6 * x + c;
                let sum: u32 = [above + i, above + i + 3, below + i, below + i + 3]
                    .iter()
                    .map(|&i| u32::from(fine[i]))
                    .sum();
                out.push(((sum + 2) / 4) as u8);
            }
        }
    }
    out
}

fn pixels(drawing: &Drawing, scale: f64) -> (u32, u32) {
    let pixel = |length: f64| (length * scale).round().max(1.0) as u32;
    (pixel(drawing.width), pixel(drawing.height))
}

type Root<'a, B> = DrawingArea<B, plotters::coord::Shift>;

fn draw<B: DrawingBackend>(root: &Root<B>, drawing: &Drawing, scale: f64) -> Result<()> {
    fonts();
    let fail = |e: DrawingAreaErrorKind<B::ErrorType>| Error::method(CannotDraw(e.to_string()));
    root.fill(&WHITE).map_err(fail)?;
    let at = |p: (f64, f64)| ((p.0 * scale).round() as i32, (p.1 * scale).round() as i32);
    for mark in &drawing.marks {
        match mark {
            Mark::Path {
                points,
                width,
                colour,
            } => {
                let style = ShapeStyle {
                    color: rgba(*colour),
                    filled: false,
                    stroke_width: (width * scale).round().max(1.0) as u32,
                };
                let points: Vec<_> = points.iter().copied().map(at).collect();
                root.draw(&PathElement::new(points, style)).map_err(fail)?;
            }
            Mark::Fill { points, colour } => {
                let points: Vec<_> = points.iter().copied().map(at).collect();
                match rectangle(&points) {
                    Some(corners) => root.draw(&Rectangle::new(corners, rgba(*colour).filled())),
                    None => root.draw(&Polygon::new(points, rgba(*colour).filled())),
                }
                .map_err(fail)?;
            }
            Mark::Disc {
                at: centre,
                radius,
                colour,
            } => {
                let radius = (radius * scale).round() as i32;
                root.draw(&Circle::new(at(*centre), radius, rgba(*colour).filled()))
                    .map_err(fail)?;
            }
            Mark::Text(text) => {
                root.draw_text(&text.text, &style(text, scale), at(text.at))
                    .map_err(fail)?;
            }
        }
    }
    root.present().map_err(fail)
}

/// The corners of an axis-parallel rectangle.
fn rectangle(points: &[(i32, i32)]) -> Option<[(i32, i32); 2]> {
    let [a, b, c, d] = points else { return None };
    let upright = a.1 == b.1 && b.0 == c.0 && c.1 == d.1 && d.0 == a.0;
    upright.then_some([*a, *c])
}

fn rgba(colour: Colour) -> RGBAColor {
    RGBAColor(colour.r, colour.g, colour.b, colour.opacity)
}

fn style<'a>(text: &Text, scale: f64) -> TextStyle<'a> {
    let face = if text.bold {
        FontStyle::Bold
    } else {
        FontStyle::Normal
    };
    let font = FontDesc::new(FontFamily::Name(FAMILY), text.size * scale, face);
    let font = match text.vertical {
        true => font.transform(FontTransform::Rotate270),
        false => font,
    };
    let across = match text.anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    TextStyle {
        font,
        color: rgba(text.colour).to_backend_color(),
        pos: Pos::new(across, VPos::Center),
    }
}
