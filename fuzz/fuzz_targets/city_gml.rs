//! CityGML: no panic.
#![no_main]

use edifice::io::city::citygml;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = citygml::parse(bytes, "fuzz.gml".as_ref());
});
