//! Tables of houses, plain or gzipped: no panic, and rows are as long as the header.
#![no_main]

use edifice::io::building_csv;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = building_csv::parse(bytes, "fuzz".as_ref()) {
        let whole = |row: &Vec<String>| row.len() == table.header.len();
        assert!(!table.rows.is_empty() && table.rows.iter().all(whole));
    }
});
