//! The six window features of a component (Sec. IV.C): its four sides are drawn, windows are told from the wall by Otsu's
//! threshold, opening and closing.

use edifice_shape::triangles::{OrientedBox, Painted, SideView, grey, view_size};
use edifice_shape::{LabelGrid, Span, components};

/// Pixels along the longer side of a picture at most.
const MOST_PIXELS: usize = 256;
/// Least side of a pixel, in metres.
const PIXEL: f64 = 0.1;
/// Share of a side that has to be painted.
const COVERED: f64 = 0.25;
/// Types of windows of a side: clusters of areas.
const TYPES: usize = 3;
/// Rounds of k-means at most.
const ROUNDS: usize = 50;
/// Windows whose area is so many standard deviations, and at least this share, off the mean of their type are outliers.
const OUTLIER: f64 = 2.0;
const OUTLIER_SHARE: f64 = 0.25;
/// Cells along a side of a facade's greys.
pub(super) const CELLS: usize = 4;
/// Fewer pixels are no window.
const LEAST_AREA: usize = 4;

/// Window width and height, spacing in x and y (metres), emptiness (share of background pixels to window pixels in the
/// windows' boxes), intensity of the background (0 to 1).
pub type WindowFeatures = [f64; 6];

/// The features of a component in a box, the mean over its painted sides; `None` where no side is painted.
pub fn window_features(paint: &[Painted], frame: &OrientedBox) -> Option<WindowFeatures> {
    let sides = (0..4).filter_map(|side| Picture::of(paint, frame, side));
    let found: Vec<WindowFeatures> = sides.filter_map(|p| p.features()).collect();
    let n = found.len() as f64;
    let mean = |k: usize| found.iter().map(|f| f[k]).sum::<f64>() / n;
    (!found.is_empty()).then(|| std::array::from_fn(mean))
}

/// The measures of one side of a box, read from its picture.
pub(super) struct Side {
    /// Width and height of the side, in metres or pixels.
    pub size: [f64; 2],
    /// Its window features.
    pub windows: WindowFeatures,
    /// Mean greys of 4 x 4 cells, from below, less that of all; 0 to 1.
    pub cells: [f64; CELLS * CELLS],
}

/// A side of a box in metres; `None` where it is not painted, or of one grey.
pub(super) fn side_features(paint: &[Painted], frame: &OrientedBox, side: usize) -> Option<Side> {
    let picture = Picture::of(paint, frame, side)?;
    picture.side(view_size(frame, side))
}

/// As [`side_features`], in pixels, of a picture of a side from edge to edge: colours, row after row from the top.
pub(super) fn picture_features(width: usize, colours: &[[u8; 3]]) -> Option<Side> {
    let height = colours.len() / width.max(1);
    // As many pixels as a side is drawn in: opening and closing are of pixels.
    let pixel = (width.max(height) as f64 / MOST_PIXELS as f64).max(1.0);
    let count = |n: usize| ((n as f64 / pixel).ceil() as usize).max(1);
    let (columns, rows) = (count(width), count(height));
    let mean = |c: usize| {
        let span = |i: usize, n: usize| {
            let edge = |i: usize| (i as f64 * pixel) as usize;
            edge(i)..edge(i + 1).max(edge(i) + 1).min(n)
        };
        let (across, up) = (span(c % columns, width), span(c / columns, height));
        let own = up.flat_map(|j| {
            across
                .clone()
                .map(move |i| grey(colours[(height - 1 - j) * width + i]))
        });
        let (sum, n) = own.fold((0_u32, 0), |(sum, n), g| (sum + u32::from(g), n + 1));
        (n > 0).then(|| (sum / n) as u8)
    };
    let picture = Picture {
        width: columns,
        height: rows,
        pixel,
        greys: (0..columns * rows).map(mean).collect(),
    };
    picture.side([width as f64, height as f64])
}

/// A side of a component in greys.
struct Picture {
    width: usize,
    height: usize,
    /// Side of a pixel of `greys`, in metres, or in pixels of the picture that it was made of.
    pixel: f64,
    /// Row after row from below; `None` where nothing is painted.
    greys: Vec<Option<u8>>,
}

impl Picture {
    /// The side that looks along +x, +y, -x or -y of the box.
    fn of(paint: &[Painted], frame: &OrientedBox, side: usize) -> Option<Self> {
        let [across, up] = view_size(frame, side);
        let pixel = PIXEL.max(across.max(up) / MOST_PIXELS as f64);
        let count = |length: f64| ((length / pixel).ceil() as usize).clamp(1, MOST_PIXELS + 1);
        let (width, height) = (count(across), count(up));
        let view = SideView::of(paint, frame, side, [width, height], [pixel; 2]);
        (view.painted() >= COVERED).then(|| Self {
            width,
            height,
            pixel,
            greys: view.colours.iter().map(|c| c.map(grey)).collect(),
        })
    }

