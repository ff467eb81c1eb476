//! Broken houses of many kinds: each is refused, when it is read or by the check, with its place named.

use std::path::Path;

use edifice::io::building_json;
use edifice::methods::building_exteriors::house::{Joining, inspect};
use serde_json::{Value, json};

/// A small sound house.
fn sound() -> Value {
    let shipped = "datasets/building_exteriors/houses.buildings.jsonl";
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(shipped)).unwrap();
    serde_json::from_str(text.lines().nth(57).unwrap()).unwrap()
}

/// Faults of a house, from the reader or the check.
fn wrong(house: &Value) -> Vec<String> {
    let bytes = serde_json::to_vec(house).unwrap();
    match building_json::parse(&bytes, Path::new("house.building.json")) {
        Err(e) => vec![e.to_string()],
        Ok(building) => inspect::faults(&building, Joining::Boxes),
    }
}

#[test]
fn every_kind_of_broken_house_is_refused_with_its_place() {
    let whole = sound();
    assert_eq!(wrong(&whole), Vec::<String>::new());
    type Break = fn(&mut Value);
    let kinds: [(&str, &str, Break); 26] = [
        ("no boxes", "no boxes", |h| h["boxes"] = json!([])),
        ("unit", "unit", |h| h["unit"] = json!("bananas")),
        ("feet", "unit", |h| h["unit"] = json!("ft")),
        ("steep", "boxes[0].roof.pitch", |h| {
            h["boxes"][0]["roof"]["pitch"] = json!(89)
        }),
        ("upright", "boxes[0].roof.pitch", |h| {
            h["boxes"][0]["roof"]["pitch"] = json!(90)
        }),
        ("a millimetre", "boxes[0].width", |h| {
            h["boxes"][0]["width"] = json!(0.001)
        }),
        ("negative", "boxes[0].depth", |h| {
            h["boxes"][0]["depth"] = json!(-3)
        }),
        ("huge", "boxes[0].depth", |h| {
            h["boxes"][0]["depth"] = json!(1e26)
        }),
        ("far away", "boxes[0].x", |h| {
            h["boxes"][0]["x"] = json!(1e9)
        }),
        ("low", "boxes[0].height", |h| {
            h["boxes"][0]["height"] = json!(0.2)
        }),
        ("a tower block", "boxes[0]", |h| {
            h["boxes"][0]["height"] = json!(30)
        }),
        ("low floors", "floor_height", |h| {
            h["floor_height"] = json!(0.9)
        }),
        ("no floors", "floor_height", |h| {
            h["floor_height"] = json!(0)
        }),
        ("no facades", "facades", |h| h["facades"] = json!([])),
        ("apart", "boxes[0]", |h| h["boxes"][0]["x"] = json!(200)),
        ("doubled", "boxes[", |h| {
            let b = h["boxes"][0].clone();
            h["boxes"].as_array_mut().unwrap().push(b);
        }),
        ("no name", "name", |h| h["name"] = json!(" ")),
        ("twice", "special[1]", |h| {
            h["special"] = json!(["chimney", "chimney"])
        }),
        ("underground", "facades[0].base", |h| {
            h["facades"][0]["base"] = json!(-1)
        }),
        ("between floors", "facades[0].base", |h| {
            h["facades"][0]["base"] = json!(1.4)
        }),
        ("no wall", "facades[0]", |h| {
            h["facades"][0]["start"] = json!(150)
        }),
        ("outside", "facades[", |h| first_element(h)["x"] = json!(80)),
        ("a slit", ".elements[", |h| {
            first_element(h)["width"] = json!(0.01)
        }),
        ("overlapping", ".elements[", |h| {
            let e = first_element(h).clone();
            elements(h).push(e);
        }),
        ("no doors", "no door", |h| {
            for piece in h["facades"].as_array_mut().unwrap() {
                let all = piece["elements"].as_array_mut().unwrap();
                all.retain(|e| e["style"] != "door");
            }
        }),
        ("a style", "style", |h| {
            h["boxes"][0]["style"] = json!("palace")
        }),
    ];
    for (name, place, broken) in kinds {
        let mut house = whole.clone();
        broken(&mut house);
        let found = wrong(&house);
        assert!(found.iter().any(|f| f.contains(place)), "{name}: {found:?}");
    }
}

fn elements(house: &mut Value) -> &mut Vec<Value> {
    let pieces = house["facades"].as_array_mut().unwrap();
    let full = pieces
        .iter_mut()
        .find(|p| !p["elements"].as_array().unwrap().is_empty());
    full.unwrap()["elements"].as_array_mut().unwrap()
}

fn first_element(house: &mut Value) -> &mut Value {
    &mut elements(house)[0]
}
