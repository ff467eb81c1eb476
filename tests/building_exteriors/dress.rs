//! City models with windows and doors, and the faults that a check of level of detail 3 must find.

use std::collections::HashSet;
use std::path::Path;

use edifice::io::detailed_cityjson::{self, Document, Place, Shell};
use edifice::io::{building_json, city};
use edifice::methods::building_exteriors::dress::{Dresser, Settings, dress, openings};
use edifice::methods::building_exteriors::house::parts::parts;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::methods::building_exteriors::survey::Candidate;
use edifice::shape::triangles::TriangleMesh;
use edifice::shape::{DetailedBuilding, PartKind};
use serde_json::{Map, Value};

fn shipped(name: &str) -> std::path::PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/building_exteriors");
    folder.join(name)
}

fn real_model() -> ModelFile {
    ModelFile::from_json(&std::fs::read_to_string(shipped("real.houses.json")).unwrap()).unwrap()
}

/// A box with a flat roof.
fn block(at: [f64; 3], size: [f64; 3]) -> TriangleMesh {
    let corner = |i: usize| [0, 1, 2].map(|k| at[k] + size[k] * (i >> k & 1) as f64);
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
            .collect(),
    }
}

fn dressed(city: &[TriangleMesh], seed: u64) -> Vec<DetailedBuilding> {
    let settings = Settings { draws: 30, seed };
    with_candidates(city, |city| dress(city, &real_model(), &settings).unwrap())
}

/// The answer of a function of the buildings, without attributes.
fn with_candidates<T>(city: &[TriangleMesh], ask: impl Fn(&[Candidate]) -> T) -> T {
    let names: Vec<String> = (0..city.len()).map(|k| format!("b{k}")).collect();
    let none = Map::<String, Value>::new();
    let city: Vec<Candidate> = city
        .iter()
        .zip(&names)
        .map(|(mesh, name)| Candidate {
            name,
            mesh,
            attributes: &none,
        })
        .collect();
    ask(&city)
}

fn shells(buildings: &[DetailedBuilding]) -> Vec<Shell> {
    let text = detailed_cityjson::to_string(buildings, &Place::default());
    detailed_cityjson::parse(text.as_bytes(), Path::new("made.city.json")).unwrap()
}

#[test]
fn walls_keep_their_corners_and_openings_lie_in_them() {
    let blocks = [
        block([0.0, 0.0, 0.0], [11.0, 9.0, 5.7]),
        block([100.0, 0.0, 3.0], [24.0, 14.0, 17.5]),
        block([200.0, 0.0, 0.0], [3.0, 2.5, 2.4]),
    ];
    let mut counts = [0, 0];
    for seed in 1..4 {
        let all = dressed(&blocks, seed);
        for (count, own) in counts.iter_mut().zip(&all) {
            *count += openings(own).count();
        }
        for (block, own) in blocks.iter().zip(&all) {
            for p in &block.positions {
                assert!(own.positions.iter().any(|q| q == p), "{p:?} is lost");
            }
            let walls: f64 = own
                .parts
                .iter()
                .filter(|p| p.kind == PartKind::WallSurface)
                .map(|p| own.area(p))
                .sum();
            let cut: f64 = openings(own)
                .filter_map(|p| p.rect)
                .map(|r| r.width * r.height)
                .sum();
            let [w, d, h] = [0, 1, 2].map(|i| block.positions[7][i] - block.positions[0][i]);
            assert!((walls + cut - 2.0 * (w + d) * h).abs() < 1e-6);
            let names: HashSet<&str> = own.parts.iter().map(|p| p.name.as_str()).collect();
            assert_eq!(names.len(), own.parts.len());
            for part in openings(own) {
                let p = part.attributes["probability"].as_f64().unwrap();
                assert!(p > 0.0 && p <= 1.0, "{}: {p}", part.name);
                let wall = &own.parts[part.wall.unwrap()];
                assert_eq!(wall.kind, PartKind::WallSurface);
            }
        }
        assert!(
            openings(&all[0]).count() >= 3,
            "{}",
            openings(&all[0]).count()
        );
        for shell in shells(&all) {
            assert!(shell.is_solid);
            assert_eq!(detailed_cityjson::faults(&shell), Vec::<String>::new());
        }
    }
    // Single draws of six storeys with few windows exist.
    assert!(counts[1] > 2 * counts[0], "{counts:?}");
}

