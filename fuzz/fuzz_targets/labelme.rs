//! Files of LabelMe: no panic, and what is read is written and read back as facade JSON.
#![no_main]

use edifice::io::{facade_json, labelme};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(facade) = labelme::parse(bytes, "fuzz".as_ref()) else {
        return;
    };
    let text = facade_json::to_string(&facade);
    let again = facade_json::parse(text.as_bytes(), "fuzz".as_ref()).expect("what was written");
    assert_eq!(facade, again);
});
