//! Every facade reader, against bytes that no one should send it: no panic, no endless loop, and an
//! error that names the file; and against files that writers wrote: the same value comes back.

use std::path::Path;

use edifice::Result;
use edifice::io::{
    self, LabelMap, annotation_xml, cmp_xml, coco, draw, facade_json, label_image, label_text,
    labelme,
};
use edifice::shape::{Facade, LabelGrid, Rect, Region, decompose};
use proptest::prelude::*;

const PATH: &str = "some.file";

/// Reads bytes as every format; each must accept them or name the file.
fn read_all(bytes: &[u8]) -> std::result::Result<(), TestCaseError> {
    let path = Path::new(PATH);
    let map = LabelMap::cmp();
    named(facade_json::parse(bytes, path))?;
    named(label_image::parse(bytes, path, None))?;
    named(label_image::parse(bytes, path, Some(&map)))?;
    named(label_text::parse(bytes, path, Some(&map)))?;
    named(LabelMap::parse(bytes, path))?;
    named(labelme::parse(bytes, path))?;
    named(coco::parse(bytes, path, None))?;
    named(annotation_xml::parse(bytes, path, Some((30.0, 40.0))))?;
    named(label_image::parse_nearest(bytes, path, None))?;
    if let Some(cmp) = named(cmp_xml::parse(bytes, path))? {
        cmp.elements(100.0, 80.0).unwrap();
        let grid = cmp.label_grid(100.0, 80.0).unwrap();
        decompose(&grid).unwrap().facade.check_tiling().unwrap();
    }
    Ok(())
}

fn named<T>(result: Result<T>) -> std::result::Result<Option<T>, TestCaseError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error) => {
            prop_assert!(error.to_string().starts_with(PATH), "{}", error);
            Ok(None)
        }
    }
}

/// Tilings of whole pixels, from random pictures of known labels.
fn tilings() -> impl Strategy<Value = Facade> {
    let cells = prop::collection::vec(0u16..4, 30);
    (1usize..7, cells).prop_map(|(columns, cells)| {
        let rows = 30 / columns;
        let grid = LabelGrid {
            name: "some".into(),
            unit: "px".into(),
            xs: (0..=columns).map(|x| x as f64).collect(),
            ys: (0..=rows).map(|y| y as f64).collect(),
            labels: ["wall", "window", "door", "sill"]
                .map(String::from)
                .to_vec(),
            cells: cells[..columns * rows].to_vec(),
        };
        decompose(&grid).unwrap().facade
    })
}

/// Any layout that the constructor accepts.
fn layouts() -> impl Strategy<Value = Facade> {
    let side = || prop_oneof![0.001f64..1.0, Just(1.0), Just(0.1 + 0.2)];
    let region = (".{1,8}", 0.0f64..1.0, 0.0f64..1.0, side(), side());
    let regions = prop::collection::vec(region, 0..8);
    (".*", "px|m|", regions, 2.5f64..1e6).prop_map(|(name, unit, regions, size)| {
        let regions = regions
            .into_iter()
            .map(|(label, x, y, width, height)| Region {
                label,
                rect: Rect::new(x, y, width, height),
            });
        Facade::new(name, unit, size, size, regions.collect()).unwrap()
    })
}

const CMP: &str = "<object>\n<points>\n<x>\n0.2\n</x><x>0.5</x><y>0.1</y><y>0.3</y></points>
<label>3</label><labelname>window</labelname><flag>1</flag></object>
<object><points><x>0.1</x><x>1</x><y>0.1</y><y>1</y></points><labelname>facade</labelname></object>";

