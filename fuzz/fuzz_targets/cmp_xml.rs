//! Rectangles of CMP: no panic, and what is read can be painted.
#![no_main]

use edifice::io::cmp_xml;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(cmp) = cmp_xml::parse(bytes, "fuzz".as_ref()) {
        cmp.elements(300.0, 400.0).expect("elements");
        let grid = cmp.label_grid(300.0, 400.0).expect("a picture");
        assert_eq!(grid.check(), Ok(()));
    }
});
