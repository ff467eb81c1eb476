//! The first page of the report: a verdict on each paper, every printed number beside ours, then every artefact.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::beside::{Beside, Counts, is_near};
use super::markdown;

/// One artefact.
#[derive(Debug, Clone, Default)]
pub struct Section {
    /// File name without extension.
    pub name: String,
    /// Heading.
    pub heading: String,
    /// Its page, in Markdown.
    pub markdown: String,
    /// Files that are there, relative to the paper's folder.
    pub files: Vec<String>,
    /// Files that the command makes and that are not there.
    pub absent: Vec<String>,
    /// The command that makes it.
    pub command: String,
    /// The command that opens its documents in the studio; none for most.
    pub studio: Option<String>,
    /// Seed, budget, version, time.
    pub made: String,
    /// Its quantities beside the printed ones.
    pub beside: Vec<Beside>,
    /// Why nothing was made, when nothing was.
    pub skipped: Option<String>,
}

/// One paper.
#[derive(Debug, Clone)]
pub struct Page {
    /// Folder of the paper.
    pub slug: String,
    /// Authors, year, title.
    pub paper: String,
    /// Its artefacts.
    pub sections: Vec<Section>,
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Relative difference at which a bar is full.
const FULL: f64 = 0.5;

/// The page as HTML text.
pub fn index(pages: &[Page]) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Edifice: report" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "Edifice: report" }
                    p.lead { "Every table and figure that was made, each beside what its paper printed. The counts below are made from the runs' own records; a difference is no error by itself, the notes of each artefact say why it is there." }
                }
                main {
                    ul.verdicts { @for page in pages { (verdict(page)) } }
                    @for page in pages {
                        h2 id=(page.slug) { (page.paper) }
                        (contents(page))
                        (numbers(page))
                        @for section in &page.sections { (artefact(&page.slug, section)) }
                    }
                }
                footer { "Pictures lead to their vector form where it is small enough to ship. Numbers, seeds, settings and digests of the data stand in the " code { "run.json" } " of each paper, commits, times and machines in its " code { "provenance.json" } "." }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
    .into_string()
}

/// A paper in a few words, on the first screen.
fn verdict(page: &Page) -> Markup {
    let counts = Counts::of(page.sections.iter().flat_map(|s| &s.beside));
    let part = |n: usize| format!("flex: {n}");
    let made = page.sections.iter().filter(|s| s.skipped.is_none()).count();
    let left: Vec<&Section> = page
        .sections
        .iter()
        .filter(|s| s.skipped.is_some())
        .collect();
    let link = |s: &Section| format!("#{}-{}", page.slug, s.name);
    html! {
        li {
            strong { a href=(format!("#{}", page.slug)) { (page.paper) } }
            @if counts.all() > 0 {
                div.share aria-hidden="true" { span.near style=(part(counts.near)) {} span.far style=(part(counts.far)) {} span.none style=(part(counts.none)) {} }
                p { "Of " (counts.all()) " printed quantities, " (counts.near) " of ours are within 5 %, " (counts.far) " differ by more; " (counts.none) " are not a number against a number." }
            } @else { p { "No printed number stands beside ours here: the paper prints pictures, or its numbers need the real data or are times." } }
            p { (made) " of " (page.sections.len()) " artefacts made here."
                @for s in left { " " a href=(link(s)) { (s.name.replace('_', " ")) } ": " (s.skipped.as_deref().unwrap_or_default()) "." }
            }
        }
    }
}

fn contents(page: &Page) -> Markup {
    html! {
        nav aria-label=(format!("Artefacts of {}", page.paper)) {
            details { summary { (page.sections.len()) " artefacts" }
                ul { @for s in &page.sections { li { a href=(format!("#{}-{}", page.slug, s.name)) { (s.heading) } } } }
            }
        }
    }
}

