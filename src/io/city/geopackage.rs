//! Footprints with heights as a GeoPackage (OGC 12-128r18): the tables of features of a database of SQLite.
//!
//! Each row of each table that `gpkg_contents` lists as `features` is a feature as GeoJSON has it, with the columns of the row as properties:
//! [`footprints`] says what becomes of it. The reference system is that of the tables; of tables with several, the
//! first that has features decides, and the others are left out and noted.

use std::path::Path;

use geozero::ToJson;
use geozero::wkb::GpkgWkb;
use rusqlite::types::ValueRef;
use rusqlite::{Connection, Row};
use serde_json::{Map, Number, Value, json};

use super::{CityError, footprints};
use edifice_base::{Error, Result};
use edifice_io::read_bytes;
use edifice_shape::triangles::City;

/// A table of features.
struct Features {
    table: String,
    geometry: String,
    system: i64,
}

/// Reads a file.
///
/// # Errors
/// Names the file, and the table and the row that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    let fault = |e: rusqlite::Error| Error::content(path, CityError::Format(e.to_string()));
    let mut database = Connection::open_in_memory().map_err(fault)?;
    database
        .deserialize_read_exact("main", bytes, bytes.len(), true)
        .map_err(fault)?;
    let tables = tables(&database).map_err(fault)?;
    let mut features = Vec::new();
    let mut system = None;
    let mut others = Vec::new();
    for table in &tables {
        if system.is_some_and(|s| s != table.system) {
            others.push(table.table.as_str());
            continue;
        }
        rows(&database, table, path, &mut features)?;
        if !features.is_empty() {
            system = Some(table.system);
        }
    }
    let name = match system {
        Some(system) => system_name(&database, system).map_err(fault)?,
        None => None,
    };
    let mut city = footprints::of_features(&features, name, path)?;
    if !others.is_empty() {
        let others = others.join(", ");
        city.notes.push(format!(
            "left out: tables of another reference system: {others}"
        ));
    }
    Ok(city)
}

fn tables(database: &Connection) -> rusqlite::Result<Vec<Features>> {
    let mut query = database.prepare(
        "SELECT g.table_name, g.column_name, g.srs_id FROM gpkg_geometry_columns g \
         JOIN gpkg_contents c ON c.table_name = g.table_name \
         WHERE c.data_type = 'features' ORDER BY g.table_name",
    )?;
    let of_row = |row: &Row| -> rusqlite::Result<Features> {
        Ok(Features {
            table: row.get(0)?,
            geometry: row.get(1)?,
            system: row.get(2)?,
        })
    };
    query.query_map([], of_row)?.collect()
}

/// The reference system as `EPSG:28992`; `None` of the two that mean an unknown one (-1 and 0).
fn system_name(database: &Connection, system: i64) -> rusqlite::Result<Option<String>> {
    let mut query = database.prepare(
        "SELECT organization, organization_coordsys_id FROM gpkg_spatial_ref_sys WHERE srs_id = ?1",
    )?;
    let mut rows = query.query([system])?;
    let Some(row) = rows.next()?.filter(|_| system > 0) else {
        return Ok(None);
    };
    let (organization, code): (String, i64) = (row.get(0)?, row.get(1)?);
    Ok(Some(format!("{}:{code}", organization.to_uppercase())))
}

