//! Model files of the procedural logic: no panic; a model that is read lays out its facades, and is
//! written and read back the same.
#![no_main]

use edifice::io::json::{check_header, parse_json};
use edifice::methods::procedural_logic::{MODEL_FORMAT, MODEL_VERSION, Model, ModelFile};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = "fuzz".as_ref();
    if check_header(bytes, path, MODEL_FORMAT, MODEL_VERSION).is_err() {
        return;
    }
    let Ok(file) = parse_json::<ModelFile>(bytes, path) else {
        return;
    };
    if let Ok(model) = Model::try_from(file) {
        for known in &model.facades {
            let _ = model.layout(known);
        }
        let _ = model.profiles();
        let text = serde_json::to_vec(&ModelFile::from(&model)).expect("a model can be written");
        let again = parse_json::<ModelFile>(&text, path).expect("written by us");
        assert_eq!(Model::try_from(again).expect("written by us"), model);
    }
});