/// All quantities of a paper, the printed number beside ours.
fn numbers(page: &Page) -> Markup {
    let all: Vec<(&Section, &Beside)> = page
        .sections
        .iter()
        .flat_map(|s| s.beside.iter().map(move |b| (s, b)))
        .collect();
    html! {
        @if !all.is_empty() {
            div.scroll tabindex="0" role="group" aria-label=(format!("Printed numbers beside ours: {}", page.paper)) {
                table.sortable {
                    caption { "Printed numbers beside ours" }
                    thead { tr { th scope="col" { "artefact" } th scope="col" { "quantity" } th.number scope="col" { "printed" } th.number scope="col" { "ours" } th scope="col" { "difference" } } }
                    tbody { @for (s, b) in all {
                        @let difference = b.difference();
                        tr {
                            td { a href=(format!("#{}-{}", page.slug, s.name)) { (s.name.replace('_', " ")) } }
                            td { (b.quantity) }
                            td.number { (b.printed) }
                            td.number { (b.ours) }
                            td data-value=(difference.map_or(String::new(), |d| format!("{d:.6}"))) { (bar(difference)) }
                        }
                    } }
                }
            }
        }
    }
}

/// A difference as a bar to the left or right of the middle, and in words.
fn bar(difference: Option<f64>) -> Markup {
    let Some(d) = difference else {
        return html! { span.made { "–" } };
    };
    let side = if d < 0.0 { "low" } else { "high" };
    let class = if is_near(d) { "near" } else { "far" };
    let width = (d.abs() / FULL).min(1.0) * 100.0;
    html! {
        div.difference {
            span.bar aria-hidden="true" { i class=(format!("{side} {class}")) style=(format!("width: {width:.0}%")) {} }
            span { (format!("{:+.1} %", 100.0 * d)) }
        }
    }
}

fn artefact(slug: &str, s: &Section) -> Markup {
    html! {
        section id=(format!("{slug}-{}", s.name)) {
            h3 { (s.heading) }
            (markdown::html(&s.markdown, markdown::LinkTargets { folder: slug, files: &s.files }))
            @if let Some(command) = &s.studio { p.made { "Opened in the studio by " code { (command) } } }
            @if !s.command.is_empty() { p.made { "Made again by " code { (s.command) } } }
            p.made {
                (s.made) ". Files: "
                @for (i, file) in s.files.iter().enumerate() {
                    @if i > 0 { ", " }
                    a href=(format!("{slug}/{file}")) { (file) }
                }
                @for file in &s.absent { ", " (file) " (not kept in the repository)" }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> Page {
        let section = Section {
            name: "table_1".into(),
            heading: "Table 1".into(),
            markdown: "# Table 1\n\n| a |\n| --- |\n| 1 |\n\n![plot](table_1.png)".into(),
            files: vec!["table_1.csv".into()],
            absent: vec!["scene.glb".into()],
            command: "edifice reproduce facade_grammar --only table_1".into(),
            studio: Some("edifice studio --report facade_grammar/table_1".into()),
            made: "seed 0".into(),
            beside: vec![Beside {
                quantity: "cost".into(),
                printed: "40".into(),
                ours: "38".into(),
            }],
            skipped: None,
        };
        let people = Section {
            name: "table_3".into(),
            heading: "Table 3".into(),
            skipped: Some("this needs people".into()),
            ..Section::default()
        };
        Page {
            slug: "facade_grammar".into(),
            paper: "Wu et al. 2014".into(),
            sections: vec![section, people],
        }
    }

    #[test]
    fn the_page_opens_with_its_verdicts_and_reads_on_a_phone() {
        let text = index(&[page()]);
        let after = |what: &str| text.find(what).unwrap_or_else(|| panic!("{what}: {text}"));
        assert!(after("Of 1 printed quantities, 1 of ours are within 5 %") < after("<section"));
        assert!(after("this needs people") < after("<section"));
        assert!(after("href=\"#facade_grammar-table_1\"") < after("id=\"facade_grammar-table_1\""));
        assert!(text.contains("-5.0 %"), "{text}");
        // What is not there is named, and no link leads to it.
        assert!(
            text.contains("scene.glb (not kept in the repository)")
                && !text.contains("href=\"facade_grammar/scene.glb\"")
        );
        assert!(
            text.contains(
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
            )
        );
        for rule in [
            "@media (max-width: 640px)",
            "@media print",
            "(prefers-color-scheme: dark)",
        ] {
            assert!(STYLE.contains(rule), "{rule}");
        }
        // Pictures shrink to the column; tables wider than it scroll by themselves.
        assert!(STYLE.contains("img { max-width: 100%; height: auto;"));
        assert!(text.contains("<div class=\"scroll\""));
        assert!(!text.contains("http://") && !text.contains("https://"));
    }
}
