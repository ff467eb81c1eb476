//! Edits of houses as text: on the command line and in commands.

use super::super::{CommandError, numbers, written};
use edifice_base::Result;
use edifice_building_exteriors::design::Edit;
use edifice_shape::BoxStyle;

/// `STYLE@X,Y,W,D,H`: a new box.
///
/// # Errors
/// The fault of the text, as a sentence.
pub fn add(text: &str) -> std::result::Result<Edit, String> {
    let parts = text.split_once('@');
    let (style, rest) = parts.ok_or_else(|| format!("{text:?}: expected STYLE@X,Y,W,D,H"))?;
    let style = match style {
        "main" => BoxStyle::Main,
        "garage" => BoxStyle::Garage,
        "porch" => BoxStyle::Porch,
        other => return Err(format!("{other:?}: expected main, garage or porch")),
    };
    Ok(Edit::Add(style, numbers(rest)?))
}

/// `INDEX=X,Y`: the new centre of a box.
///
/// # Errors
/// The fault of the text, as a sentence.
pub fn moved(text: &str) -> std::result::Result<Edit, String> {
    indexed(text).map(|(index, to)| Edit::Move(index, to))
}

/// `INDEX=W,D,H`: the new size of a box.
///
/// # Errors
/// The fault of the text, as a sentence.
pub fn resized(text: &str) -> std::result::Result<Edit, String> {
    indexed(text).map(|(index, to)| Edit::Resize(index, to))
}

fn indexed<const N: usize>(text: &str) -> std::result::Result<(usize, [f64; N]), String> {
    let parts = text.split_once('=');
    let (index, rest) = parts.ok_or_else(|| format!("{text:?}: expected INDEX=NUMBERS"))?;
    Ok((index_of(index)?, numbers(rest)?))
}

fn index_of(text: &str) -> std::result::Result<usize, String> {
    let index = text.trim().parse();
    index.map_err(|_| format!("{text:?}: the index is not a number"))
}

/// Reads the edits of a command, in the order in which they are made.
pub(super) fn parse_all(texts: &[String]) -> Result<Vec<Edit>> {
    if texts.is_empty() {
        return Err(CommandError::Nothing.into());
    }
    let read = |text: &String| {
        let (verb, rest) = text.split_once(' ').unwrap_or((text, ""));
        let edit = match verb {
            "add" => add(rest),
            "move" => moved(rest),
            "resize" => resized(rest),
            "remove" => index_of(rest).map(Edit::Remove),
            _ => Err("expected add, move, resize or remove".to_owned()),
        };
        edit.map_err(|message| CommandError::Edit {
            edit: text.clone(),
            message,
        })
    };
    let edits: std::result::Result<Vec<Edit>, CommandError> = texts.iter().map(read).collect();
    Ok(ordered(edits?))
}

/// Edits in the order in which they are made, so that each index means a box of the house before: boxes are added,
/// moved, resized, then removed from the last on.
pub fn ordered(mut edits: Vec<Edit>) -> Vec<Edit> {
    edits.sort_by_key(|edit| match edit {
        Edit::Add(..) => (0, 0),
        Edit::Move(..) => (1, 0),
        Edit::Resize(..) => (2, 0),
        Edit::Remove(index) => (3, usize::MAX - index),
    });
    edits
}

/// The arguments of `edifice building edit` that make the same edits.
pub fn words(edits: &[Edit]) -> Vec<String> {
    let word = |edit: &Edit| match *edit {
        Edit::Add(style, size) => {
            let style = match style {
                BoxStyle::Main => "main",
                BoxStyle::Garage => "garage",
                BoxStyle::Porch => "porch",
            };
            format!("--add={style}@{}", written(&size))
        }
        Edit::Move(index, to) => format!("--move={index}={}", written(&to)),
        Edit::Resize(index, to) => format!("--resize={index}={}", written(&to)),
        Edit::Remove(index) => format!("--remove={index}"),
    };
    edits.iter().map(word).collect()
}