/// Valid files of each format.
fn files() -> Vec<Vec<u8>> {
    let region = |label: &str, y: f64| Region {
        label: label.into(),
        rect: Rect::new(0.0, y, 4.0, 2.0),
    };
    let regions = vec![region("wall", 0.0), region("window", 2.0)];
    let facade = Facade::new("some", "px", 4.0, 4.0, regions).unwrap();
    vec![
        facade_json::to_string(&facade).into_bytes(),
        draw::png(&facade).unwrap(),
        label_text::to_string(&facade).unwrap().into_bytes(),
        CMP.as_bytes().to_vec(),
        br#"{"window": [255, 0, 0], "wall": 2}"#.to_vec(),
        include_bytes!("../../../fuzz/seeds/labelme/a.json").to_vec(),
        include_bytes!("../../../fuzz/seeds/annotation_xml/voc.xml").to_vec(),
        include_bytes!("../../../fuzz/seeds/annotation_xml/polygon.xml").to_vec(),
        include_bytes!("../../../fuzz/seeds/coco/a.json").to_vec(),
        jpeg(),
    ]
}

/// A JPEG of two colours that are near those of walls and windows.
fn jpeg() -> Vec<u8> {
    let colour = |x, _| image::Rgb([250, if x < 8 { 250 } else { 5 }, 5]);
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(16, 8, colour);
    image
        .write_to(&mut bytes, image::ImageFormat::Jpeg)
        .unwrap();
    bytes.into_inner()
}

proptest! {
    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read_all(&bytes)?;
    }

    #[test]
    fn random_text_never_panics(text in "[<>/{}\\[\\]\":,. a-z0-9eE+-]{0,200}") {
        read_all(text.as_bytes())?;
    }

    #[test]
    fn mutated_files_never_panic(
        file in 0usize..8,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..4), 1..8),
    ) {
        let mut bytes = files().swap_remove(file);
        for (place, byte, kind) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                2 => drop(bytes.remove(at)),
                _ => bytes.truncate(at),
            }
        }
        read_all(&bytes)?;
    }

    #[test]
    fn facade_json_round_trips(facade in layouts()) {
        let text = facade_json::to_string(&facade);
        let again = facade_json::parse(text.as_bytes(), Path::new(PATH)).unwrap();
        prop_assert_eq!(facade, again);
    }

    #[test]
    fn label_images_round_trip(facade in tilings()) {
        let bytes = draw::png(&facade).unwrap();
        let grid = label_image::parse(&bytes, Path::new(PATH), None).unwrap();
        prop_assert_eq!(grid, LabelGrid::from_facade(&facade, None).unwrap().merged());
    }

    #[test]
    fn text_matrices_round_trip(facade in tilings()) {
        let text = label_text::to_string(&facade).unwrap();
        let grid = label_text::parse(text.as_bytes(), Path::new(PATH), None).unwrap();
        prop_assert_eq!(grid, LabelGrid::from_facade(&facade, None).unwrap().merged());
    }

    #[test]
    fn drawings_are_well_formed(facade in layouts()) {
        let svg = draw::svg(&facade);
        let mut reader = quick_xml::Reader::from_str(&svg);
        let mut rectangles = 0;
        loop {
            match reader.read_event().unwrap() {
                quick_xml::events::Event::Start(e) if e.name().as_ref() == "rect" => rectangles += 1,
                quick_xml::events::Event::Eof => break,
                _ => {}
            }
        }
        prop_assert_eq!(rectangles, facade.regions.len());
    }
}

#[test]
fn every_truncation_of_every_file_is_an_error_or_a_value() {
    for file in files() {
        for length in 0..file.len() {
            read_all(&file[..length]).unwrap();
        }
    }
}

#[test]
fn formats_are_told_by_name_or_content() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["a.facade.json", "a.png", "a.txt", "a.xml"];
    for (name, bytes) in names.iter().zip(files()) {
        for path in [folder.path().join(name), folder.path().join("unnamed")] {
            std::fs::write(&path, &bytes).unwrap();
            let facade = io::read_facade(&path, &io::ReadOptions::default()).unwrap();
            assert_eq!(facade.check_tiling(), Ok(()), "{name}");
            let grid = io::read_label_grid(&path, &io::ReadOptions::default()).unwrap();
            assert_eq!(grid.check(), Ok(()));
        }
    }
}
