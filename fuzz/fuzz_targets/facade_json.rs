//! Facade JSON: no panic, and what is read is written and read back the same.
#![no_main]

use edifice::io::facade_json;
use edifice::shape::splittable;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(facade) = facade_json::parse(bytes, "fuzz".as_ref()) {
        let text = facade_json::to_string(&facade);
        let again = facade_json::parse(text.as_bytes(), "fuzz".as_ref());
        assert_eq!(again.expect("written by us"), facade);
        let _ = splittable(&facade);
    }
});