/// The names of the columns that `SELECT *` gives, and whether each is the key of the table. (The names of a statement, which `rusqlite`
/// would give, panic in a damaged file.)
fn columns(database: &Connection, table: &str) -> rusqlite::Result<Vec<(String, bool)>> {
    let mut query = database.prepare(
        "SELECT name, pk = 1 FROM pragma_table_xinfo(?1) WHERE hidden <> 1 ORDER BY cid",
    )?;
    query
        .query_map([table], |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect()
}

/// Appends the rows of a table as features.
fn rows(
    database: &Connection,
    table: &Features,
    path: &Path,
    features: &mut Vec<Value>,
) -> Result<()> {
    let at = |row: usize, text: String| {
        let place = format!("{}, row {row}", table.table);
        Error::input(path, place, CityError::Format(text))
    };
    let fault = |e: rusqlite::Error| at(features.len() + 1, e.to_string());
    let name = table.table.replace('"', "\"\"");
    let mut query = database
        .prepare(&format!("SELECT * FROM \"{name}\""))
        .map_err(fault)?;
    let columns = columns(database, &table.table).map_err(fault)?;
    let mut rows = query.query([]).map_err(fault)?;
    let mut count = 0;
    loop {
        count += 1;
        let Some(row) = rows.next().map_err(|e| at(count, e.to_string()))? else {
            return Ok(());
        };
        let mut properties = Map::new();
        let (mut geometry, mut key) = (Value::Null, Value::Null);
        for (k, (column, is_key)) in columns.iter().enumerate() {
            let value = row.get_ref(k).map_err(|e| at(count, e.to_string()))?;
            match value {
                ValueRef::Blob(blob) if *column == table.geometry => {
                    geometry = of_blob(blob).map_err(|text| at(count, text))?;
                }
                value => {
                    if *is_key {
                        key = of_value(value);
                    }
                    properties.insert(column.clone(), of_value(value));
                }
            }
        }
        // The key of the row is the identifier where there is no other.
        let id = properties.get("id").filter(|id| !id.is_null());
        let id = id.cloned().unwrap_or(key);
        features.push(json!({ "id": id, "properties": properties, "geometry": geometry }));
    }
}

/// A geometry as GeoJSON.
fn of_blob(blob: &[u8]) -> Result<Value, String> {
    let text = GpkgWkb(blob.to_vec()).to_json();
    let text = text.map_err(|e| format!("a damaged geometry: {e}"))?;
    serde_json::from_str(&text).map_err(|e| format!("a damaged geometry: {e}"))
}

fn of_value(value: ValueRef) -> Value {
    match value {
        ValueRef::Integer(v) => v.into(),
        ValueRef::Real(v) => Number::from_f64(v).map_or(Value::Null, Value::Number),
        ValueRef::Text(text) => String::from_utf8_lossy(text).into(),
        ValueRef::Null | ValueRef::Blob(_) => Value::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with its corner there, as a geometry of a GeoPackage: little-endian, without an envelope.
    fn square(x: f64, y: f64, side: f64) -> Vec<u8> {
        let mut blob = b"GP\0\x01".to_vec();
        blob.extend(28992_i32.to_le_bytes());
        blob.push(1);
        for n in [3_u32, 1, 5] {
            blob.extend(n.to_le_bytes());
        }
        for [i, j] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]] {
            blob.extend((x + side * i).to_le_bytes());
            blob.extend((y + side * j).to_le_bytes());
        }
        blob
    }

    fn package(geometry: &[u8]) -> Vec<u8> {
        let mut database = Connection::open_in_memory().unwrap();
        database
            .execute_batch(
                "CREATE TABLE gpkg_spatial_ref_sys (srs_id INTEGER, organization TEXT, organization_coordsys_id INTEGER);
                 INSERT INTO gpkg_spatial_ref_sys VALUES (28992, 'epsg', 28992), (2263, 'EPSG', 2263);
                 CREATE TABLE gpkg_contents (table_name TEXT, data_type TEXT);
                 INSERT INTO gpkg_contents VALUES ('houses \"a\"', 'features'), ('other', 'features'), ('plan', 'tiles');
                 CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, srs_id INTEGER);
                 INSERT INTO gpkg_geometry_columns VALUES ('houses \"a\"', 'shape', 28992), ('other', 'geom', 2263);
                 CREATE TABLE \"houses \"\"a\"\"\" (ogc_fid INTEGER PRIMARY KEY, id TEXT, shape BLOB, height REAL, use TEXT);
                 CREATE TABLE other (geom BLOB, height REAL);",
            )
            .unwrap();
        for (blob, height) in [
            (geometry, Some(9.0)),
            (&square(85040.0, 446000.0, 5.0), None),
        ] {
            let insert =
                "INSERT INTO \"houses \"\"a\"\"\" (shape, height, use) VALUES (?1, ?2, 'shop')";
            database.execute(insert, (blob, height)).unwrap();
        }
        database.serialize("main").unwrap().to_vec()
    }

    #[test]
    fn rows_are_buildings() {
        let bytes = package(&square(85000.0, 446000.0, 10.0));
        let city = parse(&bytes, Path::new("a.gpkg")).unwrap();
        assert_eq!(city.reference_system.as_deref(), Some("EPSG:28992"));
        assert_eq!(city.origin, [85000.0, 446000.0, 0.0]);
        let [building] = &city.buildings[..] else {
            panic!("{} buildings", city.buildings.len());
        };
        assert_eq!(building.id, "1");
        assert_eq!(building.attributes["use"], "shop");
        assert!((building.mesh.volume_above(0.0) - 900.0).abs() < 1e-6);
        let expected = [
            "left out: 1 footprints without a height",
            "left out: tables of another reference system: other",
        ];
        assert_eq!(city.notes, expected);
    }

    #[test]
    fn damage_is_said_and_harmless() {
        let said = |bytes: &[u8]| {
            let error = parse(bytes, Path::new("a.gpkg")).unwrap_err();
            error.to_string()
        };
        assert!(said(b"no database at all").contains("a.gpkg"));
        let mut blob = square(85000.0, 446000.0, 10.0);
        // Four thousand million corners, of which five follow.
        blob[17..21].copy_from_slice(&u32::MAX.to_le_bytes());
        let text = said(&package(&blob));
        assert!(
            text.contains("row 1") && text.contains("damaged geometry"),
            "{text}"
        );
        let bytes = package(&square(85000.0, 446000.0, 10.0));
        let mut state = 7_u64;
        for _ in 0..2000 {
            let mut damaged = bytes.clone();
            for _ in 0..8 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                let at = (state >> 33) as usize % damaged.len();
                damaged[at] = (state >> 25) as u8;
            }
            // Any answer will do, so long as it comes.
            drop(parse(&damaged, Path::new("a.gpkg")));
        }
    }
}
