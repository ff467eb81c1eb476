//! Shapes on the ground as GeoJSON: `Polygon` or `MultiPolygon`, as geometry, feature or collection, in metres.

use std::path::Path;

use serde_json::Value;

use super::{CityError, FARTHEST};
use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_io::read_bytes;

/// Rings of a shape, holes and parts alike, each without its last corner, which repeats the first.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<Vec<Vec<[f64; 2]>>> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Vec<Vec<[f64; 2]>>> {
    let value: Value = parse_json(bytes, path)?;
    let mut rings = Vec::new();
    collect(&value, "", &mut rings).map_err(|(place, e)| Error::input(path, place, e))?;
    let points: Vec<&[f64; 2]> = rings.iter().flatten().collect();
    if points.is_empty() {
        let text = "no polygon".to_owned();
        return Err(Error::content(path, CityError::Format(text)));
    }
    let extent = |k: usize| {
        let low = points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        points
            .iter()
            .map(|p| p[k])
            .fold(f64::NEG_INFINITY, f64::max)
            - low
    };
    let extent = extent(0).max(extent(1));
    match extent < 1.0 {
        true => Err(Error::content(path, CityError::Degrees(extent))),
        false => Ok(rings),
    }
}

type Placed = (String, CityError);

fn collect(value: &Value, place: &str, rings: &mut Vec<Vec<[f64; 2]>>) -> Result<(), Placed> {
    let inner = |key: &str| match place {
        "" => key.to_owned(),
        _ => format!("{place}.{key}"),
    };
    let list = |key: &str| {
        value
            .get(key)
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
    };
    match value.get("type").and_then(Value::as_str) {
        Some("FeatureCollection") => (list("features").enumerate())
            .try_for_each(|(i, f)| collect(f, &inner(&format!("features[{i}]")), rings)),
        Some("GeometryCollection") => (list("geometries").enumerate())
            .try_for_each(|(i, f)| collect(f, &inner(&format!("geometries[{i}]")), rings)),
        Some("Feature") => collect(
            value.get("geometry").unwrap_or(&Value::Null),
            &inner("geometry"),
            rings,
        ),
        Some("Polygon") => polygon(list("coordinates"), &inner("coordinates"), rings),
        Some("MultiPolygon") => list("coordinates").enumerate().try_for_each(|(i, p)| {
            let parts = p.as_array().into_iter().flatten();
            polygon(parts, &inner(&format!("coordinates[{i}]")), rings)
        }),
        other => {
            let text = format!("type {other:?} is no polygon");
            Err((inner("type"), CityError::Format(text)))
        }
    }
}

fn polygon<'a>(
    list: impl Iterator<Item = &'a Value>,
    place: &str,
    rings: &mut Vec<Vec<[f64; 2]>>,
) -> Result<(), Placed> {
    for (r, ring) in list.enumerate() {
        let mut corners: Vec<[f64; 2]> = Vec::new();
        for (i, p) in ring.as_array().into_iter().flatten().enumerate() {
            let at = |k: usize| p.get(k).and_then(Value::as_f64);
            let place = || format!("{place}[{r}][{i}]");
            let (Some(x), Some(y)) = (at(0), at(1)) else {
                let text = "a corner is two numbers".to_owned();
                return Err((place(), CityError::Format(text)));
            };
            if let Some(v) = [x, y].into_iter().find(|v| v.abs() > FARTHEST) {
                return Err((place(), CityError::Coordinate(v)));
            }
            corners.push([x, y]);
        }
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            let text = format!("a ring of {} corners", corners.len());
            return Err((format!("{place}[{r}]"), CityError::Format(text)));
        }
        rings.push(corners);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn say(text: &str) -> Result<usize> {
        parse(text.as_bytes(), "p.geojson".as_ref()).map(|rings| rings.len())
    }

    #[test]
    fn shapes_are_read_and_refused() {
        let square = "[[0,0],[90,0],[90,90],[0,90],[0,0]]";
        let hole = "[[20,20],[30,20],[30,30]]";
        let polygon = format!(r#"{{"type":"Polygon","coordinates":[{square},{hole}]}}"#);
        assert_eq!(say(&polygon).unwrap(), 2);
        let whole = format!(
            r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","geometry":{polygon}}}]}}"#
        );
        assert_eq!(say(&whole).unwrap(), 2);
        let multi = format!(r#"{{"type":"MultiPolygon","coordinates":[[{square}],[{hole}]]}}"#);
        assert_eq!(say(&multi).unwrap(), 2);
        let fault = |text: &str| say(text).unwrap_err().to_string();
        assert!(fault(r#"{"type":"Point","coordinates":[1,2]}"#).contains("type"));
        assert!(fault(r#"{"type":"Polygon","coordinates":[]}"#).contains("no polygon"));
        let text = r#"{"type":"Polygon","coordinates":[[[0,0],[1,"a"],[2,2]]]}"#;
        assert!(fault(text).contains("coordinates[0][1]"));
        let text = r#"{"type":"Polygon","coordinates":[[[0,0],[1e9,0],[2,2]]]}"#;
        assert!(fault(text).contains("coordinates[0][1]"));
        let text = r#"{"type":"Polygon","coordinates":[[[4.35,52.01],[4.36,52.01],[4.36,52.02]]]}"#;
        assert!(fault(text).contains("degrees"));
    }
}
