//! Building JSON and databases: no panic.
#![no_main]

use edifice::io::building_json;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = building_json::parse(bytes, "fuzz".as_ref());
    let _ = building_json::parse_lines(bytes, "fuzz".as_ref());
});
