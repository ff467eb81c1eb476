//! CGA of solids: no panic, and rules end.
#![no_main]

use edifice::io::grammar_cga::solids::{Scope, SolidRules};

libfuzzer_sys::fuzz_target!(|text: &str| {
    let scope = Scope {
        at: [0.0; 3],
        turn: 30.0,
        size: [4.0, 0.0, 3.0],
    };
    if let Ok(rules) = SolidRules::parse(text) {
        let _ = rules.evaluate("A", &Default::default(), scope);
    }
});
