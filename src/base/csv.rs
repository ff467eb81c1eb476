//! Cells of CSV files (RFC 4180, Sec. 2).

use std::borrow::Cow;

/// Texts that commonly mean "not known", in any table.
pub const MISSING: [&str; 10] = [
    "", "NA", "N/A", "NaN", "nan", "null", "NULL", "#N/A", "<NA>", "?",
];

/// A cell that reads back as `text`: in quotation marks where it has a comma, a quotation mark or an end of line.
///
/// # Examples
/// ```
/// use edifice_base::csv::cell;
/// assert_eq!(cell("hip roof"), "hip roof");
/// assert_eq!(cell("2 \"x\" 4, wood"), "\"2 \"\"x\"\" 4, wood\"");
/// ```
pub fn cell(text: &str) -> Cow<'_, str> {
    match text.contains([',', '"', '\n', '\r']) {
        true => quoted(text).into(),
        false => text.into(),
    }
}

/// A cell in quotation marks whatever it has.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
