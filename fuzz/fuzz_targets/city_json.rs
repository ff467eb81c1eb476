//! CityJSON, CityJSONSeq, GeoJSON shapes and views: no panic.
#![no_main]

use edifice::io::city::{cityjson, geojson, view_json};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = cityjson::parse(bytes, "fuzz.city.json".as_ref());
    let _ = cityjson::parse(bytes, "fuzz.city.jsonl".as_ref());
    let _ = geojson::parse(bytes, "fuzz".as_ref());
    let _ = view_json::parse(bytes, "fuzz".as_ref());
});
