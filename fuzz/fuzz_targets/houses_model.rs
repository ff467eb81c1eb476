//! Model files of houses: no panic, and what is read is written and read back.
#![no_main]

use edifice::methods::building_exteriors::model_file::ModelFile;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(file) = ModelFile::from_json(text) {
        let written = file.to_json().expect("a model can be written");
        ModelFile::from_json(&written).expect("written by us");
    }
});
