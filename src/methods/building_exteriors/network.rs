//! The learned network as a picture (Fig. 4d with the lateral edges of Fig. 11 left), in SVG.

use std::fmt::Write;

use crate::model::hierarchy::Hierarchy;

const WIDTH: f64 = 110.0;
const LEFT: f64 = 60.0;

/// Draws the style, the hidden variables with their cardinalities, the attributes and the lateral
/// edges. `discrete` names the groups of categorical columns.
pub fn svg(model: &Hierarchy, discrete: &[String]) -> String {
    let real = model.real_groups();
    let count = real.len() + discrete.len();
    let place = |i: usize| LEFT + WIDTH * i as f64;
    let width = 2.0 * LEFT + WIDTH * count.saturating_sub(1) as f64;
    let middle = width / 2.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} 400\" width=\"{width}\" height=\"400\" \
         font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n<rect width=\"{width}\" height=\"400\" fill=\"#ffffff\"/>\n\
         <defs><marker id=\"a\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\">\
         <path d=\"M0 0 L8 4 L0 8 z\" fill=\"#c0392b\"/></marker></defs>\n"
    );
    let two_levels = real
        .first()
        .is_some_and(|g| model.state_probabilities(g).is_ok());
    // Writing to a String cannot fail.
    for i in 0..count {
        let x = place(i);
        let (top, bottom) = if i < real.len() && two_levels {
            (135.0, 255.0)
        } else if i < real.len() {
            (255.0, 255.0)
        } else {
            (135.0, 135.0)
        };
        let _ = writeln!(out, "{}", line(middle, 60.0, x, top, "#8395a7"));
        if bottom > top {
            let _ = writeln!(out, "{}", line(x, 165.0, x, bottom, "#8395a7"));
        }
    }
    let styles = format!("S: {} styles", model.styles());
    out.push_str(&node(middle, 42.0, &styles, "#dfe6e9"));
    for (i, (group, states)) in real.iter().zip(model.cardinalities()).enumerate() {
        if two_levels {
            out.push_str(&node(
                place(i),
                150.0,
                &format!("{states} kinds"),
                "#dfe6e9",
            ));
        }
        out.push_str(&node(place(i), 272.0, group, "#d6eaf8"));
    }
    for (i, group) in discrete.iter().enumerate() {
        out.push_str(&node(place(real.len() + i), 150.0, group, "#d5f5e3"));
    }
    let find = |name: &String| real.iter().position(|g| g == name);
    for (parent, child) in model.lateral_edges() {
        if let (Some(a), Some(b)) = (find(&parent), find(&child)) {
            let (xa, xb) = (place(a), place(b));
            let sag = 289.0 + (xa - xb).abs().sqrt() * 4.5;
            let _ = writeln!(
                out,
                "<path d=\"M{xa} 289 C{xa} {sag} {xb} {sag} {xb} 291\" fill=\"none\" stroke=\"#c0392b\" \
                 stroke-width=\"1.5\" marker-end=\"url(#a)\"/>"
            );
        }
    }
    out.push_str("</svg>\n");
    out
}

fn line(x1: f64, y1: f64, x2: f64, y2: f64, colour: &str) -> String {
    format!("<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{colour}\"/>")
}

fn node(x: f64, y: f64, text: &str, fill: &str) -> String {
    let text = text
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"96\" height=\"34\" rx=\"8\" fill=\"{fill}\" stroke=\"#2d3436\"/>\n\
         <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{text}</text>\n",
        x - 48.0,
        y - 17.0,
        y + 4.0
    )
}
