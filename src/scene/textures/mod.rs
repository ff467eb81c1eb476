//! Building materials as small pictures that repeat without a seam, drawn by formulas: no picture is stored.
//!
//! A material is a function of the place in one repeat, periodic in both directions: the share of the light that it
//! reflects, and its height. Pixels are means of that function; a map of normals follows from the heights.

mod covering;
mod masonry;
mod noise;
mod timber;

/// A building material with a pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Texture {
    /// Bricks in stretcher bond, courses of 75 mm, with mortar.
    Brick,
    /// Render, and anything else with a fine grain.
    Plaster,
    /// Level overlapping boards on a wall, 180 mm each.
    Cladding,
    /// Clay pantiles, rows of 300 mm.
    Tiles,
    /// Asphalt shingles, courses of 150 mm, every second one moved by half a tab.
    Shingles,
    /// Boards of a floor, 140 mm each, with gaps.
    Boards,
    /// Painted timber with a faint grain.
    Paint,
}

impl Texture {
    /// All textures.
    pub const ALL: [Texture; 7] = [
        Texture::Brick,
        Texture::Plaster,
        Texture::Cladding,
        Texture::Tiles,
        Texture::Shingles,
        Texture::Boards,
        Texture::Paint,
    ];

    /// Its name in files, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Texture::Brick => "brick",
            Texture::Plaster => "plaster",
            Texture::Cladding => "cladding",
            Texture::Tiles => "tiles",
            Texture::Shingles => "shingles",
            Texture::Boards => "boards",
            Texture::Paint => "paint",
        }
    }

    /// Width and height of one repeat in metres.
    pub fn size(self) -> f64 {
        match self {
            Texture::Brick => masonry::SIZE,
            Texture::Plaster => 2.0,
            Texture::Cladding => timber::CLADDING,
            Texture::Tiles | Texture::Shingles => covering::SIZE,
            Texture::Boards => timber::BOARDS,
            Texture::Paint => 1.0,
        }
    }

    /// Pixels along each side of its picture.
    pub fn pixels(self) -> usize {
        match self {
            Texture::Plaster | Texture::Paint => 128,
            _ => 256,
        }
    }

    /// True if its joints have a colour of their own, so that the picture depends on the colour of the material.
    pub fn has_joints(self) -> bool {
        self == Texture::Brick
    }

    /// True if it is uneven, so that its [`Tile`] has normals.
    pub fn has_relief(self) -> bool {
        self != Texture::Paint
    }

    /// The material at a place of one repeat: along the eaves or the wall, then upwards, both from 0 to 1.
    fn sample(self, place: [f64; 2]) -> Sample {
        match self {
            Texture::Brick => masonry::brick(place),
            Texture::Plaster => masonry::plaster(place),
            Texture::Cladding => timber::cladding(place),
            Texture::Tiles => covering::tiles(place),
            Texture::Shingles => covering::shingles(place),
            Texture::Boards => timber::boards(place),
            Texture::Paint => timber::paint(place),
        }
    }
}

/// A material at one place.
#[derive(Debug, Clone, Copy, Default)]
struct Sample {
    /// Share of the light of the brightest place, for red, green and blue.
    share: [f64; 3],
    /// Share of the place that is joint.
    joint: f64,
    /// Height in metres.
    height: f64,
}

/// A picture, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels along each side.
    pub side: usize,
    /// Bytes a pixel: 1 for grey, 3 for red, green and blue.
    pub channels: usize,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// One repeat of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Base colours, sRGB, to be multiplied by [`factor`](Tile::factor).
    pub base: Pixels,
    /// Normals in the plane of the picture: x to the right in red, y upwards in green; `None` for what is even.
    pub normal: Option<Pixels>,
    /// Mean of the base colours, linear.
    mean: [f64; 3],
    /// The brightest colour, linear, of a material with joints.
    brightest: Option<[f64; 3]>,
}

/// Colour of mortar, sRGB.
const MORTAR: [u8; 3] = [176, 168, 156];
/// Samples along each side of a pixel.
const SAMPLES: usize = 3;
/// Steps of a byte between the colours of a picture; fewer colours make smaller files.
const STEP: f64 = 3.0;

