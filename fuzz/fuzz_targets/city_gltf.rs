//! Cities as glTF: no panic, and indices lead somewhere.
#![no_main]

use std::path::Path;

use edifice::io::city::gltf;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(city) = gltf::parse(bytes, Path::new("input.glb")) {
        for building in &city.buildings {
            let count = building.mesh.positions.len() as u32;
            assert!(building.mesh.triangles.iter().flatten().all(|&i| i < count));
        }
    }
});
