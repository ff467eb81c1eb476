//! Bounding regions of 3D Tiles: what a box covers of longitudes, latitudes and heights above the ellipsoid of WGS 84.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::earth::geodetic;
use super::gltf_transform::{Matrix, applied};

/// Points along each side of a box at which its region is measured, less one.
const PARTS: usize = 16;
/// Latitude from which on a box may surround a pole, and is taken to do so.
const POLAR: f64 = 1.55;

/// A region; longitudes and latitudes in radians, heights in metres.
#[derive(Debug, Clone, Copy)]
pub struct Region {
    low: [f64; 3],
    /// Its longitude is beyond π where the region crosses the 180th meridian.
    high: [f64; 3],
}

impl Region {
    /// A region around a box of which `frame` puts the coordinates on the earth, z up, column by column. Its sides are farther out than need
    /// be by 0.1 m, and by 1 cm more where the box is a kilometre wide.
    pub fn around(frame: &Matrix, low: [f64; 3], high: [f64; 3]) -> Self {
        let start = geodetic(applied(frame, low));
        let (mut least, mut most) = (start, start);
        for i in 0..=PARTS {
            for j in 0..=PARTS {
                let share = [i, j].map(|n| n as f64 / PARTS as f64);
                let [x, y] = [0, 1].map(|k| low[k] + share[k] * (high[k] - low[k]));
                for z in [low[2], high[2]] {
                    let mut point = geodetic(applied(frame, [x, y, z]));
                    point[0] = nearest(point[0], start[0]);
                    for k in 0..3 {
                        least[k] = least[k].min(point[k]);
                        most[k] = most[k].max(point[k]);
                    }
                }
            }
        }
        // Between the points a curve is farther out by the square of a step, divided by eight times its radius: that of the earth for
        // heights, and for latitudes that of their circle. Both are above 100 km where the region is not polar.
        let step = (0..2).map(|k| (high[k] - low[k]) / PARTS as f64);
        let beyond = 0.1 + step.map(|s| s * s).sum::<f64>() / 8e5;
        let up = beyond / 6.3e6;
        let reach = least[1].abs().max(most[1].abs());
        let margin = [up / reach.min(POLAR).cos(), up, beyond];
        let mut region = Self {
            low: [0, 1, 2].map(|k| least[k] - margin[k]),
            high: [0, 1, 2].map(|k| most[k] + margin[k]),
        };
        if reach > POLAR {
            (region.low[0], region.high[0]) = (-PI, PI);
            match region.high[1] > 0.0 {
                true => region.high[1] = FRAC_PI_2,
                false => region.low[1] = -FRAC_PI_2,
            }
        }
        region
    }

    /// The smallest region that holds both.
    pub fn union(&self, other: &Self) -> Self {
        let middle = |r: &Self| (r.low[0] + r.high[0]) / 2.0;
        let turn = nearest(middle(other), middle(self)) - middle(other);
        let moved = |[x, y, z]: [f64; 3]| [x + turn, y, z];
        let (low, high) = (moved(other.low), moved(other.high));
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(high[k])),
        }
    }

    /// West, south, east, north, lowest, highest; east is less than west across the 180th meridian.
    pub fn numbers(&self) -> [f64; 6] {
        let ([west, south, lowest], [east, north, highest]) = (self.low, self.high);
        let is_all_around = east - west >= TAU;
        let [west, east] = match is_all_around {
            true => [-PI, PI],
            false => [west, east].map(|v| match v.abs() <= PI {
                true => v,
                false => nearest(v, 0.0),
            }),
        };
        [west, south, east, north, lowest, highest]
    }
}

/// An angle, turned around until it is within half a turn of another.
fn nearest(angle: f64, to: f64) -> f64 {
    angle - ((angle - to) / TAU).round() * TAU
}

