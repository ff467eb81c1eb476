//! Element layouts from facades of any source: which part is facade, which regions are elements.
//!
//! - CMP: cropped to the object `facade` where there is exactly one.
//! - Label pictures (ECP, Graz): cropped to the rows and columns that hold more than sky, void and chimney.
//! - Layouts that spell out windows (`glass`, `frame`): connected pieces are one window.

use super::{Class, Element, Layout};
use edifice_shape::{Facade, GridError, LabelGrid, Labelled, Rect, Span, components};

/// Labels around a facade in a picture.
const AROUND: [&str; 5] = ["sky", "void", "chimney", "unlabelled", "background"];
/// Labels of the parts of a window; dormers and shutters are not.
const WINDOW_PARTS: [&str; 3] = ["glass", "frame", "window"];
/// Elements thinner than this share of the facade's longer side are specks.
const SPECK: f64 = 0.004;

/// Elements of a facade in either form.
///
/// # Errors
/// [`GridError`] as [`of_facade`] and [`of_picture`].
pub fn elements(labelled: &Labelled) -> Result<Layout, GridError> {
    match labelled {
        Labelled::Layout(facade) => of_facade(facade),
        Labelled::Picture(grid) => of_picture(grid),
    }
}

/// Elements of a layout of rectangles. With exactly one region `facade` the layout is cropped to it.
///
/// # Errors
/// [`GridError`] when a tiling that spells out its windows cannot be drawn as a grid.
pub fn of_facade(facade: &Facade) -> Result<Layout, GridError> {
    let mut frames = facade.regions.iter().filter(|r| r.label == "facade");
    let frame = match (frames.next(), frames.next()) {
        (Some(frame), None) => frame.rect,
        _ => facade.domain(),
    };
    if facade.regions.iter().any(|r| r.label == "glass")
        && let Ok(grid) = LabelGrid::from_facade(facade, None)
    {
        return of_parts(&grid);
    }
    let elements = facade.regions.iter().filter_map(|r| {
        let class = Class::of_label(&r.label)?;
        Some(Element::new(class, r.rect))
    });
    Ok(cropped(&facade.name, frame, elements))
}

/// Elements of a label picture, cropped to the facade.
///
/// # Errors
/// [`GridError`] when the grid is not valid.
pub fn of_picture(grid: &LabelGrid) -> Result<Layout, GridError> {
    grid.check()?;
    let outside = |cell: usize| AROUND.contains(&grid.labels[cell].as_str());
    let columns = grid.columns();
    let inside =
        |row: usize, column: usize| !outside(usize::from(grid.cells[row * columns + column]));
    let mut frame = Span {
        left: columns,
        right: 0,
        bottom: grid.rows(),
        top: 0,
    };
    for row in 0..grid.rows() {
        for column in (0..columns).filter(|&column| inside(row, column)) {
            frame.left = frame.left.min(column);
            frame.right = frame.right.max(column + 1);
            frame.bottom = frame.bottom.min(row);
            frame.top = frame.top.max(row + 1);
        }
    }
    if frame.left >= frame.right {
        frame = whole(grid);
    }
    let class = |label: usize| Class::of_label(&grid.labels[label]);
    Ok(cropped(&grid.name, rect(grid, frame), areas(grid, class)))
}

/// Elements of a tiling in which windows are made of parts.
fn of_parts(grid: &LabelGrid) -> Result<Layout, GridError> {
    // One label for all parts, so that they connect.
    let window = grid.labels.iter().position(|l| l == "glass").unwrap_or(0);
    let is_part = |label: &str| WINDOW_PARTS.contains(&label);
    let mut joined = grid.clone();
    for cell in &mut joined.cells {
        if is_part(&grid.labels[usize::from(*cell)]) {
            // The index of a label of this grid fits its cells.
            *cell = window.try_into().unwrap_or(*cell);
        }
    }
    let class = |label: usize| match label == window {
        true => Some(Class::Window),
        false => Class::of_label(&grid.labels[label]),
    };
    joined.check()?;
    let frame = rect(grid, whole(grid));
    Ok(cropped(&grid.name, frame, areas(&joined, class)))
}

/// The connected areas of a picture that are elements.
fn areas(grid: &LabelGrid, class: impl Fn(usize) -> Option<Class>) -> Vec<Element> {
    let areas = components(grid, whole(grid), &mut vec![0; grid.cells.len()]);
    let elements = areas.iter().filter_map(|area| {
        let class = class(usize::from(area.label))?;
        Some(Element::new(class, rect(grid, area.bounds)))
    });
    elements.collect()
}

fn whole(grid: &LabelGrid) -> Span {
    Span {
        left: 0,
        right: grid.columns(),
        bottom: 0,
        top: grid.rows(),
    }
}

fn rect(grid: &LabelGrid, span: Span) -> Rect {
    let (x, y) = (grid.xs[span.left], grid.ys[span.bottom]);
    Rect::new(x, y, grid.xs[span.right] - x, grid.ys[span.top] - y)
}

/// The elements with their centre in `frame`, cut to it, its lower left as the origin; without specks and
/// without an element that another one of its class covers.
fn cropped(name: &str, frame: Rect, elements: impl IntoIterator<Item = Element>) -> Layout {
    let least = SPECK * frame.width.max(frame.height);
    let mut kept: Vec<Element> = Vec::new();
    for element in elements {
        let r = element.rect;
        let (x, y) = r.centre();
        let (left, bottom) = (r.x.max(frame.x), r.y.max(frame.y));
        let width = r.right().min(frame.right()) - left;
        let height = r.top().min(frame.top()) - bottom;
        if !frame.contains(x, y) || width < least || height < least {
            continue;
        }
        let rect = Rect::new(left - frame.x, bottom - frame.y, width, height);
        let twice = |other: &Element| {
            other.class == element.class
                && other.rect.overlap(&rect) > 0.5 * rect.area().min(other.rect.area())
        };
        if !kept.iter().any(twice) {
            kept.push(Element::new(element.class, rect));
        }
    }
    Layout {
        name: name.to_string(),
        width: frame.width,
        height: frame.height,
        elements: kept,
    }
}
