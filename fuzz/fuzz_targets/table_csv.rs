//! Tables of any kind: a schema is guessed and read by, and has as many rows as the text.
#![no_main]

use std::path::Path;

use edifice::io::building_csv;
use edifice::model::tables::schema::Schema;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = building_csv::parse(bytes, Path::new("input"))
        && let Ok(schema) = Schema::guess(&table.header, &table.rows)
        && let Ok(data) = schema.read(&table.header, &table.rows)
    {
        assert_eq!(data.table.rows(), table.rows.len());
    }
});
