//! Tables in HTML, for notebooks.

/// Text within HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// A table with a caption: the first column is each row's name, the others have these names.
pub fn table(caption: &str, columns: &[&str], rows: &[(String, Vec<String>)]) -> String {
    let cell = |tag: &str, text: &str| format!("<{tag}>{}</{tag}>", escaped(text));
    let head: String = columns.iter().map(|name| cell("th", name)).collect();
    let line = |(name, cells): &(String, Vec<String>)| {
        let cells: String = cells.iter().map(|text| cell("td", text)).collect();
        format!("<tr>{}{cells}</tr>", cell("th", name))
    };
    let body: String = rows.iter().map(line).collect();
    format!(
        "<table><caption>{}</caption><thead><tr><th></th>{head}</tr></thead><tbody>{body}</tbody></table>",
        escaped(caption)
    )
}
