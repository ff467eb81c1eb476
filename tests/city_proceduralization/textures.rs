//! Cities with textures or named windows: what is read, what the paper's window features tell apart, and bad input.

use std::path::Path;

use edifice::cluster::purity;
use edifice::io::city::{cityjson, read};
use edifice::methods::city_proceduralization::{
    Budget, Mode, PAPER_FEATURES, Settings, decompose, proceduralize,
};
use edifice::rng::stream;
use edifice::shape::triangles::{City, Surface};
use edifice::unwatched;
use rand::RngExt;

const MATERIALS: &str =
    "newmtl plain\nKd .8 .8 .8\nnewmtl a\nKd 1 1 1\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n";

/// A facade of 100 x 80 texels: windows of `w` x `h` texels in `columns` and `rows`.
fn facade(path: &Path, [w, h]: [u32; 2], [columns, rows]: [u32; 2]) {
    let picture = image::GrayImage::from_fn(100, 80, |x, y| {
        let inside = |v: u32, n: u32, all: u32, size: u32| {
            let step = all / n;
            let from = (step - size) / 2;
            (from..from + size).contains(&(v % step))
        };
        image::Luma(
            [match inside(x, columns, 100, w) && inside(y, rows, 80, h) {
                true => 30,
                false => 190,
            }],
        )
    });
    picture.save(path).unwrap();
}

/// Boxes with facades of kinds `a` and `b` in turn, as OBJ.
pub(crate) fn boxes(folder: &Path, count: usize) -> (std::path::PathBuf, Vec<usize>) {
    facade(&folder.join("a.png"), [6, 8], [10, 5]);
    facade(&folder.join("b.png"), [24, 10], [3, 4]);
    std::fs::write(folder.join("m.mtl"), MATERIALS).unwrap();
    let mut rng = stream(1, "boxes", 0);
    let mut text = "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n".to_owned();
    for i in 0..count {
        let [w, d, h] = [(); 3].map(|()| rng.random_range(9.0..14.0));
        let at = 40.0 * i as f64;
        text += &format!("o {i}\n");
        for z in [0.0, h] {
            for (x, y) in [(0.0, 0.0), (w, 0.0), (w, d), (0.0, d)] {
                text += &format!("v {:.3} {y:.3} {z:.3}\n", at + x);
            }
        }
        text += &format!("usemtl {}\n", ["a", "b"][i % 2]);
        for k in 0..4 {
            let n = (k + 1) % 4;
            let v = |j: usize| 8 * i + j + 1;
            text += &format!("f {}/1 {}/2 {}/3 {}/4\n", v(k), v(n), v(n + 4), v(k + 4));
        }
        let v = |j: usize| 8 * i + j + 1;
        text += &format!("usemtl plain\nf {} {} {} {}\n", v(4), v(5), v(6), v(7));
    }
    let path = folder.join("boxes.obj");
    std::fs::write(&path, text).unwrap();
    (path, (0..count).map(|i| i % 2).collect())
}

#[test]
fn facades_tell_buildings_of_one_shape_apart() {
    let folder = tempfile::tempdir().unwrap();
    let (path, kinds) = boxes(folder.path(), 40);
    let city = read(&path).unwrap();
    let components = decompose(&city, true, &unwatched).components;
    assert_eq!(components.len(), 40);
    // Windows are as wide as the picture says: to a pixel of 0.1 m.
    for c in &components {
        let [w, d, _] = c.frame.size;
        let share = [0.06, 0.24][kinds[c.building]];
        let width = c.windows.unwrap()[0];
        assert!((width - share * (w + d) / 2.0).abs() < 0.12, "{width}");
    }
    let mut weights = [1.0; 11];
    for (weight, name) in weights.iter_mut().zip(PAPER_FEATURES) {
        if ["vertices", "width", "height", "depth", "rotation"].contains(&name) {
            *weight = 0.0;
        }
    }
    let grouped = |city: &City, weights: [f64; 11]| {
        let settings = Settings {
            mode: Mode::Paper,
            budget: Budget::Templates(6),
            weights,
            ..Settings::default()
        };
        let made = proceduralize(city, &settings, &unwatched).unwrap();
        let types: Vec<usize> = made.types.uses.iter().map(|u| u.kind).collect();
        let kinds: Vec<usize> = (made.decomposition.components.iter())
            .map(|c| kinds[c.building])
            .collect();
        purity(&types, &kinds)
    };
    assert_eq!(grouped(&city, weights), 1.0);
    // Without what they look like, boxes of any sizes are of no kind.
    let mut plain = city.clone();
    plain.buildings.iter_mut().for_each(|b| b.paint.clear());
    assert!(grouped(&plain, [1.0; 11]) < 0.85);
    // A box shows its texture four times; the file's bytes are shared out by texels.
    let file = std::fs::metadata(folder.path().join("a.png"))
        .unwrap()
        .len() as f64;
    let own = components.iter().find(|c| kinds[c.building] == 0).unwrap();
    assert!((own.texture_bytes - 4.0 * file).abs() < 1e-6 * file);
}

