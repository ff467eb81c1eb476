//! `<artefact>.md`: what an artefact shows, in order.

use super::provenance::Comparison;
use edifice_report::{Align, Table};

/// The page of one artefact.
pub(crate) struct Document {
    artefact: String,
    title: String,
    blocks: Vec<String>,
}

impl Document {
    /// An empty page.
    pub(crate) fn new(artefact: &str, title: &str) -> Self {
        Self {
            artefact: artefact.to_string(),
            title: title.to_string(),
            blocks: Vec::new(),
        }
    }

    /// True if nothing was added.
    pub(crate) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Adds a block of Markdown.
    pub(crate) fn block(&mut self, text: String) {
        self.blocks.push(text);
    }

    /// Adds the picture `<name>.png`.
    pub(crate) fn image(&mut self, name: &str, caption: &str) {
        self.blocks.push(format!("![{caption}]({name}.png)"));
    }

    /// The page, with the comparisons first, since they are what a reader looks for.
    pub(crate) fn markdown(&self, comparisons: &[Comparison], skipped: Option<&str>) -> String {
        let mut parts = vec![format!("# {}: {}", readable(&self.artefact), self.title)];
        if let Some(reason) = skipped {
            parts.push(format!("Not made in this run: {reason}"));
        }
        if !comparisons.is_empty() {
            let mut table = Table::new("Beside the paper")
                .column("quantity", Align::Left)
                .column("paper", Align::Right)
                .column("ours", Align::Right);
            for c in comparisons {
                table.row([c.quantity.clone(), c.printed.clone(), c.ours.clone()]);
            }
            parts.push(table.markdown());
        }
        parts.extend(self.blocks.iter().cloned());
        parts.join("\n\n") + "\n"
    }
}

/// `table_1` as `Table 1`.
pub(crate) fn readable(name: &str) -> String {
    let text = name.replace('_', " ");
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => text,
    }
}
