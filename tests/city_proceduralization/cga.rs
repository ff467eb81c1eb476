//! CGA of city grammars: the independent reader evaluates the same volumes, and an attribute changes the buildings that it should.

use std::path::Path;

use edifice::grammar::instance::{InstanceGrammar, Placement};
use edifice::io::city::{cga, grammar_file, read};
use edifice::io::grammar_cga::solids::{Scope, SolidRules};
use edifice::methods::city_proceduralization::{Budget, Mode, Settings, proceduralize};
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;

use crate::cga_judge::{judge, measures};

fn shipped(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn town() -> InstanceGrammar {
    grammar_file::read(&shipped(
        "datasets/city_proceduralization/town.city-grammar.json",
    ))
    .unwrap()
}

/// A grammar of a made city: 48 types in 16 places of motifs.
fn made(noise: f64, seed: u64, settings: &Settings) -> InstanceGrammar {
    let (city, _) = synthetic::city(16, noise, seed);
    proceduralize(&city, settings, &unwatched).unwrap().grammar
}

#[test]
fn made_cities_and_examples_have_the_same_volumes() {
    let folder = tempfile::tempdir().unwrap();
    // The rules of a town without the instances' identifiers, as they are without residuals.
    let (town, _, _) = judge(&town().rules_only(), folder.path());
    assert!(town > 10, "{town}");
    for (noise, seed, budget) in [
        (0.0, 1, Budget::Level(3)),
        (0.03, 2, Budget::Templates(40)),
        (0.05, 3, Budget::All),
    ] {
        let settings = Settings {
            budget,
            ..Settings::default()
        };
        let (count, _, _) = judge(&made(noise, seed, &settings), folder.path());
        assert!(count > 50, "{count}");
    }
    let paper = Settings {
        mode: Mode::Paper,
        ..Settings::default()
    };
    judge(&made(0.03, 4, &paper).rules_only(), folder.path());
    for name in [
        "datasets/building_exteriors/village.city.json",
        "datasets/examples/street.obj",
    ] {
        let city = read(&shipped(name)).unwrap();
        let grammar = proceduralize(&city, &Settings::default(), &unwatched).unwrap();
        judge(&grammar.grammar, folder.path());
    }
}

#[test]
fn edited_rules_and_places_far_away_have_the_same_volumes() {
    let mut grammar = made(0.03, 5, &Settings::default());
    grammar.origin = [84_000.0, 447_000.0, 0.0];
    grammar.reference_system = Some("EPSG:28992".into());
    for (i, rule) in grammar.rules.iter_mut().enumerate() {
        if rule.levels > 0 {
            rule.scale = [1.25, 0.5 + 0.1 * (i % 7) as f64, 1.5];
            rule.successors
                .iter_mut()
                .for_each(|s| s.turn += 17.0 * (i % 3) as f64);
        }
    }
    for (i, placed) in grammar.rules[0].successors.iter_mut().enumerate() {
        if !placed.numbers.is_empty() {
            placed.size = [1.0 + (i % 4) as f64 / 4.0; 3];
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let (count, _, _) = judge(&grammar, folder.path());
    assert!(count > 50, "{count}");
    let city = read(&folder.path().join("city.cga")).unwrap();
    assert_eq!(city.reference_system.as_deref(), Some("EPSG:28992"));
}

/// The value after `attr NAME = ` by a factor.
fn changed(text: &str, name: &str, factor: f64) -> String {
    let start = format!("attr {name} = ");
    let at = text.find(&start).expect("the attribute") + start.len();
    let end = at + text[at..].find('\n').expect("the end of the line");
    let value: f64 = text[at..end].parse().unwrap();
    format!("{}{}{}", &text[..at], value * factor, &text[end..])
}

#[test]
fn an_attribute_changes_the_buildings_that_do_not_state_it() {
    let grammar = made(0.0, 1, &Settings::default());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("city.cga");
    cga::write(&grammar, &path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let before = measures(&cga::read(&path).unwrap());
    let flat = grammar.flat(None);
    let axiom = flat.top().unwrap();
    let shapes = std::fs::read_to_string(folder.path().join("city.shapes.geojson")).unwrap();
    let shapes: serde_json::Value = serde_json::from_str(&shapes).unwrap();
    let (mut moved, mut kept) = (0, 0);
    for rule in grammar.rules.iter().filter(|r| r.levels == 1) {
        let own: Vec<&Placement> = (axiom.successors.iter())
            .filter(|p| p.symbol == rule.symbol)
            .collect();
        if own.len() < 2 {
            continue;
        }
        for attribute in ["h1", "height_factor"] {
            let name = format!("{}_{attribute}", rule.symbol);
            std::fs::write(&path, changed(&text, &name, 1.5)).unwrap();
            let after = measures(&cga::read(&path).unwrap());
            for feature in shapes["features"].as_array().unwrap() {
                let properties = &feature["properties"];
                let id = properties["id"].as_str().unwrap();
                let free =
                    properties["rule"] == rule.symbol.as_str() && properties[&name].is_null();
                let ratio = after[id].0 / before[id].0;
                let expected = if free { 1.5 } else { 1.0 };
                // Heights are rounded to the centimetre.
                assert!((ratio - expected).abs() < 0.003, "{name}, {id}: {ratio}");
                moved += usize::from(free);
                kept += usize::from(!free);
            }
        }
    }
    println!("{moved} buildings moved, {kept} not");
    assert!(moved > 10 && kept > 10);
}

#[test]
fn what_cannot_be_told_is_named() {
    let mut grammar = town();
    let house = grammar
        .templates
        .iter_mut()
        .find(|t| t.symbol == "house")
        .unwrap();
    house.mesh.positions.iter_mut().for_each(|p| p[1] = 0.0);
    let fault = cga::export(&grammar, "town.assets")
        .unwrap_err()
        .to_string();
    assert!(
        fault.contains("\"house\"") && fault.contains("along y"),
        "{fault}"
    );
    let mut grammar = town();
    grammar.axiom = "Nowhere".into();
    let fault = cga::export(&grammar, "town.assets")
        .unwrap_err()
        .to_string();
    assert!(fault.contains("Nowhere"), "{fault}");
}

#[test]
fn bad_rules_and_shapes_are_refused_with_their_place() {
    let scope = Scope {
        at: [0.0; 3],
        turn: 0.0,
        size: [1.0; 3],
    };
    let fault = |text: &str| {
        let rules = SolidRules::parse(text);
        let found = rules.and_then(|r| r.evaluate("A", &Default::default(), scope));
        let e = found.unwrap_err();
        format!("{}:{}: {}", e.line, e.column, e.message)
    };
    for (text, expected) in [
        ("A --> taper(1)", "1:7: the operation taper"),
        ("A --> t(1, 2)", "1:13: found ')'"),
        ("A -->\n B", "2:2: B has no rule"),
        ("A --> A", "1:7: rules go on"),
        ("A --> r(1, 0, 0)", "1:7: turns about y"),
        ("A --> s(0, 1, 1) primitiveCube()", "1:18: a scope of"),
        ("A --> t(x, 0, 0)", "1:9: x has no value"),
        (
            "f(v) = f(v) + f(v)\nA --> t(f(1), 0, 0)",
            "f goes on without end",
        ),
        ("A --> t(1 / 0, 0, 0)", "inf is no length"),
        ("attr a = 1\nattr a = 2", "2:6: this name has a value"),
        ("A(v) --> NIL", "1:1: rules with parameters"),
        ("A --> [ NIL", "found the end of the text"),
        ("B --> NIL", "A has no rule"),
        (&format!("A --> {}", "[".repeat(1000)), "nested too deeply"),
    ] {
        let found = fault(text);
        assert!(found.contains(expected), "{text}: {found}");
    }
    // A long sum is no deep one.
    let text = format!("A --> s(1{}, 1, 1) primitiveCube()", " + 1".repeat(100_000));
    let rules = SolidRules::parse(&text).unwrap();
    let solids = rules.evaluate("A", &Default::default(), scope).unwrap();
    assert_eq!(solids[0].scope.size, [100_001.0, 1.0, 1.0]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.cga");
    std::fs::write(&path, "A --> NIL").unwrap();
    let shapes = |text: &str| {
        std::fs::write(folder.path().join("a.shapes.geojson"), text).unwrap();
        cga::read(&path).unwrap_err().to_string()
    };
    let text = shapes(r#"{"features":[{"properties":{"rule":"B"}}]}"#);
    assert!(text.contains("features[0].properties.rule"), "{text}");
    let text = shapes(
        r#"{"features":[{"properties":{"rule":"A"},"geometry":{"coordinates":[[[0,0],[1,0]]]}}]}"#,
    );
    assert!(text.contains("features[0].geometry.coordinates"), "{text}");
    // A rectangle that is a line, in either direction.
    for ring in ["[[0,0],[1,0],[1,0],[0,0]]", "[[0,0],[0,0],[0,1],[0,1]]"] {
        let text = shapes(&format!(
            r#"{{"features":[{{"properties":{{"rule":"A"}},"geometry":{{"coordinates":[{ring}]}}}}]}}"#
        ));
        assert!(text.contains("features[0].geometry.coordinates"), "{text}");
    }
}
