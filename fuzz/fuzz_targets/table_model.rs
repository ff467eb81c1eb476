//! Model files of tables: no panic, and what is read is written and read back.
#![no_main]

use edifice::model::tables::table_model::TableModel;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(file) = TableModel::from_json(text) {
        let written = file.to_json().expect("read by us");
        TableModel::from_json(&written).expect("written by us");
    }
});
