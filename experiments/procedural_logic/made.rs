//! Made facades of two styles, with known architecture: what the experiments run on without data.
//!
//! The *boulevard* style has a ground floor of shops with or without a door, floors of windows with
//! small or running balconies, a roof floor and sky; the *plain* style has windows in a wall and a
//! door. Architectures are drawn from few choices, so that facades repeat them with other sizes.

use rand::{Rng, RngExt};

use super::gold::Architecture;
use crate::rng::stream;
use crate::shape::LabelGrid;

const LABELS: [&str; 7] = ["wall", "window", "balcony", "door", "shop", "roof", "sky"];
const WALL: u16 = 0;
const WINDOW: u16 = 1;
const BALCONY: u16 = 2;
const DOOR: u16 = 3;
const SHOP: u16 = 4;
const ROOF: u16 = 5;
const SKY: u16 = 6;

/// A label image under construction.
struct Painting {
    width: usize,
    height: usize,
    cells: Vec<u16>,
}

impl Painting {
    fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            cells: vec![WALL; width * height],
        }
    }

    fn fill(&mut self, x: usize, y: usize, width: usize, height: usize, label: u16) {
        for row in y..y + height {
            self.cells[row * self.width + x..row * self.width + x + width].fill(label);
        }
    }

    fn grid(self, name: String) -> LabelGrid {
        LabelGrid {
            name,
            unit: "px".into(),
            xs: (0..=self.width).map(|x| x as f64).collect(),
            ys: (0..=self.height).map(|y| y as f64).collect(),
            labels: LABELS.map(String::from).to_vec(),
            cells: self.cells,
        }
    }
}

/// Window columns: left sides and widths.
fn columns<R: Rng>(count: usize, rng: &mut R) -> (Vec<(usize, usize)>, usize) {
    let mut x = rng.random_range(15..40);
    let mut columns = Vec::with_capacity(count);
    for _ in 0..count {
        let width = rng.random_range(20..30);
        columns.push((x, width));
        x += width + rng.random_range(20..50);
    }
    (columns, x)
}

/// A boulevard facade and its architecture.
pub fn boulevard(seed: u64, index: u64) -> (LabelGrid, Architecture) {
    let rng = &mut stream(seed, "made boulevard", index);
    let count = rng.random_range(3..6);
    let upper = rng.random_range(4..6);
    let has_door = rng.random_bool(0.7);
    let running: &[usize] = [&[1, 4][..], &[4], &[]][rng.random_range(0..3)];
    let (columns, width) = columns(count, rng);
    let (ground, floor) = (rng.random_range(70..110), rng.random_range(60..80));
    let (roof, sky) = (rng.random_range(35..55), rng.random_range(30..80));
    let height = ground + upper * floor + roof + sky;
    let mut painting = Painting::new(width, height);
    painting.fill(0, 0, width, ground, SHOP);
    if has_door {
        let x = columns[rng.random_range(0..count)].0 + 5;
        painting.fill(x, 0, 28, ground, WALL);
        painting.fill(x, 0, 28, ground - rng.random_range(8..20), DOOR);
    }
    let mut lines = vec![1.0 - ground as f64 / height as f64];
    for level in 0..upper {
        let bottom = ground + level * floor;
        lines.push(1.0 - (bottom + floor) as f64 / height as f64);
        let is_running = running.contains(&level);
        if is_running {
            painting.fill(0, bottom, width, 16, BALCONY);
        }
        for &(x, w) in &columns {
            painting.fill(x, bottom, w, 16, BALCONY);
            painting.fill(x, bottom + 16, w, 28, WINDOW);
        }
    }
    painting.fill(0, ground + upper * floor, width, roof, ROOF);
    for &(x, w) in &columns {
        painting.fill(x, ground + upper * floor, w, roof, WINDOW);
    }
    painting.fill(0, height - sky, width, sky, SKY);
    let grid = painting.grid(format!("boulevard_{index}"));
    let sides: Vec<(f64, f64)> = columns
        .iter()
        .map(|&(x, w)| (x as f64 / width as f64, (x + w) as f64 / width as f64))
        .collect();
    let architecture = Architecture::new(&grid, &lines, &sides);
    (grid, architecture)
}

/// A plain facade.
pub fn plain(seed: u64, index: u64) -> LabelGrid {
    let rng = &mut stream(seed, "made plain", index);
    let count = rng.random_range(3..8);
    let floors = rng.random_range(2..5);
    let (columns, width) = columns(count, rng);
    let floor = rng.random_range(55..75);
    let sky = rng.random_range(20..60);
    let height = floors * floor + 15 + sky;
    let mut painting = Painting::new(width, height);
    let entrance = rng.random_range(0..count);
    for level in 0..floors {
        for (column, &(x, w)) in columns.iter().enumerate() {
            if level == 0 && column == entrance {
                painting.fill(x, 0, w, 45, DOOR);
            } else {
                painting.fill(x, level * floor + 15, w, 30, WINDOW);
            }
        }
    }
    painting.fill(0, height - sky, width, sky, SKY);
    painting.grid(format!("plain_{index}"))
}
