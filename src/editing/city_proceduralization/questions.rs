//! Questions to a city that do not change it.

use serde::Deserialize;
use serde_json::{Value, json};

use super::super::{CommandError, parse};
use super::City;
use super::paths::paths;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::localization::{Seen, landmarks, locate};

/// Places that are listed.
const TOP: usize = 5;

#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
enum Question {
    /// Everything known of a building, by its index.
    Building { building: usize },
    /// Finds the places where these buildings stand near each other, as somebody sees them (Demir et al. 2014, Fig.
    /// 10).
    Locate { buildings: Vec<usize> },
}

/// Answers a question.
///
/// # Errors
/// [`CommandError::Form`] for none, [`CommandError::Answer`] for a building that is not there.
pub(super) fn answer(city: &City, question: &Value) -> Result<Value> {
    match parse(question)? {
        Question::Building { building } => of_building(city, building),
        Question::Locate { buildings } => places(city, &buildings),
    }
}

fn of_building(city: &City, index: usize) -> Result<Value> {
    let made = city.made()?;
    let (grammar, buildings) = (&made.grammar, &made.derivation.buildings);
    let (id, attributes) = buildings
        .get(index)
        .ok_or(NoBuilding(index))
        .map_err(Error::method)?;
    let known = paths(grammar, Some(id));
    let own = &known.types[id];
    let path = known.path.iter().map(|turn| {
        let rule = &grammar.rules[turn.rule];
        json!({"rule": turn.rule, "symbol": rule.symbol, "part": turn.part, "parts": rule.successors.len()})
    });
    let siblings = (0..buildings.len()).filter(|k| known.types.get(&buildings[*k].0) == Some(own));
    Ok(json!({
        "id": id, "type": own, "attributes": attributes, "path": path.collect::<Vec<_>>(),
        "siblings": siblings.collect::<Vec<_>>(),
    }))
}

fn places(city: &City, seen: &[usize]) -> Result<Value> {
    let made = city.made()?;
    let derived = made.derivation.city(&made.grammar);
    let (landmarks, building) = landmarks(&derived);
    if seen.is_empty() {
        return Err(CommandError::Nothing.into());
    }
    let view: Vec<Seen> = seen
        .iter()
        .map(|index| {
            let own = building.iter().position(|b| b == index);
            own.map(|l| landmarks[l].seen).ok_or(NoBuilding(*index))
        })
        .collect::<std::result::Result<_, _>>()
        .map_err(Error::method)?;
    let found = locate(&landmarks, &view, TOP);
    let places = found.iter().map(|f| {
        let at = landmarks[f.landmark].at;
        let matched: Vec<usize> = f.matched.iter().map(|l| building[*l]).collect();
        json!({
            "building": building[f.landmark], "id": derived.buildings[building[f.landmark]].id, "at": at, "cost": f.cost,
            "matched": matched,
        })
    });
    Ok(json!({"places": places.collect::<Vec<_>>()}))
}

/// There is no such building.
#[derive(Debug, thiserror::Error)]
#[error("there is no building {0} with triangles")]
struct NoBuilding(usize);
