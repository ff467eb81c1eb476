//! Rectangles of the CMP facade database (Tylecek and Sara 2013): `cmp_bNNNN.xml`.
//!
//! The file is a list of `<object>` elements without a root (one around them is accepted). In
//! `<points>`, the two `<x>` are *rows*, as fractions of the height from the top, and the two `<y>` are
//! *columns*, as fractions of the width from the left. Both are numbers of pixels counted from 1, the
//! last one included, divided by the size of the image. Objects overlap: a label picture is painted in
//! the order of [`PAINT_ORDER`].

use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::Event;

use super::label_map::CMP;
use super::xml_place::place;
use super::{file_stem, read_bytes};
use edifice_base::{Error, Result};
use edifice_shape::{Facade, LabelGrid, Rect, Region};

/// Labels in the order in which they are painted, later over earlier; `background` lies below all
/// (`label_names.txt` of the database: descending third column).
pub const PAINT_ORDER: [&str; 11] = [
    "facade", "pillar", "cornice", "window", "shop", "deco", "molding", "blind", "door", "balcony",
    "sill",
];

/// The objects of one facade.
#[derive(Debug, Clone, PartialEq)]
pub struct CmpFacade {
    /// Name, from the file name.
    pub name: String,
    /// Objects in the order of the file.
    pub objects: Vec<CmpObject>,
}

/// A labelled rectangle in fractions of the image.
#[derive(Debug, Clone, PartialEq)]
pub struct CmpObject {
    /// One of [`CMP`].
    pub label: String,
    /// First and last row, as fractions of the height from the top.
    pub rows: [f64; 2],
    /// First and last column, as fractions of the width from the left.
    pub columns: [f64; 2],
}

/// Why a file is not a list of CMP objects.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CmpError {
    /// Malformed XML.
    #[error(transparent)]
    Xml(#[from] quick_xml::Error),
    /// The file ends inside an element.
    #[error("the file ends inside <{0}>")]
    Truncated(String),
    /// Not two `<x>` and two `<y>`.
    #[error("<{element}> stands {count} times in the object, expected 2")]
    Points {
        /// `x` or `y`.
        element: &'static str,
        /// Number of times that it stands there.
        count: usize,
    },
    /// A coordinate is not a fraction.
    #[error("<{element}> is {text:?}, expected a number from 0 to 1")]
    Fraction {
        /// `x` or `y`.
        element: &'static str,
        /// Its text.
        text: String,
    },
    /// The label is missing or not one of the database.
    #[error("<labelname> is {0:?}, expected one of the labels of CMP")]
    Label(String),
    /// The file has no object.
    #[error("no <object> in the file")]
    Empty,
}

/// Reads the objects of a file.
///
/// # Errors
/// Names the file, line and column.
pub fn read(path: &Path) -> Result<CmpFacade> {
    parse(&read_bytes(path)?, path)
}

/// Parses the objects of a file; `path` gives the name, and the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<CmpFacade> {
    let text = std::str::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    let mut reader = Reader::from_str(text);
    match parse_objects(&mut reader) {
        Ok(objects) => Ok(CmpFacade {
            name: file_stem(path),
            objects,
        }),
        Err(CmpError::Empty) => Err(Error::content(path, CmpError::Empty)),
        Err(error) => {
            let position = match error {
                CmpError::Xml(_) => reader.error_position(),
                _ => reader.buffer_position(),
            };
            Err(Error::input(path, place(bytes, position), error))
        }
    }
}

fn parse_objects(reader: &mut Reader<&[u8]>) -> Result<Vec<CmpObject>, CmpError> {
    let mut objects = Vec::new();
    let mut open: Vec<String> = Vec::new();
    let mut draft = Draft::default();
    loop {
        match reader.read_event()? {
            Event::Start(start) => {
                open.push(start.name().as_ref().to_string());
                match start.name().as_ref() {
                    "object" => draft = Draft::default(),
                    "x" => draft.xs.push(String::new()),
                    "y" => draft.ys.push(String::new()),
                    _ => {}
                }
            }
            Event::Text(text) => {
                let text = text.xml10_content();
                match open.last().map(String::as_str) {
                    Some("x") => draft
                        .xs
                        .last_mut()
                        .into_iter()
                        .for_each(|x| x.push_str(&text)),
                    Some("y") => draft
                        .ys
                        .last_mut()
                        .into_iter()
                        .for_each(|y| y.push_str(&text)),
                    Some("labelname") => draft.label.push_str(&text),
                    _ => {}
                }
            }
            // The reader has checked that the end matches the start.
            Event::End(_) if open.pop().as_deref() == Some("object") => {
                objects.push(std::mem::take(&mut draft).finish()?);
            }
            Event::Eof => break,
            _ => {}
        }
    }
    match open.pop() {
        Some(element) => Err(CmpError::Truncated(element)),
        None if objects.is_empty() => Err(CmpError::Empty),
        None => Ok(objects),
    }
}

/// The texts of an object before they are checked.
#[derive(Default)]
struct Draft {
    label: String,
    xs: Vec<String>,
    ys: Vec<String>,
}

impl Draft {
    fn finish(self) -> Result<CmpObject, CmpError> {
        let label = self.label.trim();
        if !CMP.contains(&label) {
            return Err(CmpError::Label(label.to_string()));
        }
        Ok(CmpObject {
            label: label.to_string(),
            rows: fractions("x", &self.xs)?,
            columns: fractions("y", &self.ys)?,
        })
    }
}

