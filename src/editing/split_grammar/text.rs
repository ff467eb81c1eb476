//! Edits of a grammar as they are written on the command line and in the log.

use super::super::{CommandError, numbers};
use super::edits::GrammarEdit;
use super::place::Place;

impl std::str::FromStr for GrammarEdit {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        read(text).map_err(|message| CommandError::Edit {
            edit: text.to_owned(),
            message,
        })
    }
}

fn index(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| format!("{text:?} is no index"))
}

fn place(text: &str) -> Result<(usize, Place), String> {
    let (rule, part) = text.split_once('.').ok_or("expected RULE.PART")?;
    let rule = index(rule)?;
    let part = match (part.strip_prefix('c'), part.strip_prefix('r')) {
        (Some(k), _) => Place::Column(index(k)?),
        (_, Some(k)) => Place::Row(index(k)?),
        _ => Place::Part(index(part)?),
    };
    Ok((rule, part))
}

fn number(text: &str) -> Result<f64, String> {
    numbers::<1>(text).map(|[v]| v)
}

fn read(text: &str) -> Result<GrammarEdit, String> {
    let (verb, rest) = text.split_once(' ').unwrap_or((text, ""));
    let value = || rest.split_once('=').ok_or("expected a value after =");
    Ok(match verb {
        "resize" | "border" => {
            let (at, size) = value()?;
            let ((rule, part), size) = (place(at)?, number(size)?);
            match verb {
                "resize" => GrammarEdit::Resize(rule, part, size),
                _ => GrammarEdit::Border(rule, part, size),
            }
        }
        "symbol" => {
            let (at, name) = value()?;
            let (rule, part) = place(at)?;
            GrammarEdit::Symbol(rule, part, name.to_owned())
        }
        "insert" => {
            let (at, what) = value()?;
            let (rule, part) = place(at)?;
            let (name, size) = match what.rsplit_once(':') {
                Some((name, size)) => (Some(name.to_owned()), size),
                None => (None, what),
            };
            GrammarEdit::Insert(rule, part, name, number(size)?)
        }
        "remove" => place(rest).map(|(rule, part)| GrammarEdit::Remove(rule, part))?,
        "grow" => place(rest).map(|(rule, part)| GrammarEdit::Grow(rule, part))?,
        "shrink" => place(rest).map(|(rule, part)| GrammarEdit::Shrink(rule, part))?,
        "repeat" => GrammarEdit::Repeat(index(rest)?),
        "weight" => {
            let (rule, weight) = value()?;
            GrammarEdit::Weight(index(rule)?, number(weight)?)
        }
        "outline" => GrammarEdit::Outline(numbers(rest)?),
        _ => {
            return Err(
                "expected resize, border, symbol, insert, remove, grow, shrink, repeat, weight or outline".into(),
            );
        }
    })
}
