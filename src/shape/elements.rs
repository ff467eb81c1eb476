//! The elements of a facade (windows, doors, ...) without the wall that they lie on.

use super::components::components;
use super::{Facade, GridError, LabelGrid, Rect, Region, Span};

/// Labels of what lies behind the elements.
pub const BACKGROUND_LABELS: [&str; 6] = ["wall", "facade", "background", "sky", "roof", "void"];

/// True if a label names the surface behind the elements rather than an element.
pub fn is_background(label: &str) -> bool {
    BACKGROUND_LABELS
        .iter()
        .any(|b| b.eq_ignore_ascii_case(label))
}

/// The element layout of a label picture: one region for each connected area that is not background,
/// from the bottom up, then from the left; of areas that are not rectangles, the smallest rectangle
/// around them.
///
/// # Errors
/// [`GridError`] when the grid is not [valid](LabelGrid::check).
pub fn elements_of_grid(grid: &LabelGrid) -> Result<Facade, GridError> {
    grid.check()?;
    let whole = Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    };
    let areas = components(grid, whole, &mut vec![0; grid.cells.len()]);
    let regions = areas.iter().map(|area| {
        let b = area.bounds;
        let (x, y) = (grid.xs[b.left], grid.ys[b.bottom]);
        Region {
            label: grid.labels[usize::from(area.label)].clone(),
            rect: Rect::new(x, y, grid.xs[b.right] - x, grid.ys[b.top] - y),
        }
    });
    let elements = regions.filter(|r| !is_background(&r.label)).collect();
    let (width, height) = (grid.xs[grid.columns()], grid.ys[grid.rows()]);
    Ok(Facade::new(
        grid.name.clone(),
        grid.unit.clone(),
        width,
        height,
        elements,
    )?)
}

/// The element layout of a layout: its regions that are not background. In a tiling, touching regions
/// of one label are one element, as an element may have been cut to make the tiling.
pub fn elements_of_facade(facade: &Facade) -> Facade {
    let tiling = LabelGrid::from_facade(facade, None).and_then(|grid| elements_of_grid(&grid));
    tiling.unwrap_or_else(|_| {
        let mut elements = facade.clone();
        elements.regions.retain(|r| !is_background(&r.label));
        elements
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(label: &str, x: f64, y: f64, width: f64, height: f64) -> Region {
        Region {
            label: label.into(),
            rect: Rect::new(x, y, width, height),
        }
    }

    #[test]
    fn pieces_of_one_window_are_one_element() {
        let regions = vec![
            region("Wall", 0.0, 0.0, 1.0, 2.0),
            region("window", 1.0, 0.0, 1.0, 1.0),
            region("window", 1.0, 1.0, 1.0, 1.0),
        ];
        let mut facade = Facade::new("f", "px", 2.0, 2.0, regions).unwrap();
        let elements = elements_of_facade(&facade);
        assert_eq!(elements.regions, [region("window", 1.0, 0.0, 1.0, 2.0)]);
        // Not a tiling: regions stay as they are.
        facade.regions.remove(0);
        assert_eq!(elements_of_facade(&facade).regions.len(), 2);
    }
}
