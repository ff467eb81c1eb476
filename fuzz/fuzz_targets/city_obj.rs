//! Cities as OBJ: no panic; indices lead somewhere.
#![no_main]

use edifice::io::city::obj;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(city) = obj::parse(bytes, "fuzz".as_ref()) {
        for b in &city.buildings {
            assert_eq!(b.mesh.corners().count(), b.mesh.triangles.len());
        }
    }
});
