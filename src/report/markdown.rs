//! The Markdown that this crate writes, as HTML: headings, paragraphs, tables, pictures, links, bold, code.

use maud::{Markup, PreEscaped, html};

/// The targets of the links of a page.
#[derive(Clone, Copy)]
pub(crate) struct LinkTargets<'a> {
    /// Folder that links and pictures are relative to.
    pub folder: &'a str,
    /// Files in it: a picture links to its vector form where there is one.
    pub files: &'a [String],
}

/// Renders the page of an artefact. The first heading is left out, since the index has its own.
pub(crate) fn html(text: &str, place: LinkTargets) -> Markup {
    let blocks: Vec<&str> = text
        .split("\n\n")
        .map(str::trim)
        .filter(|b| !b.is_empty())
        .collect();
    html! {
        @for block in blocks {
            @if block.starts_with("# ") {}
            @else if block.starts_with('|') { (table(block, place)) }
            @else if let Some(heading) = block.strip_prefix("## ") { h4 { (inline(heading, place)) } }
            @else if block.starts_with("```") { pre tabindex="0" { (block.trim_matches('`').trim()) } }
            @else if block.starts_with("- ") {
                ul { @for line in block.lines() { li { (inline(line.trim_start_matches("- "), place)) } } }
            }
            @else { p { (inline(block, place)) } }
        }
    }
}

/// Rows of a table that the index shows; the rest stand in the artefact's own page.
const MOST_ROWS: usize = 40;
/// Rows from which on a table is folded.
const FOLDED: usize = 14;

fn table(block: &str, place: LinkTargets) -> Markup {
    let cells = |line: &str| -> Vec<String> {
        let line = line.trim().trim_start_matches('|').trim_end_matches('|');
        let line = line.replace("\\|", "\u{1}");
        line.split('|')
            .map(|c| c.trim().replace('\u{1}', "|"))
            .collect()
    };
    let page = place.files.iter().find(|file| file.ends_with(".md"));
    let mut lines = block.lines();
    let head = cells(lines.next().unwrap_or_default());
    let right: Vec<bool> = cells(lines.next().unwrap_or_default())
        .iter()
        .map(|c| c.ends_with(':'))
        .collect();
    let class = |i: usize| {
        let number = right.get(i) == Some(&true);
        number.then_some("number")
    };
    let rows: Vec<&str> = lines.by_ref().take(MOST_ROWS).collect();
    let whole = html! {
        div.scroll tabindex="0" role="group" aria-label="Table" { table {
            thead { tr { @for (i, cell) in head.iter().enumerate() {
                @if cell.is_empty() { td {} } @else { th class=[class(i)] scope="col" { (inline(cell, place)) } }
            } } }
            tbody { @for line in &rows {
                tr { @for (i, cell) in cells(line).iter().enumerate() { td class=[class(i)] { (inline(cell, place)) } } }
            } }
        } }
    };
    html! {
        @if rows.len() > FOLDED { details { summary { "Table of " (rows.len()) " rows" } (whole) } } @else { (whole) }
        @let left = lines.count();
        @if left > 0 {
            p.made { (left) " more rows" @if let Some(page) = page { " in " a href=(format!("{}/{page}", place.folder)) { (page) } } }
        }
    }
}

/// Pictures, links, bold and code within a line.
fn inline(text: &str, place: LinkTargets) -> Markup {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(['!', '[', '*', '`']) {
        out.push_str(&html! { (rest[..at]) }.into_string());
        rest = &rest[at..];
        let (piece, used) = special(rest, place);
        out.push_str(&piece.into_string());
        rest = &rest[used..];
    }
    out.push_str(&html! { (rest) }.into_string());
    PreEscaped(out)
}

/// The construct that `text` starts with, and its length; one plain character when there is none.
fn special(text: &str, place: LinkTargets) -> (Markup, usize) {
    let picture = text.starts_with("![");
    if let Some((name, target, used)) = link(text.strip_prefix('!').unwrap_or(text)) {
        let vector = target.strip_suffix(".png").map(|t| format!("{t}.svg"));
        let vector = vector.filter(|name| place.files.contains(name));
        let outside = target.contains("://") || target.starts_with('#');
        let located = |name: &str| match outside {
            true => name.to_string(),
            false => format!("{}/{name}", place.folder),
        };
        let fine = located(vector.as_deref().unwrap_or(target));
        let target = located(target);
        if picture {
            return (
                html! { a href=(fine) { img src=(target) alt=(name) loading="lazy"; } },
                used + 1,
            );
        }
        if !text.starts_with('!') {
            return (html! { a href=(target) { (name) } }, used);
        }
    }
    for (mark, bold) in [("**", true), ("`", false)] {
        if let Some((inner, _)) = text.strip_prefix(mark).and_then(|t| t.split_once(mark)) {
            let used = inner.len() + 2 * mark.len();
            return match bold {
                true => (html! { b { (inner) } }, used),
                false => (html! { code { (inner) } }, used),
            };
        }
    }
    let used = text.chars().next().map_or(0, char::len_utf8);
    (html! { (text[..used]) }, used)
}

fn link(text: &str) -> Option<(&str, &str, usize)> {
    let (name, rest) = text.strip_prefix('[')?.split_once("](")?;
    let (target, _) = rest.split_once(')')?;
    (!name.contains(['[', '\n'])).then_some((name, target, name.len() + target.len() + 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_links_and_escapes() {
        let text = "# Title\n\n| a | b |\n| --- | --: |\n| x \\| y | **1.5** |\n\n![plot](p.png)\n\n1 < 2, see [csv](t.csv) and `code` [1] 2*3!";
        let files = ["q.svg".to_string()];
        let place = LinkTargets {
            folder: "facade_grammar",
            files: &files,
        };
        let page = html(text, place).into_string();
        assert!(
            page.contains("<td>x | y</td><td class=\"number\"><b>1.5</b></td>"),
            "{page}"
        );
        assert!(
            page.contains(
                "<a href=\"facade_grammar/p.png\"><img src=\"facade_grammar/p.png\" alt=\"plot\""
            ),
            "{page}"
        );
        let fine = html("![fine](q.png)", place).into_string();
        assert!(
            fine.contains("<a href=\"facade_grammar/q.svg\"><img src=\"facade_grammar/q.png\""),
            "{fine}"
        );
        assert!(page.contains("1 &lt; 2, see <a href=\"facade_grammar/t.csv\">csv</a> and <code>code</code> [1] 2*3!"), "{page}");
        assert!(!page.contains("Title"));
    }

    #[test]
    fn long_tables_are_cut_and_say_so() {
        let rows = "| 1 |\n".repeat(MOST_ROWS + 3);
        let files = ["t.md".to_string()];
        let place = LinkTargets {
            folder: "x",
            files: &files,
        };
        let page = html(&format!("| a |\n| --- |\n{rows}"), place).into_string();
        assert_eq!(page.matches("<td").count(), MOST_ROWS);
        assert!(page.contains("<summary>Table of 40 rows</summary>"));
        assert!(
            page.contains("3 more rows in <a href=\"x/t.md\">t.md</a>"),
            "{page}"
        );
    }
}
