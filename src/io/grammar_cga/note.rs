//! Our comments in CGA text: what CGA has no word for.

use chumsky::span::SimpleSpan;

use super::error::Fault;
use super::token::Token;

/// A comment that begins with `//@`.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Note {
    /// `//@ unit "px"`
    Unit(String),
    /// `//@ facade Facade 400 x 600 "name"`: a start.
    Facade {
        symbol: String,
        width: f64,
        height: f64,
        name: Option<String>,
    },
    /// `//@ symbol Wall_2 "Wall 2"`: the symbol that an identifier stands for.
    Symbol { identifier: String, name: String },
    /// `//@ sym_split`: the split below is a mirrored one, written out.
    SymSplit,
    /// `//@ grid_split`: the nested splits below are one grid.
    GridSplit,
    /// `//@ sizes absolute`: the sizes after `~` are absolute ones, which other lots may stretch.
    SizesAbsolute,
    /// `//@ relative`: but in the split below they are weights.
    Relative,
    /// `//@ weights 3 1.5`: the weights that the percentages below were rounded from.
    Weights(Vec<f64>),
}

impl Note {
    /// Reads a comment, `//@` included.
    pub(super) fn parse(text: &str, span: SimpleSpan) -> Result<Self, Fault> {
        let wrong = |expected: &str| Fault::new(span, format!("expected {expected}"));
        let words = text.trim_start_matches("//@").trim();
        let (kind, rest) = words
            .split_once(char::is_whitespace)
            .map_or((words, ""), |(kind, rest)| (kind, rest.trim()));
        let bare = |note: Self| match rest {
            "" => Ok(note),
            _ => Err(wrong(&format!("nothing after //@ {kind}"))),
        };
        match kind {
            "unit" => quoted(rest)
                .map(Note::Unit)
                .ok_or_else(|| wrong("//@ unit \"px\"")),
            "facade" => facade(rest).ok_or_else(|| wrong("//@ facade Symbol 400 x 600 \"name\"")),
            "symbol" => symbol(rest).ok_or_else(|| wrong("//@ symbol identifier \"any text\"")),
            "sizes" if rest == "absolute" => Ok(Note::SizesAbsolute),
            "sizes" => Err(wrong("//@ sizes absolute")),
            "relative" => bare(Note::Relative),
            "sym_split" => bare(Note::SymSplit),
            "grid_split" => bare(Note::GridSplit),
            "weights" => {
                let weights = rest.split_whitespace().map(|w| w.parse().ok());
                let weights: Option<Vec<f64>> = weights.collect();
                weights
                    .map(Note::Weights)
                    .ok_or_else(|| wrong("//@ weights 3 1.5 ..."))
            }
            _ => Err(wrong(
                "//@ unit, facade, symbol, sizes, relative, sym_split, grid_split or weights",
            )),
        }
    }

    /// True if the comment is about the whole text, and not about the rule below it.
    pub(super) fn is_header(&self) -> bool {
        matches!(
            self,
            Note::Unit(_) | Note::Facade { .. } | Note::Symbol { .. } | Note::SizesAbsolute
        )
    }
}

/// A JSON string.
fn quoted(text: &str) -> Option<String> {
    serde_json::from_str(text).ok()
}

fn facade(rest: &str) -> Option<Note> {
    let mut words = rest.splitn(5, ' ');
    let symbol = words.next().filter(|s| !s.is_empty())?.to_owned();
    let width = words.next()?.parse().ok()?;
    words.next().filter(|&x| x == "x")?;
    let height = words.next()?.parse().ok()?;
    let name = match words.next() {
        None => None,
        Some(text) => Some(quoted(text.trim())?),
    };
    Some(Note::Facade {
        symbol,
        width,
        height,
        name,
    })
}

fn symbol(rest: &str) -> Option<Note> {
    let (identifier, name) = rest.split_once(char::is_whitespace)?;
    Some(Note::Symbol {
        identifier: identifier.to_owned(),
        name: quoted(name.trim())?,
    })
}

/// The header notes, and the other tokens.
#[allow(clippy::type_complexity)] // two lists of things with places
pub(super) fn split_header<'a>(
    tokens: Vec<(Token<'a>, SimpleSpan)>,
) -> Result<(Vec<(Note, SimpleSpan)>, Vec<(Token<'a>, SimpleSpan)>), Fault> {
    let mut header = Vec::new();
    let mut rest = Vec::new();
    for (token, span) in tokens {
        match token {
            Token::Note(text) => {
                let note = Note::parse(text, span)?;
                if note.is_header() {
                    header.push((note, span));
                } else {
                    rest.push((token, span));
                }
            }
            _ => rest.push((token, span)),
        }
    }
    Ok((header, rest))
}
