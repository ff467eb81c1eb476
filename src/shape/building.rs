//! Parametric buildings: boxes, roofs and facade pieces (Fan and Wonka 2016, Sec. 4.1).
//!
//! The mass model is the union of overlapping boxes that stand on the ground. x runs from left to
//! right as seen from the front, y from the front to the back, z up; all lengths are in the
//! building's unit. Build a value with [`Building::new`], which checks every number.

use serde::{Deserialize, Serialize};

use super::Rect;
use super::building_error::BuildingError;
use super::hidden::Hidden;

/// The kind of a box of the mass model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BoxStyle {
    /// A general part of the house.
    Main,
    /// A garage.
    Garage,
    /// A porch, front or back by where it lies.
    Porch,
}

/// Style of a roof.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RoofStyle {
    /// Level.
    Flat,
    /// Two slopes.
    Gable,
    /// Four slopes.
    Hip,
    /// One slope.
    Shed,
    /// A cone, over towers.
    Cone,
}

/// Direction of a ridge in plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ridge {
    /// Along the width.
    X,
    /// Along the depth.
    Y,
}

/// Roof of a box.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Roof {
    /// Style.
    pub style: RoofStyle,
    /// Slope in degrees, from 0 to below 90.
    pub pitch: f64,
    /// Orientation flag.
    pub ridge: Ridge,
}

/// A box of the mass model, standing on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MassBox {
    /// Kind of the box.
    pub style: BoxStyle,
    /// Centre along x.
    pub x: f64,
    /// Centre along y.
    pub y: f64,
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub depth: f64,
    /// Extent along z, without the roof.
    pub height: f64,
    /// Its roof.
    pub roof: Roof,
}

impl MassBox {
    /// The box seen from above.
    pub fn plan(&self) -> Rect {
        Rect::new(
            self.x - self.width / 2.0,
            self.y - self.depth / 2.0,
            self.width,
            self.depth,
        )
    }
}

/// A side of the building.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Towards smaller y: the street.
    Front,
    /// Towards larger y.
    Back,
    /// Towards smaller x.
    Left,
    /// Towards larger x.
    Right,
}

impl Side {
    /// All four, in the order of the attributes.
    pub const ALL: [Side; 4] = [Side::Front, Side::Back, Side::Left, Side::Right];

    /// `"front"`, `"back"`, `"left"` or `"right"`.
    pub fn name(self) -> &'static str {
        match self {
            Side::Front => "front",
            Side::Back => "back",
            Side::Left => "left",
            Side::Right => "right",
        }
    }
}

/// Kind and style of a facade element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementStyle {
    /// Window whose sashes slide up and down.
    Sash,
    /// Window whose leaves slide sideways.
    Sliding,
    /// Window on side hinges.
    Casement,
    /// Bay window.
    Bay,
    /// Window that does not open.
    Fixed,
    /// A door.
    Door,
}

/// A window or door on a facade piece.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FacadeElement {
    /// Kind and style.
    pub style: ElementStyle,
    /// Left edge, from the start of the piece.
    pub x: f64,
    /// Lower edge, from the base of the piece.
    pub y: f64,
    /// Extent along the piece.
    pub width: f64,
    /// Extent upwards.
    pub height: f64,
}

impl FacadeElement {
    /// Its rectangle in the coordinates of the piece.
    pub fn rect(&self) -> Rect {
        Rect::new(self.x, self.y, self.width, self.height)
    }
}

/// A plane piece of wall on one side of the building.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FacadePiece {
    /// The side it belongs to.
    pub side: Side,
    /// Its start along the side: x for front and back, y for left and right.
    pub start: f64,
    /// Height of its lower edge above the ground.
    pub base: f64,
    /// Extent along the side.
    pub width: f64,
    /// Extent upwards.
    pub height: f64,
    /// Its windows and doors.
    pub elements: Vec<FacadeElement>,
}

impl FacadePiece {
    /// Area in squared units.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }
}

/// A special element of the building.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Special {
    /// A chimney.
    Chimney,
    /// A tower.
    Tower,
}

/// A house seen from outside. A side without facade pieces has not been observed.
#[derive(Debug, Clone, PartialEq)]
pub struct Building {
    /// Name, for tables.
    pub name: String,
    /// Unit of all lengths, for example `m`.
    pub unit: String,
    /// Height of a floor: a box has floor k when it reaches the middle of that floor.
    pub floor_height: f64,
    /// The mass model.
    pub boxes: Vec<MassBox>,
    /// The facade pieces of all sides.
    pub facades: Vec<FacadePiece>,
    /// Special elements that are present.
    pub special: Vec<Special>,
    /// Parts that have not been looked at, for example in a city model without windows; none for a whole house.
    pub unobserved: Vec<Hidden>,
}

