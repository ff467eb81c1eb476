//! The learned network as a picture (Fig. 4d with the lateral edges of Fig. 11 left), in SVG.

use std::fmt::Write;

use edifice_model::hierarchy::Hierarchy;

/// Width of the drawing on a page: the narrower side of A4 landscape's print area, 280 mm, at 96 dpi.
const PAGE: f64 = 1058.0;
/// Width of a node, unless a name is longer.
const NODE: f64 = 76.0;
/// Space between two nodes.
const SPACE: f64 = 6.0;
/// Width of a letter.
const LETTER: f64 = 7.0;
/// Bottom of the nodes that lateral edges leave.
const FLOOR: f64 = 289.0;

/// Draws the style, the hidden variables with their cardinalities, the attributes and the lateral
/// edges, at most as wide as a page: where there are more groups than fit, everything is smaller.
/// `discrete` names the groups of categorical columns.
pub fn svg(model: &Hierarchy, discrete: &[String]) -> String {
    let real = model.real_groups();
    let find = |name: &String| real.iter().position(|g| g == name);
    let edges = model.lateral_edges();
    let edges = edges.iter().filter_map(|(a, b)| Some((find(a)?, find(b)?)));
    let picture = Picture {
        styles: model.styles(),
        kinds: model.cardinalities(),
        real,
        discrete,
        two_levels: real
            .first()
            .is_some_and(|g| model.state_probabilities(g).is_ok()),
        edges: edges.collect(),
    };
    picture.svg()
}

/// The nodes and edges of the drawing.
struct Picture<'m> {
    styles: usize,
    /// Groups of attributes below hidden variables, and the cardinality of each.
    real: &'m [String],
    kinds: Vec<usize>,
    /// Groups of attributes below the style.
    discrete: &'m [String],
    two_levels: bool,
    /// Lateral edges, by places in `real`.
    edges: Vec<(usize, usize)>,
}

impl Picture<'_> {
    fn svg(&self) -> String {
        let names = || self.real.iter().chain(self.discrete);
        let longest = names().map(|n| n.chars().count()).max().unwrap_or(0);
        let node_width = NODE.max(LETTER * longest as f64 + 8.0);
        let pitch = node_width + SPACE;
        let place = |i: usize| pitch * (i as f64 + 0.5) + SPACE;
        let count = names().count().max(1);
        let width = (pitch * count as f64).max(120.0) + 2.0 * SPACE;
        let curves: Vec<(f64, f64, f64)> = self
            .edges
            .iter()
            .map(|&(a, b)| (place(a), place(b)))
            .map(|(a, b)| {
                (
                    a,
                    b,
                    FLOOR + 4.0 * (10.0 + (a - b).abs().sqrt() * 4.0) / 3.0,
                )
            })
            .collect();
        // A curve comes as low as three quarters of the way to its control points.
        let lowest = curves
            .iter()
            .map(|&(_, _, sag)| FLOOR + 0.75 * (sag - FLOOR));
        let height = (lowest.fold(FLOOR, f64::max) + 14.0).ceil();
        let scale = (PAGE / width).min(1.0);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{:.0}\" height=\"{:.0}\" \
             font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
             <defs><marker id=\"a\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\">\
             <path d=\"M0 0 L8 4 L0 8 z\" fill=\"#c0392b\"/></marker></defs>\n",
            width * scale,
            height * scale
        );
        let middle = width / 2.0;
        // Writing to a String cannot fail.
        for i in 0..names().count() {
            let x = place(i);
            let (top, bottom) = if i < self.real.len() && self.two_levels {
                (135.0, 255.0)
            } else if i < self.real.len() {
                (255.0, 255.0)
            } else {
                (135.0, 135.0)
            };
            let _ = writeln!(out, "{}", line(middle, 60.0, x, top, "#8395a7"));
            if bottom > top {
                let _ = writeln!(out, "{}", line(x, 165.0, x, bottom, "#8395a7"));
            }
        }
        let mut node = |x, y, text: &str, fill| {
            let width = node_width.max(LETTER * text.chars().count() as f64 + 8.0);
            out.push_str(&boxed((x, y), width, text, fill));
        };
        node(
            middle,
            42.0,
            &format!("S: {} styles", self.styles),
            "#dfe6e9",
        );
        for (i, (group, kinds)) in self.real.iter().zip(&self.kinds).enumerate() {
            if self.two_levels {
                node(place(i), 150.0, &format!("{kinds} kinds"), "#dfe6e9");
            }
            node(place(i), 272.0, group, "#d6eaf8");
        }
        for (i, group) in self.discrete.iter().enumerate() {
            node(place(self.real.len() + i), 150.0, group, "#d5f5e3");
        }
        for (a, b, sag) in curves {
            let _ = writeln!(
                out,
                "<path d=\"M{a} {FLOOR} C{a} {sag} {b} {sag} {b} {}\" fill=\"none\" stroke=\"#c0392b\" \
                 stroke-width=\"1.5\" marker-end=\"url(#a)\"/>",
                FLOOR + 2.0
            );
        }
        out.push_str("</svg>\n");
        out
    }
}

