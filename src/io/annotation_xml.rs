//! Element layouts from XML annotations of images: Pascal VOC, and polygons as LabelMe's XML and the eTRIMS database have
//! them. One `<annotation>` a file, with an `<object>` for each element.
//!
//! ```xml
//! <annotation> <size> <width>400</width> <height>600</height> </size>
//!   <object> <name>window</name>
//!     <bndbox> <xmin>21</xmin> <ymin>41</ymin> <xmax>50</xmax> <ymax>100</ymax> </bndbox> </object>
//!   <object> <name>door</name>
//!     <polygon> <pt><x>10</x><y>500</y></pt> <pt><x>60</x><y>500</y></pt> <pt><x>60</x><y>600</y></pt> </polygon> </object>
//! </annotation>
//! ```
//! Readings:
//! - `<bndbox>` numbers pixels from 1 and includes the last one (development kit of Pascal VOC 2012, Sec. 4): the box above is 30
//!   pixels wide and 60 high. A polygon has points in pixels from the upper left; it becomes the smallest box around it. An
//!   object with both has its `<bndbox>`.
//! - The size stands in `<size>`, in `<imagesize>` (`<ncols>`, `<nrows>`; LabelMe), or is that of the picture beside the file.
//! - Objects with `<deleted>1</deleted>` (LabelMe) are left out; `<part>`s of objects are not elements.
//! - What hangs over the border of the image is cut off.
//! - Of eTRIMS (Korc and Foerstner 2009) no file may be redistributed; its objects are read as polygons of this form.

use std::path::Path;

use quick_xml::Reader;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::Event;

use super::annotation::{BoxError, ImageBox, check_side};
use super::file_stem;
use super::xml_place::place;
use edifice_base::{Error, Result};
use edifice_shape::Facade;

/// Elements in elements, at most.
const DEEPEST: usize = 32;
/// Bytes of text in an element that are kept; names and numbers are shorter.
const MOST_TEXT: usize = 1000;

