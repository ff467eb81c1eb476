//! A document to begin with.

/// A document to begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Example {
    /// The name that it is asked for by.
    pub id: &'static str,
    /// Kind of document.
    pub kind: &'static str,
    /// A few words.
    pub title: &'static str,
    /// A sentence.
    pub about: &'static str,
    /// Its source.
    #[serde(skip)]
    pub source: Source,
}

/// The source of an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A file that ships.
    File(&'static str),
    /// A line of a file that ships, from 0, under a name of its own.
    Line(&'static str, usize, &'static str),
    /// A text under a name.
    Text(&'static str, &'static str),
}
