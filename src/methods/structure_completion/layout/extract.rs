//! Element layouts from facades of any source: which part is facade, which regions are elements.
//!
//! - CMP: cropped to the object `facade` where there is exactly one.
//! - Label pictures (ECP, Graz) and tilings, which are pictures by another name: cropped to the rows and columns that
//!   hold more than sky, void and chimney; connected areas are one element.
//! - Pictures and tilings that spell out windows (`glass`, `frame`): connected parts are one window.

use super::{Class, Element, Layout};
use edifice_shape::{Facade, GridError, LabelGrid, Labelled, Rect, Span, components};

/// Labels around a facade in a picture.
const AROUND: [&str; 5] = ["sky", "void", "chimney", "unlabelled", "background"];
/// Labels of the parts of a window; dormers and shutters are not.
const WINDOW_PARTS: [&str; 3] = ["glass", "frame", "window"];
/// Elements thinner than this share of the facade's longer side are specks.
const SPECK: f64 = 0.004;
/// The longer side counts as at most so many times the shorter one, so that a long row of houses keeps its windows.
const LONGEST: f64 = 4.0;
/// Places that differ by less than this share of the facade's longer side are the same.
const SAME: f64 = 1e-9;

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

/// Elements of a layout of rectangles. A tiling is read as the picture of it, so that pieces of one element are joined;
/// where none is in pieces they come in the order of the regions. Any other layout with exactly one region `facade` is
/// cropped to it.
///
/// # Errors
/// [`GridError`] when a tiling cannot be drawn as a grid.
pub fn of_facade(facade: &Facade) -> Result<Layout, GridError> {
    if facade.check_tiling().is_ok() {
        let drawn = of_picture(&LabelGrid::from_facade(facade, None)?)?;
        let written = cropped(&facade.name, facade.domain(), regions(facade));
        return Ok(match same_elements(&written, &drawn) {
            true => written,
            false => drawn,
        });
    }
    let mut frames = facade.regions.iter().filter(|r| r.label == "facade");
    let frame = match (frames.next(), frames.next()) {
        (Some(frame), None) => frame.rect,
        _ => facade.domain(),
    };
    Ok(cropped(&facade.name, frame, regions(facade)))
}

/// The regions of a layout that are elements.
fn regions(facade: &Facade) -> impl Iterator<Item = Element> {
    facade.regions.iter().filter_map(|r| {
        let class = Class::of_label(&r.label)?;
        Some(Element::new(class, r.rect))
    })
}

/// True if two layouts have the same outline and elements, in whatever order.
fn same_elements(a: &Layout, b: &Layout) -> bool {
    let slack = SAME * a.width.max(a.height);
    let near = |(a, b): (f64, f64)| (a - b).abs() <= slack;
    let same = |a: &Element, b: &Element| {
        let (p, q) = (a.rect, b.rect);
        let sides = [
            (p.x, q.x),
            (p.y, q.y),
            (p.width, q.width),
            (p.height, q.height),
        ];
        a.class == b.class && sides.into_iter().all(near)
    };
    near((a.width, b.width))
        && near((a.height, b.height))
        && a.elements.len() == b.elements.len()
        && (a.elements.iter()).all(|own| b.elements.iter().any(|other| same(own, other)))
}

/// Elements of a label picture, cropped to the facade: its connected areas, where windows are spelt out (`glass`) those
/// of their parts together.
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
    let areas = match grid.labels.iter().position(|label| label == "glass") {
        Some(glass) => whole_windows(grid, glass),
        None => areas(grid, |label| Class::of_label(&grid.labels[label])),
    };
    Ok(cropped(&grid.name, rect(grid, frame), areas))
}