/// Two fractions, the lower first.
fn fractions(element: &'static str, texts: &[String]) -> Result<[f64; 2], CmpError> {
    let [a, b] = texts else {
        let count = texts.len();
        return Err(CmpError::Points { element, count });
    };
    let parse = |text: &String| {
        let number = text.trim().parse().ok();
        number
            .filter(|v| (0.0..=1.0).contains(v))
            .ok_or_else(|| CmpError::Fraction {
                element,
                text: text.trim().to_string(),
            })
    };
    let (a, b): (f64, f64) = (parse(a)?, parse(b)?);
    Ok([a.min(b), a.max(b)])
}

impl CmpFacade {
    /// The objects as rectangles of whole pixels, y up; those without area are left out.
    fn regions(&self, width: f64, height: f64) -> Vec<Region> {
        let span = |[first, last]: [f64; 2], size: f64| {
            // From pixel numbers, counted from 1 and inclusive, to edges.
            let from = ((first * size).round() - 1.0).max(0.0);
            (from, (last * size).round().min(size))
        };
        let region = |object: &CmpObject| {
            let (left, right) = span(object.columns, width);
            let (top, bottom) = span(object.rows, height);
            Region {
                label: object.label.clone(),
                rect: Rect::new(left, height - bottom, right - left, bottom - top),
            }
        };
        let has_area = |r: &Region| r.rect.width > 0.0 && r.rect.height > 0.0;
        self.objects.iter().map(region).filter(has_area).collect()
    }

    /// The element layout: every object but the wall itself (`facade`, `background`), in the order of
    /// the file. Objects may overlap. `width` and `height` are those of the image, in pixels.
    ///
    /// # Errors
    /// [`Error::Content`] when the size is not positive.
    pub fn elements(&self, width: f64, height: f64) -> Result<Facade> {
        let mut regions = self.regions(width, height);
        regions.retain(|r| r.label != "facade" && r.label != "background");
        self.facade(width, height, regions)
    }

    /// All objects as rectangles of whole pixels, y up, the facade itself among them.
    ///
    /// # Errors
    /// As [`CmpFacade::elements`].
    pub fn layout(&self, width: f64, height: f64) -> Result<Facade> {
        self.facade(width, height, self.regions(width, height))
    }

    /// The label picture, painted in the order of the database.
    ///
    /// # Errors
    /// [`Error::Content`] when the size is not positive.
    pub fn label_grid(&self, width: f64, height: f64) -> Result<LabelGrid> {
        let mut regions = self.regions(width, height);
        let order = |r: &Region| PAINT_ORDER.iter().position(|&label| label == r.label);
        regions.sort_by_key(order);
        let facade = self.facade(width, height, regions)?;
        let grid = LabelGrid::from_facade(&facade, Some(CMP[0]));
        Ok(grid
            .map_err(|e| Error::content(self.name.as_ref(), e))?
            .merged())
    }

    fn facade(&self, width: f64, height: f64, regions: Vec<Region>) -> Result<Facade> {
        Facade::new(self.name.clone(), "px", width, height, regions)
            .map_err(|e| Error::content(self.name.as_ref(), e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str =
        "<object><points>\r\n<x>\r\n0.2\r\n</x><x>0.5</x><y>0.1</y><y>0.3</y></points>
        <label>3</label><labelname>\nwindow\n</labelname></object>
        <object><points><x>0.1</x><x>1</x><y>0.1</y><y>1</y></points><label>2</label>
        <labelname>facade</labelname></object>";

    #[test]
    fn x_is_rows_and_y_is_columns() {
        let facade = parse(GOOD.as_bytes(), "cmp_b0001.xml".as_ref()).unwrap();
        assert_eq!(facade.name, "cmp_b0001");
        let elements = facade.elements(10.0, 20.0).unwrap();
        assert_eq!(elements.regions.len(), 1);
        // Columns 1 to 3, rows 4 to 10 of 20 from the top, counted from 1.
        assert_eq!(elements.regions[0].rect, Rect::new(0.0, 10.0, 3.0, 7.0));
        let grid = facade.label_grid(10.0, 20.0).unwrap();
        assert_eq!(grid.labels, ["background", "facade", "window"]);
        let wrapped = format!("<annotation>{GOOD}</annotation>");
        assert_eq!(
            parse(wrapped.as_bytes(), "cmp_b0001.xml".as_ref()).unwrap(),
            facade
        );
    }

    #[test]
    fn bad_files_name_their_place() {
        let cases = [
            ("0.5", "1.5", "line 7, column 22: <x> is \"1.5\""),
            ("0.5", "NaN", "<x> is \"NaN\""),
            ("<x>0.5</x>", "", "<x> stands 1 times"),
            ("window", "widow", "<labelname> is \"widow\""),
            ("</points>", "", "line 7, column 13"),
            (
                "<labelname>facade</labelname></object>",
                "",
                "ends inside <object>",
            ),
        ];
        for (from, to, expected) in cases {
            let text = GOOD.replacen(from, to, 1);
            let message = parse(text.as_bytes(), "a.xml".as_ref())
                .unwrap_err()
                .to_string();
            assert!(message.contains(expected), "{to}: {message}");
        }
        assert!(
            parse(b"hello", "a.xml".as_ref())
                .unwrap_err()
                .to_string()
                .contains("no <object>")
        );
    }
}