/// Why a file is no annotation.
#[derive(Debug, thiserror::Error)]
enum AnnotationError {
    #[error(transparent)]
    Xml(#[from] quick_xml::Error),
    #[error("the file ends inside <{0}>")]
    Truncated(String),
    #[error("elements stand more than {DEEPEST} deep in each other")]
    TooDeep,
    #[error("<{0}> is no <annotation>")]
    Root(String),
    #[error("no <annotation> in the file")]
    Empty,
    #[error("`&{0};` is unknown")]
    Entity(String),
    #[error("<{element}> is {text:?}, expected a finite number")]
    Number { element: String, text: String },
    #[error("an object without <{0}>")]
    Missing(&'static str),
}

/// True if the text of an XML file is an annotation of this kind and not a list of CMP, which has `<labelname>`s.
pub(super) fn is_annotation(bytes: &[u8]) -> bool {
    let has = |word: &[u8]| bytes.windows(word.len()).any(|w| w == word);
    has(b"<annotation") && !has(b"<labelname")
}

/// Parses the bytes of an annotation; `path` names the layout, and the file in errors. `beside` is the size of the image in
/// pixels where the file does not state it.
///
/// # Errors
/// Names the file and the line and column of what is wrong; of a box, of the end of its object.
pub fn parse(bytes: &[u8], path: &Path, beside: Option<(f64, f64)>) -> Result<Facade> {
    let text = std::str::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    let mut reader = Reader::from_str(text);
    let mut found = Annotation::default();
    if let Err(error) = found.read(&mut reader) {
        let position = match error {
            AnnotationError::Xml(_) => reader.error_position(),
            _ => reader.buffer_position(),
        };
        return Err(Error::input(path, place(bytes, position), error));
    }
    let (width, height) = match (found.width, found.height, beside) {
        (Some(width), Some(height), _) => (width, height),
        (_, _, Some(size)) => size,
        _ => {
            let message = "neither <size> nor <imagesize>, and no PNG of the same name beside it";
            return Err(Error::content(path, message));
        }
    };
    check_side(width, path, "width of the image")?;
    check_side(height, path, "height of the image")?;
    let mut regions = Vec::with_capacity(found.objects.len());
    for object in found.objects {
        let region = object.area.region(&object.name, width, height);
        let region = region.map_err(|e: BoxError| {
            let message = format!("{}: {e}", object.name);
            Error::input(path, place(bytes, object.end), message)
        })?;
        regions.push(region);
    }
    Facade::new(file_stem(path), "px", width, height, regions).map_err(|e| Error::content(path, e))
}

/// The parts of a file that were read.
#[derive(Default)]
struct Annotation {
    width: Option<f64>,
    height: Option<f64>,
    objects: Vec<Object>,
    draft: Draft,
}

struct Object {
    name: String,
    area: ImageBox,
    /// Byte at which it ends.
    end: u64,
}

/// An object that is being read.
#[derive(Default)]
struct Draft {
    name: Option<String>,
    deleted: bool,
    /// Left, top, right and bottom of the `<bndbox>`, as written.
    edges: [Option<f64>; 4],
    points: Vec<[f64; 2]>,
    /// Coordinates of the `<pt>` that is open.
    point: [Option<f64>; 2],
}

impl Annotation {
    fn read(&mut self, reader: &mut Reader<&[u8]>) -> Result<(), AnnotationError> {
        let mut open: Vec<String> = Vec::new();
        let (mut content, mut seen) = (String::new(), false);
        loop {
            match reader.read_event()? {
                Event::Start(start) => {
                    let name = start.name().as_ref().to_owned();
                    if open.is_empty() && name != "annotation" {
                        return Err(AnnotationError::Root(name));
                    }
                    if open.len() >= DEEPEST {
                        return Err(AnnotationError::TooDeep);
                    }
                    seen = true;
                    open.push(name);
                    content.clear();
                }
                Event::Text(text) => add(&mut content, &text.xml10_content()),
                Event::CData(text) => add(&mut content, &text.xml10_content()),
                Event::GeneralRef(entity) => {
                    let known = resolve_predefined_entity(&entity);
                    let known = known.ok_or_else(|| AnnotationError::Entity(entity.to_string()))?;
                    add(&mut content, known);
                }
                // The reader has checked that the end matches the start.
                Event::End(_) => {
                    let place: Vec<&str> = open.iter().map(String::as_str).collect();
                    self.end(&place, content.trim(), reader.buffer_position())?;
                    open.pop();
                    content.clear();
                }
                Event::Eof => break,
                _ => {}
            }
        }
        match open.pop() {
            Some(element) => Err(AnnotationError::Truncated(element)),
            None if !seen => Err(AnnotationError::Empty),
            None => Ok(()),
        }
    }

    /// An element ends: `place` are the names of those that are open, it among them, and `text` is what stood in it.
    fn end(&mut self, place: &[&str], text: &str, at: u64) -> Result<(), AnnotationError> {
        let draft = &mut self.draft;
        match place {
            [_, "size", side @ "width"] | [_, "imagesize", side @ "ncols"] => {
                self.width = Some(number(side, text)?);
            }
            [_, "size", side @ "height"] | [_, "imagesize", side @ "nrows"] => {
                self.height = Some(number(side, text)?);
            }
            [_, "object", "name"] => draft.name = Some(text.to_owned()),
            [_, "object", "deleted"] => draft.deleted = text == "1",
            [_, "object", "bndbox", edge] => {
                let edges = ["xmin", "ymin", "xmax", "ymax"];
                if let Some(index) = edges.iter().position(|e| e == edge) {
                    draft.edges[index] = Some(number(edge, text)?);
                }
            }
            [_, "object", "polygon", "pt", axis @ "x"] => {
                draft.point[0] = Some(number(axis, text)?)
            }
            [_, "object", "polygon", "pt", axis @ "y"] => {
                draft.point[1] = Some(number(axis, text)?)
            }
            [_, "object", "polygon", "pt"] => match std::mem::take(&mut draft.point) {
                [Some(x), Some(y)] => draft.points.push([x, y]),
                [None, _] => return Err(AnnotationError::Missing("x> in a <pt")),
                [_, None] => return Err(AnnotationError::Missing("y> in a <pt")),
            },
            [_, "object"] => {
                let draft = std::mem::take(draft);
                if !draft.deleted {
                    self.objects.push(draft.finish(at)?);
                }
            }
            _ => {}
        }
        Ok(())
    }
}

impl Draft {
    fn finish(self, end: u64) -> Result<Object, AnnotationError> {
        let name = self.name.filter(|name| !name.is_empty());
        let name = name.ok_or(AnnotationError::Missing("name"))?;
        let area = match self.edges {
            [Some(left), Some(top), Some(right), Some(bottom)] => ImageBox {
                // The first pixel has the number 1, and its edge is at 0.
                left: left - 1.0,
                top: top - 1.0,
                right,
                bottom,
            },
            [None, None, None, None] => {
                let around = ImageBox::around(&self.points);
                around.ok_or(AnnotationError::Missing("bndbox> or <polygon"))?
            }
            _ => return Err(AnnotationError::Missing("xmin>, <ymin>, <xmax> or <ymax")),
        };
        Ok(Object { name, area, end })
    }
}

fn add(content: &mut String, text: &str) {
    if content.len() + text.len() <= MOST_TEXT {
        content.push_str(text);
    }
}

fn number(element: &str, text: &str) -> Result<f64, AnnotationError> {
    let number = text.parse().ok().filter(|v: &f64| v.is_finite());
    number.ok_or_else(|| AnnotationError::Number {
        element: element.to_owned(),
        text: text.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::Rect;

    const VOC: &str = "<?xml version=\"1.0\"?>\n<annotation verified=\"yes\"><filename>x.jpg</filename>
<source><database>a &amp; b</database></source>
<size><width>40</width><height>60</height><depth>3</depth></size>
<object><name>window</name><difficult>0</difficult>
<bndbox><xmin>3</xmin><ymin>6</ymin><xmax>10</xmax><ymax>20.5</ymax></bndbox>
<part><name>sill</name><bndbox><xmin>1</xmin><ymin>1</ymin><xmax>2</xmax><ymax>2</ymax></bndbox></part></object>
<object><name>door</name><deleted>0</deleted>
<polygon><username>a</username><pt><x>20</x><y>41</y></pt><pt><x>30</x><y>40</y></pt><pt><x>29</x><y>60.4</y></pt></polygon></object>
<object><name>gone</name><deleted>1</deleted></object>
</annotation>\n";

    fn fail(text: &str) -> String {
        let error = parse(text.as_bytes(), "a.xml".as_ref(), None).unwrap_err();
        error.to_string()
    }

    #[test]
    fn boxes_and_polygons_are_elements_with_y_up() {
        let facade = parse(VOC.as_bytes(), "dir/house.1.xml".as_ref(), None).unwrap();
        assert_eq!(
            (facade.name.as_str(), facade.width, facade.height),
            ("house", 40.0, 60.0)
        );
        let regions = facade.regions.iter().map(|r| (r.label.as_str(), r.rect));
        let regions: Vec<(&str, Rect)> = regions.collect();
        let expected = [
            // Pixels 3 to 10 and rows 6 to 20.5 from the top, counted from 1.
            ("window", Rect::new(2.0, 39.5, 8.0, 15.5)),
            ("door", Rect::new(20.0, 0.0, 10.0, 20.0)),
        ];
        assert_eq!(regions, expected);
        assert!(is_annotation(VOC.as_bytes()));
        assert!(!is_annotation(
            b"<annotation><object><labelname>window</labelname>"
        ));
    }

    #[test]
    fn the_size_may_stand_elsewhere() {
        let size = "<size><width>40</width><height>60</height><depth>3</depth></size>";
        let without = VOC.replacen(size, "", 1);
        assert!(fail(&without).contains("neither <size> nor <imagesize>"));
        let beside = parse(without.as_bytes(), "a.xml".as_ref(), Some((80.0, 60.0))).unwrap();
        assert_eq!(beside.width, 80.0);
        // That of LabelMe stands at the end.
        let end = "<imagesize><nrows>60</nrows><ncols>40</ncols></imagesize></annotation>";
        let labelme = without.replacen("</annotation>", end, 1);
        let whole = parse(VOC.as_bytes(), "a.xml".as_ref(), None).unwrap();
        assert_eq!(
            parse(labelme.as_bytes(), "a.xml".as_ref(), None).unwrap(),
            whole
        );
    }

    #[test]
    fn bad_files_name_their_place() {
        let cases = [
            (
                "<xmin>3<",
                "<xmin>nan<",
                "line 6, column 25: <xmin> is \"nan\"",
            ),
            ("<xmin>3<", "<xmin>1e999<", "<xmin> is \"1e999\""),
            ("<xmin>3<", "<xmin><", "<xmin> is \"\""),
            (
                "<xmin>3</xmin>",
                "",
                "line 7, column 113: an object without <xmin>",
            ),
            ("<xmax>10<", "<xmax>2<", "window: the box is 0 x 15.5"),
            ("<ymax>20.5<", "<ymax>-9<", "window: the box is 8 x -14"),
            ("<name>window</name>", "", "an object without <name>"),
            ("<name>door<", "<name> <", "an object without <name>"),
            (
                "<x>20</x>",
                "",
                "line 9, column 50: an object without <x> in a <pt>",
            ),
            (
                "<width>40<",
                "<width>0<",
                "width of the image: 0, expected a positive",
            ),
            ("<height>60<", "<height>-60<", "height of the image: -60"),
            ("&amp;", "&lol;", "`&lol;` is unknown"),
            (
                "</object>\n<object><name>door",
                "<object><name>door",
                "line 10, column 1",
            ),
            ("</annotation>", "", "the file ends inside <annotation>"),
            (
                "<annotation verified=\"yes\">",
                "<annotations>",
                "<annotations> is no <annotation>",
            ),
        ];
        for (from, to, expected) in cases {
            let text = VOC.replacen(from, to, 1);
            assert_ne!(text, VOC, "{from}");
            let message = fail(&text);
            assert!(message.starts_with("a.xml: "), "{message}");
            assert!(message.contains(expected), "{to}: {message}");
        }
        assert!(fail("").contains("no <annotation>"));
        assert!(fail(&format!("<annotation>{}", "<a>".repeat(100_000))).contains("32 deep"));
    }

    #[test]
    fn polygons_are_cut_at_the_border_and_points_are_none() {
        let over = VOC.replacen("<x>29</x>", "<x>99</x>", 1);
        let facade = parse(over.as_bytes(), "a.xml".as_ref(), None).unwrap();
        assert_eq!(facade.regions[1].rect, Rect::new(20.0, 0.0, 20.0, 20.0));
        let text = VOC.replacen(
            "<pt><x>30</x><y>40</y></pt><pt><x>29</x><y>60.4</y></pt>",
            "",
            1,
        );
        assert!(fail(&text).contains("door: the box is 0 x 0"));
    }
}
