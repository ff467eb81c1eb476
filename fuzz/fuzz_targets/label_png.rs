//! Label images, PNG and (by nearest colours) JPEG: no panic, and what is read is a valid picture.
#![no_main]

use edifice::io::{LabelMap, label_image};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let map = LabelMap::cmp();
    for map in [None, Some(&map)] {
        if let Ok(grid) = label_image::parse(bytes, "fuzz".as_ref(), map) {
            assert_eq!(grid.check(), Ok(()));
        }
    }
    if let Ok((grid, _)) = label_image::parse_nearest(bytes, "fuzz".as_ref(), None) {
        assert_eq!(grid.check(), Ok(()));
    }
});
