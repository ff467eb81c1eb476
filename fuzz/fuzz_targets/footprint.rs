//! Footprints as GeoJSON: no panic; a plan that is read is of one piece.
#![no_main]

use edifice::io::footprint;
use edifice::shape::PlanUnion;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(plan) = footprint::parse(bytes, "fuzz".as_ref()) {
        assert_eq!(PlanUnion::new(&plan).soundness().parts, 1);
    }
});
