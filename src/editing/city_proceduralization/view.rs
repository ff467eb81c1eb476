//! The view of a city, as a page shows it: templates once, and the places of their instances.

use serde_json::{Value, json};

use super::paths::paths;
use super::{City, Made};
use edifice_base::Result;

/// Everything there is to show: lengths in metres to the centimetre, corners of templates in thousandths of their box.
pub(super) fn view(city: &City) -> Result<Value> {
    let original = city.original.as_ref().map(|o| {
        json!({"buildings": o.city.buildings.len(), "triangles": o.city.triangles(), "file": o.file})
    });
    let mut shown = city
        .made
        .as_ref()
        .map_or_else(nothing, |m| grammar(city, m));
    shown["unit"] = "m".into();
    shown["original"] = json!(original);
    Ok(shown)
}

/// A city without a grammar.
fn nothing() -> Value {
    json!({
        "level": null, "origin": [0.0, 0.0, 0.0], "templates": [], "instances": [], "buildings": [], "types": [], "typeNames": [],
        "errors": null, "rules": [], "depth": 0, "nonTerminals": 0,
    })
}

fn grammar(city: &City, made: &Made) -> Value {
    let Made {
        grammar,
        derivation,
        level,
        errors,
    } = made;
    let templates = grammar.templates.iter().map(|t| {
        let thousandths = |v: &f64| (v * 1e3).round() as i64;
        let positions: Vec<i64> = t.mesh.positions.iter().flatten().map(thousandths).collect();
        json!({"symbol": t.symbol, "positions": positions, "triangles": t.mesh.triangles.concat()})
    });
    let known = paths(grammar, None);
    let instances = derivation
        .instances
        .iter()
        .zip(&known.depths)
        .map(|(i, depth)| {
            let place = [i.at, i.size].concat();
            let mut row: Vec<f64> = place.iter().map(|v| (v * 100.0).round() / 100.0).collect();
            row.push((i.turn * 100.0).round() / 100.0);
            json!([i.template, i.building, row, depth])
        });
    let rules = grammar.rules.iter().enumerate();
    let shown = rules.filter(|(_, r)| r.symbol != grammar.axiom).map(|(index, r)| {
        json!({"rule": index, "symbol": r.symbol, "weight": r.weight, "parts": r.successors.len()})
    });
    let buildings: Vec<&str> = derivation.buildings.iter().map(|b| b.0.as_str()).collect();
    let mut names: Vec<&str> = known.types.values().map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    let number = |id: &&str| {
        known
            .types
            .get(*id)
            .and_then(|t| names.binary_search(&t.as_str()).ok())
    };
    let types: Vec<Option<usize>> = buildings.iter().map(number).collect();
    let errors = city.original.as_ref().map(|original| {
        errors.get_or_init(|| {
            let errors = original.volume_errors(&derivation.city(grammar));
            let thousandths = |id: &&str| errors.get(*id).map(|e| (e * 1e3).round() / 1e3);
            buildings.iter().map(thousandths).collect()
        })
    });
    json!({
        "level": level, "origin": grammar.origin, "templates": templates.collect::<Vec<_>>(),
        "instances": instances.collect::<Vec<_>>(), "buildings": buildings, "types": types, "typeNames": names, "errors": errors,
        "rules": shown.collect::<Vec<_>>(), "depth": derivation.depth, "nonTerminals": grammar.non_terminals(),
    })
}
