//! The view of a document as its difference to one that the page has: an edit of a city changes a few numbers of long lists.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

/// Fewer changed entries of a list are told whole.
const FEW: usize = 8;

/// The difference between two views, both objects: `set` has the keys whose values are new, `at` for lists of the same length the
/// entries that are new by their index, `numbers` those lists in which only numbers of hundredths changed, `gone` the keys that are no
/// more.
///
/// A list of `numbers` has `rows`, the changed entries, each as its index less the one before, and `columns`: `path` leads to the
/// number in an entry, which becomes `floor(100 * times * number + 0.5) + off` hundredths. `off` lists those that are not 0, as pairs: the
/// position in `rows` less that of the pair before, then the number.
pub(crate) fn difference(old: &Value, new: &Value) -> Value {
    let none = Map::new();
    let [old, new] = [old, new].map(|v| v.as_object().unwrap_or(&none));
    let (mut set, mut at, mut numbers) = (Map::new(), Map::new(), Map::new());
    for (key, value) in new {
        match (old.get(key), value) {
            (Some(before), _) if before == value => {}
            (Some(Value::Array(before)), Value::Array(now)) if before.len() == now.len() => {
                let pairs = before.iter().zip(now).enumerate();
                let changed: Vec<(usize, &Value, &Value)> = pairs
                    .filter(|(_, (a, b))| a != b)
                    .map(|(k, (a, b))| (k, a, b))
                    .collect();
                let columns = match changed.len() > FEW {
                    true => columns(&changed),
                    false => None,
                };
                if let Some(columns) = columns {
                    numbers.insert(key.clone(), columns);
                } else if 2 * changed.len() < now.len() {
                    let entries = changed
                        .iter()
                        .map(|(k, _, b)| (k.to_string(), (*b).clone()));
                    at.insert(key.clone(), Value::Object(entries.collect()));
                } else {
                    set.insert(key.clone(), value.clone());
                }
            }
            _ => _ = set.insert(key.clone(), value.clone()),
        }
    }
    let gone: Vec<&String> = old.keys().filter(|k| !new.contains_key(*k)).collect();
    json!({"set": set, "at": at, "numbers": numbers, "gone": gone})
}

/// Hundredths of a number, if it is a whole number of them.
fn hundredths(value: &Value) -> Option<f64> {
    let value = value.as_f64()?;
    let count = (value * 100.0).round();
    (count.abs() < 1e12 && count / 100.0 == value).then_some(count)
}

/// Adds the paths of all numbers that differ; false if something else differs.
fn leaves(old: &Value, new: &Value, path: &mut Vec<usize>, out: &mut Vec<Vec<usize>>) -> bool {
    match (old, new) {
        _ if old == new => true,
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().all(|(k, (a, b))| {
                path.push(k);
                let only_numbers = leaves(a, b, path, out);
                path.pop();
                only_numbers
            })
        }
        (Value::Number(_), Value::Number(_)) => {
            out.push(path.clone());
            true
        }
        _ => false,
    }
}

fn leaf<'a>(value: &'a Value, path: &[usize]) -> Option<&'a Value> {
    path.iter().try_fold(value, |v, k| v.get(*k))
}

/// The changed entries of a list column by column; `None` if other things than whole hundredths changed.
fn columns(changed: &[(usize, &Value, &Value)]) -> Option<Value> {
    let mut paths: BTreeMap<Vec<usize>, Vec<(f64, f64)>> = BTreeMap::new();
    for (_, old, new) in changed {
        let mut own = Vec::new();
        if !leaves(old, new, &mut Vec::new(), &mut own) {
            return None;
        }
        // Lists of plain numbers are told whole: an entry has to be a list itself.
        if own.iter().any(Vec::is_empty) {
            return None;
        }
        for path in own {
            paths.entry(path).or_default();
        }
    }
    for (path, pairs) in &mut paths {
        for (_, old, new) in changed {
            let [old, new] = [old, new].map(|v| leaf(v, path).and_then(hundredths));
            pairs.push((old?, new?));
        }
    }
    let mut last = 0;
    let rows: Vec<usize> = changed
        .iter()
        .map(|(k, ..)| k - std::mem::replace(&mut last, *k))
        .collect();
    let columns: Vec<Value> = paths
        .iter()
        .map(|(path, pairs)| {
            let times = common_factor(pairs);
            let mut off = Vec::new();
            let mut last = 0;
            for (k, (old, new)) in pairs.iter().enumerate() {
                // As the page computes it, from the number itself.
                let by = new - (100.0 * times * (old / 100.0) + 0.5).floor();
                if by != 0.0 {
                    off.extend([(k - std::mem::replace(&mut last, k)) as i64, by as i64]);
                }
            }
            json!({"path": path, "times": times, "off": off})
        })
        .collect();
    Some(json!({"rows": rows, "columns": columns}))
}