    fn side(&self, size: [f64; 2]) -> Option<Side> {
        let windows = self.features()?;
        let mut sums = [(0.0, 0.0); CELLS * CELLS];
        for (i, grey) in self.greys.iter().enumerate() {
            let cell = |at: usize, n: usize| (at * CELLS / n).min(CELLS - 1);
            let c = cell(i / self.width, self.height) * CELLS + cell(i % self.width, self.width);
            if let Some(grey) = grey {
                sums[c].0 += f64::from(*grey) / 255.0;
                sums[c].1 += 1.0;
            }
        }
        let (sum, n) = sums.iter().fold((0.0, 0.0), |t, s| (t.0 + s.0, t.1 + s.1));
        let mean = sum / f64::max(n, 1.0);
        let cells = sums.map(|(s, n)| if n > 0.0 { s / n - mean } else { 0.0 });
        Some(Side {
            size,
            windows,
            cells,
        })
    }

    /// `None` for a side of one grey.
    fn features(&self) -> Option<WindowFeatures> {
        let mut counts = [0_usize; 256];
        self.greys
            .iter()
            .flatten()
            .for_each(|&g| counts[usize::from(g)] += 1);
        let threshold = otsu(&counts)?;
        let dark = |g: &Option<u8>| g.is_some_and(|g| g < threshold);
        let mut mask = Mask {
            width: self.width,
            cells: self.greys.iter().map(dark).collect(),
        };
        // Opening, then closing.
        for grow in [false, true, true, false] {
            mask = mask.morphed(grow);
        }
        let wall = self
            .greys
            .iter()
            .zip(&mask.cells)
            .filter(|(_, window)| !**window);
        let wall: Vec<f64> = wall.filter_map(|(g, _)| *g).map(f64::from).collect();
        let intensity = wall.iter().sum::<f64>() / (255.0 * wall.len().max(1) as f64);
        let windows = dominant(mask.regions(self.height));
        if windows.is_empty() {
            return Some([0.0, 0.0, 0.0, 0.0, 0.0, intensity]);
        }
        let n = windows.len() as f64;
        let mean = |f: &dyn Fn(&Region) -> f64| windows.iter().map(f).sum::<f64>() / n;
        let sides = |r: &Region| {
            [
                r.bounds.right - r.bounds.left,
                r.bounds.top - r.bounds.bottom,
            ]
        };
        let [width, height] = [0, 1].map(|k| mean(&|r| sides(r)[k] as f64));
        let emptiness = mean(&|r| {
            let [w, h] = sides(r);
            (w * h - r.cells) as f64 / r.cells as f64
        });
        let middles = |k: usize| -> Vec<usize> {
            let both = |r: &Region| match k {
                0 => r.bounds.left + r.bounds.right,
                _ => r.bounds.bottom + r.bounds.top,
            };
            windows.iter().map(|r| both(r) / 2).collect()
        };
        let spacing = |k: usize, side: f64| {
            usual_distance(middles(k), side / 2.0).map_or(0.0, |d| (d as f64 - side).max(0.0))
        };
        let metres = |pixels: f64| pixels * self.pixel;
        Some([
            metres(width),
            metres(height),
            metres(spacing(0, width)),
            metres(spacing(1, height)),
            emptiness,
            intensity,
        ])
    }
}

/// The grey below which pixels are foreground: greatest variance between the two classes (Otsu 1979); `None` for one grey.
fn otsu(counts: &[usize; 256]) -> Option<u8> {
    let total: usize = counts.iter().sum();
    let sum: usize = counts.iter().enumerate().map(|(g, n)| g * n).sum();
    let (mut below, mut sum_below) = (0, 0);
    let mut best: Option<(f64, u8)> = None;
    for (grey, &count) in (0..=255_u8).zip(counts) {
        let above = total - below;
        if below > 0 && above > 0 {
            let mean = sum_below as f64 / below as f64;
            let apart = (sum - sum_below) as f64 / above as f64 - mean;
            let between = below as f64 * above as f64 * apart * apart;
            if best.is_none_or(|b| between > b.0) {
                best = Some((between, grey));
            }
        }
        below += count;
        sum_below += usize::from(grey) * count;
    }
    best.map(|b| b.1)
}

