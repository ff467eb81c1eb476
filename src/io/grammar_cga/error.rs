//! Errors in CGA text, with their place.

use std::fmt;

use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};
use chumsky::span::{SimpleSpan, Span};

/// Longest line that is printed under an error, in bytes.
const LINE_SHOWN: usize = 400;

/// An error, at a place given in bytes.
#[derive(Debug)]
pub(super) struct Fault {
    pub span: SimpleSpan,
    pub message: String,
}

impl Fault {
    pub(super) fn new(span: SimpleSpan, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { span, message }
    }
}

/// An error in CGA text, with the line that it stands in.
#[derive(Debug, Clone, PartialEq)]
pub struct CgaError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The offending text; empty at the end of the file.
    pub found: String,
    /// The error as a sentence.
    pub message: String,
    /// The line, with the offending text marked.
    pub snippet: String,
}

impl CgaError {
    /// Finds line and column of `fault` in `text` and renders the line.
    pub(super) fn new(fault: Fault, text: &str) -> Self {
        let place = |at: usize| {
            let mut down = (0..=at.min(text.len())).rev();
            down.find(|&i| text.is_char_boundary(i)).unwrap_or(0)
        };
        let (start, end) = (place(fault.span.start()), place(fault.span.end()));
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let end = end.clamp(start, line_end.max(start));
        let shown = &text[line_start..line_end];
        let snippet = match shown.len() {
            0..=LINE_SHOWN => snippet(text, start..end, &fault.message),
            _ => String::new(),
        };
        Self {
            line: before.matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            found: text[start..end].chars().take(60).collect(),
            message: fault.message,
            snippet,
        }
    }
}

/// The line of `range`, with a mark under it.
fn snippet(text: &str, range: std::ops::Range<usize>, message: &str) -> String {
    let mut out = Vec::new();
    let config = Config::default()
        .with_color(false)
        .with_compact(true)
        .with_index_type(IndexType::Byte);
    let label = Label::new(range.clone()).with_message(message);
    let written = Report::build(ReportKind::Error, range)
        .with_config(config)
        .with_label(label)
        .finish()
        .write(Source::from(text), &mut out);
    // Two lines of heading repeat what the caller prints with the path.
    let text = String::from_utf8_lossy(&out);
    match written {
        Ok(()) => text.lines().skip(2).collect::<Vec<_>>().join("\n"),
        Err(_) => String::new(),
    }
}

impl fmt::Display for CgaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match self.found.as_str() {
            "" => f.write_str(" (at the end of a line)")?,
            found => write!(f, " (at `{found}`)")?,
        }
        match self.snippet.as_str() {
            "" => Ok(()),
            snippet => write!(f, "\n{snippet}"),
        }
    }
}

impl std::error::Error for CgaError {}
