//! Layouts as rows of pixels: what label images and text matrices are written from.

use edifice_shape::{Facade, Rect};

/// Label of what no region covers: elements lie on a wall.
pub const BACKGROUND: &str = "wall";

/// Longest side that is drawn with one pixel a unit.
const MAX_SIDE: f64 = 8192.0;

/// Longer side, in pixels, of layouts that do not lie on whole numbers.
const SCALED_SIDE: f64 = 1024.0;

/// A layout sampled at pixel centres, rows from the top.
pub struct Raster {
    /// Pixels along x.
    pub width: usize,
    /// Pixels along y.
    pub height: usize,
    /// Label names, sorted.
    pub labels: Vec<String>,
    /// Index into `labels` of each pixel.
    pub pixels: Vec<u32>,
}

impl Raster {
    /// Paints a layout, later regions over earlier ones, over [`BACKGROUND`].
    ///
    /// A layout on whole numbers, up to 8192 units, gets one pixel a unit, so that reading the
    /// result gives it back; others are scaled to 1024 pixels along their longer side.
    pub fn new(facade: &Facade) -> Self {
        let scale = if is_whole(facade) {
            1.0
        } else {
            SCALED_SIDE / facade.width.max(facade.height)
        };
        let side = |length: f64| ((length * scale).round() as usize).max(1);
        let (width, height) = (side(facade.width), side(facade.height));
        let names = facade.regions.iter().map(|r| r.label.as_str());
        let mut labels: Vec<String> = names.chain([BACKGROUND]).map(str::to_string).collect();
        labels.sort_unstable();
        labels.dedup();
        let number = |name: &str| labels.partition_point(|l| l.as_str() < name) as u32;
        let mut pixels = vec![number(BACKGROUND); width * height];
        // The first pixel whose centre is not below an edge.
        let pixel =
            |edge: f64, count: usize| ((edge * scale - 0.5).ceil().max(0.0) as usize).min(count);
        for region in &facade.regions {
            let Rect { x, y, .. } = region.rect;
            let (left, right) = (pixel(x, width), pixel(region.rect.right(), width));
            let (bottom, top) = (pixel(y, height), pixel(region.rect.top(), height));
            let label = number(&region.label);
            for row in height - top..height - bottom {
                pixels[row * width + left..row * width + right].fill(label);
            }
        }
        Self {
            width,
            height,
            labels,
            pixels,
        }
    }

    /// The rows from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.pixels.chunks_exact(self.width)
    }
}

fn is_whole(facade: &Facade) -> bool {
    let whole = |v: f64| (v - v.round()).abs() < 1e-6;
    let edges = |r: Rect| [r.x, r.y, r.right(), r.top()];
    facade.width.max(facade.height) <= MAX_SIDE
        && whole(facade.width)
        && whole(facade.height)
        && facade
            .regions
            .iter()
            .all(|r| edges(r.rect).into_iter().all(whole))
}