/// Pixels that are windows.
struct Mask {
    width: usize,
    cells: Vec<bool>,
}

/// A connected region of the mask.
struct Region {
    bounds: Span,
    cells: usize,
}

impl Mask {
    /// Dilated, or eroded, by 3 x 3; what is outside the picture does not count.
    fn morphed(&self, grow: bool) -> Self {
        let (w, h) = (self.width, self.cells.len() / self.width);
        let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        let cell = |at: usize| {
            let mut around = near(at / w, h).flat_map(|j| near(at % w, w).map(move |i| j * w + i));
            match grow {
                true => around.any(|k| self.cells[k]),
                false => around.all(|k| self.cells[k]),
            }
        };
        Self {
            width: w,
            cells: (0..self.cells.len()).map(cell).collect(),
        }
    }

    fn regions(&self, height: usize) -> Vec<Region> {
        let line = |n: usize| (0..=n).map(|v| v as f64).collect();
        let grid = LabelGrid {
            name: String::new(),
            unit: "px".to_owned(),
            xs: line(self.width),
            ys: line(height),
            labels: vec!["wall".to_owned(), "window".to_owned()],
            cells: self.cells.iter().map(|&c| u16::from(c)).collect(),
        };
        let whole = Span {
            left: 0,
            right: self.width,
            bottom: 0,
            top: height,
        };
        let mut of_cell = vec![0; self.cells.len()];
        let all = components(&grid, whole, &mut of_cell).into_iter();
        all.filter(|c| c.label == 1 && c.cells >= LEAST_AREA)
            .map(|c| Region {
                bounds: c.bounds,
                cells: c.cells,
            })
            .collect()
    }
}

/// The regions of the type with most members, without outliers: types are clusters of areas (k-means in one dimension from
/// evenly spread quantiles).
fn dominant(mut regions: Vec<Region>) -> Vec<Region> {
    if regions.is_empty() {
        return regions;
    }
    regions.sort_by_key(|r| r.cells);
    let area = |r: &Region| r.cells as f64;
    let quantile = |k: usize| area(&regions[(2 * k + 1) * regions.len() / (2 * TYPES)]);
    let mut centres: Vec<f64> = (0..TYPES).map(quantile).collect();
    centres.dedup();
    let nearest = |centres: &[f64], r: &Region| {
        let far = |c: usize| (centres[c] - area(r)).abs();
        (0..centres.len())
            .min_by(|&a, &b| far(a).total_cmp(&far(b)))
            .unwrap_or(0)
    };
    let mut labels: Vec<usize> = regions.iter().map(|r| nearest(&centres, r)).collect();
    for _ in 0..ROUNDS {
        for (c, centre) in centres.iter_mut().enumerate() {
            let own = regions.iter().zip(&labels).filter(|(_, l)| **l == c);
            let own: Vec<f64> = own.map(|(r, _)| area(r)).collect();
            if !own.is_empty() {
                *centre = own.iter().sum::<f64>() / own.len() as f64;
            }
        }
        let next: Vec<usize> = regions.iter().map(|r| nearest(&centres, r)).collect();
        if next == labels {
            break;
        }
        labels = next;
    }
    let count = |c: usize| labels.iter().filter(|l| **l == c).count();
    // Of types of as many members, the larger windows.
    let most = (0..centres.len()).max_by_key(|&c| count(c)).unwrap_or(0);
    let n = count(most) as f64;
    let own = || regions.iter().zip(&labels).filter(|(_, l)| **l == most);
    let variance = own()
        .map(|(r, _)| (area(r) - centres[most]).powi(2))
        .sum::<f64>()
        / n;
    let centre = centres[most];
    let limit = (OUTLIER * variance.sqrt()).max(OUTLIER_SHARE * centre);
    let mut labels = labels.iter();
    regions.retain(|r| labels.next() == Some(&most) && (area(r) - centre).abs() <= limit);
    regions
}

/// The most frequent distance between neighbouring middles, of those of at least `least` pixels (windows above each other
/// are not neighbours); of equally frequent ones the smallest.
fn usual_distance(mut middles: Vec<usize>, least: f64) -> Option<usize> {
    middles.sort_unstable();
    let mut distances: Vec<usize> = middles.windows(2).map(|w| w[1] - w[0]).collect();
    distances.retain(|&d| d as f64 >= least);
    distances.sort_unstable();
    let runs = distances.chunk_by(|a, b| a == b);
    let most = runs.rev().max_by_key(|run| run.len());
    most.map(|run| run[0])
}

#[cfg(test)]
mod tests;
