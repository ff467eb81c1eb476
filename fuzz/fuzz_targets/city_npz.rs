//! Cities as NumPy archives: no panic; indices lead somewhere.
#![no_main]

use edifice::io::city::npz;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(city) = npz::parse(bytes.to_vec(), "fuzz".as_ref()) {
        for b in &city.buildings {
            assert_eq!(b.mesh.corners().count(), b.mesh.triangles.len());
        }
    }
});
