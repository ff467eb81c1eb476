//! What a page shows of a city: templates once, and where they stand.

use serde_json::{Value, json};

use crate::grammar::instance::{InstanceDerivation, InstanceGrammar};

/// Everything there is to show: lengths in metres to the centimetre, corners of templates in thousandths of their box.
pub fn view(grammar: &InstanceGrammar, derivation: &InstanceDerivation) -> Value {
    let templates = grammar.templates.iter().map(|t| {
        let thousandths = |v: &f64| (v * 1e3).round() as i64;
        let positions: Vec<i64> = t.mesh.positions.iter().flatten().map(thousandths).collect();
        json!({"symbol": t.symbol, "positions": positions, "triangles": t.mesh.triangles.concat()})
    });
    let instances = derivation.instances.iter().map(|i| {
        let place = [i.at, i.size].concat();
        let mut row: Vec<f64> = place.iter().map(|v| (v * 100.0).round() / 100.0).collect();
        row.push((i.turn * 100.0).round() / 100.0);
        json!([i.template, i.building, row])
    });
    let rules = grammar.rules.iter().enumerate();
    let shown = rules.filter(|(_, r)| r.symbol != grammar.axiom).map(|(index, r)| {
        json!({"rule": index, "symbol": r.symbol, "weight": r.weight, "parts": r.successors.len()})
    });
    let buildings: Vec<&str> = derivation.buildings.iter().map(|b| b.0.as_str()).collect();
    json!({
        "unit": "m", "origin": grammar.origin, "templates": templates.collect::<Vec<_>>(),
        "instances": instances.collect::<Vec<_>>(), "buildings": buildings,
        "rules": shown.collect::<Vec<_>>(), "depth": derivation.depth, "nonTerminals": grammar.non_terminals(),
    })
}
