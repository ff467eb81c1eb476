//! Annotations of Pascal VOC and eTRIMS: no panic, and what is read is written and read back as facade JSON.
#![no_main]

use edifice::io::{annotation_xml, facade_json};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(facade) = annotation_xml::parse(bytes, "fuzz".as_ref(), Some((30.0, 40.0))) else {
        return;
    };
    let text = facade_json::to_string(&facade);
    let again = facade_json::parse(text.as_bytes(), "fuzz".as_ref()).expect("what was written");
    assert_eq!(facade, again);
});