impl Building {
    /// Checks and builds a building.
    ///
    /// # Errors
    /// [`BuildingError`] for a unit that is none of m, cm, mm, ft and in, no box at all, a floor height or a size that
    /// is not positive, a number that is not finite or beyond 500 m, more than 100 floors, a pitch outside `[0, 90)`, a
    /// facade piece below the ground, an element that reaches outside its piece.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        floor_height: f64,
        boxes: Vec<MassBox>,
        facades: Vec<FacadePiece>,
        special: Vec<Special>,
    ) -> Result<Self, BuildingError> {
        let unit = unit.into();
        let known = UNITS.iter().find(|(name, _)| *name == unit);
        let Some((_, in_metre)) = known else {
            return Err(BuildingError::Unit { unit });
        };
        let bounds = Bounds {
            most: LARGEST * in_metre,
            farthest: FARTHEST * in_metre,
        };
        bounds.positive(|| "floor_height".into(), floor_height)?;
        if boxes.is_empty() {
            return Err(BuildingError::NoBoxes);
        }
        for (i, b) in boxes.iter().enumerate() {
            check_box(i, b, &bounds)?;
            let floors = b.height / floor_height;
            if floors > MOST_FLOORS {
                return Err(BuildingError::Floors { index: i, floors });
            }
        }
        for (i, piece) in facades.iter().enumerate() {
            check_piece(i, piece, &bounds)?;
        }
        Ok(Self {
            name: name.into(),
            unit,
            floor_height,
            boxes,
            facades,
            special,
            unobserved: Vec::new(),
        })
    }

    /// True if a part has not been looked at.
    pub fn is_unobserved(&self, part: Hidden) -> bool {
        self.unobserved.contains(&part)
    }

    /// Number of floors the box reaches, at least 1.
    pub fn floors_of(&self, b: &MassBox) -> usize {
        // Floor k is reached when height >= (k + 1/2) floor heights; every box stands on floor 0.
        ((b.height / self.floor_height + 0.5).floor() as usize).max(1)
    }

    /// Number of floors of the building, at least 1.
    pub fn floors(&self) -> usize {
        let floors = self.boxes.iter().map(|b| self.floors_of(b));
        floors.max().unwrap_or(1)
    }

    /// Plans of the boxes that reach floor `k` (0 is the ground floor).
    pub fn floor_plan(&self, k: usize) -> Vec<Rect> {
        let reaching = self.boxes.iter().filter(|b| self.floors_of(b) > k);
        reaching.map(MassBox::plan).collect()
    }
}

/// Units of length and how many of them a metre has.
const UNITS: [(&str, f64); 5] = [
    ("m", 1.0),
    ("cm", 100.0),
    ("mm", 1000.0),
    ("ft", 3.280_84),
    ("in", 39.370_1),
];
/// Largest size of a building and farthest coordinate from the origin (m), and most floors of a box.
const LARGEST: f64 = 500.0;
const FARTHEST: f64 = 1e4;
const MOST_FLOORS: f64 = 100.0;

/// Bounds of the numbers of a building, in its unit of length.
struct Bounds {
    /// Largest size.
    most: f64,
    /// Farthest coordinate.
    farthest: f64,
}

impl Bounds {
    /// A coordinate of a box.
    fn coordinate(&self, place: impl Fn() -> String, value: f64) -> Result<(), BuildingError> {
        Self::within(self.farthest, place, value)
    }

    fn finite(&self, place: impl Fn() -> String, value: f64) -> Result<(), BuildingError> {
        Self::within(self.most, place, value)
    }

    fn within(most: f64, place: impl Fn() -> String, value: f64) -> Result<(), BuildingError> {
        if !value.is_finite() {
            return Err(BuildingError::NotFinite {
                place: place(),
                value,
            });
        }
        if value.abs() > most {
            return Err(BuildingError::TooLarge {
                place: place(),
                value,
                most,
            });
        }
        Ok(())
    }

    fn positive(&self, place: impl Fn() -> String, value: f64) -> Result<(), BuildingError> {
        if !(value.is_finite() && value > 0.0) {
            return Err(BuildingError::NotPositive {
                place: place(),
                value,
            });
        }
        self.finite(place, value)
    }
}

fn check_box(i: usize, b: &MassBox, bounds: &Bounds) -> Result<(), BuildingError> {
    let at = |field: &str| format!("boxes[{i}].{field}");
    bounds.coordinate(|| at("x"), b.x)?;
    bounds.coordinate(|| at("y"), b.y)?;
    bounds.positive(|| at("width"), b.width)?;
    bounds.positive(|| at("depth"), b.depth)?;
    bounds.positive(|| at("height"), b.height)?;
    if !(0.0..90.0).contains(&b.roof.pitch) {
        return Err(BuildingError::Pitch {
            index: i,
            value: b.roof.pitch,
        });
    }
    Ok(())
}

fn check_piece(i: usize, piece: &FacadePiece, bounds: &Bounds) -> Result<(), BuildingError> {
    let at = |field: &str| format!("facades[{i}].{field}");
    bounds.coordinate(|| at("start"), piece.start)?;
    bounds.finite(|| at("base"), piece.base)?;
    bounds.positive(|| at("width"), piece.width)?;
    bounds.positive(|| at("height"), piece.height)?;
    if piece.base < 0.0 {
        return Err(BuildingError::Underground {
            index: i,
            base: piece.base,
        });
    }
    // Sums of rounded numbers may pass the edge by a rounding error, never by more.
    let slack = 1e-6 * piece.width.max(piece.height);
    for (k, e) in piece.elements.iter().enumerate() {
        let at = |field: &str| format!("facades[{i}].elements[{k}].{field}");
        bounds.finite(|| at("x"), e.x)?;
        bounds.finite(|| at("y"), e.y)?;
        bounds.positive(|| at("width"), e.width)?;
        bounds.positive(|| at("height"), e.height)?;
        let r = e.rect();
        if r.x < -slack
            || r.y < -slack
            || r.right() > piece.width + slack
            || r.top() > piece.height + slack
        {
            return Err(BuildingError::ElementOutside {
                piece: i,
                element: k,
                width: piece.width,
                height: piece.height,
            });
        }
    }
    Ok(())
}