/// The median factor from the old to the new numbers.
fn common_factor(pairs: &[(f64, f64)]) -> f64 {
    let mut factors: Vec<f64> = pairs
        .iter()
        .filter(|(old, _)| *old != 0.0)
        .map(|(old, new)| new / old)
        .collect();
    if factors.is_empty() {
        return 1.0;
    }
    factors.sort_by(f64::total_cmp);
    // Few digits: the factor that the user wrote. All products stay exact integers of at most 53 bits.
    match (factors[factors.len() / 2] * 1e3).round() / 1e3 {
        times if times.abs() <= 1e3 => times,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    /// The number of an entry that a path leads to.
    fn leaf_mut<'a>(value: &'a mut Value, path: &Value) -> &'a mut Value {
        let steps = path.as_array().unwrap().iter();
        steps.fold(value, |v, k| &mut v[k.as_u64().unwrap() as usize])
    }

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
        for (key, list) in difference["numbers"].as_object().unwrap() {
            let mut rows = Vec::new();
            for gap in list["rows"].as_array().unwrap() {
                rows.push(rows.last().unwrap_or(&0) + gap.as_u64().unwrap() as usize);
            }
            for column in list["columns"].as_array().unwrap() {
                let mut off = vec![0.0; rows.len()];
                let mut place = 0;
                for pair in column["off"].as_array().unwrap().chunks(2) {
                    place += pair[0].as_u64().unwrap() as usize;
                    off[place] = pair[1].as_f64().unwrap();
                }
                for (row, off) in rows.iter().zip(off) {
                    let number = leaf_mut(&mut now[key][*row], &column["path"]);
                    let scaled = 100.0 * column["times"].as_f64().unwrap();
                    let count = (scaled * number.as_f64().unwrap() + 0.5).floor() + off;
                    *number = json!(count / 100.0);
                }
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

    /// A list like that of a city's instances.
    fn rows(stream: &mut StdRng, count: usize) -> Vec<Value> {
        let row = |_| {
            let mut number = || f64::from(stream.random_range(-5000..5000)) / 100.0;
            let numbers = [number(), number(), number(), 0.0];
            json!([
                stream.random_range(0..4),
                stream.random_range(0..9),
                numbers
            ])
        };
        (0..count).map(row).collect()
    }

    #[test]
    fn numbers_are_told_column_by_column() {
        let stream = &mut StdRng::seed_from_u64(7);
        for case in 0..2000 {
            let count = stream.random_range(1..40);
            let old = rows(stream, count);
            let (factor, share) = (stream.random_range(0.2..3.0), stream.random_range(0.0..1.0));
            let mut new = old.clone();
            for row in &mut new {
                if stream.random_bool(share) {
                    let number = row[2][1].as_f64().unwrap();
                    row[2][1] = json!((number * factor * 100.0).round() / 100.0);
                }
                match case % 8 {
                    // Things that are not whole hundredths, or no numbers.
                    0 if stream.random_bool(0.1) => row[2][0] = json!(0.125),
                    1 if stream.random_bool(0.1) => row[0] = json!("none"),
                    2 if stream.random_bool(0.1) => row[2][3] = json!(1e15),
                    3 if stream.random_bool(0.5) => row[2][3] = json!(-0.5),
                    4 if stream.random_bool(0.1) => row[2] = json!([1.0]),
                    _ => {}
                }
            }
            let [old, new] = [old, new].map(|list| json!({"list": list}));
            assert_eq!(applied(&old, &difference(&old, &new)), new, "case {case}");
        }
        // An edit of a size is told by its factor.
        let old = json!({"list": rows(stream, 1000)});
        let mut new = old.clone();
        for row in new["list"].as_array_mut().unwrap() {
            let number = row[2][2].as_f64().unwrap();
            row[2][2] = json!((number * 1.5 * 100.0).round() / 100.0);
        }
        let told = difference(&old, &new);
        assert_eq!(told["numbers"]["list"]["columns"][0]["times"], json!(1.5));
        assert!(told.to_string().len() * 5 < new.to_string().len());
    }
}
