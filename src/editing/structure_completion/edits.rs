//! Edits of a layout of elements, as text and as values.

use super::super::{CommandError, numbers};
use edifice_base::Result;
use edifice_shape::{AnnotatedFacade, AnnotationError, Facade, LayoutError, Note, Rect, Region};

/// One edit. Elements are named by their id, or by `#K`, their place in the file from 0.
#[derive(Debug, Clone, PartialEq)]
pub enum FacadeEdit {
    /// `add LABEL@X,Y,W,H`: a new element, its lower left corner and its size.
    Add(String, Rect),
    /// `move ID=X,Y`: its lower left corner.
    Move(String, [f64; 2]),
    /// `resize ID=W,H`: its lower left corner stays.
    Resize(String, [f64; 2]),
    /// `relabel ID=LABEL`.
    Relabel(String, String),
    /// `remove ID`.
    Remove(String),
    /// `unknown X,Y,W,H`: what is there is not known.
    Unknown(Rect),
    /// `known INDEX`: an unknown rectangle, from 0, is known after all.
    Known(usize),
    /// `outline W,H`: another width and height.
    Outline([f64; 2]),
}

/// Why an edit of a layout cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FacadeEditError {
    /// There is no such element.
    #[error("there is no element {0:?}")]
    NoElement(String),
    /// There is no such unknown rectangle.
    #[error("there is no unknown rectangle {index}: there are {count}")]
    NoUnknown {
        /// Its index.
        index: usize,
        /// Number of unknown rectangles.
        count: usize,
    },
    /// A rectangle without a size.
    #[error("{0:?}: expected a width and height above zero")]
    Size(Rect),
    /// The edited layout is none.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The edited annotations do not fit.
    #[error(transparent)]
    Annotation(#[from] AnnotationError),
}

/// The name of an element in edits.
pub(super) fn reference(note: &Note, index: usize) -> String {
    note.id.clone().unwrap_or_else(|| format!("#{index}"))
}

/// A rectangle with a size.
pub(super) fn checked(r: Rect) -> Result<Rect, FacadeEditError> {
    let numbers = [r.x, r.y, r.width, r.height];
    match numbers.iter().all(|v| v.is_finite()) && r.width > 0.0 && r.height > 0.0 {
        true => Ok(r),
        false => Err(FacadeEditError::Size(r)),
    }
}

impl std::str::FromStr for FacadeEdit {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        read(text).map_err(|message| CommandError::Edit {
            edit: text.to_owned(),
            message,
        })
    }
}

fn read(text: &str) -> Result<FacadeEdit, String> {
    let (verb, rest) = text.split_once(' ').unwrap_or((text, ""));
    // A label or id may hold the sign itself: what follows the last one is numbers.
    let at = |sign: char, form: &str| {
        let parts = rest.rsplit_once(sign);
        parts.ok_or_else(|| format!("expected {verb} {form}"))
    };
    let rect = |text: &str| numbers(text).map(|[x, y, w, h]: [f64; 4]| Rect::new(x, y, w, h));
    Ok(match verb {
        "add" => {
            let (label, place) = at('@', "LABEL@X,Y,W,H")?;
            FacadeEdit::Add(label.to_owned(), rect(place)?)
        }
        "move" => {
            let (id, to) = at('=', "ID=X,Y")?;
            FacadeEdit::Move(id.to_owned(), numbers(to)?)
        }
        "resize" => {
            let (id, to) = at('=', "ID=W,H")?;
            FacadeEdit::Resize(id.to_owned(), numbers(to)?)
        }
        "relabel" => {
            let (id, label) = at('=', "ID=LABEL")?;
            FacadeEdit::Relabel(id.to_owned(), label.to_owned())
        }
        "remove" if !rest.is_empty() => FacadeEdit::Remove(rest.to_owned()),
        "unknown" => FacadeEdit::Unknown(rect(rest)?),
        "known" => FacadeEdit::Known(rest.parse().map_err(|_| "expected known INDEX")?),
        "outline" => FacadeEdit::Outline(numbers(rest)?),
        _ => {
            return Err(
                "expected add, move, resize, relabel, remove, unknown, known or outline".into(),
            );
        }
    })
}

impl FacadeEdit {
    /// Reads edits.
    pub(super) fn parse_all(texts: &[String]) -> Result<Vec<Self>> {
        if texts.is_empty() {
            return Err(CommandError::Nothing.into());
        }
        let read: Result<Vec<Self>, CommandError> = texts.iter().map(|t| t.parse()).collect();
        Ok(read?)
    }
}

/// The layout after edits, made in turn. An element that is added, moved, resized or relabelled is observed from then on:
/// a completion keeps it.
///
/// # Errors
/// [`FacadeEditError`].
pub fn edit(
    layout: &AnnotatedFacade,
    edits: &[FacadeEdit],
) -> Result<AnnotatedFacade, FacadeEditError> {
    let mut out = layout.clone();
    for edit in edits {
        apply(&mut out, edit)?;
    }
    let f = out.facade;
    out.facade = Facade::new(f.name, f.unit, f.width, f.height, f.regions)?;
    out.check()?;
    Ok(out)
}

