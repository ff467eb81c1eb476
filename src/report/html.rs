//! The first page of the report: every artefact beside what the paper printed.

use maud::{DOCTYPE, PreEscaped, html};

use super::markdown;

/// One artefact.
#[derive(Debug, Clone)]
pub struct Section {
    /// File name without extension.
    pub name: String,
    /// Heading.
    pub heading: String,
    /// Its page, in Markdown.
    pub markdown: String,
    /// Files it wrote, relative to the paper's folder.
    pub files: Vec<String>,
    /// Seed, budget, version, time.
    pub made: String,
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

const STYLE: &str = "
body { margin: 0; font: 15px/1.5 'DejaVu Sans', Verdana, sans-serif; color: #22262b; background: #f6f7f8; }
main { max-width: 1080px; margin: 0 auto; padding: 24px 20px 80px; }
nav { background: #fff; border: 1px solid #e0e4e8; padding: 12px 18px; columns: 2; font-size: 13px; }
nav h2 { margin: 0 0 6px; font-size: 15px; column-span: all; } nav h3 { margin: 4px 0; font-size: 13px; break-after: avoid; } nav ul { margin: 0 0 8px; padding-left: 18px; }
section { background: #fff; border: 1px solid #e0e4e8; margin: 22px 0; padding: 6px 22px 16px; }
h1 { font-size: 26px; } h2 { font-size: 20px; margin-top: 44px; } h3 { font-size: 17px; }
img { max-width: 100%; height: auto; } .scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; margin: 4px 0 14px; }
th, td { padding: 3px 10px; border-bottom: 1px solid #e6e9ec; text-align: left; vertical-align: top; }
thead th { border-bottom: 2px solid #9aa2ab; } .number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.made { color: #5f6770; font-size: 12px; } code, pre { font: 12.5px 'DejaVu Sans Mono', monospace; background: #f1f3f5; padding: 1px 3px; }
pre { padding: 10px 14px; overflow-x: auto; }
p, li, h1, h2, h3, h4 { overflow-wrap: anywhere; }
@media (max-width: 640px) {
  body { font-size: 16px; } main { padding: 12px 10px 60px; } nav { columns: 1; font-size: 16px; padding: 10px 14px; } nav h3 { font-size: 16px; }
  nav li { padding: 5px 0; } section { padding: 4px 12px 12px; } h1 { font-size: 22px; } h2 { font-size: 19px; margin-top: 30px; }
  table { font-size: 14px; } .made { font-size: 14px; }
}
";

/// The page as HTML text.
pub fn index(pages: &[Page]) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Edifice: report" }
                style { (PreEscaped(STYLE)) }
            }
            body { main {
                h1 { "Edifice: report" }
                nav aria-label="Contents" { h2 { "Contents" } @for page in pages {
                    h3 { (page.paper) }
                    ul { @for s in &page.sections { li { a href=(format!("#{}-{}", page.slug, s.name)) { (s.heading) } } } }
                } }
                p { "Every table and figure that was made, each beside what its paper printed. Pictures link to their vector form where it is small enough to ship." }
                @for page in pages {
                    h2 { (page.paper) }
                    p.made { a href=(format!("{}/run.json", page.slug)) { "run.json" } ": commands, seeds, settings, digests of the data" }
                    @for s in &page.sections {
                        section id=(format!("{}-{}", page.slug, s.name)) {
                            h3 { (s.heading) }
                            (markdown::html(&s.markdown, markdown::Place { folder: &page.slug, files: &s.files }))
                            p.made {
                                (s.made) ". Files: "
                                @for (i, file) in s.files.iter().enumerate() {
                                    @if i > 0 { ", " }
                                    a href=(format!("{}/{file}", page.slug)) { (file) }
                                }
                            }
                        }
                    }
                }
            } }
        }
    }
    .into_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_opens_with_its_contents_and_reads_on_a_phone() {
        let section = Section {
            name: "table_1".into(),
            heading: "Table 1".into(),
            markdown: "# Table 1\n\n| a |\n| --- |\n| 1 |\n\n![plot](table_1.png)".into(),
            files: vec!["table_1.csv".into()],
            made: "seed 0".into(),
        };
        let page = Page {
            slug: "facade_grammar".into(),
            paper: "Wu et al. 2014".into(),
            sections: vec![section],
        };
        let text = index(&[page]);
        let after = |what: &str| text.find(what).unwrap_or_else(|| panic!("{what}: {text}"));
        // Nothing but the title stands before the list, and each entry leads to its section.
        assert!(text.contains("<h1>Edifice: report</h1><nav"), "{text}");
        assert!(after("</nav>") < after("<section") && after("</nav>") < after("<p>"));
        assert!(after("href=\"#facade_grammar-table_1\"") < after("id=\"facade_grammar-table_1\""));
        assert!(
            text.contains(
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
            )
        );
        let phone = &STYLE[STYLE.find("@media (max-width: 640px)").unwrap()..];
        assert!(phone.contains("nav { columns: 1;"));
        // Pictures shrink to the column; tables wider than it scroll by themselves.
        assert!(
            STYLE.contains("img { max-width: 100%; height: auto; } .scroll { overflow-x: auto; }")
        );
        assert!(text.contains("<div class=\"scroll\"><table>"));
    }
}
