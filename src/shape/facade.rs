//! Facade layouts: labelled rectangles in a rectangular domain.
//!
//! A *tiling* covers the domain without gaps or overlaps (what grammar inference needs); an
//! *element layout* lists only windows, doors, ... on a wall (what structure completion needs).
//! Source: Wu et al. 2014, Sec. 3.1.

use super::Rect;

/// A terminal region: a rectangle and its material.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Material or element name, for example `window`.
    pub label: String,
    /// Its place, in the facade's coordinates.
    pub rect: Rect,
}

/// A facade layout. Build it with [`Facade::new`], which checks every region.
#[derive(Debug, Clone, PartialEq)]
pub struct Facade {
    /// Name, for tables and file names.
    pub name: String,
    /// Unit of all lengths, for example `px` or `m`.
    pub unit: String,
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// The regions, in the order of the file.
    pub regions: Vec<Region>,
}

/// Why a list of rectangles is not a layout, or a layout not a tiling.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LayoutError {
    /// Width or height of the facade is not a positive number.
    #[error("facade {dimension} is {value}, expected a positive number")]
    FacadeSize {
        /// `width` or `height`.
        dimension: &'static str,
        /// The value found.
        value: f64,
    },
    /// A coordinate or size of a region is not finite, or a size is not positive.
    #[error("regions[{index}].{field} is {value}, expected a finite number{}", if *.positive { " above zero" } else { "" })]
    RegionNumber {
        /// Index of the region.
        index: usize,
        /// `x`, `y`, `width` or `height`.
        field: &'static str,
        /// The value found.
        value: f64,
        /// True if the field must be above zero.
        positive: bool,
    },
    /// A region has an empty label.
    #[error("regions[{index}].label is empty")]
    EmptyLabel {
        /// Index of the region.
        index: usize,
    },
    /// A region reaches outside the facade.
    #[error("regions[{index}] ({label}) reaches outside the facade of {width} x {height}")]
    Outside {
        /// Index of the region.
        index: usize,
        /// Its label.
        label: String,
        /// Width of the facade.
        width: f64,
        /// Height of the facade.
        height: f64,
    },
    /// Two regions overlap.
    #[error(
        "regions[{first}] ({first_label}) and regions[{second}] ({second_label}) overlap at ({x}, {y})"
    )]
    Overlap {
        /// Index of one region.
        first: usize,
        /// Its label.
        first_label: String,
        /// Index of the other.
        second: usize,
        /// Its label.
        second_label: String,
        /// A point in the overlap.
        x: f64,
        /// A point in the overlap.
        y: f64,
    },
    /// A place that no region covers.
    #[error("no region covers the place from ({x}, {y}) to ({right}, {top})")]
    Gap {
        /// Left of an uncovered cell.
        x: f64,
        /// Its bottom.
        y: f64,
        /// Its right.
        right: f64,
        /// Its top.
        top: f64,
    },
    /// No full line splits a part of the facade (Wu et al. 2014, Sec. 6.3).
    #[error(
        "no full line splits the {count} regions from ({x}, {y}) to ({right}, {top}), regions[{index}] ({label}) first"
    )]
    Unsplittable {
        /// Left of the part.
        x: f64,
        /// Its bottom.
        y: f64,
        /// Its right.
        right: f64,
        /// Its top.
        top: f64,
        /// Number of its regions.
        count: usize,
        /// Lowest index among them.
        index: usize,
        /// The label of that region.
        label: String,
    },
    /// A region is thinner than what counts as a difference.
    #[error("regions[{index}] ({label}) is thinner than {tolerance}")]
    TooThin {
        /// Index of the region.
        index: usize,
        /// Its label.
        label: String,
        /// Longest difference that counts as none.
        tolerance: f64,
    },
    /// The facade has no region at all.
    #[error("the facade has no regions")]
    Empty,
}

impl Facade {
    /// Checks and builds a layout (tiling or element layout).
    ///
    /// # Errors
    /// [`LayoutError`] for a facade without positive size, a region with a number that is not
    /// finite, no positive size, no label, or that reaches outside the facade.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        width: f64,
        height: f64,
        regions: Vec<Region>,
    ) -> Result<Self, LayoutError> {
        for (dimension, value) in [("width", width), ("height", height)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LayoutError::FacadeSize { dimension, value });
            }
        }
        let slack = 1e-9 * width.max(height);
        for (index, region) in regions.iter().enumerate() {
            let r = region.rect;
            let fields = [
                ("x", r.x, false),
                ("y", r.y, false),
                ("width", r.width, true),
                ("height", r.height, true),
            ];
            for (field, value, positive) in fields {
                if !value.is_finite() || (positive && value <= 0.0) {
                    return Err(LayoutError::RegionNumber {
                        index,
                        field,
                        value,
                        positive,
                    });
                }
            }
            if region.label.is_empty() {
                return Err(LayoutError::EmptyLabel { index });
            }
            if r.x < -slack || r.y < -slack || r.right() > width + slack || r.top() > height + slack
            {
                return Err(LayoutError::Outside {
                    index,
                    label: region.label.clone(),
                    width,
                    height,
                });
            }
        }
        Ok(Self {
            name: name.into(),
            unit: unit.into(),
            width,
            height,
            regions,
        })
    }

    /// The whole domain.
    pub fn domain(&self) -> Rect {
        Rect::new(0.0, 0.0, self.width, self.height)
    }
}
