//! Localization from photographs of facades.

use std::path::{Path, PathBuf};
use std::process::Command;

use edifice::io::city::read;
use edifice::methods::city_proceduralization::facades::{Facade, facades, photographed};
use edifice::methods::city_proceduralization::localization::{landmarks, locate_facades};
use edifice::rng::stream;
use edifice::shape::triangles::City;
use rand::{Rng, RngExt};

const SIZE: [u32; 2] = [120, 96];

/// A wall with a random grid of windows.
fn facade(rng: &mut impl Rng) -> Vec<[u8; 3]> {
    let [columns, rows] = [rng.random_range(2..8_u32), rng.random_range(2..7)];
    let shares = [(); 2].map(|()| rng.random_range(0.35..0.75));
    let wall = rng.random_range(150..240_u8);
    let inside = |v: u32, n: u32, all: u32, share: f64| {
        let step = f64::from(all) / f64::from(n);
        ((f64::from(v) + 0.5) % step / step - 0.5).abs() < share / 2.0
    };
    let texel = |i: u32| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let window = inside(x, columns, SIZE[0], shares[0]) && inside(y, rows, SIZE[1], shares[1]);
        [if window { 40 } else { wall }; 3]
    };
    (0..SIZE[0] * SIZE[1]).map(texel).collect()
}

fn save(path: &Path, colours: &[[u8; 3]]) {
    let bytes = colours.as_flattened().to_vec();
    let picture = image::RgbImage::from_raw(SIZE[0], SIZE[1], bytes).unwrap();
    picture.save(path).unwrap();
}

fn noisy(colours: &[[u8; 3]], rng: &mut impl Rng) -> Vec<[u8; 3]> {
    let darker = rng.random_range(0..12);
    let one = |c: &[u8; 3]| {
        let noise = rng.random_range(-9..=9_i16);
        c.map(|v| (i16::from(v) + noise - darker).clamp(0, 255) as u8)
    };
    colours.iter().map(one).collect()
}

/// Boxes of any sizes on a grid, each with its own facade all around.
fn city(folder: &Path, side: usize) -> (PathBuf, Vec<Vec<[u8; 3]>>) {
    let mut rng = stream(3, "street", 0);
    let (mut text, mut materials) = (
        "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n".to_owned(),
        String::new(),
    );
    let mut all = Vec::new();
    for i in 0..side * side {
        let colours = facade(&mut rng);
        save(&folder.join(format!("{i}.png")), &colours);
        materials += &format!("newmtl {i}\nmap_Kd {i}.png\n");
        let [w, d, h] = [(); 3].map(|()| rng.random_range(9.0..14.0));
        let (x0, y0) = (30.0 * (i % side) as f64, 30.0 * (i / side) as f64);
        text += &format!("o house {i}\nusemtl {i}\n");
        for z in [0.0, h] {
            for (x, y) in [(0.0, 0.0), (w, 0.0), (w, d), (0.0, d)] {
                text += &format!("v {:.3} {:.3} {z:.3}\n", x0 + x, y0 + y);
            }
        }
        let v = |j: usize| 8 * i + j + 1;
        for k in 0..4 {
            let n = (k + 1) % 4;
            text += &format!("f {}/1 {}/2 {}/3 {}/4\n", v(k), v(n), v(n + 4), v(k + 4));
        }
        text += &format!("f {}/1 {}/2 {}/3 {}/4\n", v(4), v(5), v(6), v(7));
        all.push(colours);
    }
    std::fs::write(folder.join("m.mtl"), materials).unwrap();
    let path = folder.join("street.obj");
    std::fs::write(&path, text).unwrap();
    (path, all)
}

/// A house and the two nearest to it, the nearest first: indices of buildings.
fn seen(city: &City, from: usize) -> [usize; 3] {
    let (places, buildings) = landmarks(city);
    let at = |b: usize| places[buildings.iter().position(|&o| o == b).unwrap()].at;
    let far = |b: usize| (at(b)[0] - at(from)[0]).hypot(at(b)[1] - at(from)[1]);
    let mut all = buildings.clone();
    all.sort_by(|&a, &b| far(a).total_cmp(&far(b)));
    [all[0], all[1], all[2]]
}

