//! The view of a document as its difference to one that the page has: an edit of a city changes a few entries of long lists.

use serde_json::{Map, Value, json};

/// The difference between two views, both objects: `set` has the keys whose values are new, `at` for lists of the same length the
/// entries that are new by their index, `gone` the keys that are no more.
pub(crate) fn difference(old: &Value, new: &Value) -> Value {
    let none = Map::new();
    let [old, new] = [old, new].map(|v| v.as_object().unwrap_or(&none));
    let (mut set, mut at) = (Map::new(), Map::new());
    for (key, value) in new {
        match (old.get(key), value) {
            (Some(before), _) if before == value => {}
            (Some(Value::Array(before)), Value::Array(now)) if before.len() == now.len() => {
                let pairs = before.iter().zip(now).enumerate();
                let changed: Map<String, Value> = pairs
                    .filter(|(_, (a, b))| a != b)
                    .map(|(k, (_, b))| (k.to_string(), b.clone()))
                    .collect();
                match 2 * changed.len() < now.len() {
                    true => at.insert(key.clone(), changed.into()),
                    false => set.insert(key.clone(), value.clone()),
                };
            }
            _ => _ = set.insert(key.clone(), value.clone()),
        }
    }
    let gone: Vec<&String> = old.keys().filter(|k| !new.contains_key(*k)).collect();
    json!({"set": set, "at": at, "gone": gone})
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The view that the page makes of a difference.
    fn applied(old: &Value, difference: &Value) -> Value {
        let mut now = old.clone();
        for key in difference["gone"].as_array().unwrap() {
            now.as_object_mut().unwrap().remove(key.as_str().unwrap());
        }
        for (key, value) in difference["set"].as_object().unwrap() {
            now[key] = value.clone();
        }
        for (key, entries) in difference["at"].as_object().unwrap() {
            for (k, value) in entries.as_object().unwrap() {
                now[key][k.parse::<usize>().unwrap()] = value.clone();
            }
        }
        now
    }

    #[test]
    fn a_difference_leads_from_one_view_to_the_other() {
        let views = [
            json!({"a": [1, 2, 3, 4], "b": {"x": 1}, "c": null}),
            json!({"a": [1, 2, 9, 4], "b": {"x": 1}, "d": 2}),
            json!({"a": [0, 0, 0, 4], "b": {"x": 2}}),
            json!({"a": [1], "b": []}),
            json!({}),
        ];
        for old in &views {
            for new in &views {
                assert_eq!(&applied(old, &difference(old, new)), new);
            }
        }
        let one = difference(&views[0], &views[1]);
        assert_eq!(one["at"], json!({"a": {"2": 9}}));
        assert_eq!(one["set"], json!({"d": 2}));
    }
}
