//! Element layouts from the boxes of a COCO file: one JSON file for many images.
//!
//! ```json
//! { "images": [ { "id": 7, "file_name": "house.jpg", "width": 400, "height": 600 } ],
//!   "categories": [ { "id": 1, "name": "window" } ],
//!   "annotations": [ { "image_id": 7, "category_id": 1, "bbox": [20, 500, 30, 60] } ] }
//! ```
//! A box is x, y, width, height in pixels from the upper left; a layout's y goes up. Segmentations are
//! not read. What hangs over the border of the image is cut off.

use std::fmt;
use std::path::Path;

use serde::Deserialize;

use super::annotation::{ImageBox, check_side};
use super::json::parse_json;
use super::{file_stem, read_bytes};
use edifice_base::{Error, Result};
use edifice_shape::Facade;

/// Longest list of images in an error.
const LISTED: usize = 8;

/// Reads the element layout of one image.
///
/// # Errors
/// As [`parse`].
pub fn read(path: &Path, image: Option<&str>) -> Result<Facade> {
    parse(&read_bytes(path)?, path, image)
}

/// Parses the bytes of a COCO file; `path` names the file in errors. `image` picks one of several
/// images: by its file name, that name without folders and extension, or its number.
///
/// # Errors
/// Names the file and the JSON path or the line and column of what is wrong. A file of several images
/// of which none is picked, and a pick that is not there or not the only one, are errors.
pub fn parse(bytes: &[u8], path: &Path, image: Option<&str>) -> Result<Facade> {
    let file: File = parse_json(bytes, path)?;
    let (index, image) = file.pick(path, image)?;
    check_side(image.width, path, &format!("images[{index}].width"))?;
    check_side(image.height, path, &format!("images[{index}].height"))?;
    let mut regions = Vec::new();
    for (index, annotation) in file.annotations.iter().enumerate() {
        if annotation.image_id != image.id {
            continue;
        }
        let at = |field: &str| format!("annotations[{index}].{field}");
        let id = &annotation.category_id;
        let category = file.categories.iter().find(|c| c.id == *id);
        let category = category.ok_or_else(|| {
            let message = format!("no category has the id {id}");
            Error::input(path, at("category_id"), message)
        })?;
        let [left, top, width, height] = annotation.bbox;
        let around = ImageBox {
            left,
            top,
            right: left + width,
            bottom: top + height,
        };
        let region = around.region(&category.name, image.width, image.height);
        regions.push(region.map_err(|e| Error::input(path, at("bbox"), e))?);
    }
    let name = file_stem(image.file_name.as_ref());
    Facade::new(name, "px", image.width, image.height, regions)
        .map_err(|e| Error::input(path, format!("images[{index}]"), e))
}

#[derive(Deserialize)]
struct File {
    images: Vec<Image>,
    categories: Vec<Category>,
    annotations: Vec<Annotation>,
}

/// COCO has numbers; other tools write texts.
#[derive(Deserialize, Clone, PartialEq)]
#[serde(untagged, expecting = "expected a whole number or a text")]
enum Id {
    Number(i64),
    Text(String),
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Id::Number(number) => write!(f, "{number}"),
            Id::Text(text) => write!(f, "{text:?}"),
        }
    }
}

#[derive(Deserialize)]
struct Image {
    id: Id,
    file_name: String,
    width: f64,
    height: f64,
}

#[derive(Deserialize)]
struct Category {
    id: Id,
    name: String,
}

#[derive(Deserialize)]
struct Annotation {
    image_id: Id,
    category_id: Id,
    bbox: [f64; 4],
}

impl Image {
    fn is_called(&self, name: &str) -> bool {
        let id = match &self.id {
            Id::Number(number) => number.to_string() == name,
            Id::Text(text) => text == name,
        };
        id || self.file_name == name || file_stem(self.file_name.as_ref()) == name
    }
}

