//! The common parts of the files of annotation tools: boxes in image coordinates, y down.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_shape::{Rect, Region};

/// A box in an image: edges in pixels, from the left and from the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ImageBox {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

/// A box that has no area, or none inside its image.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(super) enum BoxError {
    #[error("the box is {width} x {height}, expected sizes above zero")]
    Empty { width: f64, height: f64 },
    #[error("the box lies outside the image of {width} x {height}")]
    Outside { width: f64, height: f64 },
}

/// Checks a side of an image, which stands at `place` in the file.
pub(super) fn check_side(value: f64, path: &Path, place: &str) -> Result<()> {
    match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => {
            let message = format!("{value}, expected a positive number");
            Err(Error::input(path, place, message))
        }
    }
}

impl ImageBox {
    /// The smallest box around points; `None` without points.
    pub(crate) fn around(points: &[[f64; 2]]) -> Option<Self> {
        let mut points = points.iter();
        let &[x, y] = points.next()?;
        let first = Self {
            left: x,
            top: y,
            right: x,
            bottom: y,
        };
        Some(points.fold(first, |b, &[x, y]| Self {
            left: b.left.min(x),
            top: b.top.min(y),
            right: b.right.max(x),
            bottom: b.bottom.max(y),
        }))
    }

    /// The region of the box in an image of `width` x `height`, y up. What hangs over the border of the
    /// image, as hand-drawn boxes do, is cut off. Both sides of the image must be above zero.
    pub(crate) fn region(self, label: &str, width: f64, height: f64) -> Result<Region, BoxError> {
        let (x, y) = (self.right - self.left, self.bottom - self.top);
        if !(x > 0.0 && y > 0.0) {
            return Err(BoxError::Empty {
                width: x,
                height: y,
            });
        }
        let (left, right) = (self.left.clamp(0.0, width), self.right.clamp(0.0, width));
        let (top, bottom) = (self.top.clamp(0.0, height), self.bottom.clamp(0.0, height));
        if !(right > left && bottom > top) {
            return Err(BoxError::Outside { width, height });
        }
        Ok(Region {
            label: label.to_owned(),
            rect: Rect::new(left, height - bottom, right - left, bottom - top),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_turned_cut_and_checked() {
        let around = ImageBox::around(&[[3.0, 8.0], [1.0, 9.5], [2.0, 12.0]]).unwrap();
        let region = around.region("door", 20.0, 10.0).unwrap();
        // Two pixels hang over the lower border.
        assert_eq!(region.rect, Rect::new(1.0, 0.0, 2.0, 2.0));
        assert_eq!(ImageBox::around(&[]), None);
        let line = ImageBox::around(&[[1.0, 1.0], [1.0, 5.0]]).unwrap();
        assert!(matches!(
            line.region("a", 9.0, 9.0),
            Err(BoxError::Empty { .. })
        ));
        let away = ImageBox::around(&[[30.0, 1.0], [31.0, 5.0]]).unwrap();
        assert!(matches!(
            away.region("a", 9.0, 9.0),
            Err(BoxError::Outside { .. })
        ));
    }
}
