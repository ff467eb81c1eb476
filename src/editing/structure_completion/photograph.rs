//! The photograph under a drawing.

use std::sync::Arc;

use serde::Deserialize;
use serde_json::{Value, json};

use super::super::script::{Shell, Word};
use super::super::{Applied, parse};
use super::{ENDING, Sketch};
use edifice_base::{Error, Result};
use edifice_io::photograph;
use edifice_shape::AnnotatedFacade;

/// The questions to a drawing that do not change it.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
enum Question {
    /// The picture under it.
    Photograph,
    /// The picture that it was opened from, whose corners are not known yet.
    Original,
}

/// Answers a question.
///
/// # Errors
/// [`CommandError::Form`](super::super::CommandError::Form) for none.
pub(super) fn answer(sketch: &Sketch, question: &Value) -> Result<Value> {
    let picture = match parse(question)? {
        Question::Photograph => sketch.layout.photograph.as_ref().map(photograph::address),
        Question::Original => sketch.original.as_ref().map(|o| o.address()),
    };
    Ok(json!({"picture": picture}))
}

impl Sketch {
    /// Another photograph under the drawing, or none; a completion of it begins anew.
    pub(super) fn photograph(&self, address: Option<&str>) -> Result<Applied> {
        let read = address.map(photograph::of_address).transpose();
        let picture = read.map_err(Error::method)?;
        let shell = Shell::new(["facade", "edit", "--output", ">"]);
        let (said, shell) = match &picture {
            Some(picture) => {
                let [width, height] = picture.size();
                let mut shell = shell.arg("--photograph");
                let text = photograph::address(picture);
                shell.words.push(Word::File(".photograph.txt", text));
                (format!("photograph of {width} x {height} pixels"), shell)
            }
            None => ("no photograph".to_owned(), shell.arg("--no-photograph")),
        };
        let mut shell = shell.gives(ENDING, Some(String::new()));
        shell.words.extend(Shell::new(["--", "<"]).words);
        let layout = AnnotatedFacade {
            photograph: picture,
            ..self.layout.clone()
        };
        let state = Self {
            pins: self.pins.clone(),
            forbidden: self.forbidden.clone(),
            ..Self::new(layout)
        };
        Ok(Applied {
            state: Arc::new(state),
            said,
            shell,
            warnings: Vec::new(),
        })
    }
}