#[test]
fn three_photographs_tell_where_they_were_taken() {
    const SIDE: usize = 8;
    let folder = tempfile::tempdir().unwrap();
    let (path, pictures) = city(folder.path(), SIDE);
    let city = read(&path).unwrap();
    let (places, buildings) = landmarks(&city);
    let known: Vec<Vec<Facade>> = buildings
        .iter()
        .map(|&b| facades(&city.buildings[b]))
        .collect();
    assert!(known.iter().all(|f| f.len() == 4));
    let mut rng = stream(4, "photographs", 0);
    let (mut right, mut count) = (0, 0);
    for i in 0..SIDE * SIDE {
        let wanted = seen(&city, i);
        let view =
            wanted.map(|k| photographed(SIZE[0] as usize, &noisy(&pictures[k], &mut rng)).unwrap());
        let found = locate_facades(&places, &known, &view, 1);
        right += usize::from(found[0].matched.iter().map(|&l| buildings[l]).eq(wanted));
        count += 1;
        assert!(found[0].cost.is_finite() && found[0].cost >= 0.0);
    }
    assert!(right * 10 >= count * 9, "{right} of {count}");
    assert!(locate_facades(&places, &known, &[], 1).is_empty());
}

#[test]
fn the_command_takes_photographs() {
    const SIDE: usize = 5;
    let folder = tempfile::tempdir().unwrap();
    let (path, pictures) = city(folder.path(), SIDE);
    let grammar = folder.path().join("street.city-grammar.json");
    let run = |arguments: &[&Path]| {
        let out = Command::new(env!("CARGO_BIN_EXE_edifice"))
            .arg("city")
            .args(arguments)
            .output()
            .unwrap();
        let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
        (out.status.code(), text(&out.stdout), text(&out.stderr))
    };
    let p = Path::new;
    let made = run(&[
        p("proceduralize"),
        &path,
        p("--templates"),
        p("all"),
        p("-o"),
        &grammar,
    ]);
    assert_eq!(made.0, Some(0), "{}", made.2);
    let mut rng = stream(5, "photographs", 0);
    let wanted = seen(&read(&path).unwrap(), 7);
    let views = wanted.map(|k| {
        let file = folder.path().join(format!("view {k}.jpg"));
        save(&file, &noisy(&pictures[k], &mut rng));
        file
    });
    // In the city, and in its grammar.
    for known in [&path, &grammar] {
        let [a, b, c] = &views;
        let (code, found, error) = run(&[
            p("locate"),
            known,
            p("--view"),
            a,
            b,
            c,
            p("--top"),
            p("1"),
            p("--json"),
        ]);
        assert_eq!(code, Some(0), "{error}");
        let place: serde_json::Value = serde_json::from_str(&found).unwrap();
        assert_eq!(
            place["matched"],
            serde_json::json!(wanted.map(|k| format!("house {k}")))
        );
    }
    // One grey; no picture; a city without textures.
    let grey = folder.path().join("grey.png");
    save(&grey, &vec![[90; 3]; (SIZE[0] * SIZE[1]) as usize]);
    let (code, _, error) = run(&[p("locate"), &path, p("--view"), &grey]);
    assert!(code == Some(1) && error.contains("grey.png"), "{error}");
    let text = folder.path().join("text.png");
    std::fs::write(&text, "text").unwrap();
    let (code, _, error) = run(&[p("locate"), &path, p("--view"), &text]);
    assert!(code == Some(1) && error.contains("text.png"), "{error}");
    let plain = folder.path().join("plain.city-grammar.json");
    let made = run(&[
        p("proceduralize"),
        &path,
        p("--texture-pixels"),
        p("0"),
        p("-o"),
        &plain,
    ]);
    assert_eq!(made.0, Some(0), "{}", made.2);
    let (code, _, error) = run(&[p("locate"), &plain, p("--view"), &views[0]]);
    assert!(code == Some(1) && error.contains("texture"), "{error}");
}