impl File {
    /// The image asked for, or the only one, with its place in the list.
    fn pick(&self, path: &Path, name: Option<&str>) -> Result<(usize, &Image)> {
        let fits = |(_, image): &(usize, &Image)| name.is_none_or(|name| image.is_called(name));
        let found: Vec<(usize, &Image)> = self.images.iter().enumerate().filter(fits).collect();
        let list = |images: &mut dyn Iterator<Item = &Image>| {
            let mut names: Vec<&str> = images
                .map(|i| i.file_name.as_str())
                .take(LISTED + 1)
                .collect();
            if names.len() > LISTED {
                names[LISTED] = "...";
            }
            names.join(", ")
        };
        match (found.as_slice(), name) {
            (&[only], _) => Ok(only),
            ([], None) => Err(Error::content(path, "no images")),
            ([], Some(name)) => {
                let message = format!(
                    "{} has no image {name:?}; it has {}",
                    path.display(),
                    list(&mut self.images.iter())
                );
                Err(Error::option("--image", message))
            }
            (several, None) => {
                let message = format!(
                    "{} images, --image NAME picks one: {}",
                    several.len(),
                    list(&mut self.images.iter())
                );
                Err(Error::input(path, "images", message))
            }
            (several, Some(name)) => {
                let message = format!(
                    "{name:?} is the name of {} images: {}",
                    several.len(),
                    list(&mut several.iter().map(|(_, i)| *i))
                );
                Err(Error::option("--image", message))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::Rect;

    const ONE: &str = r#"{ "info": {}, "licenses": [],
      "images": [{"id": 7, "file_name": "paris/house.01.jpg", "width": 40, "height": 60, "license": 1}],
      "categories": [{"id": 1, "name": "window", "supercategory": "facade"}, {"id": 2, "name": "door"}],
      "annotations": [
        {"id": 1, "image_id": 7, "category_id": 1, "bbox": [2, 5.5, 8, 15], "area": 120, "iscrowd": 0, "segmentation": [[2, 5]]},
        {"id": 2, "image_id": 7, "category_id": 2, "bbox": [20, 50, 10, 10.5]} ] }"#;

    fn two() -> String {
        let images = r#""images": [{"id": "b", "file_name": "b.png", "width": 5, "height": 6}, "#;
        ONE.replacen("\"images\": [", images, 1)
    }

    fn fail(text: &str, image: Option<&str>) -> String {
        parse(text.as_bytes(), "a.json".as_ref(), image)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn boxes_of_the_image_are_read_with_y_up() {
        for (text, image) in [
            (ONE.to_owned(), None),
            (two(), Some("house")),
            (two(), Some("7")),
            (two(), Some("paris/house.01.jpg")),
        ] {
            let facade = parse(text.as_bytes(), "a.json".as_ref(), image).unwrap();
            assert_eq!(facade.name, "house");
            assert_eq!((facade.width, facade.height), (40.0, 60.0));
            let labels: Vec<&str> = facade.regions.iter().map(|r| r.label.as_str()).collect();
            assert_eq!(labels, ["window", "door"]);
            assert_eq!(facade.regions[0].rect, Rect::new(2.0, 39.5, 8.0, 15.0));
            assert_eq!(facade.regions[1].rect, Rect::new(20.0, 0.0, 10.0, 10.0));
        }
        let other = parse(two().as_bytes(), "a.json".as_ref(), Some("b")).unwrap();
        assert_eq!((other.width, other.regions.len()), (5.0, 0));
    }

    #[test]
    fn images_must_be_picked() {
        let message = fail(&two(), None);
        assert_eq!(
            message,
            "a.json: images: 2 images, --image NAME picks one: b.png, paris/house.01.jpg"
        );
        let message = fail(&two(), Some("c"));
        assert!(message.starts_with("--image: a.json has no image \"c\"; it has b.png"));
        let same = two().replacen("b.png", "rome/house.png", 1);
        let message = fail(&same, Some("house"));
        assert!(message.starts_with("--image: \"house\" is the name of 2 images"));
        let none = ONE.replacen("{\"id\": 7", "{\"id\": 8", 1);
        assert!(parse(none.as_bytes(), "a.json".as_ref(), None).is_ok());
    }

    #[test]
    fn bad_files_name_their_place() {
        let cases = [
            (
                "\"category_id\": 2",
                "\"category_id\": 3",
                "annotations[1].category_id: no category has the id 3",
            ),
            (
                "[20, 50, 10, 10.5]",
                "[20, 50, 0, 10.5]",
                "annotations[1].bbox: the box is 0 x 10.5",
            ),
            (
                "[20, 50, 10, 10.5]",
                "[20, 60, 1, 1]",
                "annotations[1].bbox: the box lies outside the image of 40 x 60",
            ),
            (
                "[20, 50, 10, 10.5]",
                "[20, 50, 10]",
                "annotations[1].bbox: invalid length 3",
            ),
            (
                "[20, 50, 10, 10.5]",
                "[20, 50, 1e999, 1]",
                "annotations[1].bbox",
            ),
            (
                "\"image_id\": 7",
                "\"image_id\": 7.5",
                "annotations[0].image_id: expected a whole number or a text",
            ),
            (
                "\"height\": 60",
                "\"height\": -60",
                "images[0].height: -60, expected a positive number",
            ),
            (
                "\"name\": \"door\"",
                "\"name\": \"\"",
                "images[0]: regions[1].label is empty",
            ),
            ("\"categories\"", "\"kinds\"", "missing field `categories`"),
            (
                "\"id\": 7, \"file_name\"",
                "\"id\": 7, \"name\"",
                "images[0]: missing field `file_name`",
            ),
            ("] }", "", "line 6"),
        ];
        for (from, to, expected) in cases {
            let text = ONE.replacen(from, to, 1);
            assert_ne!(text, ONE, "{from}");
            let message = fail(&text, None);
            assert!(message.starts_with("a.json: "), "{message}");
            assert!(message.contains(expected), "{to}: {message}");
        }
        let empty = ONE.replacen("\"images\": [", "\"images\": [], \"kept\": [", 1);
        assert_eq!(fail(&empty, None), "a.json: no images");
    }
}
