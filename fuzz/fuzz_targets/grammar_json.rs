//! Grammar JSON: no panic, and what is read is written and read back the same.
#![no_main]

use edifice::io::grammar_json;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(grammar) = grammar_json::parse(bytes, "fuzz".as_ref()) {
        let text = grammar_json::to_string(&grammar);
        let again = grammar_json::parse(text.as_bytes(), "fuzz".as_ref());
        assert_eq!(again.expect("written by us"), grammar);
    }
});
