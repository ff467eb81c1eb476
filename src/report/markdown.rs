//! The Markdown that this crate writes, as HTML: headings, paragraphs, tables, pictures, links, bold, code.

use maud::{Markup, PreEscaped, html};

/// Renders the page of an artefact; links and pictures are relative to `folder`. The first heading
/// is left out, since the index has its own.
pub fn html(text: &str, folder: &str) -> Markup {
    let blocks: Vec<&str> = text
        .split("\n\n")
        .map(str::trim)
        .filter(|b| !b.is_empty())
        .collect();
    html! {
        @for block in blocks {
            @if block.starts_with("# ") {}
            @else if block.starts_with('|') { (table(block, folder)) }
            @else if let Some(heading) = block.strip_prefix("## ") { h4 { (inline(heading, folder)) } }
            @else if block.starts_with("```") { pre { (block.trim_matches('`').trim()) } }
            @else if block.starts_with("- ") {
                ul { @for line in block.lines() { li { (inline(line.trim_start_matches("- "), folder)) } } }
            }
            @else { p { (inline(block, folder)) } }
        }
    }
}

fn table(block: &str, folder: &str) -> Markup {
    let cells = |line: &str| -> Vec<String> {
        let line = line.trim().trim_start_matches('|').trim_end_matches('|');
        let line = line.replace("\\|", "\u{1}");
        line.split('|')
            .map(|c| c.trim().replace('\u{1}', "|"))
            .collect()
    };
    let mut lines = block.lines();
    let head = cells(lines.next().unwrap_or_default());
    let right: Vec<bool> = cells(lines.next().unwrap_or_default())
        .iter()
        .map(|c| c.ends_with(':'))
        .collect();
    let class = |i: usize| {
        if right.get(i) == Some(&true) {
            "number"
        } else {
            ""
        }
    };
    html! {
        div.scroll { table {
            thead { tr { @for (i, cell) in head.iter().enumerate() { th class=(class(i)) { (inline(cell, folder)) } } } }
            tbody { @for line in lines {
                tr { @for (i, cell) in cells(line).iter().enumerate() { td class=(class(i)) { (inline(cell, folder)) } } }
            } }
        } }
    }
}

/// Pictures, links, bold and code within a line.
fn inline(text: &str, folder: &str) -> Markup {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(['!', '[', '*', '`']) {
        out.push_str(&html! { (rest[..at]) }.into_string());
        rest = &rest[at..];
        let (piece, used) = special(rest, folder);
        out.push_str(&piece.into_string());
        rest = &rest[used..];
    }
    out.push_str(&html! { (rest) }.into_string());
    PreEscaped(out)
}

/// The construct that `text` starts with, and its length; one plain character when there is none.
fn special(text: &str, folder: &str) -> (Markup, usize) {
    let picture = text.starts_with("![");
    if let Some((name, target, used)) = link(text.strip_prefix('!').unwrap_or(text)) {
        let outside = target.contains("://") || target.starts_with('#');
        let target = if outside {
            target.to_string()
        } else {
            format!("{folder}/{target}")
        };
        if picture {
            let fine = target
                .strip_suffix(".png")
                .map_or(target.clone(), |t| format!("{t}.svg"));
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
        let page = html(text, "facade_grammar").into_string();
        assert!(
            page.contains("<td class=\"\">x | y</td><td class=\"number\"><b>1.5</b></td>"),
            "{page}"
        );
        assert!(
            page.contains("<img src=\"facade_grammar/p.png\" alt=\"plot\""),
            "{page}"
        );
        assert!(page.contains("1 &lt; 2, see <a href=\"facade_grammar/t.csv\">csv</a> and <code>code</code> [1] 2*3!"), "{page}");
        assert!(!page.contains("Title"));
    }
}