/// Draws one repeat. The `colour` (sRGB) matters only to materials that have joints.
pub fn tile(texture: Texture, colour: [u8; 3]) -> Tile {
    let side = texture.pixels();
    let samples = sampled(texture, side);
    let count = samples.len() as f64;
    let (own, mortar) = (colour.map(linear), MORTAR.map(linear));
    // Where there are joints the brightest colour holds both, and the picture says the share of it.
    let grey = [0, 1, 2].map(|c| samples.iter().map(|s| s.share[c]).sum::<f64>() / count);
    let brick = [0, 1, 2].map(|c| own[c] / grey[c]);
    let brightest = texture
        .has_joints()
        .then(|| [0, 1, 2].map(|c| brick[c].max(mortar[c]).min(1.0)));
    let share = |s: &Sample| match brightest {
        Some(most) => [0, 1, 2].map(|c| {
            let mixed = brick[c] * s.share[c] * (1.0 - s.joint) + mortar[c] * s.joint;
            (mixed / most[c]).min(1.0)
        }),
        None => s.share,
    };
    let channels = if brightest.is_some() { 3 } else { 1 };
    let mut mean = [0.0; 3];
    let mut bytes = Vec::with_capacity(side * side * channels);
    for sample in &samples {
        let share = share(sample);
        for c in 0..3 {
            mean[c] += share[c] / count;
        }
        bytes.extend(share[..channels].iter().map(|v| stepped(*v)));
    }
    Tile {
        base: Pixels {
            side,
            channels,
            bytes,
        },
        normal: normals(texture, &samples),
        mean,
        brightest,
    }
}

impl Tile {
    /// The linear colour that the picture is multiplied by, so that it looks like `colour` (sRGB) from afar.
    pub fn factor(&self, colour: [u8; 3]) -> [f64; 3] {
        let own = colour.map(linear);
        let even = [0, 1, 2].map(|c| (own[c] / self.mean[c]).min(1.0));
        self.brightest.unwrap_or(even)
    }
}

/// Means over pixels, rows from the top.
fn sampled(texture: Texture, side: usize) -> Vec<Sample> {
    let n = (SAMPLES * SAMPLES) as f64;
    let mut out = Vec::with_capacity(side * side);
    for row in 0..side {
        for column in 0..side {
            let mut mean = Sample::default();
            for k in 0..SAMPLES * SAMPLES {
                let within = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
                let x = (column as f64 + within(k % SAMPLES)) / side as f64;
                let y = 1.0 - (row as f64 + within(k / SAMPLES)) / side as f64;
                let one = texture.sample([x, y]);
                for c in 0..3 {
                    mean.share[c] += one.share[c] / n;
                }
                mean.joint += one.joint / n;
                mean.height += one.height / n;
            }
            out.push(mean);
        }
    }
    out
}

/// Steepest slope that a map of normals shows.
const STEEPEST: f64 = 1.5;

/// Normals by central differences of the heights, over the edges of the picture too.
fn normals(texture: Texture, samples: &[Sample]) -> Option<Pixels> {
    let side = texture.pixels();
    let height = |row: usize, column: usize| samples[row % side * side + column % side].height;
    if !texture.has_relief() {
        return None;
    }
    let step = 2.0 * texture.size() / side as f64;
    let mut bytes = Vec::with_capacity(3 * side * side);
    for row in 0..side {
        for column in 0..side {
            let right = height(row, column + 1) - height(row, column + side - 1);
            let up = height(row + side - 1, column) - height(row + 1, column);
            let slope = [right, up].map(|d| (d / step).clamp(-STEEPEST, STEEPEST));
            let length = (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
            let normal = [-slope[0] / length, -slope[1] / length, 1.0 / length];
            bytes.extend(normal.map(|v| (127.5 + 127.5 * v).round() as u8));
        }
    }
    Some(Pixels {
        side,
        channels: 3,
        bytes,
    })
}

/// A channel of a colour from sRGB to linear.
fn linear(channel: u8) -> f64 {
    let c = f64::from(channel) / 255.0;
    match c <= 0.04045 {
        true => c / 12.92,
        false => ((c + 0.055) / 1.055).powf(2.4),
    }
}

/// A linear share as a byte of sRGB, of those in steps.
fn stepped(share: f64) -> u8 {
    let curve = match share <= 0.003_130_8 {
        true => 12.92 * share,
        false => 1.055 * share.powf(1.0 / 2.4) - 0.055,
    };
    ((curve * 255.0 / STEP).round() * STEP).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_material_reflects_more_than_it_gets_and_none_jumps() {
        for texture in Texture::ALL {
            let side = 97;
            for i in 0..side * side {
                let place = [i % side, i / side].map(|k| k as f64 / side as f64);
                let Sample {
                    share,
                    joint,
                    height,
                } = texture.sample(place);
                let name = texture.name();
                // Hues of bricks pass the mean by a twentieth.
                assert!(
                    share.iter().all(|s| (0.0..=1.06).contains(s)),
                    "{name}: {share:?}"
                );
                assert!((0.0..=1.0).contains(&joint), "{name}: {joint}");
                assert!(height.abs() < 0.1, "{name}: {height}");
            }
        }
    }
}