#[cfg(test)]
mod tests {
    use super::super::earth::earth_centred;
    use super::super::faceted::unit;
    use super::{FRAC_PI_2, Matrix, PI, Region, applied, geodetic};
    use edifice_base::rng::stream;
    use edifice_shape::vec3::cross;
    use rand::RngExt;

    /// East, north and up at a place, turned about the vertical.
    fn frame(longitude: f64, latitude: f64, turn: f64) -> Matrix {
        let at = earth_centred(longitude, latitude, 20.0);
        let (sin, cos) = latitude.sin_cos();
        let up = [cos * longitude.cos(), cos * longitude.sin(), sin];
        let east = unit([-longitude.sin(), longitude.cos(), 0.0]).unwrap();
        let north = cross(up, east);
        let (s, c) = turn.sin_cos();
        let x: [f64; 3] = std::array::from_fn(|k| c * east[k] + s * north[k]);
        let y = cross(up, x);
        std::array::from_fn(|i| match (i / 4, i % 4) {
            (3, 3) => 1.0,
            (_, 3) => 0.0,
            (column, k) => [x, y, up, at][column][k],
        })
    }

    fn holds([west, south, east, north, low, high]: [f64; 6], [x, y, z]: [f64; 3]) -> bool {
        let along = match west <= east {
            true => (west..=east).contains(&x),
            false => x >= west || x <= east,
        };
        along && (south..=north).contains(&y) && (low..=high).contains(&z)
    }

    /// Boxes of a metre to 100 km anywhere on the earth, one in four at the 180th meridian or a pole.
    #[test]
    fn a_region_holds_every_point_of_its_boxes_and_little_more() {
        let mut rng = stream(1, "regions", 0);
        for case in 0..2000 {
            let mut longitude = rng.random_range(-PI..PI);
            let mut latitude = rng.random_range(-1.5..1.5);
            match case % 8 {
                0 => longitude = PI - rng.random_range(-1e-4..1e-4),
                1 => latitude = FRAC_PI_2 - rng.random_range(0.0..1e-4),
                _ => {}
            }
            let frame = frame(longitude, latitude, rng.random_range(-PI..PI));
            let mut any = || -> ([f64; 3], [f64; 3]) {
                let size = 10.0_f64.powf(rng.random_range(0.0..5.0));
                let low: [f64; 3] = std::array::from_fn(|_| rng.random_range(-size..size));
                let side = |k: usize| rng.random_range(0.0..[size, size, 300.0][k]);
                let sides: [f64; 3] = std::array::from_fn(side);
                (low, std::array::from_fn(|k| low[k] + sides[k]))
            };
            let boxes = [any(), any()];
            let [a, b] = boxes.map(|(low, high)| Region::around(&frame, low, high));
            for (region, boxes) in [
                (a, &boxes[..1]),
                (a.union(&b), &boxes[..]),
                (b.union(&a), &boxes[..]),
            ] {
                let numbers = region.numbers();
                assert!(numbers[0].abs() <= PI && numbers[2].abs() <= PI);
                for _ in 0..20 {
                    let (low, high) = boxes[rng.random_range(0..boxes.len())];
                    let share: [f64; 3] = std::array::from_fn(|_| rng.random_range(0.0..=1.0));
                    let p = std::array::from_fn(|k| low[k] + share[k] * (high[k] - low[k]));
                    let point = geodetic(applied(&frame, p));
                    assert!(holds(numbers, point), "{case}: {numbers:?} {point:?}");
                }
            }
            // Not larger than the box by more than it says: in height, where that is a plain difference.
            let (low, high) = boxes[0];
            let corner = |i: usize| [0, 1, 2].map(|k| [low, high][i >> k & 1][k]);
            let heights = (0..8).map(|i| geodetic(applied(&frame, corner(i)))[2]);
            let most = heights.fold(f64::NEG_INFINITY, f64::max);
            let side = (high[0] - low[0]).hypot(high[1] - low[1]) / 1000.0;
            assert!(a.high[2] - most < 0.11 + 0.01 * side * side, "{case}");
        }
    }
}
