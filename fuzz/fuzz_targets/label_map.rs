//! Label maps: no panic.
#![no_main]

use edifice::io::LabelMap;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = LabelMap::parse(bytes, "fuzz".as_ref());
});