fn line(x1: f64, y1: f64, x2: f64, y2: f64, colour: &str) -> String {
    format!("<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{colour}\"/>")
}

/// A node of the given width around a point.
fn boxed((x, y): (f64, f64), width: f64, text: &str, fill: &str) -> String {
    let text = text
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{width}\" height=\"34\" rx=\"8\" fill=\"{fill}\" stroke=\"#2d3436\"/>\n\
         <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{text}</text>\n",
        x - width / 2.0,
        y - 17.0,
        y + 4.0
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of every attribute `name` in the text.
    fn numbers(svg: &str, name: &str) -> Vec<f64> {
        let key = format!(" {name}=\"");
        let values = svg.split(&key).skip(1);
        let number = |rest: &str| rest.split('"').next().and_then(|v| v.parse().ok());
        values.filter_map(number).collect()
    }

    #[test]
    fn everything_is_drawn_inside_a_page() {
        for (real, discrete, long) in [
            (0, 0, ""),
            (1, 0, ""),
            (10, 3, ""),
            (30, 20, ""),
            (10, 3, "a very long name "),
        ] {
            let names = |count: usize| -> Vec<String> {
                (0..count).map(|i| format!("{long}group{i}")).collect()
            };
            let (real, discrete) = (names(real), names(discrete));
            let pairs = (0..real.len()).flat_map(|a| (0..real.len()).map(move |b| (a, b)));
            let picture = Picture {
                styles: 7,
                kinds: vec![3; real.len()],
                real: &real,
                discrete: &discrete,
                two_levels: true,
                edges: pairs.filter(|(a, b)| a != b).collect(),
            };
            let svg = picture.svg();
            let view = svg.split("viewBox=\"0 0 ").nth(1).unwrap();
            let view: Vec<f64> = view
                .split('"')
                .next()
                .unwrap()
                .split(' ')
                .map(|v| v.parse().unwrap())
                .collect();
            let (width, height) = (numbers(&svg, "width")[0], numbers(&svg, "height")[0]);
            assert!(width <= PAGE && height <= 760.0, "{width} x {height}");
            assert!((width / height / (view[0] / view[1]) - 1.0).abs() < 0.02);
            let xs = ["x", "x1", "x2"].map(|n| numbers(&svg, n)).concat();
            assert!(xs.iter().all(|x| (0.0..=view[0]).contains(x)), "{xs:?}");
            let rights = numbers(&svg, "x").len();
            assert!(rights > 0);
            // As far from the left side as from the right, but for the least width.
            let rects = svg.split("<rect x=\"").skip(1).map(|rect| {
                let x: f64 = rect.split('"').next().unwrap().parse().unwrap();
                (x, x + numbers(rect, "width")[0])
            });
            let ends = rects.fold((f64::INFINITY, 0.0_f64), |e, r| {
                (e.0.min(r.0), e.1.max(r.1))
            });
            if real.len() > 1 {
                assert!(
                    (ends.0 - (view[0] - ends.1)).abs() < 1.0,
                    "{ends:?} of {view:?}"
                );
            }
            for rect in svg.split("<rect x=\"").skip(1) {
                let x: f64 = rect.split('"').next().unwrap().parse().unwrap();
                let right = x + numbers(rect, "width")[0];
                assert!(
                    real.is_empty() || (x >= 0.0 && right <= view[0]),
                    "{x} {right}"
                );
            }
            // The lowest point of a curve is at its middle.
            for curve in svg.split("<path d=\"M").skip(2) {
                let curve = curve.split('"').next().unwrap().replace(['C', 'M'], "");
                let at: Vec<f64> = curve
                    .split_whitespace()
                    .map(|v| v.parse().unwrap())
                    .collect();
                let low = (at[1] + 3.0 * at[3] + 3.0 * at[5] + at[7]) / 8.0;
                assert!(low + 1.0 < view[1], "{low} of {}", view[1]);
            }
        }
    }
}
