//! Model files of structure completion: no panic; a model that is read is written and read back the same.
#![no_main]

use edifice::methods::structure_completion::model::Model;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    if let Ok(model) = Model::from_json(text) {
        let again = Model::from_json(&model.to_json());
        assert_eq!(again.expect("written by us"), model);
    }
});
