//! Pictures of cities, one beside the other, from one place: from the south-west, or from above. What is drawn is moved to the middle
//! of the first city in double precision, wherever in its reference system it lies.

mod drawing;
mod figure_ground;
mod glyphs;
mod legend;
mod scene;
mod terrain;

use edifice_io::scene_png::picture_png;
use edifice_scene::render::{Picture, render};
use edifice_scene::trace::framing_at;
use edifice_shape::triangles::City;

use self::drawing::seen;
pub use self::drawing::{Drawing, Drawn, View};
use self::scene::scene;

/// Space between pictures, in pixels.
const GAP: usize = 8;
/// From the south-west, downward; y is up.
const OBLIQUE: ([f32; 3], f32) = ([0.35, -0.55, -0.75], 30.0);
/// From above, north at the top, from so far that walls are hardly seen.
const PLAN: ([f32; 3], f32) = ([0.0, -1.0, -1e-4], 4.0);

/// Colours, red, green and blue from 0 to 255, each with what it stands for.
pub type Legend = Vec<([u8; 3], String)>;

/// Draws cities from one place, from which all are seen whole, as a PNG of one row; each picture is `width` x `height` pixels.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn side_by_side(
    cities: &[&City],
    width: usize,
    height: usize,
) -> Result<Vec<u8>, png::EncodingError> {
    let drawn: Vec<Drawn> = cities
        .iter()
        .map(|city| Drawn {
            city,
            colours: None,
        })
        .collect();
    let drawing = Drawing {
        width,
        height,
        view: View::Oblique,
        around: None,
    };
    draw(&drawn, &drawing, &Vec::new())
}

/// Draws cities as [`side_by_side`] does, with a legend in the corner of the first, if it has entries.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub fn draw(
    cities: &[Drawn],
    drawing: &Drawing,
    legend: &Legend,
) -> Result<Vec<u8>, png::EncodingError> {
    let Drawing { width, height, .. } = *drawing;
    let Some(first) = cities.first() else {
        return Ok(Vec::new());
    };
    let middle = middle_of(first.city, drawing);
    let mut pictures = match drawing.view {
        View::Oblique => seen_from(cities, drawing, middle, OBLIQUE),
        View::Plan => seen_from(cities, drawing, middle, PLAN),
        View::FigureGround => figure_ground::draw(cities, drawing),
    };
    if let Some(first) = pictures.first_mut() {
        legend::write(first, legend);
    }
    let whole = cities.len() * (width + GAP) - GAP;
    let mut rgb = vec![255; whole * height * 3];
    for (i, picture) in pictures.iter().enumerate() {
        for (y, row) in picture.rgb.chunks_exact(width * 3).enumerate() {
            let from = (y * whole + i * (width + GAP)) * 3;
            rgb[from..from + row.len()].copy_from_slice(row);
        }
    }
    picture_png(&Picture {
        width: whole,
        height,
        rgb,
    })
}

/// Pictures in perspective, all from the place from which all cities are seen whole.
fn seen_from(
    cities: &[Drawn],
    drawing: &Drawing,
    middle: [f64; 3],
    (direction, angle): ([f32; 3], f32),
) -> Vec<Picture> {
    let Drawing { width, height, .. } = *drawing;
    let scenes = cities.iter().map(|city| scene(city, drawing, middle));
    let scenes: Vec<_> = scenes.collect();
    let camera = framing_at(&scenes, direction, width as f32 / height as f32, angle);
    let pictures = scenes.iter().map(|s| render(s, &camera, width, height));
    pictures.collect()
}

/// The least and the greatest corner of what is drawn of a city, relative to its origin; `None` where nothing is.
pub fn bounds(city: &City, drawing: &Drawing) -> Option<([f64; 3], [f64; 3])> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for b in &city.buildings {
        if let Some((l, h)) = b.mesh.bounds().filter(|b| seen(b, city, drawing)) {
            for k in 0..3 {
                low[k] = low[k].min(l[k]);
                high[k] = high[k].max(h[k]);
            }
        }
    }
    (low[0] <= high[0]).then_some((low, high))
}

/// The middle of what is drawn of a city, in the coordinates of its reference system.
fn middle_of(city: &City, drawing: &Drawing) -> [f64; 3] {
    match bounds(city, drawing) {
        Some((low, high)) => [0, 1, 2].map(|k| (low[k] + high[k]) / 2.0 + city.origin[k]),
        None => city.origin,
    }
}
