//! Houses measured from city models: boxes with roofs fitted to the triangles of a detached building (level of
//! detail 2: walls and roof planes, without windows).
//!
//! Let `h(x, y)` be the height of the surface over the ground, sampled on a square raster in the building's own axes,
//! and `P` its plan. Wanted are few boxes `b` whose roofs' upper envelope
//!
//! ```text
//! m(x, y) = max over b containing (x, y) of  e_b + t_b d_b(x, y)
//! ```
//!
//! is near `h`, where `e_b` is the eave height, `t_b` the tangent of the pitch and `d_b` the distance from the eaves:
//! from the two edges along the ridge (gable), from all four (hip), from one (shed), 0 (flat).
//!
//! 1. **Axes.** The argument of `sum A exp(4 i θ)` over the walls' areas `A` and directions `θ`, divided by 4. At least
//!    85 % of the wall area within 8 degrees of it, else the building is *slanted*.
//! 2. **Grid.** Wall coordinates along either axis, clustered within 0.35 m by area. A cell at least half in `P` is
//!    inside.
//! 3. **Levels.** Roof planes are joined from triangles that share an edge and a direction (cosine .995). A cell has the
//!    lowest eave among the planes that cover more than a fifth of it; eaves within 0.5 m are one level.
//! 4. **Boxes.** From the highest level down, the rectangle of cells of at least that level that adds the largest
//!    uncovered area of that level, until all is covered.
//! 5. **Roofs.** For each box and kind of roof `(e_b, t_b)` by linear least squares over the samples at which the box is
//!    the envelope; the kind of the least mean absolute error, flat or gable unless another gains a tenth. A wing reaches
//!    into the box that it leans on where that lowers the error. Two rounds.
//! 6. **Fit**, by code of its own ([`Fit`]): intersection over union of the plans from clipped triangles, volume from
//!    prisms under the roof triangles, mean absolute difference of the heights.
//!
//! # Deviations and readings
//! - The paper's authors modelled their 200 houses by hand; this takes their place.
//! - A city model does not say which side is the front: the longer extent is the width, and of the two ways round that
//!   one whose sheds rise as those of [`edifice_shape::RoofStyle::Shed`] do. Porches, facades, chimneys and towers are
//!   recorded as not observed ([`edifice_shape::Building::unobserved`]).
//! - A garage is told by proxy: a flat box below 3.4 m of 12 to 50 square metres on the outside of a house that has
//!   another box at least twice as large.
//! - Storeys come from the file's attributes; where they would be lower than 2.1 m, one of them is taken to be under the
//!   pitched roof. Else they come from the highest eave over 2.8 m, rounded, at most 3 where these would be no higher than 4.2 m each.
//! - Dwellings are told from halls by the file's use where it has one, else by shape ([`Refused::NoDwelling`]).

mod boxes;
mod detached;
mod fit;
mod heights;
mod known;
mod planes;
mod roofs;
mod surfaces;
mod walls;

use rayon::prelude::*;

use edifice_shape::triangles::TriangleMesh;
use edifice_shape::{BoxStyle, Building, BuildingError, Hidden, MassBox, RoofStyle};

pub use detached::attached;
pub use fit::Fit;
pub use known::Known;
pub(crate) use surfaces::is_wall;

/// Limits of what counts as a house, in metres and square metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Smallest and largest plan.
    pub area: [f64; 2],
    /// Lowest and highest ridge over the ground.
    pub height: [f64; 2],
    /// Least intersection over union of the measured and the fitted plan.
    pub iou: f64,
    /// Most boxes.
    pub boxes: usize,
    /// True if flat halls and sheds without a known use are refused by their shape.
    pub by_shape: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            area: [45.0, 350.0],
            height: [2.5, 14.0],
            iou: 0.9,
            boxes: 12,
            by_shape: true,
        }
    }
}

/// A house measured from triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Surveyed {
    /// The house.
    pub building: Building,
    /// Fit of the house to the triangles.
    pub fit: Fit,
    /// Year of construction, where the file has it.
    pub year: Option<i64>,
}

