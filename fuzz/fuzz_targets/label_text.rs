//! Text matrices: no panic, and small ones decompose into tilings that lines can split.
#![no_main]

use edifice::io::label_text;
use edifice::shape::{LabelGrid, decompose, splittable};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(grid) = label_text::parse(bytes, "fuzz".as_ref(), None) else {
        return;
    };
    assert_eq!(grid.check(), Ok(()));
    if grid.cells.len() <= 1000 {
        let facade = decompose(&grid).expect("a valid grid").facade;
        assert_eq!(splittable(&facade), Ok(()));
        let painted = LabelGrid::from_facade(&facade, None).expect("a tiling");
        assert_eq!(painted.merged(), grid.merged());
    }
});
