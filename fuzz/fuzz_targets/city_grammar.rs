//! City grammars: no panic; written and read back the same.
#![no_main]

use edifice::io::city::grammar_json;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(grammar) = grammar_json::parse(bytes, "fuzz".as_ref()) {
        let text = grammar_json::to_string(&grammar).expect("finite numbers");
        let again = grammar_json::parse(text.as_bytes(), "fuzz".as_ref()).expect("what was written");
        assert_eq!(grammar_json::to_string(&again).expect("finite numbers"), text);
    }
});
