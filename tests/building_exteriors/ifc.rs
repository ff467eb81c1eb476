//! IFC of houses: whole references, a product for each part, strings and numbers of the exchange format.

use edifice::io::{building_json, detailed_ifc};
use edifice::methods::building_exteriors::house::parts::parts;
use edifice::methods::building_exteriors::house::scene::colour;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::shape::{Building, DetailedBuilding, PartKind};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

fn shipped() -> Vec<Building> {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    building_json::read(&shipped).unwrap()
}

fn detailed(building: &Building) -> DetailedBuilding {
    parts(building, &model(building, Joining::Boxes).unwrap())
}

fn text(building: &DetailedBuilding) -> String {
    detailed_ifc::to_text(building, |finish| colour(finish, 0))
}

/// A token of the clear text: a string in quotes, or what stands between separators.
fn tokens(line: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '\'' => {
                // Up to an apostrophe that is not doubled.
                let mut end = 1;
                loop {
                    end += rest[end..].find('\'').expect("the end of a string") + 1;
                    if !rest[end..].starts_with('\'') {
                        break end;
                    }
                    end += 1;
                }
            }
            '(' | ')' | ',' | ';' | '=' => 1,
            _ => rest.find(['(', ')', ',', ';', '=', '\'']).expect("an end"),
        };
        found.push(&rest[..length]);
        rest = &rest[length..];
    }
    found
}

/// Instances by number: class, and the tokens of the arguments. Panics where the text is not well formed.
fn instances(text: &str) -> BTreeMap<usize, (String, Vec<String>)> {
    assert!(text.starts_with("ISO-10303-21;\nHEADER;\n") && text.is_ascii());
    let (_, data) = text.split_once("\nDATA;\n").unwrap();
    let data = data.strip_suffix("ENDSEC;\nEND-ISO-10303-21;\n").unwrap();
    let mut all = BTreeMap::new();
    for line in data.lines() {
        let all_tokens = tokens(line);
        let [id, "=", class, arguments @ .., ";"] = &all_tokens[..] else {
            panic!("{line}");
        };
        let id = id.strip_prefix('#').unwrap().parse().unwrap();
        let depth = arguments.iter().fold(0, |depth, t| match *t {
            "(" => depth + 1,
            ")" => depth - 1,
            _ => depth,
        });
        assert_eq!(depth, 0, "{line}");
        let arguments: Vec<_> = arguments.iter().map(|t| (*t).to_owned()).collect();
        let earlier = all.insert(id, ((*class).to_owned(), arguments));
        assert_eq!(earlier, None, "#{id} twice");
    }
    all
}

/// Checks what every file has; returns the number of instances of each class.
fn check(building: &DetailedBuilding) -> BTreeMap<String, usize> {
    let text = text(building);
    assert!(
        text == self::text(building),
        "{}: the same bytes",
        building.name
    );
    let all = instances(&text);
    let mut ids = BTreeSet::new();
    let mut counts = BTreeMap::new();
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    for (id, (class, arguments)) in &all {
        *counts.entry(class.clone()).or_default() += 1;
        for token in arguments {
            if let Some(other) = token.strip_prefix('#') {
                let other: usize = other.parse().unwrap();
                assert!(
                    all.contains_key(&other) && other < *id,
                    "#{id} needs #{other}"
                );
            } else if token.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
                let number: f64 = token.parse().unwrap();
                assert!(number.is_finite() && number.abs() < 1e4, "#{id}: {token}");
            }
        }
        // What has a global identifier has it first, as a string of 22 signs.
        if arguments[1].len() == 24 && arguments.get(3).is_some_and(|owner| owner == "$") {
            assert!(ids.insert(arguments[1].clone()), "#{id}: identifier twice");
            if let Some(name) = arguments.get(5) {
                *names.entry(name).or_default() += 1;
            }
        }
    }
    for part in &building.parts {
        let name = format!("'{}'", part.name.replace('\'', "''"));
        if part.name.is_ascii() {
            assert_eq!(
                names.get(name.as_str()),
                Some(&1),
                "{} {name}",
                building.name
            );
        }
    }
    let count = |class: &str| counts.get(class).copied().unwrap_or(0);
    let of = |kind: PartKind| building.parts.iter().filter(|p| p.kind == kind).count();
    assert_eq!(count("IFCWINDOW"), of(PartKind::Window));
    assert_eq!(count("IFCDOOR"), of(PartKind::Door));
    assert_eq!(count("IFCWALL"), of(PartKind::WallSurface));
    let hosted = building.parts.iter().filter(|p| p.wall.is_some()).count();
    for class in [
        "IFCOPENINGELEMENT",
        "IFCRELVOIDSELEMENT",
        "IFCRELFILLSELEMENT",
    ] {
        assert_eq!(count(class), hosted, "{class}");
    }
    let products = [
        "WALL",
        "SLAB",
        "WINDOW",
        "DOOR",
        "COVERING",
        "CHIMNEY",
        "BUILDINGELEMENTPROXY",
    ];
    let products = products.iter().map(|class| count(&format!("IFC{class}")));
    assert_eq!(products.sum::<usize>(), building.parts.len());
    counts
}