/// Why a building of a city model becomes no house.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refused {
    /// It has no walls or no roof, or a coordinate is not finite.
    #[error("no walls or no roof")]
    NoSurface,
    /// Plan or height out of the limits.
    #[error("plan of {area:.0} square metres, {height:.1} m high: out of the limits")]
    Size {
        /// Area of the plan.
        area: f64,
        /// Height of the ridge.
        height: f64,
    },
    /// Another building stands within 0.4 m.
    #[error("attached to another building")]
    Attached,
    /// The file's use says that nobody lives there.
    #[error("its use is {0:?}")]
    Use(String),
    /// A flat roof on something too low or too large for a dwelling.
    #[error("a flat roof at {height:.1} m on {area:.0} square metres: no dwelling by its shape")]
    NoDwelling {
        /// Area of the plan.
        area: f64,
        /// Height of the roof.
        height: f64,
    },
    /// Walls in other directions than two.
    #[error("{0:.0} % of its walls stand at right angles")]
    Slanted(f64),
    /// Several parts, or a courtyard.
    #[error("its plan has several parts or a courtyard")]
    Plan,
    /// More boxes than the limit, or none.
    #[error("{0} boxes")]
    Boxes(usize),
    /// The boxes miss the plan.
    #[error("intersection over union of the plans {0:.2}")]
    Iou(f64),
    /// More than three storeys.
    #[error("{0} storeys")]
    Storeys(usize),
    /// The boxes are no building.
    #[error(transparent)]
    Building(#[from] BuildingError),
}

impl Refused {
    /// A word for counting.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::NoSurface => "no surface",
            Self::Size { .. } => "size",
            Self::Attached => "attached",
            Self::Use(_) => "use",
            Self::NoDwelling { .. } => "no dwelling by shape",
            Self::Slanted(_) => "slanted walls",
            Self::Plan => "plan in parts",
            Self::Boxes(_) => "boxes",
            Self::Iou(_) => "plan missed",
            Self::Storeys(_) => "storeys",
            Self::Building(_) => "no building",
        }
    }
}

/// Height below which a storey of those that the file tells is under the roof (m).
const LOWEST: f64 = 2.1;
/// Usual and greatest height of a storey where the file does not say how many there are (m), and most storeys.
const STOREY: f64 = 2.8;
const TALLEST: f64 = 4.2;
const STOREYS: usize = 3;
/// Garage proxy: highest eave (m), smallest and largest plan (square metres).
const GARAGE: (f64, [f64; 2]) = (3.4, [12.0, 50.0]);
/// A flat roof lower than this (m), or a plan larger than this (square metres), is no dwelling.
const HALL: (f64, f64) = (4.0, 220.0);

/// Plan area (square metres) and height (m) of a building's triangles at a glance; `None` without a roof.
pub fn size(mesh: &TriangleMesh) -> Option<[f64; 2]> {
    let (low, high) = mesh.bounds()?;
    let area = surfaces::plan_area(mesh);
    let all = [area, high[2] - low[2]];
    (area > 0.0 && all.iter().all(|v| v.is_finite())).then_some(all)
}

/// Checks that the size is within the limits.
///
/// # Errors
/// [`Refused::Size`], [`Refused::NoSurface`].
pub fn sized(mesh: &TriangleMesh, limits: &Limits) -> Result<(), Refused> {
    let [area, height] = size(mesh).ok_or(Refused::NoSurface)?;
    let within = |v: f64, [low, high]: [f64; 2]| (low..=high).contains(&v);
    match within(area, limits.area) && within(height, limits.height) {
        true => Ok(()),
        false => Err(Refused::Size { area, height }),
    }
}

/// A building of a city model.
#[derive(Debug, Clone, Copy)]
pub struct Candidate<'a> {
    /// Its identifier.
    pub name: &'a str,
    /// Its triangles, in metres.
    pub mesh: &'a TriangleMesh,
    /// Its attributes in the file.
    pub attributes: &'a serde_json::Map<String, serde_json::Value>,
}

/// Measures the detached houses among all buildings of a city, in their order. Names of houses are identifiers without
/// what cannot stand in the name of a file.
///
/// Complexity: linear in the triangles; buildings are measured in parallel, with the same result for any number of threads.
pub fn survey_all(city: &[Candidate], limits: &Limits) -> Vec<Result<Surveyed, Refused>> {
    let meshes: Vec<&TriangleMesh> = city.iter().map(|b| b.mesh).collect();
    let attached = attached(&meshes);
    let mut found: Vec<_> = city
        .par_iter()
        .zip(&attached)
        .map(|(b, attached)| {
            sized(b.mesh, limits)?;
            if *attached {
                return Err(Refused::Attached);
            }
            survey(b.name, b.mesh, &Known::new(b.attributes), limits)
        })
        .collect();
    let mut seen = std::collections::HashSet::new();
    for (number, house) in found
        .iter_mut()
        .enumerate()
        .filter_map(|(k, f)| Some((k, f.as_mut().ok()?)))
    {
        let usual = |c: char| {
            if c.is_ascii_alphanumeric() || "_-".contains(c) {
                c
            } else {
                '_'
            }
        };
        let plain: String = house.building.name.chars().map(usual).take(80).collect();
        let is_new = !plain.is_empty() && seen.insert(plain.clone());
        house.building.name = match is_new {
            true => plain,
            false => format!("{plain}_{}", number + 1),
        };
    }
    found
}

