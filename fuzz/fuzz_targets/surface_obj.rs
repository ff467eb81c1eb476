//! Surfaces of houses as OBJ: no panic; what is closed is closed when written and read again.
#![no_main]

use edifice::io::surface_obj;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(surface) = surface_obj::parse(bytes, "fuzz".as_ref()) else {
        return;
    };
    let text = surface_obj::to_text(&surface, "fuzz");
    let again = surface_obj::parse(text.as_bytes(), "fuzz".as_ref()).expect("written text reads");
    assert_eq!(again.positions, surface.positions);
    assert_eq!(again.check().is_ok(), surface.check().is_ok());
});