#[test]
fn every_reference_is_of_an_instance_and_every_part_is_a_product() {
    for building in shipped().iter().step_by(11) {
        let detailed = detailed(building);
        let counts = check(&detailed);
        assert_eq!(counts["IFCBUILDINGSTOREY"], building.floors());
        let text = text(&detailed);
        let triangles: usize = detailed.parts.iter().map(|p| p.triangles.len()).sum();
        let faces = text
            .lines()
            .filter(|l| l.contains("=IFCTRIANGULATEDFACESET("));
        // Each triangle is written as three numbers in parentheses within the list of its set.
        let written: usize = faces.map(|l| l.matches("),(").count() + 1).sum();
        assert_eq!(written, triangles, "{}", building.name);
    }
}

#[test]
fn a_house_without_windows_and_one_without_anything_are_written() {
    let mut building = shipped().swap_remove(0);
    for piece in &mut building.facades {
        piece.elements.clear();
    }
    let counts = check(&detailed(&building));
    assert!(!counts.contains_key("IFCWINDOW") && counts["IFCWALL"] > 0);
    let counts = check(&DetailedBuilding::default());
    assert_eq!(counts["IFCBUILDINGSTOREY"], 1);
}

#[test]
fn names_and_attributes_are_escaped() {
    let mut building = shipped().swap_remove(0);
    building.name = r"O'Brien\Größe 家".into();
    let mut detailed = detailed(&building);
    detailed.parts[0].name = "d'un côté".into();
    let attributes = &mut detailed.parts[0].attributes;
    attributes.insert("probability".into(), 1e-7.into());
    attributes.insert("it's".into(), serde_json::json!({ "a": ["ü"] }));
    check(&detailed);
    let text = text(&detailed);
    assert!(text.contains(r"'O''Brien\\Gr\X2\00F600DF\X0\e \X2\5BB6\X0\'"));
    assert!(text.contains(r"'d''un c\X2\00F4\X0\t\X2\00E9\X0\'"));
    assert!(text.contains("IFCPROPERTYSINGLEVALUE('probability',$,IFCREAL(1.E-7),$)"));
    assert!(text.contains(r#"('it''s',$,IFCTEXT('{"a":["\X2\00FC\X0\"]}'),$)"#));
}

#[test]
fn a_window_lies_in_the_opening_of_its_wall_with_its_size() {
    let building = &shipped()[0];
    let detailed = detailed(building);
    let all = instances(&text(&detailed));
    let reference = |token: &str| token.strip_prefix('#').unwrap().parse::<usize>().unwrap();
    let fills = all.values().filter(|(c, _)| c == "IFCRELFILLSELEMENT");
    for (_, arguments) in fills {
        // From the end: `)`, element, comma, opening.
        let end = arguments.len();
        let element = reference(&arguments[end - 2]);
        let opening = reference(&arguments[end - 4]);
        let name = all[&element].1[5].trim_matches('\'').to_owned();
        let part = detailed.parts.iter().find(|p| p.name == name).unwrap();
        let rect = part.rect.unwrap();
        // Placement of the element is relative to that of its opening.
        let place = |id: usize| reference(&all[&id].1[11]);
        assert_eq!(reference(&all[&place(element)].1[1]), place(opening));
        // Identifier, owner, name, description, type, placement, shape, tag, height, width; commas between.
        let sizes = [17, 19].map(|k| all[&element].1[k].parse::<f64>().unwrap());
        assert!((sizes[0] - rect.height).abs() < 1e-6 && (sizes[1] - rect.width).abs() < 1e-6);
        // The wall is not cut again: its hole has no shape.
        assert_eq!(all[&opening].1[13], "$");
        let voids = all
            .values()
            .find(|(c, a)| c == "IFCRELVOIDSELEMENT" && reference(&a[a.len() - 2]) == opening);
        let wall = reference(&voids.unwrap().1[9]);
        let wall_name = all[&wall].1[5].trim_matches('\'').to_owned();
        assert_eq!(wall_name, detailed.parts[part.wall.unwrap()].name);
    }
}
