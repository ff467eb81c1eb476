//! Facades of which a part is seen: elements drawn, moved, resized and relabelled, and completed again (Fan et al. 2014,
//! Fig. 15).

mod answers;
mod edits;
mod given;
pub mod hiding;
mod photograph;
mod starts;
mod straighten;
mod view;

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::Value;

pub use answers::{Answers, complete, shipped_model};
pub use edits::{FacadeEdit, FacadeEditError, edit};
pub use given::{Given, Wanted};
pub use straighten::{Outline, StraightenError, USUAL_HEIGHT, straightened};

use self::starts::{EMPTY, FOUR};
use super::examples::{Example, Source as From};
use super::script::Shell;
use super::work::Work;
use super::{
    Applied, CommandError, Editor, Opened, State, answer, count_of_answers, ends, parse, written,
};
use edifice_base::{Error, Result};
use edifice_io::{Source, draw, facade_json};
use edifice_shape::{AnnotatedFacade, Note, Rect, is_background};
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::extract;
use edifice_structure_completion::method::Method;

/// Most answers at once.
const MOST: usize = 100;
const ENDING: &str = ".facade.json";
const FORMATS: &[&str] = &["svg", "png"];

/// Photographs of facades.
const PHOTOGRAPHS: [&str; 3] = [".jpg", ".jpeg", ".png"];

/// Opens element layouts and partial layouts, `*.facade.json`, and photographs to draw over.
pub const EDITOR: Editor = Editor {
    kind: "completion",
    open,
    examples: &[
        Example {
            id: "four",
            kind: "completion",
            title: "Four elements",
            about: "Three windows and a door: the rest is completed, and again after each change.",
            source: From::Text("four_elements.facade.json", FOUR),
        },
        Example {
            id: "sketch",
            kind: "completion",
            title: "An empty facade",
            about: "Draw a few windows and a door, and have it completed.",
            source: From::Text("sketch.facade.json", EMPTY),
        },
    ],
};

fn open(path: &Path, bytes: &[u8], _work: &Work) -> Opened {
    if PHOTOGRAPHS.iter().any(|ending| ends(path, ending)) {
        let sketch = straighten::open(path, bytes);
        return Some(sketch.map(|sketch| Arc::new(sketch) as Arc<dyn State>));
    }
    if !ends(path, ENDING) {
        return None;
    }
    let annotated = match facade_json::parse_annotated(bytes, path) {
        Ok(annotated) => annotated,
        Err(e) => return Some(Err(e)),
    };
    // A facade with its wall and nothing unknown is whole: it is for the editor of grammars.
    let whole = has_wall(&annotated) || annotated.facade.check_tiling().is_ok();
    if !is_told(&annotated) && whole {
        return None;
    }
    Some(Ok(Arc::new(Sketch::new(annotated))))
}

fn is_told(a: &AnnotatedFacade) -> bool {
    a.unknown.is_some() || a.photograph.is_some() || a.notes.iter().any(|n| *n != Note::default())
}

fn has_wall(a: &AnnotatedFacade) -> bool {
    a.facade.regions.iter().any(|r| is_background(&r.label))
}

/// A layout of elements with its annotations. Layouts of elements stay as they are; elements are taken out of
/// tilings, label pictures and CMP files. `bytes` are those of the file, which the path only names.
///
/// # Errors
/// When a picture has no elements, or the layout cannot be read.
pub fn annotated(source: Source, bytes: &[u8], path: &Path) -> Result<AnnotatedFacade> {
    if let Source::Layout(facade) = &source {
        // Boxes of LabelMe and COCO are layouts too, without annotations.
        let annotated = facade_json::parse_annotated(bytes, path)
            .unwrap_or_else(|_| AnnotatedFacade::plain(facade.clone()));
        if is_told(&annotated) || !has_wall(&annotated) {
            return Ok(annotated);
        }
    }
    let elements = extract::elements(&source.labelled()?).map_err(|e| Error::content(path, e))?;
    let facade = elements.facade().map_err(|e| Error::content(path, e))?;
    Ok(AnnotatedFacade::plain(facade))
}

/// A facade that is being drawn and completed.
#[derive(Clone)]
pub struct Sketch {
    layout: AnnotatedFacade,
    pins: Vec<String>,
    forbidden: Vec<Rect>,
    answers: Vec<(AnnotatedFacade, Completion)>,
    chosen: Option<usize>,
    /// The photograph whose corners are not known yet.
    original: Option<Arc<straighten::Original>>,
}

#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    Edit {
        edits: Vec<String>,
    },
    Complete {
        count: usize,
        #[serde(default)]
        seed: u64,
        #[serde(default = "best")]
        method: String,
        #[serde(default)]
        pins: Vec<String>,
        #[serde(default)]
        forbid: Vec<[f64; 4]>,
    },
    Choose {
        answer: usize,
    },
    Photograph {
        picture: Option<String>,
    },
    Straighten {
        picture: Option<String>,
        corners: [[f64; 2]; 4],
        height: Option<f64>,
    },
}

fn best() -> String {
    Method::Best.option().to_owned()
}

