//! Element layouts from LabelMe: one JSON file an image.
//!
//! ```json
//! { "imagePath": "house.jpg", "imageWidth": 400, "imageHeight": 600,
//!   "shapes": [ { "label": "window", "shape_type": "rectangle", "points": [[20, 500], [50, 560]] } ] }
//! ```
//! Points are pixels from the upper left; a layout's y goes up. A rectangle is given by two opposite
//! corners in any order; a polygon becomes the smallest box around it. What hangs over the border of
//! the image is cut off. Circles, lines, points and masks are no elements and are refused.

use std::path::Path;

use serde::Deserialize;

use super::annotation::{ImageBox, check_side};
use super::json::parse_json;
use super::{file_stem, read_bytes};
use edifice_base::{Error, Result};
use edifice_shape::Facade;

/// Reads an element layout from a file of LabelMe.
///
/// # Errors
/// Names the file and the JSON path or the line and column of what is wrong.
pub fn read(path: &Path) -> Result<Facade> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file of LabelMe; `path` names the layout, and the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Facade> {
    let file: File = parse_json(bytes, path)?;
    let (width, height) = (file.image_width, file.image_height);
    check_side(width, path, "imageWidth")?;
    check_side(height, path, "imageHeight")?;
    let mut regions = Vec::with_capacity(file.shapes.len());
    for (index, shape) in file.shapes.iter().enumerate() {
        let at = |field: &str| format!("shapes[{index}].{field}");
        let points = &shape.points;
        match shape.shape_type.as_deref() {
            Some("rectangle") if points.len() != 2 => {
                let message = format!("{} points, a rectangle has 2", points.len());
                return Err(Error::input(path, at("points"), message));
            }
            Some("rectangle" | "polygon") | None => {}
            Some(other) => {
                let message = format!("{other:?} is unsupported, expected rectangle or polygon");
                return Err(Error::input(path, at("shape_type"), message));
            }
        }
        let around = ImageBox::around(points)
            .ok_or_else(|| Error::input(path, at("points"), "no points"))?;
        let region = around.region(&shape.label, width, height);
        regions.push(region.map_err(|e| Error::input(path, at("points"), e))?);
    }
    Facade::new(file_stem(path), "px", width, height, regions).map_err(|e| Error::content(path, e))
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct File {
    image_width: f64,
    image_height: f64,
    shapes: Vec<Shape>,
}

#[derive(Deserialize)]
struct Shape {
    label: String,
    /// A polygon, in files of the first versions.
    shape_type: Option<String>,
    points: Vec<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::Rect;

    const GOOD: &str = r#"{ "version": "5.4.1", "flags": {}, "imagePath": "x.jpg", "imageData": null,
      "imageWidth": 40, "imageHeight": 60, "shapes": [
      {"label": "window", "points": [[10, 20.5], [2, 5]], "group_id": null, "shape_type": "rectangle", "flags": {}},
      {"label": "door", "points": [[20, 41], [30, 40], [29, 60.4]], "shape_type": "polygon"},
      {"label": "shop", "points": [[1, 50], [9, 50], [9, 55]]} ] }"#;

    #[test]
    fn rectangles_and_polygons_are_boxes_with_y_up() {
        let facade = parse(GOOD.as_bytes(), "dir/house.json".as_ref()).unwrap();
        assert_eq!(
            (facade.name.as_str(), facade.unit.as_str()),
            ("house", "px")
        );
        assert_eq!((facade.width, facade.height), (40.0, 60.0));
        let regions: Vec<(&str, Rect)> = facade
            .regions
            .iter()
            .map(|r| (r.label.as_str(), r.rect))
            .collect();
        let expected = [
            ("window", Rect::new(2.0, 39.5, 8.0, 15.5)),
            ("door", Rect::new(20.0, 0.0, 10.0, 20.0)),
            ("shop", Rect::new(1.0, 5.0, 8.0, 5.0)),
        ];
        assert_eq!(regions, expected);
    }

    #[test]
    fn bad_files_name_their_place() {
        let cases = [
            (
                "\"rectangle\"",
                "\"circle\"",
                "shapes[0].shape_type: \"circle\" is unsupported",
            ),
            (
                "[2, 5]]",
                "[2, 5], [3, 3]]",
                "shapes[0].points: 3 points, a rectangle has 2",
            ),
            (
                "[2, 5]]",
                "[10, 5]]",
                "shapes[0].points: the box is 0 x 15.5",
            ),
            (
                "[[1, 50], [9, 50], [9, 55]]",
                "[]",
                "shapes[2].points: no points",
            ),
            (
                "[[1, 50], [9, 50], [9, 55]]",
                "[[1, 90], [2, 99]]",
                "shapes[2].points: the box lies outside",
            ),
            ("[20, 41]", "[20, 41, 3]", "shapes[1].points"),
            ("[20, 41]", "[20, \"41\"]", "shapes[1].points[0][1]"),
            (
                "\"imageHeight\": 60",
                "\"imageHeight\": null",
                "imageHeight: invalid type: null",
            ),
            (
                "\"imageHeight\": 60",
                "\"imageHeight\": 0",
                "imageHeight: 0, expected a positive number",
            ),
            (
                "\"imageHeight\": 60",
                "\"imageHeight\": -1",
                "imageHeight: -1, expected a positive number",
            ),
            ("\"imageHeight\": 60,", "", "missing field `imageHeight`"),
            (
                "\"label\": \"door\"",
                "\"label\": \"\"",
                "regions[1].label is empty",
            ),
            (
                "\"label\": \"door\"",
                "\"name\": \"door\"",
                "shapes[1]: missing field `label`",
            ),
            ("] }", "]", "line 5"),
        ];
        for (from, to, expected) in cases {
            let text = GOOD.replacen(from, to, 1);
            assert_ne!(text, GOOD, "{from}");
            let message = parse(text.as_bytes(), "a.json".as_ref()).unwrap_err();
            let message = message.to_string();
            assert!(message.starts_with("a.json: "), "{message}");
            assert!(message.contains(expected), "{to}: {message}");
        }
    }
}
