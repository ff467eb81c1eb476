//! The baseline: the same window everywhere at the same distance.

use edifice_shape::DetailedBuilding;
use rayon::prelude::*;

use super::choice::{Element, ElementKind};
use super::draw::Site;
use super::exposure::Roofs;
use super::{cut, walls};
use crate::survey::{Candidate, Known};

/// A plain grid of windows, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Width and height of a window.
    pub window: [f64; 2],
    /// Height of the sill over the floor.
    pub sill: f64,
    /// Distance of the middles of two neighbours.
    pub spacing: f64,
    /// Height of a storey where the city does not tell their number.
    pub storey: f64,
}

impl Default for Grid {
    /// Windows of 1.2 m x 1.4 m over a sill of 0.9 m, 3 m apart, in storeys of 2.9 m.
    fn default() -> Self {
        Self {
            window: [1.2, 1.4],
            sill: 0.9,
            spacing: 3.0,
            storey: 2.9,
        }
    }
}

/// Dresses buildings with a grid of windows on all walls that have room, without doors: what [`super::dress`] is
/// compared with.
pub fn plain_grid(city: &[Candidate], grid: &Grid) -> Vec<DetailedBuilding> {
    let roofs = Roofs::new(city.iter().map(|b| b.mesh));
    let one = |(number, own): (usize, &Candidate)| {
        let mut faces = walls::faces(own.mesh, |p| roofs.covers(number, p));
        roofs.note(number, &mut faces.walls);
        let site = Site::new(&faces, Known::new(own.attributes).storeys);
        let (storeys, storey) = site.storeys(grid.storey);
        let mut found = Vec::new();
        let [width, height] = grid.window;
        for (wall, [start, end]) in site.runs() {
            let bays = ((end - start) / grid.spacing).floor().max(1.0);
            for (k, floor) in (0..bays as usize).flat_map(|k| (0..storeys).map(move |f| (k, f))) {
                let middle = start + (k as f64 + 0.5) * (end - start) / bays;
                let foot = faces.ground + floor as f64 * storey + grid.sill;
                let rect = [
                    [middle - width / 2.0, middle + width / 2.0],
                    [foot, foot + height],
                ];
                if site.has_room(wall, rect) {
                    let element = Element {
                        kind: ElementKind::Window,
                        wall,
                        storey: floor,
                        rect,
                    };
                    found.push((element, None));
                }
            }
        }
        cut::dressed(own, &faces, &found)
    };
    city.par_iter().enumerate().map(one).collect()
}
