//! Box mapping: the looks of what stands in an oriented box as one picture, its four sides and its top side by side.
//!
//! A template that is simplified, or put into other boxes, keeps its looks: texture coordinates follow from a corner's place
//! in the unit box and from the way its triangle looks, and need not be carried along when triangles are cut and merged.

use super::side_view::{SideView, TOP, VIEWS, view_size};
use super::{OrientedBox, Painted, Surface};

/// Share of a view that coordinates keep away from its edges: the next view begins behind them.
const EDGE: f64 = 0.002;

/// Five views of equal size, one beside the other.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxTexture {
    /// Columns of all views together.
    pub width: usize,
    /// Red, green, blue, row after row from the top.
    pub colours: Vec<[u8; 3]>,
}

impl BoxTexture {
    /// The views of `paint` from around the box, as fine as its textures and with at most `most` pixels along a side of
    /// a view; `None` if nothing with a texture is seen. Unpainted pixels get the view's mean colour, a view without
    /// any the mean of all.
    pub fn of(paint: &[Painted], frame: &OrientedBox, most: usize) -> Option<Self> {
        let (low, high) = (frame.base[2], frame.base[2] + frame.size[2]);
        let textured = |p: &&Painted| matches!(*p.surface, Surface::Texture(_));
        let own = paint.iter().filter(textured);
        let share = |p: &Painted| p.share_between(low, high);
        let area: f64 = own.clone().map(|p| p.area() * share(p)).sum();
        let texels: f64 = own.map(|p| p.texels() * share(p)).sum();
        if !(area > 0.0 && texels > 0.0) {
            return None;
        }
        let texel = (area / texels).sqrt();
        let longest = |k: usize| (0..VIEWS).map(move |v| view_size(frame, v)[k]);
        let count = |k: usize| {
            let length = longest(k).fold(0.0, f64::max);
            (length / texel).ceil().clamp(1.0, most.max(1) as f64) as usize
        };
        let (width, height) = (count(0), count(1));
        let views: Vec<SideView> = (0..VIEWS)
            .map(|view| SideView::whole(paint, frame, view, [width, height]))
            .collect();
        let all = mean(views.iter().flat_map(|v| &v.colours))?;
        let mut colours = vec![all; VIEWS * width * height];
        for (v, view) in views.iter().enumerate() {
            let own = mean(view.colours.iter()).unwrap_or(all);
            for (j, row) in view.colours.chunks(width).rev().enumerate() {
                let from = (j * VIEWS + v) * width;
                for (to, colour) in colours[from..from + width].iter_mut().zip(row) {
                    *to = colour.unwrap_or(own);
                }
            }
        }
        Some(Self {
            width: VIEWS * width,
            colours,
        })
    }
}

fn mean<'a>(colours: impl Iterator<Item = &'a Option<[u8; 3]>>) -> Option<[u8; 3]> {
    let mut sum = [0_usize; 3];
    let mut count = 0;
    for colour in colours.flatten() {
        count += 1;
        (0..3).for_each(|k| sum[k] += usize::from(colour[k]));
    }
    (count > 0).then(|| sum.map(|s| (s / count) as u8))
}

/// The view in which a triangle of the unit box is seen most.
pub fn box_view([a, b, c]: [[f64; 3]; 3]) -> usize {
    let edge = |q: [f64; 3]| [0, 1, 2].map(|k| q[k] - a[k]);
    let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
    let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    // What looks downwards is as dark as what lies above it.
    if z.abs() > x.abs().max(y.abs()) {
        return TOP;
    }
    match (x.abs() >= y.abs(), x >= 0.0, y >= 0.0) {
        (true, true, _) => 0,
        (false, _, true) => 1,
        (true, false, _) => 2,
        (false, _, false) => 3,
    }
}

/// Texture coordinates (u to the right, v upwards, 0 to 1) of a point of the unit box in a view.
pub fn box_coordinates([x, y, z]: [f64; 3], view: usize) -> [f64; 2] {
    let [u, v] = match view {
        0 => [y + 0.5, z],
        1 => [0.5 - x, z],
        2 => [0.5 - y, z],
        3 => [x + 0.5, z],
        _ => [x + 0.5, y + 0.5],
    };
    let [u, v] = [u, v].map(|t| EDGE + (1.0 - 2.0 * EDGE) * t.clamp(0.0, 1.0));
    [(view as f64 + u) / VIEWS as f64, v]
}