impl Sketch {
    /// A layout without edits.
    pub fn new(layout: AnnotatedFacade) -> Self {
        Self {
            layout,
            pins: Vec::new(),
            forbidden: Vec::new(),
            answers: Vec::new(),
            chosen: None,
            original: None,
        }
    }

    fn path(&self) -> &Path {
        Path::new(&self.layout.facade.name)
    }

    fn edit(&self, texts: &[String]) -> Result<Applied> {
        let edits = FacadeEdit::parse_all(texts)?;
        let layout = edit(&self.layout, &edits).map_err(Error::method)?;
        let mut shell = Shell::new(["facade", "edit", "--output", ">", "--", "<"]);
        for text in texts {
            shell = shell.arg(text);
        }
        let mut state = Self {
            pins: self.pins.clone(),
            forbidden: self.forbidden.clone(),
            original: self.original.clone(),
            ..Self::new(layout)
        };
        let ids: Vec<&str> = (state.layout.notes.iter())
            .filter_map(|n| n.id.as_deref())
            .collect();
        state.pins.retain(|pin| ids.contains(&pin.as_str()));
        Ok(Applied {
            state: Arc::new(state),
            said: texts.join(", "),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }

    fn complete(
        &self,
        method: &str,
        count: usize,
        seed: u64,
        pins: &[String],
        forbidden: &[Rect],
    ) -> Result<Applied> {
        let count = count_of_answers(count, MOST)?;
        let unknown = || CommandError::Edit {
            edit: method.to_owned(),
            message: "unknown method".to_owned(),
        };
        let how = Method::of_option(method).ok_or_else(unknown)?;
        let wanted = Wanted {
            width: None,
            height: None,
            pins,
            forbidden,
        };
        let layout = self.layout.clone();
        let answers = complete(
            layout,
            &wanted,
            how,
            shipped_model()?,
            count,
            seed,
            self.path(),
        )?;
        let whole = answers.whole();
        let mut shell = Shell::new(["facade", "complete", "<"])
            .option("--method", method)
            .option("--count", count)
            .option("--seed", seed);
        for pin in pins {
            shell = shell.option("--pin", pin);
        }
        for r in forbidden {
            shell = shell.option("--forbid", written(&[r.x, r.y, r.width, r.height]));
        }
        let output = Shell::new(["--output", ">"]).words;
        shell.words.extend(output);
        let layout = whole.first().unwrap_or(&self.layout).clone();
        let found = whole.len();
        let result = (found > 0).then(|| file(1));
        Ok(Applied {
            state: Arc::new(Self {
                layout,
                pins: pins.to_vec(),
                forbidden: forbidden.to_vec(),
                answers: whole.into_iter().zip(answers.completions).collect(),
                chosen: Some(1),
                original: self.original.clone(),
            }),
            said: format!("complete in {found} ways, seed {seed}"),
            shell: shell.gives("", result),
            warnings: answers.warnings,
        })
    }

    fn choose(&self, wanted: usize) -> Result<Applied> {
        let (layout, _) = answer(&self.answers, wanted)?;
        let state = Self {
            layout: layout.clone(),
            chosen: Some(wanted),
            ..self.clone()
        };
        Ok(Applied {
            state: Arc::new(state),
            said: format!("take answer {wanted}"),
            shell: Shell::default().gives("", Some(file(wanted))),
            warnings: Vec::new(),
        })
    }
}

/// The file of an answer in the folder that `facade complete` writes.
pub fn file(answer: usize) -> String {
    format!("completion_{answer}{ENDING}")
}

impl State for Sketch {
    fn kind(&self) -> &'static str {
        EDITOR.kind
    }

    fn name(&self) -> &str {
        &self.layout.facade.name
    }

    fn ending(&self) -> &'static str {
        ENDING
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        Ok(facade_json::annotated_to_string(&self.layout).into_bytes())
    }

    fn view(&self) -> Result<Value> {
        Ok(view::view(self))
    }

    fn apply(&self, command: &Value, work: &Work) -> Result<Applied> {
        match parse(command)? {
            Command::Edit { edits } => self.edit(&edits),
            Command::Complete {
                count,
                seed,
                method,
                pins,
                forbid,
            } => {
                let rects = forbid.iter().map(|[x, y, w, h]| Rect::new(*x, *y, *w, *h));
                let rects: Vec<Rect> = rects.collect();
                for r in &rects {
                    edits::checked(*r).map_err(Error::method)?;
                }
                work.tell("completing the facade", None)?;
                self.complete(&method, count, seed, &pins, &rects)
            }
            Command::Choose { answer } => self.choose(answer),
            Command::Photograph { picture } => self.photograph(picture.as_deref()),
            Command::Straighten {
                picture,
                corners,
                height,
            } => {
                work.tell("straightening the photograph", None)?;
                self.straighten(picture.as_deref(), corners, height)
            }
        }
    }

    fn ask(&self, question: &Value) -> Result<Value> {
        photograph::answer(self, question)
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        match format {
            "svg" => Ok(draw::svg(&self.layout.facade).into_bytes()),
            "png" => draw::png(&self.layout.facade).map_err(Error::method),
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}