/// Measures a detached building of known size. `known` is what the file says of it.
///
/// Complexity: linear in triangles and raster samples, `O(n^4)` in the grid lines `n` of one axis.
///
/// # Errors
/// [`Refused`] says why it is no house.
pub fn survey(
    name: &str,
    mesh: &TriangleMesh,
    known: &Known,
    limits: &Limits,
) -> Result<Surveyed, Refused> {
    sized(mesh, limits)?;
    if let Some(other) = &known.other_use {
        return Err(Refused::Use(other.clone()));
    }
    let axes = walls::axes(mesh).ok_or(Refused::NoSurface)?;
    if axes.share < walls::RIGHT {
        return Err(Refused::Slanted(100.0 * axes.share));
    }
    let turned = walls::turned(mesh, axes.angle);
    let planes = planes::planes(&turned);
    let mut map = heights::HeightMap::new(&turned, &planes).ok_or(Refused::NoSurface)?;
    if !map.is_whole() {
        return Err(Refused::Plan);
    }
    let flat = map.flat_share();
    if limits.by_shape && !known.is_dwelling && flat > 0.75 {
        let (area, height) = (map.area(), map.median());
        if height < HALL.0 || area > HALL.1 {
            return Err(Refused::NoDwelling { area, height });
        }
    }
    let lines = walls::lines(&turned, &map);
    let found = boxes::boxes(&lines, &map, &planes);
    if found.is_empty() || found.len() > limits.boxes {
        return Err(Refused::Boxes(found.len()));
    }
    let roofed = roofs::fitted(&found, &map);
    let mut boxes: Vec<MassBox> = roofed.iter().map(roofs::RoofedBox::mass_box).collect();
    garage(&mut boxes);
    let highest = boxes.iter().map(|b| b.height).fold(0.0, f64::max);
    let is_pitched = boxes.iter().any(|b| b.roof.style != RoofStyle::Flat);
    let storeys = match known.storeys {
        // One is under the roof.
        Some(storeys) if is_pitched && storeys > 1 && highest < LOWEST * storeys as f64 => {
            storeys - 1
        }
        Some(storeys) => storeys,
        None => {
            let storeys = ((highest / STOREY).round() as usize).max(1);
            // Three tall storeys rather than four of the usual height.
            match highest <= TALLEST * STOREYS as f64 {
                true => storeys.min(STOREYS),
                false => storeys,
            }
        }
    };
    if storeys > STOREYS {
        return Err(Refused::Storeys(storeys));
    }
    let fit = Fit::new(&boxes, &turned, &map);
    if fit.iou < limits.iou {
        return Err(Refused::Iou(fit.iou));
    }
    // The corner of the house is the origin.
    let low = |f: fn(&MassBox) -> f64| boxes.iter().map(f).fold(f64::INFINITY, f64::min);
    let (x, y) = (low(|b| b.x - b.width / 2.0), low(|b| b.y - b.depth / 2.0));
    for b in &mut boxes {
        let millimetres = |v: f64| (v * 1e3).round() / 1e3;
        (b.x, b.y) = (millimetres(b.x - x), millimetres(b.y - y));
    }
    let floor_height = (highest / storeys as f64 * 1e3).round() / 1e3;
    let mut building = Building::new(name, "m", floor_height, boxes, Vec::new(), Vec::new())?;
    building.unobserved = vec![Hidden::Porch, Hidden::Facades, Hidden::Special];
    Ok(Surveyed {
        building,
        fit,
        year: known.year,
    })
}

/// Calls a box a garage that looks like one, at most one.
fn garage(boxes: &mut [MassBox]) {
    let area = |b: &MassBox| b.width * b.depth;
    let largest = boxes.iter().map(area).fold(0.0, f64::max);
    let (lowest, [least, most]) = GARAGE;
    let looks = |b: &&mut MassBox| {
        let own = area(b);
        b.roof.style == RoofStyle::Flat
            && b.height < lowest
            && (least..=most).contains(&own)
            && own <= largest / 2.0
            && b.width.min(b.depth) >= 2.4
    };
    let found = boxes.iter_mut().filter(looks);
    if let Some(b) = found.min_by(|a, b| area(a).total_cmp(&area(b))) {
        b.style = BoxStyle::Garage;
    }
}
