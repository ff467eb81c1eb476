//! Elements that method `paper` reuses: sub-styles of the database, and those of the house with the most similar
//! styles (Sec. 6.2).

use rand::Rng;

use super::styles::WINDOWS;
use crate::house::Database;
use edifice_cluster::kmeans;
use edifice_shape::{ElementStyle, FacadeElement};

/// Sub-styles of each style (Sec. 6.2).
const SUB_STYLES: usize = 5;
/// Most steps of k-means.
const STEPS: usize = 50;
/// Columns of the ten style attributes.
const FLAGS: std::ops::Range<usize> = 39..49;

/// Average element of a sub-style, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubStyle {
    /// Its style.
    pub style: ElementStyle,
    /// Average width.
    pub width: f64,
    /// Average height.
    pub height: f64,
    /// Average height of the lower edge over the floor.
    pub sill: f64,
}

/// The sub-styles of windows and doors of which the facades of a house are made.
#[derive(Debug, Clone, PartialEq)]
pub struct Elements {
    /// Sub-styles of the windows of the house with the most similar styles.
    pub windows: Vec<SubStyle>,
    /// Sub-styles of the doors of that house.
    pub doors: Vec<SubStyle>,
    /// Average width of wall between its elements, and between these and the ends of a piece (m).
    pub gap: f64,
    /// Index of that house in the database.
    pub house: usize,
}

/// Sub-styles by k-means on the sizes of all elements of a style, five for each, and of these the ones that occur on
/// the house whose style attributes differ least from `flags` (the first of several).
pub fn elements(
    database: &Database,
    flags: &[bool; 10],
    leave_out: Option<usize>,
    rng: &mut impl Rng,
) -> Elements {
    let differences = |house: usize| {
        let row = FLAGS.zip(flags);
        row.filter(|(c, flag)| (database.rows[house][*c].unwrap_or(0.0) > 0.5) != **flag)
            .count()
    };
    let houses = (0..database.buildings.len()).filter(|h| Some(*h) != leave_out);
    let house = houses.min_by_key(|h| differences(*h)).unwrap_or(0);
    let of_style = |style, rng: &mut _| sub_styles(database, style, house, rng);
    let windows = WINDOWS.into_iter();
    Elements {
        windows: windows.flat_map(|s| of_style(s, rng)).collect(),
        doors: of_style(ElementStyle::Door, rng),
        gap: average_gap(database, house),
        house,
    }
}

/// The sub-styles of a style that occur on a house.
fn sub_styles(
    database: &Database,
    style: ElementStyle,
    house: usize,
    rng: &mut impl Rng,
) -> Vec<SubStyle> {
    let mut own: Vec<(usize, &FacadeElement)> = Vec::new();
    for (h, building) in database.buildings.iter().enumerate() {
        let elements = building.facades.iter().flat_map(|p| &p.elements);
        own.extend(elements.filter(|e| e.style == style).map(|e| (h, e)));
    }
    if own.is_empty() {
        return Vec::new();
    }
    let sizes: Vec<f64> = own.iter().flat_map(|(_, e)| [e.width, e.height]).collect();
    let weights = vec![1.0; own.len()];
    let labels = kmeans(&sizes, 2, &weights, SUB_STYLES, STEPS, rng).labels;
    let average = |k: usize| {
        let members = || {
            let labelled = own.iter().zip(&labels).filter(move |(_, l)| **l == k);
            labelled.map(|((h, e), _)| (*h, *e))
        };
        members().find(|(h, _)| *h == house)?;
        let n = members().count() as f64;
        let mean =
            |value: fn(&FacadeElement) -> f64| members().map(|(_, e)| value(e)).sum::<f64>() / n;
        Some(SubStyle {
            style,
            width: mean(|e| e.width),
            height: mean(|e| e.height),
            sill: mean(|e| e.y),
        })
    };
    (0..SUB_STYLES).filter_map(average).collect()
}

/// Bare wall of the pieces with elements over the number of gaps that it is parted into.
fn average_gap(database: &Database, house: usize) -> f64 {
    let (mut bare, mut gaps) = (0.0, 0.0);
    let pieces = database.buildings[house].facades.iter();
    for piece in pieces.filter(|p| !p.elements.is_empty()) {
        bare += piece.width - piece.elements.iter().map(|e| e.width).sum::<f64>();
        gaps += piece.elements.len() as f64 + 1.0;
    }
    if gaps > 0.0 {
        (bare / gaps).max(0.1)
    } else {
        1.0
    }
}
