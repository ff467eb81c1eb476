//! Elevations and plan of a scene as SVG: what is seen from the front, the back, the left, the right and above.
//!
//! Triangles are painted from the farthest to the nearest, lit by how they face the eye; right for surfaces that do not
//! cut each other, such as closed ones.

use std::fmt::Write;

use edifice_scene::Scene;
use edifice_shape::vec3::{cross, dot};

/// Pixels per metre, and room around each view (m).
const SCALE: f64 = 24.0;
const MARGIN: f64 = 1.2;

/// A view: its name, what is to the right and upwards in it, and what is towards the eye (y up).
const VIEWS: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("front", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ("right", [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
    ("back", [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ("left", [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
    ("plan", [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
];

/// The drawing.
pub fn elevations(scene: &Scene) -> String {
    let triangles = triangles(scene);
    let (mut views, mut x, mut tallest) = (String::new(), 0.0, 0.0_f64);
    for (name, right, up) in VIEWS {
        let (text, width, height) = view(&triangles, name, right, up, x);
        views.push_str(&text);
        x += width;
        tallest = tallest.max(height);
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" height=\"{:.0}\" viewBox=\"0 {:.2} {:.2} {:.2}\">\n\
         <rect x=\"0\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"#fff\"/>\n{views}</svg>\n",
        x * SCALE,
        tallest * SCALE,
        -tallest,
        x,
        tallest,
        -tallest,
        x,
        tallest
    )
}

type Triangle = ([[f64; 3]; 3], [u8; 3]);

fn triangles(scene: &Scene) -> Vec<Triangle> {
    let mut out = Vec::new();
    for group in &scene.groups {
        for instance in &group.instances {
            let mesh = &scene.meshes[instance.mesh];
            for (material, indices) in &mesh.parts {
                let colour = scene.materials[*material].color;
                for t in indices.chunks_exact(3) {
                    let corner = |i: usize| {
                        let p = mesh.positions[t[i] as usize];
                        group.place(instance.place(p)).map(f64::from)
                    };
                    out.push(([corner(0), corner(1), corner(2)], colour));
                }
            }
        }
    }
    out
}

/// The triangles that face the eye, farthest first, with the width and height that they take.
fn view(
    triangles: &[Triangle],
    name: &str,
    right: [f64; 3],
    up: [f64; 3],
    left: f64,
) -> (String, f64, f64) {
    let toward = cross(right, up);
    let mut seen: Vec<(f64, [[f64; 2]; 3], [u8; 3])> = Vec::new();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (t, colour) in triangles {
        let edge = |i: usize| [0, 1, 2].map(|a| t[i][a] - t[0][a]);
        let normal = cross(edge(1), edge(2));
        let length = dot(normal, normal).sqrt();
        let facing = dot(normal, toward) / length.max(1e-300);
        let flat = t.map(|p| [dot(p, right), dot(p, up)]);
        for p in flat {
            low = [0, 1].map(|a| low[a].min(p[a]));
            high = [0, 1].map(|a| high[a].max(p[a]));
        }
        if facing > 1e-3 {
            let depth = t.iter().map(|p| dot(*p, toward)).sum::<f64>() / 3.0;
            let light = 0.72 + 0.28 * facing;
            seen.push((depth, flat, colour.map(|c| (f64::from(c) * light) as u8)));
        }
    }
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    if seen.is_empty() {
        return (String::new(), 2.0 * MARGIN, 2.0 * MARGIN);
    }
    let mut text = format!("<g id=\"{name}\" stroke-width=\"0.01\">\n");
    for (_, flat, [r, g, b]) in seen {
        let colour = format!("#{r:02x}{g:02x}{b:02x}");
        let _ = write!(text, "<path fill=\"{colour}\" stroke=\"{colour}\" d=\"");
        for (k, p) in flat.iter().enumerate() {
            let command = if k == 0 { 'M' } else { 'L' };
            let (x, y) = (left + MARGIN + p[0] - low[0], -(MARGIN + p[1] - low[1]));
            let _ = write!(text, "{command}{x:.3} {y:.3}");
        }
        text.push_str("Z\"/>\n");
    }
    text.push_str("</g>\n");
    let size = [0, 1].map(|a| high[a] - low[a] + 2.0 * MARGIN);
    (text, size[0], size[1])
}
