//! Start shapes as GeoJSON.

use serde_json::{Map, Value, json};

use super::rules::Rules;
use super::shapes::Start;
use edifice_grammar::instance::InstanceGrammar;

/// The GeoJSON of start shapes, one a line.
pub(super) fn text(grammar: &InstanceGrammar, starts: &[Start], rules: &Rules<'_>) -> String {
    let lines: Vec<String> = starts
        .iter()
        .map(|s| feature(s, grammar.origin, rules).to_string())
        .collect();
    let name = Value::from(grammar.name.as_str());
    let system = grammar.reference_system.as_deref().map(|name| {
        let system = json!({ "type": "name", "properties": { "name": name } });
        format!("\"crs\":{system},\n")
    });
    format!(
        "{{\"type\":\"FeatureCollection\",\"name\":{name},\n{}\"features\":[\n{}\n]}}\n",
        system.unwrap_or_default(),
        lines.join(",\n")
    )
}

fn feature(start: &Start, origin: [f64; 3], rules: &Rules<'_>) -> Value {
    let round = |v: f64| (v * 1e6).round() / 1e6 + 0.0;
    let (sin, cos) = start.turn.to_radians().sin_cos();
    let [w, d] = start.plan;
    let corners = [
        [-0.5, -0.5],
        [0.5, -0.5],
        [0.5, 0.5],
        [-0.5, 0.5],
        [-0.5, -0.5],
    ];
    let ring = corners.map(|[x, y]| {
        let (x, y) = (x * w, y * d);
        let at = [x * cos - y * sin, x * sin + y * cos, 0.0];
        [0, 1, 2].map(|k| round(at[k] + start.at[k] + origin[k]))
    });
    let mut properties = Map::new();
    let known = rules.kind(start.kind);
    properties.insert("id".to_owned(), start.id.as_str().into());
    properties.insert("rule".to_owned(), known.rule.as_str().into());
    for ((name, default), value) in known.attributes.iter().zip(&start.numbers) {
        if default != value {
            properties.insert(name.clone(), (*value).into());
        }
    }
    json!({ "type": "Feature", "properties": properties, "geometry": { "type": "Polygon", "coordinates": [ring] } })
}