fn apply(layout: &mut AnnotatedFacade, edit: &FacadeEdit) -> Result<(), FacadeEditError> {
    match edit {
        FacadeEdit::Add(label, rect) => {
            let rect = checked(*rect)?;
            let id = free_id(layout);
            layout.facade.regions.push(Region {
                label: label.clone(),
                rect,
            });
            layout.notes.push(Note {
                id: Some(id),
                observed: Some(true),
                ..Note::default()
            });
        }
        FacadeEdit::Move(id, [x, y]) => {
            let k = fixed(layout, id)?;
            let rect = &mut layout.facade.regions[k].rect;
            (rect.x, rect.y) = (*x, *y);
        }
        FacadeEdit::Resize(id, [w, h]) => {
            let k = fixed(layout, id)?;
            let rect = &mut layout.facade.regions[k].rect;
            (rect.width, rect.height) = (*w, *h);
            checked(*rect)?;
        }
        FacadeEdit::Relabel(id, label) => {
            let k = fixed(layout, id)?;
            layout.facade.regions[k].label.clone_from(label);
        }
        FacadeEdit::Remove(id) => {
            let k = index(layout, id)?;
            layout.facade.regions.remove(k);
            layout.notes.remove(k);
        }
        FacadeEdit::Unknown(rect) => {
            let rect = checked(*rect)?;
            layout.unknown.get_or_insert_default().push(rect);
        }
        FacadeEdit::Known(index) => {
            let count = layout.unknown.as_ref().map_or(0, Vec::len);
            match &mut layout.unknown {
                Some(rects) if *index < count => drop(rects.remove(*index)),
                _ => {
                    let index = *index;
                    return Err(FacadeEditError::NoUnknown { index, count });
                }
            }
            // Without any, all that is not observed is unknown again.
            layout.unknown = layout.unknown.take().filter(|u| !u.is_empty());
        }
        FacadeEdit::Outline([w, h]) => {
            (layout.facade.width, layout.facade.height) = (*w, *h);
        }
    }
    Ok(())
}

/// The element of that id, or of that place.
fn index(layout: &AnnotatedFacade, id: &str) -> Result<usize, FacadeEditError> {
    let mut notes = layout.notes.iter();
    let named = notes.position(|note| note.id.as_deref() == Some(id));
    let place = || id.strip_prefix('#').and_then(|k| k.parse().ok());
    let found = named.or_else(place).filter(|k| *k < layout.notes.len());
    found.ok_or_else(|| FacadeEditError::NoElement(id.to_owned()))
}

/// The element of a name, observed from now on.
fn fixed(layout: &mut AnnotatedFacade, id: &str) -> Result<usize, FacadeEditError> {
    let k = index(layout, id)?;
    let note = &mut layout.notes[k];
    note.observed = Some(true);
    (note.probability, note.reason) = (None, None);
    Ok(k)
}

fn free_id(layout: &AnnotatedFacade) -> String {
    let taken = |id: &String| layout.notes.iter().any(|n| n.id.as_ref() == Some(id));
    let mut names = (1..).map(|k| format!("drawn_{k}"));
    // There are fewer elements than numbers.
    names.find(|id| !taken(id)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn empty() -> AnnotatedFacade {
        let facade = Facade::new("f", "m", 12.0, 9.0, Vec::new());
        AnnotatedFacade::plain(facade.unwrap())
    }

    fn done(edits: &[&str]) -> Result<AnnotatedFacade, String> {
        let edits: Result<Vec<FacadeEdit>, _> = edits.iter().map(|e| e.parse()).collect();
        edit(&empty(), &edits.map_err(|e: CommandError| e.to_string())?).map_err(|e| e.to_string())
    }

    #[test]
    fn edits_are_made_in_turn() {
        let made = done(&[
            "add window@1,1,1,1.5",
            "add door@5,0,1,2",
            "move drawn_1=2,3",
            "resize drawn_2=1.25,2",
            "relabel #0=balcony",
            "unknown 0,0,6,9",
            "unknown 6,0,6,9",
            "known 0",
        ])
        .unwrap();
        assert_eq!(made.facade.regions[0].label, "balcony");
        assert_eq!(made.facade.regions[0].rect, Rect::new(2.0, 3.0, 1.0, 1.5));
        assert_eq!(made.facade.regions[1].rect, Rect::new(5.0, 0.0, 1.25, 2.0));
        assert_eq!(made.unknown, Some(vec![Rect::new(6.0, 0.0, 6.0, 9.0)]));
    }

    #[test]
    fn a_moved_element_of_a_completion_is_observed() {
        let mut layout = done(&["add window@1,1,1,1"]).unwrap();
        layout.notes[0] = Note {
            id: Some("added_1".into()),
            observed: Some(false),
            probability: Some(0.5),
            reason: Some("why".into()),
        };
        let moved = edit(&layout, &["move added_1=3,1".parse().unwrap()]).unwrap();
        assert_eq!(moved.notes[0].observed, Some(true));
        assert_eq!(moved.notes[0].probability, None);
    }

    #[test]
    fn bad_edits_name_the_culprit() {
        for (edits, expected) in [
            (&["move w=1,1"][..], "no element \"w\""),
            (&["add window@11.5,0,1,1"], "reaches outside"),
            (&["add window@1,0,0,1"], "above zero"),
            (&["add @1,0,1,1"], "label is empty"),
            (&["add window@1,0,1"], "expected 4 numbers"),
            (&["known 0"], "no unknown rectangle 0"),
            (&["outline 0,3"], "facade width is 0"),
            (&["fly away"], "expected add"),
        ] {
            let message = done(edits).unwrap_err();
            assert!(message.contains(expected), "{edits:?}: {message}");
        }
    }
}