#[test]
fn party_walls_have_no_windows_and_winding_does_not_matter() {
    let [a, b] = [
        block([0.0, 0.0, 0.0], [8.0, 10.0, 9.0]),
        block([8.0, 0.0, 0.0], [8.0, 10.0, 9.0]),
    ];
    let mut turned = b.clone();
    // Every other triangle is wound the wrong way.
    turned
        .triangles
        .iter_mut()
        .step_by(2)
        .for_each(|t| t.swap(1, 2));
    for city in [[a.clone(), b], [a, turned]] {
        let all = dressed(&city, 2);
        for own in &all {
            assert!(openings(own).count() > 0);
            for part in openings(own) {
                let rect = part.rect.unwrap();
                let at_party = (rect.corner[0] - 8.0).abs() < 0.2 && rect.along[0].abs() < 0.5;
                assert!(!at_party, "{} on the party wall", part.name);
            }
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let village = city::read(&shipped("village.city.json")).unwrap();
    let meshes: Vec<TriangleMesh> = village.buildings.into_iter().map(|b| b.mesh).collect();
    let text = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| detailed_cityjson::to_string(&dressed(&meshes, 7), &Place::default()))
    };
    assert_eq!(text(1), text(3));
}

#[test]
fn a_city_in_pieces_is_the_whole_one() {
    let village = city::read(&shipped("village.city.json")).unwrap();
    let meshes: Vec<TriangleMesh> = village.buildings.into_iter().map(|b| b.mesh).collect();
    let (draws, seed) = (30, 7);
    let whole = dressed(&meshes, seed);
    let mut document = Document::default();
    with_candidates(&meshes, |city| {
        let model = real_model();
        let dresser = Dresser::new(city, &model, &Settings { draws, seed }).unwrap();
        let pieces = (0..city.len())
            .step_by(5)
            .map(|k| dresser.dressed(k..k + 5));
        pieces.flat_map(Result::unwrap).collect::<Vec<_>>()
    })
    .iter()
    .zip(&whole)
    .for_each(|(piece, own)| {
        assert_eq!(piece, own);
        document.add(piece);
    });
    let place = Place::default();
    assert_eq!(
        document.finish(&place),
        detailed_cityjson::to_string(&whole, &place)
    );
}

#[test]
fn houses_are_sound_solids_and_every_kind_of_fault_is_found() {
    let houses = building_json::read(&shipped("houses.buildings.jsonl")).unwrap();
    let of = |k: usize| {
        let whole = model(&houses[k], Joining::Boxes).unwrap();
        shells(&[parts(&houses[k], &whole)]).remove(0)
    };
    for k in (0..200).step_by(40) {
        assert_eq!(
            detailed_cityjson::faults(&of(k)),
            Vec::<String>::new(),
            "house {k}"
        );
    }
    let sound = of(3);
    let faults = |change: &dyn Fn(&mut Shell)| {
        let mut shell = sound.clone();
        change(&mut shell);
        detailed_cityjson::faults(&shell).join("; ")
    };
    let window = sound
        .surfaces
        .iter()
        .position(|s| s.class == "Window")
        .unwrap();
    assert!(faults(&|s| s.triangles.truncate(s.triangles.len() - 1)).contains("302"));
    assert!(faults(&|s| s.triangles[0].0.swap(0, 1)).contains("302"));
    assert!(faults(&|s| s.triangles.iter_mut().for_each(|(t, _)| t.swap(0, 1))).contains("307"));
    assert!(faults(&|s| s.triangles[5].0[1] = s.triangles[5].0[0]).contains("without area"));
    assert!(faults(&|s| s.surfaces[window].parent = None).contains("no wall"));
    assert!(faults(&|s| s.surfaces[window].parent = Some(window)).contains("no wall"));
    assert!(
        faults(&|s| s.surfaces.iter_mut().for_each(|d| d.children.clear()))
            .contains("does not name it")
    );
    // A corner of a window moved ten metres through the house.
    let (t, _) = sound.triangles.iter().find(|(_, s)| *s == window).unwrap();
    let corner = t[0] as usize;
    let far = (10.0 / sound.scale[0]) as i64;
    let moved =
        |axis: usize, by: i64| faults(&move |s: &mut Shell| s.positions[corner][axis] += by);
    let crossed = [moved(0, far), moved(0, -far), moved(1, far), moved(1, -far)];
    assert!(crossed.iter().any(|f| f.contains("306")), "{crossed:?}");
    assert!(faults(&|s| s.triangles.clear()).contains("no surfaces"));
    for far in [i64::MIN, i64::MAX, 1 << 41] {
        assert!(faults(&|s| s.positions[0][2] = far).contains("too large"));
    }
    let twice = |s: &mut Shell| {
        let count = s.positions.len() as u32;
        let high: Vec<[i64; 3]> = s
            .positions
            .iter()
            .map(|p| [p[0], p[1], p[2] + far * 9])
            .collect();
        s.positions.extend(high);
        let more: Vec<_> = s
            .triangles
            .iter()
            .map(|(t, k)| (t.map(|v| v + count), *k))
            .collect();
        s.triangles.extend(more);
    };
    assert!(faults(&twice).contains("305"));
}
