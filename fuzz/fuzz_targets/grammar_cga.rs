//! CGA text: no panic, and what is read can be written and read again.
#![no_main]

use edifice::io::grammar_cga;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(grammar) = grammar_cga::parse(bytes, "fuzz".as_ref()) {
        let text = grammar_cga::to_string(&grammar);
        grammar_cga::parse(text.as_bytes(), "fuzz".as_ref()).expect("written by us");
    }
});
