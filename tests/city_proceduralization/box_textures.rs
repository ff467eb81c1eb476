//! Templates with textures: what they show, and every format that carries them.

use std::path::Path;

use edifice::grammar::instance::{InstanceGrammar, Kept};
use edifice::io::city::{add_textures, compact, glb, gltf, grammar_json, obj, paint_parts, read};
use edifice::methods::city_proceduralization::{Budget, Settings, decompose, proceduralize};
use edifice::shape::triangles::{City, SideView, Surface, VIEWS, grey};
use edifice::unwatched;

use super::textures::boxes;

/// The grammar of a city with the looks of its templates.
fn textured(city: &City, budget: Budget) -> InstanceGrammar {
    let settings = Settings {
        budget,
        ..Settings::default()
    };
    let mut made = proceduralize(city, &settings, &unwatched).unwrap();
    let textures = made.box_textures(city, 256);
    add_textures(&mut made.grammar, &textures).unwrap();
    made.grammar
}

fn derived(grammar: &InstanceGrammar) -> City {
    let mut city = grammar.derive().unwrap().city(grammar);
    paint_parts(&mut city).unwrap();
    city
}

/// Mean difference of greys between the views of the buildings of two cities, in the boxes of the first.
fn difference(a: &City, b: &City) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for component in &decompose(a, true, &unwatched).components {
        let building = &a.buildings[component.building];
        let like = b.buildings.iter().find(|other| other.id == building.id);
        let like = like.unwrap();
        for view in 0..VIEWS {
            let of = |paint| SideView::whole(paint, &component.frame, view, [60, 50]).colours;
            for (p, q) in of(&building.paint).iter().zip(of(&like.paint)) {
                let both = p.zip(q).map(|(p, q)| [grey(p), grey(q)].map(f64::from));
                if let Some([p, q]) = both {
                    sum += (p - q).abs();
                    count += 1.0;
                }
            }
        }
    }
    assert!(count > 0.8 * 60.0 * 50.0 * 5.0 * a.buildings.len() as f64);
    sum / count
}

#[test]
fn a_derived_city_looks_like_the_one_it_is_made_from() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = boxes(folder.path(), 8);
    let city = read(&path).unwrap();
    let grammar = textured(&city, Budget::All);
    assert!(grammar.templates.iter().all(|t| t.texture.is_some()));
    let off = difference(&city, &derived(&grammar));
    assert!(off < 8.0, "{off} of 255");
    // What would not hold if facades were mixed up.
    let mut turned = derived(&grammar);
    turned
        .buildings
        .iter_mut()
        .flat_map(|b| &mut b.paint)
        .for_each(|p| {
            p.uv.iter_mut().for_each(|uv| uv[0] += 0.23);
        });
    assert!(difference(&city, &turned) > 20.0);
    // Without its picture a template shows nothing.
    for kept in [Kept::Shape, Kept::Buildings] {
        let bare = derived(&grammar.keeping(kept));
        assert!(bare.buildings.iter().all(|b| b.paint.is_empty()));
        let named = bare
            .buildings
            .iter()
            .filter(|b| city.buildings.iter().any(|o| o.id == b.id));
        assert_eq!(
            named.count(),
            if kept == Kept::Buildings {
                city.buildings.len()
            } else {
                0
            }
        );
    }
}

#[test]
fn text_bytes_and_gltf_carry_textures() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = boxes(folder.path(), 8);
    let city = read(&path).unwrap();
    for budget in [Budget::All, Budget::Templates(3)] {
        let grammar = textured(&city, budget);
        let text = grammar_json::to_string(&grammar).unwrap();
        let again = grammar_json::parse(text.as_bytes(), Path::new("a.city-grammar.json")).unwrap();
        assert_eq!(again.templates, grammar.templates);
        let bytes = compact::to_bytes(&grammar).unwrap();
        let again = compact::from_bytes(&bytes).unwrap();
        for (a, b) in again.templates.iter().zip(&grammar.templates) {
            assert!(a.texture.is_some() && a.texture == b.texture);
        }
        // Derived, proceduralized and derived again: the same bytes.
        for instancing in [true, false] {
            let derivation = grammar.derive().unwrap();
            let first = glb::to_bytes(&grammar, &derivation, instancing).unwrap();
            let back = gltf::parse(&first, Path::new("boxes.glb")).unwrap();
            assert!(difference(&derived(&grammar), &back) < 0.5);
            let made = textured(&back, budget);
            let second = glb::to_bytes(&made, &made.derive().unwrap(), instancing).unwrap();
            assert!(first == second, "{budget:?} {instancing}");
        }
    }
}

#[test]
fn obj_files_bring_their_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = boxes(folder.path(), 5);
    let city = derived(&textured(&read(&path).unwrap(), Budget::All));
    let out = folder.path().join("derived.obj");
    obj::write(&city, &out).unwrap();
    let again = read(&out).unwrap();
    assert!(difference(&city, &again) < 1.0);
    let pictures = |c: &City| -> Vec<Vec<u8>> {
        let all = c.buildings.iter().flat_map(|b| &b.paint);
        let files = all.filter_map(|p| match &*p.surface {
            Surface::Texture(t) => Some(t.file.to_vec()),
            Surface::Plain(_) => None,
        });
        let mut files: Vec<Vec<u8>> = files.collect();
        files.sort();
        files.dedup();
        files
    };
    assert_eq!(pictures(&again), pictures(&city));
    assert!(!pictures(&city).is_empty());
}

#[test]
fn a_texture_that_is_no_picture_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = boxes(folder.path(), 2);
    let grammar = textured(&read(&path).unwrap(), Budget::All);
    let text = grammar_json::to_string(&grammar).unwrap();
    let uri = "data:image/png;base64,";
    let at = text.find(uri).unwrap() + uri.len();
    let end = at + text[at..].find('"').unwrap();
    for wrong in ["", "????", "AAAA", &text[at..at + 400]] {
        let damaged = format!("{}{wrong}{}", &text[..at], &text[end..]);
        let parsed = grammar_json::parse(damaged.as_bytes(), Path::new("a.city-grammar.json"));
        let error = parsed.unwrap_err().to_string();
        assert!(error.contains("templates[0].texture"), "{error}");
    }
    let other = text.replacen(uri, "https://example.org/", 1);
    let parsed = grammar_json::parse(other.as_bytes(), Path::new("a.city-grammar.json"));
    assert!(
        parsed
            .unwrap_err()
            .to_string()
            .contains("templates[0].texture")
    );
}
