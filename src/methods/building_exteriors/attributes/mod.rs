//! The attribute-based representation of a building (Sec. 4.2 and Appendix A): 49 numbers in 13
//! groups.
//!
//! With `Flr_k` the union of the plans of the boxes that reach floor `k`, `BB` a bounding box:
//!
//! | group | columns | definition |
//! | --- | --- | --- |
//! | `bbox` | w, d, h | extents of the mass model, in the building's unit |
//! | `bcr` | 1 | `Area(Flr_0) / Area(BB(Flr_0))` |
//! | `bdry` | 1 | `Perimeter(Flr_0) / sqrt(Area(Flr_0))` |
//! | `far` | 1 | `sum_k Area(Flr_k) / Area(BB(Flr_0))` |
//! | `arf` | 3 | `Area(Flr_k) / sum_j Area(Flr_j)`, k = 0, 1, 2 |
//! | `garage` | 6 | position (x, y) in `BB(Flr_0)`, size (w, d, h), `Visible / Perimeter` |
//! | `porch` | 12 | the same of the front porch, then of the back porch |
//! | `wwr` | 4 sides | `sum_k Area(e_k) / sum_j Area(f_j)` over elements e and pieces f |
//! | `symmetry` | 4 sides | `sum_j Area(f_j) IsSymmetric(f_j) / sum_j Area(f_j)` |
//! | `alignment` | 4 sides | aligned pairs of pieces / pairs that can be aligned |
//! | `roof` | flat, gable, hip | 1 where the style is present |
//! | `window` | sash, sliding, casement, bay, fixed | 1 where the style is present |
//! | `special` | chimney, tower | 1 where present |
//!
//! # Deviations and readings
//! - All boxes, garage and porches included, belong to the mass model, so to `Flr_0` and to both
//!   bounding boxes; the roof does not count in `h`.
//! - A box has floor k when it reaches the middle of that floor (the paper leaves floors open).
//! - Position is the centre of the part's bounding box relative to the lower-left corner of
//!   `BB(Flr_0)`, divided by its width and depth: in `[0, 1]`, without unit.
//! - Several garage boxes are one garage, their union. A porch box is a front porch when its centre
//!   lies in the front half of `BB(Flr_0)`, else a back porch. No such box: all zeros (the paper).
//! - `Visible` is the part of the boundary that borders the open air; a courtyard is not open air,
//!   and an open porch in front of a garage hides it (the paper's Figure 20 draws plans only).
//! - Symmetric: mirrored left to right, every element meets one of the same style and place, within
//!   2 % of a floor height. A piece without elements is symmetric.
//! - Pieces can be aligned when one stands above the other and their extents overlap by more than
//!   that tolerance, both with elements centred in the overlap; they are aligned when every such
//!   element of the piece with fewer of them has the centre, left or right edge of one of the other.
//!   No pair: 0, as for absent garages.
//! - A side without any facade piece was not observed: its three attributes are missing, not zero; so are the window
//!   styles of a house without any piece, and the columns of parts that the house calls unobserved.
//! - Shed and cone roofs (Sec. 6.1) have no attribute, as in the paper. Doors count as facade
//!   elements for `wwr`, symmetry and alignment and have no style attribute.

mod columns;
mod facade;
mod mass;

pub use columns::{COLUMNS, GROUPS, Group, Level};

use edifice_shape::{Building, ElementStyle, Hidden, RoofStyle, Special};

/// The attributes of one building, in the order of [`COLUMNS`]; `None` is missing.
pub type AttributeRow = Vec<Option<f64>>;

/// Why a building has no attributes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AttributeError {
    /// The area ratios of floors describe at most three floors (Appendix A.1).
    #[error("{name}: {floors} floors; the attributes describe at most 3")]
    TooManyFloors {
        /// Name of the building.
        name: String,
        /// Number of its floors.
        floors: usize,
    },
}

/// Measures the 49 attributes of a building.
///
/// # Errors
/// [`AttributeError::TooManyFloors`] for more than three floors.
pub fn attributes(building: &Building) -> Result<AttributeRow, AttributeError> {
    let floors = building.floors();
    if floors > 3 {
        return Err(AttributeError::TooManyFloors {
            name: building.name.clone(),
            floors,
        });
    }
    let mut row: AttributeRow = mass::attributes(building).into_iter().map(Some).collect();
    row.extend(facade::attributes(building));
    row.extend(
        presence(building)
            .into_iter()
            .map(|p| Some(f64::from(u8::from(p)))),
    );
    debug_assert_eq!(row.len(), COLUMNS.len());
    for part in Hidden::ALL {
        let windowless = part == Hidden::Facades && building.facades.is_empty();
        if building.is_unobserved(part) || windowless {
            hidden_columns(part).for_each(|c| row[c] = None);
        }
    }
    Ok(row)
}

/// Columns that an unobserved part leaves missing.
fn hidden_columns(part: Hidden) -> Box<dyn Iterator<Item = usize>> {
    match part {
        Hidden::Garage => Box::new(9..15),
        Hidden::Porch => Box::new(15..27),
        Hidden::Facades => Box::new((27..39).chain(42..47)),
        Hidden::Roof => Box::new(39..42),
        Hidden::Special => Box::new(47..49),
    }
}

/// The 27 mass model attributes alone (Appendix A.1): what [`attributes`] begins with, for any number
/// of floors; area above the third counts for none.
pub fn mass_attributes(building: &Building) -> Vec<f64> {
    mass::attributes(building)
}

/// The twelve facade attributes alone (Appendix A.2), as they stand in [`attributes`].
pub fn facade_attributes(building: &Building) -> AttributeRow {
    facade::attributes(building)
}

/// The ten element attributes (Appendix A.3).
fn presence(building: &Building) -> [bool; 10] {
    let roof = |style| building.boxes.iter().any(|b| b.roof.style == style);
    let window = |style| {
        let mut elements = building.facades.iter().flat_map(|f| &f.elements);
        elements.any(|e| e.style == style)
    };
    [
        roof(RoofStyle::Flat),
        roof(RoofStyle::Gable),
        roof(RoofStyle::Hip),
        window(ElementStyle::Sash),
        window(ElementStyle::Sliding),
        window(ElementStyle::Casement),
        window(ElementStyle::Bay),
        window(ElementStyle::Fixed),
        building.special.contains(&Special::Chimney),
        building.special.contains(&Special::Tower),
    ]
}