#[test]
fn archives_of_obj_files_are_one_city() {
    let folder = tempfile::tempdir().unwrap();
    boxes(folder.path(), 6);
    let path = folder.path().join("city.tar");
    let mut archive = tar::Builder::new(std::fs::File::create(&path).unwrap());
    for name in ["a.png", "b.png", "m.mtl", "boxes.obj"] {
        archive
            .append_path_with_name(folder.path().join(name), Path::new("within").join(name))
            .unwrap();
    }
    archive.into_inner().unwrap();
    let (city, plain) = (
        read(&path).unwrap(),
        read(&folder.path().join("boxes.obj")).unwrap(),
    );
    assert_eq!(city.buildings, plain.buildings);
    assert_eq!(city.name, "city");
    let bytes = std::fs::read(&path).unwrap();
    for (name, bytes) in [
        ("cut.tar", &bytes[..bytes.len() / 3]),
        ("none.tar", b"".as_slice()),
        ("no.tar.xz", b"no archive".as_slice()),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains(name) || error.contains("within"), "{error}");
    }
}

#[test]
fn materials_that_are_missing_or_wrong_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = boxes(folder.path(), 2);
    let say = || read(&path).unwrap_err().to_string();
    std::fs::write(folder.path().join("b.png"), b"no picture").unwrap();
    let error = say();
    assert!(
        error.contains("m.mtl") && error.contains("line 7") && error.contains("b.png"),
        "{error}"
    );
    std::fs::remove_file(folder.path().join("b.png")).unwrap();
    let error = say();
    assert!(
        error.contains("m.mtl") && error.contains("b.png"),
        "{error}"
    );
    std::fs::write(folder.path().join("m.mtl"), "newmtl a\nKd 1 nan 1\n").unwrap();
    assert!(say().contains("line 2"));
    std::fs::write(folder.path().join("m.mtl"), "Kd 1 1 1\n").unwrap();
    assert!(say().contains("without newmtl"));
    std::fs::remove_file(folder.path().join("m.mtl")).unwrap();
    assert!(say().contains("m.mtl"));
    for (line, text) in [
        ("vt nan 0", "line 1"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1", "line 3"),
    ] {
        std::fs::write(&path, line).unwrap();
        let error = say();
        assert!(error.contains(text), "{error}");
    }
}

#[test]
fn named_windows_of_cityjson_are_painted() {
    let text = r#"{"type":"CityJSON","version":"2.0",
        "vertices":[[0,0,0],[9,0,0],[9,0,6],[0,0,6],[2,0,2],[4,0,2],[4,0,4],[2,0,4]],
        "CityObjects":{"h":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"3",
        "boundaries":[[[0,1,2,3],[4,7,6,5]],[[4,5,6,7]]],
        "semantics":{"surfaces":[{"type":"WallSurface"},{"type":"Window"}],"values":[0,1]}}]}}}"#;
    let city = cityjson::parse(text.as_bytes(), "a.city.json".as_ref()).unwrap();
    let area = |grey: u8| -> f64 {
        let own = city.buildings[0].paint.iter();
        own.filter(|p| *p.surface == Surface::Plain([grey; 3]))
            .map(|p| {
                let [a, b, c] = p.corners;
                ((b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0])).abs() / 2.0
            })
            .sum()
    };
    assert_eq!((area(40), area(220)), (4.0, 50.0));
    // Nothing is painted where no windows are named.
    let plain = cityjson::parse(
        text.replace("Window", "Roof").as_bytes(),
        "a.city.json".as_ref(),
    );
    assert!(plain.unwrap().buildings[0].paint.is_empty());
}