/// The elements of a picture in which windows are made of parts, among them that of number `glass`.
fn whole_windows(grid: &LabelGrid, glass: usize) -> Vec<Element> {
    // One label for all parts, so that they connect.
    let is_part = |label: u16| WINDOW_PARTS.contains(&grid.labels[usize::from(label)].as_str());
    let mut joined = grid.clone();
    for cell in joined.cells.iter_mut().filter(|cell| is_part(**cell)) {
        // The index of a label of this grid fits its cells.
        *cell = glass.try_into().unwrap_or(*cell);
    }
    areas(&joined, |label| match label == glass {
        true => Some(Class::Window),
        false => Class::of_label(&grid.labels[label]),
    })
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
    let sides = [frame.width, frame.height];
    let (long, short) = (sides[0].max(sides[1]), sides[0].min(sides[1]));
    let least = SPECK * long.min(LONGEST * short);
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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::{Region, decompose};

    /// A picture of cells of 10 x 10, the uppermost row first: `s`ky, `.` wall, `w`indow, `d`oor, `g`lass, `f`rame.
    fn picture(rows: &[&str]) -> LabelGrid {
        let names = [
            ('s', "sky"),
            ('.', "wall"),
            ('w', "window"),
            ('d', "door"),
            ('g', "glass"),
            ('f', "frame"),
        ];
        let number = |c: char| names.iter().position(|(own, _)| *own == c);
        let cells = rows.iter().rev().flat_map(|row| row.chars());
        let cuts = |count: usize| (0..=count).map(|k| 10.0 * k as f64).collect();
        LabelGrid {
            name: "f".into(),
            unit: "px".into(),
            xs: cuts(rows[0].len()),
            ys: cuts(rows.len()),
            labels: names.map(|(_, name)| name.into()).to_vec(),
            cells: cells.map(|c| number(c).unwrap() as u16).collect(),
        }
    }

    #[test]
    fn a_picture_and_the_tiling_made_of_it_have_the_same_elements() {
        let whole = [
            "sssssss", "s.....s", "s.ww..s", "s.w.w.s", "s.d...s", "sdd...s",
        ];
        let parts = [
            "sssssss", "..fff..", "..fgf..", "..fgf..", "..fff.w", "....ddd",
        ];
        for (rows, windows) in [(whole, 2), (parts, 2)] {
            let grid = picture(&rows);
            let tiling = decompose(&grid).expect("a tiling").facade;
            let labels = |name: &str| tiling.regions.iter().filter(|r| r.label == name).count();
            assert!(labels("sky") > 0 && labels("window") + labels("frame") > 2);
            let (drawn, split) = (of_picture(&grid).unwrap(), of_facade(&tiling).unwrap());
            assert_eq!(drawn, split);
            assert_eq!(
                (drawn.count(Class::Window), drawn.count(Class::Door)),
                (windows, 1)
            );
            assert_eq!(drawn.height, 50.0);
        }
    }

    #[test]
    fn elements_on_a_wall_stay_apart_though_they_touch() {
        let window = |x: f64| Region {
            label: "window".into(),
            rect: Rect::new(x, 10.0, 10.0, 20.0),
        };
        let facade = Facade::new("f", "m", 60.0, 40.0, vec![window(10.0), window(20.0)]).unwrap();
        assert_eq!(of_facade(&facade).unwrap().count(Class::Window), 2);
    }

    #[test]
    fn windows_of_a_long_frontage_are_no_specks() {
        let window = |k: u32| Region {
            label: "window".into(),
            rect: Rect::new(f64::from(k), 1.0, 0.8, 1.4),
        };
        let facade = Facade::new("f", "m", 300.0, 9.0, (0..300).map(window).collect()).unwrap();
        assert_eq!(of_facade(&facade).unwrap().count(Class::Window), 300);
        let grid = LabelGrid::from_facade(&facade, Some("wall")).unwrap();
        assert_eq!(of_picture(&grid).unwrap().count(Class::Window), 300);
    }

    #[test]
    fn elements_of_a_tiling_that_are_whole_keep_their_order() {
        let mut tiling = decompose(&picture(&["....", ".w.d", "...d"]))
            .unwrap()
            .facade;
        tiling.regions.reverse();
        let written: Vec<Element> = regions(&tiling).collect();
        assert_eq!(of_facade(&tiling).unwrap().elements, written);
        tiling.regions.reverse();
        let found = of_facade(&tiling).unwrap();
        assert_eq!(found.elements, [written[1], written[0]]);
    }
}
