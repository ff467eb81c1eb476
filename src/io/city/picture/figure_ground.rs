//! Figure-ground plans of cities.

use super::drawing::{Drawing, Drawn, seen};
use edifice_scene::render::Picture;

/// The colour of a building that has none of its own.
const FIGURE: [u8; 3] = [45; 3];
/// Samples of a pixel along each side.
const SAMPLES: usize = 3;
/// White around the plan, a share of its extent.
const MARGIN: f64 = 0.03;

/// The place of a picture's samples on the ground.
struct Frame {
    /// The upper left corner of the picture, in the coordinates of the reference system.
    corner: [f64; 2],
    /// Samples a metre.
    scale: f64,
    /// Samples along the width and the height.
    size: [usize; 2],
}

/// Figure-ground plans of cities, all with the frame that holds all of them.
pub(super) fn draw(cities: &[Drawn], drawing: &Drawing) -> Vec<Picture> {
    let frame = Frame::new(cities, drawing);
    let pictures = cities.iter().map(|city| plan(city, drawing, &frame));
    pictures.collect()
}

impl Frame {
    fn new(cities: &[Drawn], drawing: &Drawing) -> Self {
        let size = [drawing.width, drawing.height];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for drawn in cities {
            if let Some((l, h)) = super::bounds(drawn.city, drawing) {
                for k in 0..2 {
                    low[k] = low[k].min(l[k] + drawn.city.origin[k]);
                    high[k] = high[k].max(h[k] + drawn.city.origin[k]);
                }
            }
        }
        let metres = [0, 1].map(|k| ((high[k] - low[k]) * (1.0 + 2.0 * MARGIN)).max(1e-3));
        let pixels = [0, 1].map(|k| size[k] as f64);
        // Of a picture without any building the scale is of no meaning.
        let scale = match low[0] <= high[0] {
            true => (pixels[0] / metres[0]).min(pixels[1] / metres[1]),
            false => 1.0,
        };
        let middle = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
        Frame {
            corner: [
                middle[0] - pixels[0] / scale / 2.0,
                middle[1] + pixels[1] / scale / 2.0,
            ],
            scale: scale * SAMPLES as f64,
            size: size.map(|n| n * SAMPLES),
        }
    }

    /// A point of the reference system, in samples from the upper left corner.
    fn place(&self, p: [f64; 2]) -> [f64; 2] {
        [p[0] - self.corner[0], self.corner[1] - p[1]].map(|v| v * self.scale)
    }
}

fn plan(drawn: &Drawn, drawing: &Drawing, frame: &Frame) -> Picture {
    let [columns, rows] = frame.size;
    let mut samples = vec![[255u8; 3]; columns * rows];
    let city = drawn.city;
    for (number, building) in city.buildings.iter().enumerate() {
        let bounds = building.mesh.bounds();
        if !bounds.is_some_and(|b| seen(&b, city, drawing)) {
            continue;
        }
        let colour = drawn.colours.and_then(|c| c.get(number));
        let colour = *colour.unwrap_or(&FIGURE);
        for triangle in &building.mesh.triangles {
            let corners = triangle.map(|i| {
                let p = building.mesh.positions[i as usize];
                frame.place([p[0] + city.origin[0], p[1] + city.origin[1]])
            });
            fill(&mut samples, frame.size, &corners, colour);
        }
    }
    let mut rgb = Vec::with_capacity(drawing.width * drawing.height * 3);
    for y in 0..drawing.height {
        for x in 0..drawing.width {
            let first = y * SAMPLES * columns + x * SAMPLES;
            let own = (0..SAMPLES * SAMPLES)
                .map(|s| samples[first + s / SAMPLES * columns + s % SAMPLES]);
            let sum = own.fold([0; 3], |sum: [usize; 3], c| {
                [0, 1, 2].map(|k| sum[k] + usize::from(c[k]))
            });
            rgb.extend(sum.map(|v| (v / (SAMPLES * SAMPLES)) as u8));
        }
    }
    Picture {
        width: drawing.width,
        height: drawing.height,
        rgb,
    }
}

/// Fills the samples whose middle lies in a triangle, or on its edge. A wall, which has no area from above, fills none.
fn fill(
    samples: &mut [[u8; 3]],
    [columns, rows]: [usize; 2],
    corners: &[[f64; 2]; 3],
    colour: [u8; 3],
) {
    let [a, b, c] = *corners;
    let area = side(a, b, c);
    if !(area.is_finite() && area.abs() > f64::MIN_POSITIVE) {
        return;
    }
    let range = |k: usize, count: usize| {
        let low = a[k].min(b[k]).min(c[k]) - 0.5;
        let high = a[k].max(b[k]).max(c[k]) - 0.5;
        // Conversion to integers saturates.
        (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).max(0.0) as usize).min(count)
    };
    for y in range(1, rows) {
        for x in range(0, columns) {
            let p = [x as f64 + 0.5, y as f64 + 0.5];
            let inside = [side(a, b, p), side(b, c, p), side(c, a, p)];
            if inside.iter().all(|s| s * area.signum() >= 0.0) {
                samples[y * columns + x] = colour;
            }
        }
    }
}

/// Twice the signed area of a triangle.
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::View;
    use edifice_shape::triangles::{City, CityBuilding, TriangleMesh};

    /// A flat roof with its lower corner at a place.
    fn house([x, y]: [f64; 2], [w, d]: [f64; 2]) -> CityBuilding {
        let corners = [[x, y], [x + w, y], [x + w, y + d], [x, y + d]];
        CityBuilding {
            mesh: TriangleMesh {
                positions: corners.map(|[x, y]| [x, y, 9.0]).to_vec(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            },
            ..CityBuilding::default()
        }
    }

    fn drawing(width: usize, height: usize) -> Drawing {
        Drawing {
            width,
            height,
            view: View::FigureGround,
            around: None,
        }
    }

    #[test]
    fn what_is_dark_has_the_area_of_the_footprints() {
        let origin = [500_000.0, 4_000_000.0, 0.0];
        let buildings = vec![
            house([0.0; 2], [30.0, 10.0]),
            house([50.0, 40.0], [10.0, 20.0]),
        ];
        let city = City {
            origin,
            buildings,
            ..City::default()
        };
        let drawing = drawing(300, 300);
        let drawn = Drawn {
            city: &city,
            colours: None,
        };
        let frame = Frame::new(&[drawn], &drawing);
        let picture = plan(&drawn, &drawing, &frame);
        let dark: f64 = picture
            .rgb
            .chunks_exact(3)
            .map(|c| f64::from(255 - c[0]) / f64::from(255 - FIGURE[0]))
            .sum();
        let scale = frame.scale / SAMPLES as f64;
        let area = dark / (scale * scale);
        assert!((area - 500.0).abs() < 5.0, "{area}");
        // North is at the top: the second building, in the north-east, is in the upper right quarter.
        let at = |x: usize, y: usize| picture.rgb[(y * 300 + x) * 3];
        assert_eq!(at(260, 40), FIGURE[0]);
        assert_eq!(at(260, 260), 255);
    }

    #[test]
    fn a_city_without_buildings_is_white() {
        let city = City::default();
        let drawing = drawing(20, 12);
        let drawn = Drawn {
            city: &city,
            colours: None,
        };
        let picture = &draw(&[drawn], &drawing)[0];
        assert!(picture.rgb.iter().all(|v| *v == 255));
    }
}
